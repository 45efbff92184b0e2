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

/// A body whose angle follows that of another: by the same turns, or with a
/// turn + b other = 0 in a pair that rolls, up to whole periods 2 pi (a + b),
/// on which its equation does not depend (gear.hpp).
struct Tie {
  int body;
  double a, b;
  bool rolls;
};

/// The turn of the other body of a rolling pair if one turns by `by`:
/// of all possible turns the one that changes its pose least, and of these the
/// smallest.
double least_turn(const Tie& tie, double by) {
  constexpr double turn = 2 * std::numbers::pi;
  constexpr int most_periods = 24;
  const double period = turn * (tie.a + tie.b) / tie.b, first = -tie.a / tie.b * by;
  if (period == 0) return first;
  // Whole turns of the other body come round with the periods; those nearest to
  // no turn at all are looked at.
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

}  // namespace

void move_whole_turns(const Evaluator& evaluator, std::span<double> q) {
  const Plan& plan = evaluator.plan();
  const Model& model = evaluator.model();
  constexpr double turn = 2 * std::numbers::pi;
  struct Start {
    int body;
    double by;
  };
  std::vector<Start> starts;
  std::vector<std::vector<Tie>> tied(at(plan.bodies));
  const auto turns_off = [](double misfit) { return std::round(misfit / turn); };
  const auto body_of = [&](int model_body) { return model_body < 0 ? -1 : plan.plan_body[at(model_body)]; };
  const auto angle = [&](int body) { return body < 0 ? 0.0 : q[at(3 * body + 2)]; };
  const auto tie = [&](int i, int j, double a, double b, bool rolls) {
    if (i < 0 || j < 0) return;
    tied[at(i)].push_back({j, a, b, rolls});
    tied[at(j)].push_back({i, b, a, rolls});
  };
  for (const auto& entry : std::get<std::vector<ElementEntry<AbsoluteAngle<double>, double>>>(model.constraints)) {
    if (plan.is_released(entry.id)) continue;
    const int body = body_of(entry.i);
    const double k = turns_off(evaluator.element_value(entry.id).f - angle(body));
    if (k != 0) starts.push_back({body, k * turn});
  }
  for (const auto& entry : std::get<std::vector<ElementEntry<RelativeAngle<double>, double>>>(model.constraints)) {
    if (plan.is_released(entry.id)) continue;
    const int i = body_of(entry.i), j = body_of(entry.j);
    const double k = turns_off(evaluator.element_value(entry.id).f - (angle(j) - angle(i)));
    if (k == 0) {
      tie(i, j, 1, -1, false);
    } else if (j >= 0 && j < plan.moving) {
      starts.push_back({j, k * turn});
    } else {
      starts.push_back({i, -k * turn});
    }
  }
  if (starts.empty()) return;
  for (const auto& entry : std::get<std::vector<ElementEntry<Weld<double>, double>>>(model.constraints)) {
    if (!plan.is_released(entry.id)) tie(body_of(entry.i), body_of(entry.j), 1, -1, false);
  }
  for (const auto& entry : std::get<std::vector<ElementEntry<Gear<double>, double>>>(model.constraints)) {
    if (plan.is_released(entry.id)) continue;
    const Gear<double>& gear = entry.element;
    tie(body_of(entry.i), body_of(entry.j), gear.radius_i, gear.internal ? -gear.radius_j : gear.radius_j, true);
  }
  for (const auto& entry : std::get<std::vector<ElementEntry<Belt<double>, double>>>(model.constraints)) {
    if (plan.is_released(entry.id)) continue;
    const Belt<double>& belt = entry.element;
    tie(body_of(entry.i), body_of(entry.j), belt.radius_i, belt.crossed ? belt.radius_j : -belt.radius_j, true);
  }
  struct Turned {
    int body;
    double by;
  };
  std::vector<char> moved(at(plan.bodies), 0);
  for (const Start& start : starts) {
    if (start.body < 0 || start.body >= plan.moving || moved[at(start.body)]) continue;
    std::vector<Turned> queue = {{start.body, start.by}};
    moved[at(start.body)] = 1;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const Turned turned = queue[head];
      q[at(3 * turned.body + 2)] += turned.by;
      for (const Tie& other : tied[at(turned.body)]) {
        if (moved[at(other.body)] || other.body >= plan.moving) continue;
        moved[at(other.body)] = 1;
        queue.push_back({other.body, other.rolls ? least_turn(other, turned.by) : turned.by});
      }
    }
  }
}

}  // namespace catena
