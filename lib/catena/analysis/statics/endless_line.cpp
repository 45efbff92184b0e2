#include "catena/analysis/statics/endless_line.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/modes_dense.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/analysis/statics/solvers/endless_fall.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The part of the unbalanced forces along motions without stiffness, over columns.
std::vector<double> driven_direction(StaticSystem& system, MotionGroups& groups, std::span<const double> lambda) {
  const StiffnessFloor floor(system, lambda, 0, &groups);
  const std::vector<double> weight = metric_of_arms(system, lambda);
  std::vector<double> residual(at(system.plan().columns)), direction(residual.size(), 0.0);
  system.residual(lambda, residual);
  const DenseModes dense(system, groups, weight);
  for (const Mode& mode : dense.lowest(0, floor)) {
    if (std::abs(mode.omega2) > neutral_part * system.matrix().absolute_quadratic(mode.shape)) continue;
    double work = 0;
    for (std::size_t c = 0; c < residual.size(); ++c) work -= residual[c] * mode.shape[c];
    for (std::size_t c = 0; c < residual.size(); ++c) direction[c] += work * mode.shape[c];
  }
  return direction;
}

// The bodies of a group moved alike, as the loads on all of them pull: over columns.
std::vector<double> drift_of(const StaticSystem& system, const MotionGroup& group) {
  std::vector<double> direction(at(system.plan().columns), 0.0);
  double load[2] = {0, 0};
  const auto axis = [&](int c) { return system.plan().coordinate[at(c)] % 3; };
  for (int c : group.columns) {
    if (axis(c) < 2) load[axis(c)] -= system.gradient()[at(c)];
  }
  for (int c : group.columns) {
    if (axis(c) < 2) direction[at(c)] = load[axis(c)];
  }
  return direction;
}

// Along this direction, if it is one that the energy falls along without end from q.
std::optional<EndlessLine> follow(StaticSystem& system, std::span<const double> q, std::vector<double> direction,
                                  double force_scale) {
  EndlessLine line{.direction = std::move(direction)};
  double largest = 0;
  for (const double v : line.direction) largest = std::max(largest, std::abs(v));
  if (!(largest > 0) || !std::isfinite(largest)) return {};
  for (std::size_t c = 0; c < line.direction.size(); ++c) {
    line.direction[c] /= largest;
    line.force -= line.direction[c] * system.gradient()[c];
  }
  const bool endless = line.force > thresholds::no_force * force_scale && falls_for_ever(system, q, line.direction);
  return endless ? std::optional(line) : std::nullopt;
}

}  // namespace

std::optional<EndlessLine> find_endless_line(StaticSystem& system, std::span<const double> q) {
  system.move_to(q);
  std::vector<double> lambda(at(system.plan().rows));
  balance_loads(system, lambda);
  system.fill(lambda, Curvature::exact, 0);
  const double force_scale = system.force_scale(lambda);
  MotionGroups groups(system, true);
  if (!groups.are_small()) return {};
  std::optional<EndlessLine> line = follow(system, q, driven_direction(system, groups, lambda), force_scale);
  for (const MotionGroup& group : groups.groups()) {
    if (line) break;
    line = follow(system, q, drift_of(system, group), force_scale);
  }
  return line;
}

}  // namespace catena
