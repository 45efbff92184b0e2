// Steps of an elimination while they are put together: sorted into runs that do the same. Private to lane_elimination.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <vector>

#include "catena/analysis/batch/kernels/lane_code.hpp"
#include "catena/base/at.hpp"

namespace catena {

/// Slots that hold constants.
struct LaneUnits {
  int one, minus_one, minus_two;
};

class LaneSteps {
 public:
  /// `factors_are_places`: of the same numbers as targets and sources.
  LaneSteps(const LaneUnits& units, bool factors_are_places) : units_(units), factors_are_places_(factors_are_places) {}

  /// Slots or rows.
  void append(LaneAct act, int target, int source, int factor) {
    order_.push_back({act, 0, {target, source, factor}});
    put(act, {target, source, factor});
  }
  /// t + m s with m = 1, -1 or -2: of two ways to write it that which begins no run.
  void append_sum(int m, int target, int source) {
    order_.push_back({LaneAct::add_product, m, {target, source, -1}});
    const std::size_t earliest = earliest_run({target, source, -1});
    const auto run = [&](LaneAct act) { return last_[static_cast<std::size_t>(act)]; };
    const bool adds =
        m == -2 || (run(LaneAct::add_product) > earliest && run(LaneAct::add_product) > run(LaneAct::subtract_product));
    const int factor = m == -2 ? units_.minus_two : (m == 1) == adds ? units_.one : units_.minus_one;
    put(adds ? LaneAct::add_product : LaneAct::subtract_product, {target, source, factor});
  }
  /// The tail of this number, between other steps of its rows.
  void append_tail(int number, const LaneTail& tail) {
    order_.push_back({LaneAct::solve_tail, 0, {number, -1, -1}});
    runs_.push_back({LaneAct::solve_tail, {{number, -1, -1}}});
    for (int r = 0; r < tail.size; ++r) note(written_, tail.row[r], runs_.size() - 1);
  }

  /// The steps of the transposed operator: (E_n ... E_1)^T = E_1^T ... E_n^T, and (t += m s)^T is s += m t.
  LaneSteps transposed(const std::vector<LaneTail>& tails) const {
    LaneSteps result(units_, factors_are_places_);
    for (auto one = order_.rbegin(); one != order_.rend(); ++one) {
      const auto& [act, sum, step] = *one;
      if (act == LaneAct::solve_tail)
        result.append_tail(step.target, tails[at(step.target)]);
      else if (sum != 0)
        result.append_sum(sum, step.source, step.target);
      else
        result.append(act, step.source, step.target, step.factor);
    }
    return result;
  }

  /// Puts all steps into `step`, with places of values, and returns their runs.
  std::vector<LaneRun> finish(std::vector<LaneStep>& step) const {
    std::vector<LaneRun> runs;
    for (const Run& run : runs_) {
      if (run.act == LaneAct::solve_tail) {
        runs.push_back({run.act, run.steps.front().target, 0});
        continue;
      }
      const int first = static_cast<int>(step.size());
      const auto place = [](int number) { return lane_count * number; };
      for (const LaneStep& s : run.steps) step.push_back({place(s.target), place(s.source), place(s.factor)});
      runs.push_back({run.act, first, static_cast<int>(step.size())});
    }
    return runs;
  }

 private:
  struct Run {
    LaneAct act;
    std::vector<LaneStep> steps;
  };
  struct Appended {
    LaneAct act;
    int sum;  ///< the constant factor; 0: none
    LaneStep step;
  };
  std::size_t earliest_run(const LaneStep& s) const {
    const std::size_t earliest = std::max({after_writing(s.target), after_reading(s.target), after_writing(s.source)});
    return factors_are_places_ ? std::max(earliest, after_writing(s.factor)) : earliest;
  }
  void put(LaneAct act, const LaneStep& step) {
    const std::size_t run = run_of(act, earliest_run(step));
    runs_[run].steps.push_back(step);
    note(written_, step.target, run);
    note(read_, step.source, run);
    if (factors_are_places_) note(read_, step.factor, run);
  }
  /// The last run of its kind, if it is not before `earliest`; else a new one. Steps of one run keep their order.
  std::size_t run_of(LaneAct act, std::size_t earliest) {
    std::size_t& last = last_[static_cast<std::size_t>(act)];
    if (last == 0 || last - 1 < earliest) {
      runs_.push_back({act, {}});
      last = runs_.size();
    }
    return last - 1;
  }
  static std::size_t look_up(const std::vector<std::size_t>& list, int place) {
    return place >= 0 && at(place) < list.size() ? list[at(place)] : 0;
  }
  std::size_t after_writing(int place) const { return look_up(written_, place); }
  std::size_t after_reading(int place) const { return look_up(read_, place); }
  static void note(std::vector<std::size_t>& list, int place, std::size_t run) {
    if (place < 0) return;
    if (list.size() <= at(place)) list.resize(at(place) + 1, 0);
    list[at(place)] = std::max(list[at(place)], run);
  }

  LaneUnits units_;
  bool factors_are_places_;
  std::vector<Run> runs_;
  std::vector<Appended> order_;  // as they were appended
  std::vector<std::size_t> written_,
      read_;                           // of every place: the last run that writes, or reads it
  std::array<std::size_t, 2> last_{};  // of every kind: one more than its last run
};

}  // namespace catena
