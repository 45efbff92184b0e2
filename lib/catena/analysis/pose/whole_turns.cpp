#include "catena/analysis/pose/whole_turns.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "catena/base/at.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/belt.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/weld.hpp"

namespace catena {
namespace {

/// A body whose angle follows that of another: by the same turns, or with a turn + b other = 0 in a pair that rolls, up
/// to whole periods 2 pi (a + b), on which its equation does not depend (gear.hpp).
struct Tie {
  int body;
  double a, b;
  bool rolls;
};

/// The turn of the other body of a rolling pair if one turns by `by`: of all possible turns the one that changes its
/// pose least, and of these the smallest.
double least_turn(const Tie& tie, double by) {
  constexpr double turn = 2 * std::numbers::pi;
  // Periods of a pair whose radii are in a ratio of whole numbers up to some fifty come back to where they were.
  constexpr int most_periods = 24;
  const double period = turn * (tie.a + tie.b) / tie.b, first = -tie.a / tie.b * by;
  if (period == 0) return first;
  // Whole turns of the other body come round with the periods; those nearest to no turn at all are looked at.
  const double centre = std::round(-first / period);
  double best = first + centre * period;
  const auto pose = [&](double x) { return std::abs(std::remainder(x, turn)); };
  for (int k = -most_periods; k <= most_periods; ++k) {
    const double x = first + (centre + k) * period;
    const bool nearer = pose(x) < pose(best) - 1e-9;
    if (nearer || (pose(x) < pose(best) + 1e-9 && std::abs(x) < std::abs(best))) best = x;
  }
  return best;
}

struct Turned {
  int body;
  double by;  // rad
};

/// Bodies whose given angle is off by whole turns from what a value asks for, and those that turn with them.
class WholeTurns {
 public:
  WholeTurns(const Evaluator& evaluator, std::span<double> q)
      : evaluator_(evaluator), plan_(evaluator.plan()), q_(q), tied_(at(plan_.bodies)), moved_(at(plan_.bodies), 0) {}

  void move() {
    find_starts();
    if (starts_.empty()) return;
    each<Weld>([&](const auto& entry) { tie(body(entry.i), body(entry.j), {1, -1}, false); });
    each<Gear>([&](const auto& entry) {
      const auto& gear = entry.element;
      tie(body(entry.i), body(entry.j), {gear.radius_i, gear.internal ? -gear.radius_j : gear.radius_j}, true);
    });
    each<Belt>([&](const auto& entry) {
      const auto& belt = entry.element;
      tie(body(entry.i), body(entry.j), {belt.radius_i, belt.crossed ? belt.radius_j : -belt.radius_j}, true);
    });
    for (const Turned& start : starts_) {
      if (start.body >= 0 && start.body < plan_.moving && !moved_[at(start.body)]) turn_with(start);
    }
  }

 private:
  static constexpr double turn = 2 * std::numbers::pi;
  struct Ratio {
    double i, j;
  };

  /// Calls f for every element of a type that holds.
  template <template <class> class E, class F>
  void each(F&& f) const {
    for (const auto& entry : std::get<std::vector<ElementEntry<E<double>, double>>>(evaluator_.model().constraints)) {
      if (!plan_.is_released(entry.id)) f(entry);
    }
  }
  int body(int model_body) const { return model_body < 0 ? -1 : plan_.plan_body[at(model_body)]; }
  double angle(int body) const { return body < 0 ? 0.0 : q_[at(3 * body + 2)]; }
  void tie(int i, int j, Ratio ratio, bool rolls) {
    if (i < 0 || j < 0) return;
    tied_[at(i)].push_back({j, ratio.i, ratio.j, rolls});
    tied_[at(j)].push_back({i, ratio.j, ratio.i, rolls});
  }

  void find_starts() {
    const auto turns_off = [](double misfit) { return std::round(misfit / turn); };
    each<AbsoluteAngle>([&](const auto& entry) {
      const int b = body(entry.i);
      const double k = turns_off(evaluator_.element_value(entry.id).f - angle(b));
      if (k != 0) starts_.push_back({b, k * turn});
    });
    each<RelativeAngle>([&](const auto& entry) {
      const int i = body(entry.i), j = body(entry.j);
      const double k = turns_off(evaluator_.element_value(entry.id).f - (angle(j) - angle(i)));
      if (k == 0) {
        tie(i, j, {1, -1}, false);
      } else if (j >= 0 && j < plan_.moving) {
        starts_.push_back({j, k * turn});
      } else {
        starts_.push_back({i, -k * turn});
      }
    });
  }

  /// Turns a body, and those that are tied to it, each once.
  void turn_with(const Turned& start) {
    std::vector<Turned> queue = {start};
    moved_[at(start.body)] = 1;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const Turned turned = queue[head];
      q_[at(3 * turned.body + 2)] += turned.by;
      for (const Tie& other : tied_[at(turned.body)]) {
        if (moved_[at(other.body)] || other.body >= plan_.moving) continue;
        moved_[at(other.body)] = 1;
        queue.push_back({other.body, other.rolls ? least_turn(other, turned.by) : turned.by});
      }
    }
  }

  const Evaluator& evaluator_;
  const Plan& plan_;
  std::span<double> q_;
  std::vector<Turned> starts_;
  std::vector<std::vector<Tie>> tied_;
  std::vector<char> moved_;
};

}  // namespace

void move_whole_turns(const Evaluator& evaluator, std::span<double> q) { WholeTurns(evaluator, q).move(); }

}  // namespace catena
