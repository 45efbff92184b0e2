#include "catena/analysis/statics/endless_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/modes_dense.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Extents of the scene: anything that bends or stretches on the way shows there, and the rounding of the direction,
// which grows with the square of the way, does not yet.
constexpr double far = 1e3;
// What the energy's fall may differ from F s by, of itself: its rounding there is 1e-12, and any spring that is
// stretched on the way is larger.
constexpr double bend = 1e-6;

// The part of the unbalanced forces along motions without stiffness, over columns.
std::vector<double> driven_direction(StaticSystem& system, std::span<const double> lambda) {
  MotionGroups groups(system, true);
  if (!groups.are_small()) return {};
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

}  // namespace

std::optional<EndlessLine> find_endless_line(StaticSystem& system, std::span<const double> q) {
  system.move_to(q);
  std::vector<double> lambda(at(system.plan().rows));
  balance_loads(system, lambda);
  system.fill(lambda, Curvature::exact, 0);
  EndlessLine line{.direction = driven_direction(system, lambda)};
  double largest = 0;
  for (const double v : line.direction) largest = std::max(largest, std::abs(v));
  if (!(largest > 0) || !std::isfinite(largest)) return {};
  for (std::size_t c = 0; c < line.direction.size(); ++c) {
    line.direction[c] /= largest;
    line.force -= line.direction[c] * system.gradient()[c];
  }
  const double energy = system.energy(), reach = far * system.extent();
  bool endless = line.force > thresholds::no_force * system.force_scale(lambda);
  std::vector<double> there;
  for (const double s : {reach / 2, reach}) {
    if (!endless) break;
    there.assign(q.begin(), q.end());
    system.advance(there, line.direction, s, std::numeric_limits<double>::infinity());
    system.move_to(there);
    endless = system.phi_norm() <= std::max(descent::restored, 10 * system.rounding_change()) &&
              std::abs(energy - system.energy() - line.force * s) <= bend * line.force * s;
  }
  system.move_to(q);
  return endless ? std::optional(line) : std::nullopt;
}

}  // namespace catena
