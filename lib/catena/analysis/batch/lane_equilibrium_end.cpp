// Equilibria in lanes: the last steps of a search, and the check of what it found.
#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/balance/static_accuracy.hpp"
#include "catena/analysis/batch/lane_equilibrium.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// Steps of Newton's method beside a place of rest: the longest one, length scales or rad; the part of it that the next
// one may have, which shows K to be the same to that part; what is no longer than rounding leaves where motions are
// soft.
constexpr int last_steps = 6;
constexpr double next_part = 0.05, not_shorter = thresholds::least_gain;

}  // namespace

// The last steps of Newton's method; returns those that are still not at rest.
LaneSet LaneEquilibrium::settle(LaneSet& lanes) {
  LaneSet going = lanes;
  std::fill(system_.shift[0], system_.shift[0] + lane_count, 0.0);
  for (int k = 0; k < last_steps && going != 0; ++k) {
    system_.look();
    system_.reflect(lanes);
    system_.curve();
    system_.stiffen();
    system_.step();
    base_.copy(system_.q);
    for_each_lane(going, [&](int lane) {
      const double step = system_.told(rest_step, lane), before = at_lane(lane).before;
      if (system_.told(rest_positive, lane) != 1)
        return leave(lanes, lane, "it leaves the place at which it came to rest");
      for (int r = 0; r < system_.rows(); ++r) system_.lambda[r][lane] = system_.next_lambda[r][lane];
      go(1U << lane, true);
      const bool is_rounded = step > not_shorter * before && step <= descent::rounded_change;
      if (step <= system_.rounding(lane) || is_rounded) {
        going &= ~(1U << lane);
      } else if (!(step <= next_part * before)) {
        return leave(lanes, lane, "its stiffness changes much where it comes to rest");
      }
      at_lane(lane).before = step;
    });
    going &= lanes;
  }
  return going;
}

void LaneEquilibrium::finish(LaneSet& lanes, double tolerance) {
  const LaneSet restless = settle(lanes);
  for_each_lane(restless, [&](int lane) { leave(lanes, lane, "its last steps do not settle"); });
  if (lanes != 0) check(lanes, tolerance);
}

void LaneEquilibrium::check(LaneSet& lanes, double tolerance) {
  system_.soften();
  system_.look();
  system_.weigh();
  for_each_lane(lanes, [&](int lane) {
    const double force = system_.told(rest_force, lane), dead = system_.told(rest_dead, lane);
    const double residual = system_.told(rest_residual, lane);
    const double stiffest = std::max(system_.told(rest_stiffest, lane), force / system_.length(lane));
    if (!(residual <= tolerance * force) || (dead > 0 && !(residual <= StaticAccuracy::shown * dead)))
      return leave(lanes, lane, "its forces balance to the rounding of stiff springs alone");
    if (!(system_.told(rest_gap, lane) <= tolerance)) return leave(lanes, lane, "its constraints do not hold");
    // Softer modes certificates look at more closely; here twice as soft ones are left to them.
    if (system_.columns() > system_.rows() &&
        !(system_.told(rest_softest, lane) >= 2 * descent::suspicious_part * stiffest))
      leave(lanes, lane, "a motion is resisted so little that only a certificate tells by how much");
  });
}

}  // namespace catena
