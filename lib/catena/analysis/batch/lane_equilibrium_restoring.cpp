// Equilibria in lanes: steps brought back onto the constraints.
#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/batch/lane_equilibrium.hpp"

namespace catena {
namespace {

// A residual as near to the limit, relative to it: single searches solve for corrections with constraints that yield by
// 1e-10 (KktMatrix), which moves the residual by parts of that size.
constexpr double doubtful_part = 1e-6;

}  // namespace

bool LaneEquilibrium::is_restored(int lane) const {
  return system_.told(rest_gap, lane) <= std::max(descent::restored, 10 * system_.rounding(lane));
}

// Corrections with the factors at hand, or anew; returns those that meet the constraints.
LaneSet LaneEquilibrium::correct_all(LaneSet& lanes, LaneSet going, bool anew) {
  LaneSet restored = 0;
  for_each_lane(going, [&](int lane) { at_lane(lane).before = system_.told(rest_gap, lane); });
  for (int k = 0; k <= descent::most_corrections; ++k) {
    for_each_lane(going, [&](int lane) {
      if (is_restored(lane)) restored |= 1U << lane;
    });
    going &= ~restored & lanes;
    if (going == 0 || k == descent::most_corrections) break;
    if (anew) {
      for_each_lane(going, [&](int lane) { system_.by_weights[0][lane] = 1; });
      system_.reflect(going);
    }
    system_.correct(going);
    LaneSet lost = 0;
    for_each_lane(going, [&](int lane) {
      if (!(system_.told(rest_step, lane) < descent::longest_correction)) lost |= 1U << lane;
    });
    system_.look();
    for_each_lane(going & ~lost, [&](int lane) {
      double& before = at_lane(lane).before;
      const double now = system_.told(rest_gap, lane), limit = descent::remaining_part * before;
      if (is_restored(lane)) return;
      if (std::abs(now - limit) <= doubtful_part * limit)
        return leave(lanes, lane, "whether its constraints are met soon enough is a matter of rounding");
      if (!(now <= limit)) lost |= 1U << lane;
      before = now;
    });
    going &= ~lost;
  }
  return restored & lanes;
}

// Onto the constraints from q, which is where a step leads to; returns those that came there.
LaneSet LaneEquilibrium::restore(LaneSet& lanes, LaneSet working) {
  system_.look();
  LaneSet restored = correct_all(lanes, working, false);
  const LaneSet others = working & lanes & ~restored;
  if (others == 0) return restored;
  go(others, false);
  system_.look();
  return restored | correct_all(lanes, others, true);
}

}  // namespace catena
