// Steps of an elimination while they are put together: sorted into runs that do the same. Private to lane_elimination.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>
#include <vector>

#include "catena/analysis/batch/lane_code.hpp"
#include "catena/base/at.hpp"

namespace catena {

class LaneSteps {
 public:
  /// `factors_are_places`: of the same numbers as targets and sources.
  explicit LaneSteps(bool factors_are_places) : factors_are_places_(factors_are_places) {}

  /// Slots or rows; -1 for those that a step does not have.
  void append(LaneAct act, int target, int source = -1, int factor = -1) {
    order_.push_back({act, {target, source, factor}});
    std::size_t earliest = std::max({after_writing(target), after_reading(target), after_writing(source)});
    if (factors_are_places_) earliest = std::max(earliest, after_writing(factor));
    const std::size_t run = run_of(act, earliest);
    runs_[run].steps.push_back({target, source, factor});
    note(written_, target, run);
    note(read_, source, run);
    if (factors_are_places_) note(read_, factor, run);
  }
  /// The tail of this number, between other steps of its rows.
  void append_tail(int number, const LaneTail& tail) {
    order_.push_back({LaneAct::solve_tail, {number, -1, -1}});
    runs_.push_back({LaneAct::solve_tail, {{number, -1, -1}}});
    for (int r = 0; r < tail.size; ++r) note(written_, tail.row[r], runs_.size() - 1);
  }

  /// The steps of the transposed operator: (E_n ... E_1)^T = E_1^T ... E_n^T, and (t += m s)^T is s += m t.
  LaneSteps transposed(const std::vector<LaneTail>& tails) const {
    LaneSteps result(factors_are_places_);
    for (auto one = order_.rbegin(); one != order_.rend(); ++one) {
      const auto& [act, step] = *one;
      if (act == LaneAct::solve_tail)
        result.append_tail(step.target, tails[at(step.target)]);
      else if (act == LaneAct::negate)
        result.append(act, step.target);
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
      const auto place = [](int number) { return lane_count * std::max(number, 0); };
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

  bool factors_are_places_;
  std::vector<Run> runs_;
  std::vector<std::pair<LaneAct, LaneStep>> order_;  // as they were appended
  std::vector<std::size_t> written_,
      read_;                           // of every place: the last run that writes, or reads it
  std::array<std::size_t, 6> last_{};  // of every kind: one more than its last run
};

}  // namespace catena
