#include "catena/analysis/batch/lane_equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A row of which the rows before it leave less than this part: single searches begin to take it for one that follows
// from others where factors lose all digits, at 1e-10 or so.
constexpr double least_rank = 1e-6;
// A pivot below this part of the stiffest may have the other sign in another order of operations: in plans of a few
// dozen coordinates rounding is below 1e-13 of it, and regularised equations take 1e-10 of what rows resist.
constexpr double doubtful_pivot = 1e-9;
// A lane's numbers are those of a single search to rounding, where positions meet the constraints to 1e-10: decisions
// nearer to their limits, relative to what is compared, are left to that.
constexpr double doubtful_decrease = 1e-7, doubtful_noise = 0.3, doubtful_clip = 1e-9;
// The slope of a step against the terms of its curvature, a hundred times what a single search takes for neutral.
constexpr double neutral_terms = 1e-8;
// N, N/m: far from where products are no longer represented, which single searches look for.
constexpr double most_force = 1e60;
// A mechanism that goes so many extents or radians away may not be held.
constexpr double far_away = 1e3;

}  // namespace

LaneEquilibrium::LaneEquilibrium(const LaneProgram& program)
    : system_(program), base_(program.plan().columns), start_(program.plan().columns) {}

void LaneEquilibrium::leave(LaneSet& lanes, int lane, const char* why) {
  lanes &= ~(1U << lane);
  at_lane(lane).why = why;
}

void LaneEquilibrium::begin(int designs) {
  system_.use(designs);
  for (Lane& lane : lanes_) lane = Lane{0, 1, 0, 0, 0, 0, 1, 0, false, false, nullptr};
}

const char* LaneEquilibrium::set_design(int lane, const Evaluator& evaluator, std::span<const double> q,
                                        bool is_linear) {
  if (!system_.set_design(lane, evaluator)) return "a number of it is not finite";
  at_lane(lane).is_linear = is_linear;
  set_start(lane, q);
  return nullptr;
}

void LaneEquilibrium::set_start(int lane, std::span<const double> q) {
  for (int c = 0; c < system_.columns(); ++c) {
    const Vec2<double> from = system_.origin(c / 3, lane);
    system_.q[c][lane] = start_[c][lane] = q[at(c)] + (c % 3 == 0 ? from.x : c % 3 == 1 ? from.y : 0);
  }
}

void LaneEquilibrium::take(int lane, std::span<double> q, std::span<double> lambda) const {
  for (int c = 0; c < system_.columns(); ++c) {
    const Vec2<double> from = system_.origin(c / 3, lane);
    q[at(c)] = system_.q[c][lane] - (c % 3 == 0 ? from.x : c % 3 == 1 ? from.y : 0);
  }
  for (int r = 0; r < system_.rows(); ++r) lambda[at(r)] = system_.lambda[r][lane];
}

LaneSet LaneEquilibrium::unmet(LaneSet lanes, double most) {
  system_.look();
  LaneSet open = 0;
  for_each_lane(lanes, [&](int lane) {
    if (!(system_.told(rest_gap, lane) <= most)) open |= 1U << lane;
  });
  return open;
}

// Multipliers, and what a search compares with.
void LaneEquilibrium::prepare(LaneSet& lanes) {
  system_.look();
  system_.reflect(lanes);
  system_.balance();
  for_each_lane(lanes, [&](int lane) {
    Lane& own = at_lane(lane);
    // Where constraints have no second derivatives the first step needs no multipliers.
    for (int r = 0; r < system_.rows() && own.is_linear; ++r) system_.lambda[r][lane] = 0;
    own.energy = system_.told(rest_energy, lane) + system_.missed(system_.lambda, lane);
    own.energy_size = std::abs(own.energy);
    own.extent = system_.told(rest_extent, lane);
    if (!std::isfinite(own.energy)) leave(lanes, lane, "its energy is not finite");
  });
}

// Of every lane the first one whose inertia is that of a minimum.
void LaneEquilibrium::choose_shifts(LaneSet& lanes) {
  std::fill(system_.shift[0], system_.shift[0] + lane_count, 0.0);
  for (LaneSet pending = lanes; pending != 0; pending &= lanes) {
    system_.stiffen();
    for_each_lane(pending, [&](int lane) {
      double& shift = system_.shift[0][lane];
      const double stiffest = system_.told(rest_stiffest, lane);
      const double loads = system_.told(rest_force, lane) / at_lane(lane).extent;
      if (system_.told(rest_positive, lane) == 1) pending &= ~(1U << lane);
      if (!(system_.told(rest_pivot, lane) > doubtful_pivot * std::max(stiffest, shift)))
        return leave(lanes, lane, "whether a motion is resisted is a matter of rounding");
      if (!has(pending, lane)) return;
      shift = shift == 0 ? std::max({descent::first_of_rounding * stiffest, descent::first_of_force * loads,
                                     descent::part_of_last * at_lane(lane).last_shift})
                         : shift * descent::stiffening;
      if (!(shift <= descent::largest_shift * std::max(stiffest, loads)))
        leave(lanes, lane, "no stiffness holds it where the search comes to");
    });
  }
}

// Those whose step is the last one.
LaneSet LaneEquilibrium::judge_steps(LaneSet& lanes, double tolerance) {
  LaneSet last = 0;
  for_each_lane(lanes, [&](int lane) {
    const double step = system_.told(rest_step, lane);
    const double slope = system_.told(rest_slope, lane) - system_.missed(system_.next_lambda, lane);
    const double shift = system_.shift[0][lane];
    at_lane(lane).slope = slope;
    if (!std::isfinite(step) || !std::isfinite(slope)) return leave(lanes, lane, "a step is not finite");
    if (step <= (shift > 0 ? descent::polishing_change : descent::last_step)) {
      last |= 1U << lane;
      at_lane(lane).before = shift > 0 ? descent::last_step : step;
      return;
    }
    if (system_.told(rest_residual, lane) <= 10 * tolerance * system_.told(rest_force, lane))
      return leave(lanes, lane, "forces balance, but a step away from there changes its place");
    if (shift == 0 && -slope <= neutral_terms * system_.told(rest_terms, lane))
      leave(lanes, lane, "a motion is resisted by rounding alone");
  });
  return last;
}

// q from the base by the step, or by the part of it that is tried.
void LaneEquilibrium::go(LaneSet lanes, bool whole) {
  for_each_lane(lanes, [&](int lane) {
    const double factor = whole ? 1 : at_lane(lane).factor;
    for (int c = 0; c < system_.columns(); ++c) system_.q[c][lane] = base_[c][lane] + factor * system_.change[c][lane];
  });
}

// Takes steps that lower the energy enough, and halves those that do not.
void LaneEquilibrium::judge_energies(LaneSet& lanes, LaneSet& working, LaneSet restored) {
  for_each_lane(working & lanes, [&](int lane) {
    Lane& own = at_lane(lane);
    if (has(restored, lane)) {
      const double decrease = descent::sufficient_decrease * own.factor * std::min(own.slope, 0.0);
      const double noise = descent::noise_part * (own.energy_size + system_.told(rest_force, lane) * own.extent);
      const double then = system_.told(rest_energy, lane) + system_.missed(system_.next_lambda, lane);
      const double beyond = then - (own.energy + decrease + noise);
      if (!(std::abs(beyond) > doubtful_noise * noise + doubtful_decrease * std::abs(decrease)))
        return leave(lanes, lane, "whether a step lowers the energy enough is a matter of rounding");
      if (beyond < 0) {
        own.energy = then;
        own.energy_size = std::max(own.energy_size, std::abs(then));
        own.last_shift = system_.shift[0][lane];
        if (own.is_clipped) own.reach *= 2;
        working &= ~(1U << lane);
        return;
      }
      own.reach = std::max(own.reach / 2, 1.0);
    }
    own.factor /= 2;
    if (!(own.factor > thresholds::smallest_factor)) leave(lanes, lane, "no step lowers its energy");
  });
  working &= lanes;
}

void LaneEquilibrium::search(LaneSet& lanes) {
  base_.copy(system_.q);
  for_each_lane(lanes, [&](int lane) {
    Lane& own = at_lane(lane);
    const double turn = system_.told(rest_turn, lane), travel = system_.told(rest_travel, lane);
    const double limit = std::min(own.reach * descent::largest_turn / turn, own.reach * own.extent / travel);
    own.is_clipped = limit < 1;
    own.factor = std::min(1.0, limit);
    if (std::abs(limit - 1) <= doubtful_clip) leave(lanes, lane, "whether a step is too long is a matter of rounding");
  });
  for (LaneSet working = lanes; working != 0;) {
    go(working, false);
    const LaneSet restored = restore(lanes, working);
    judge_energies(lanes, working, restored);
  }
  for_each_lane(lanes, [&](int lane) {
    system_.by_weights[0][lane] = 0;
    for (int r = 0; r < system_.rows(); ++r) system_.lambda[r][lane] = system_.next_lambda[r][lane];
    for (int c = 0; c < system_.columns(); ++c) {
      const double moved = std::abs(system_.q[c][lane] - start_[c][lane]);
      if (!(moved <= far_away * (c % 3 == 2 ? 1 : at_lane(lane).extent)))
        return leave(lanes, lane, "it goes far from its start");
    }
  });
}

LaneSet LaneEquilibrium::find(LaneSet lanes, double tolerance) {
  prepare(lanes);
  LaneSet resting = 0;
  for (int k = 0; k < descent::most_steps && lanes != 0; ++k) {
    if (k > 0) system_.reflect(lanes);
    system_.weigh();
    system_.curve();
    for_each_lane(lanes, [&](int lane) {
      if (!(system_.told(rest_rank, lane) > least_rank))
        return leave(lanes, lane, "its constraints come near to depending on each other");
      if (!(std::max(system_.told(rest_stiffest, lane), system_.told(rest_load, lane)) < most_force))
        leave(lanes, lane, "a force or a stiffness is very large");
    });
    choose_shifts(lanes);
    if (lanes == 0) break;
    system_.step();
    const LaneSet last = judge_steps(lanes, tolerance);
    base_.copy(system_.q);
    go(last, true);
    for_each_lane(last, [&](int lane) {
      for (int r = 0; r < system_.rows(); ++r) system_.lambda[r][lane] = system_.next_lambda[r][lane];
    });
    resting |= last;
    lanes &= ~last;
    if (lanes != 0) search(lanes);
  }
  for_each_lane(lanes, [&](int lane) { leave(lanes, lane, "it does not come to rest soon"); });
  if (resting != 0) finish(resting, tolerance);
  return resting;
}

}  // namespace catena
