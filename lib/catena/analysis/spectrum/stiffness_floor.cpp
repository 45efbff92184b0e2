// StiffnessFloor: what rounding leaves of stiffnesses, and the arms at which bodies are held.
#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/motion_groups.hpp"
#include "catena/assembly/systems/tangent.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Parts of the uncancelled stiffness that rounding may leave. Multipliers come from solutions refined to 1e-15 or so of
// the largest; a value below a few hundred of these roundings cannot be distinguished from zero. Of coordinates far
// from the origin the last digits are unknown.
constexpr double stiffness_rounding = 2e-13;
// Levers below this part of the length scale are rounding of places.
constexpr double rounding_of_arm = 1e-9;

/// What the equations hold every body with: the sum of the sizes of their forces, N.
std::vector<double> forces_of_equations(const StaticSystem& system, std::span<const double> lambda) {
  const Plan& plan = system.plan();
  std::vector<double> force(at(plan.moving), 0.0);
  for (int c = 0; c < plan.columns; ++c) {
    const int coordinate = plan.coordinate[at(c)];
    if (coordinate % 3 == 2) continue;
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
      force[at(coordinate / 3)] += std::abs(system.jacobian()[at(k)] * lambda[at(plan.jacobian.row_index[at(k)])]);
  }
  return force;
}

// A body that hangs from one equation, its centroid below the point held, has no lever there but for rounding: the
// force passes the centroid. The stiffness against turning is that force times the distance.
void lengthen_by_loads(StaticSystem& system, std::span<const double> lambda, std::vector<double>& arms) {
  const std::vector<double> force = forces_of_equations(system, lambda);
  std::vector<double> turning(arms.size(), 0.0);
  visit_curvature(system.evaluator(), lambda, [&](int row, int column, double value) {
    if (row == column && row % 3 == 2) turning[at(row / 3)] += std::abs(value);
  });
  for (std::size_t b = 0; b < arms.size(); ++b) {
    if (force[b] > 0) arms[b] = std::max(arms[b], turning[b] / force[b]);
  }
}

}  // namespace

std::vector<double> body_arms(StaticSystem& system, std::span<const double> lambda) {
  const Plan& plan = system.plan();
  std::vector<double> travel(at(plan.rows), 0.0), turning(at(plan.moving), 0.0), pushing(turning), arms(turning);
  // Constraints: the distance from the body's origin to the point that they hold.
  for (const bool turns : {false, true}) {
    for (int c = 0; c < plan.columns; ++c) {
      const int coordinate = plan.coordinate[at(c)];
      if ((coordinate % 3 == 2) != turns) continue;
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
        const double entry = std::abs(system.jacobian()[at(k)]);
        double& moved = travel[at(plan.jacobian.row_index[at(k)])];
        if (!turns) moved = std::max(moved, entry);
        if (turns && moved > 0) arms[at(coordinate / 3)] = std::max(arms[at(coordinate / 3)], entry / moved);
      }
    }
  }
  lengthen_by_loads(system, lambda, arms);
  // Forces: the same, from the stiffness against both.
  visit_tangent(system.evaluator(), lambda, [&](int row, int column, double value) {
    if (row != column) return;
    double& most = (row % 3 == 2 ? turning : pushing)[at(row / 3)];
    most = std::max(most, std::abs(value));
  });
  for (std::size_t b = 0; b < arms.size(); ++b) {
    if (arms[b] < rounding_of_arm * system.length()) arms[b] = 0;
    if (!(arms[b] > 0) && pushing[b] > 0) arms[b] = std::sqrt(turning[b] / pushing[b]);
    if (!(arms[b] > 0)) arms[b] = system.length();
  }
  return arms;
}

std::vector<double> metric_of_arms(StaticSystem& system, std::span<const double> lambda) {
  const std::vector<double> arms = body_arms(system, lambda);
  std::vector<double> weight;
  for (const int coordinate : system.plan().coordinate)
    weight.push_back(coordinate % 3 == 2 ? arms[at(coordinate / 3)] * arms[at(coordinate / 3)] : 1);
  return weight;
}

StiffnessFloor::StiffnessFloor(StaticSystem& system, std::span<const double> lambda, double residual,
                               const MotionGroups* groups) {
  const Plan& plan = system.plan();
  Evaluator& evaluator = system.evaluator();
  const std::vector<double> arms = body_arms(system, lambda);
  // Per body, without cancellation: stiffness against travel, N/m, and against turning, N m.
  std::vector<double> travel(arms.size(), 0.0), turning(arms.size(), 0.0);
  visit_tangent(evaluator, lambda, [&](int row, int column, double value) {
    const std::size_t b = at(row / 3), d = at(column / 3);
    const double size = std::abs(value);
    if (row % 3 == 2) {
      turning[b] += size * (column % 3 == 2 ? 1 : arms[b]);
    } else {
      travel[b] += size / (column % 3 == 2 ? arms[d] : 1);
    }
  });
  // Only the part of a pin's force across the arm enters K, but its rounding is that of the whole force.
  const std::vector<double> force = forces_of_equations(system, lambda);
  for (std::size_t b = 0; b < arms.size(); ++b) turning[b] += force[b] * arms[b];
  double farthest = 0;
  for (int b = 0; b < plan.moving; ++b) {
    const Frame<double> frame = evaluator.ground_frame(b);
    farthest = std::max({farthest, std::abs(frame.x), std::abs(frame.y)});
  }
  const double part = stiffness_rounding + thresholds::few_roundings * farthest / system.length();
  // Shapes contain rounding too: every travel includes a little turning, and the other way round.
  for (std::size_t b = 0; b < arms.size(); ++b) travel[b] += turning[b] / (arms[b] * arms[b]);
  for (int coordinate : plan.coordinate) {
    const std::size_t b = at(coordinate / 3);
    floor_.push_back((coordinate % 3 == 2 ? arms[b] * arms[b] : 1) * (part * travel[b] + residual / arms[b]));
  }
  if (!groups) return;
  for (const MotionGroup& group : groups->groups()) {
    double stiffest = 0;
    for (int c : group.columns) stiffest = std::max(stiffest, travel[at(plan.coordinate[at(c)] / 3)]);
    for (int c : group.columns) {
      const double arm = plan.coordinate[at(c)] % 3 == 2 ? arms[at(plan.coordinate[at(c)] / 3)] : 1;
      floor_[at(c)] += thresholds::few_roundings * stiffest * arm * arm;
    }
  }
}

double StiffnessFloor::operator()(std::span<const double> v) const {
  double sum = 0;
  for (std::size_t c = 0; c < floor_.size(); ++c) sum += floor_[c] * v[c] * v[c];
  return sum;
}

double StiffnessFloor::between(std::span<const double> u, std::span<const double> v) const {
  double sum = 0;
  for (std::size_t c = 0; c < floor_.size(); ++c) sum += floor_[c] * std::abs(u[c] * v[c]);
  return sum;
}

}  // namespace catena
