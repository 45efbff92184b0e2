// Static equilibria of a group of designs, side by side: the minimum of the potential energy that is reached downhill
// from the start of each.
//
// Lanes take the steps of a single search (statics/solvers/static_descent.hpp) by the same rules
// (balance/descent_rules.hpp), every lane with its own shift of K and its own length of step: they follow the same
// road to the same place. A lane leaves the group, with the reason, where the single search might take another one:
// where a decision is as near to its limit as rounding, the inertia that of a saddle to rounding, a start in balance
// but not at rest, steps that the energy rejects all along, a constraint near to depending on others, more than a turn.
// The others do not notice, and the design is for the single search. What is found is checked: forces balance and
// constraints hold to the tolerance, K is positive on the null space of Phi_q, and by so much that no rounding decides.
//
//   softest stiffness >= 2e-6 of the largest      of which the certificate of a single search has no doubt
//                                                 (spectrum/certificate.hpp)
//
// Units: m, rad, N, J. Allocates when it is made.
#pragma once

#include <array>
#include <string>

#include "catena/analysis/batch/lane_static_system.hpp"

namespace catena {

class LaneEquilibrium {
 public:
  /// `program`, one of make_static(), must outlive this object.
  explicit LaneEquilibrium(const LaneProgram& program);

  /// So many designs come next, in the first lanes.
  void begin(int designs);
  /// The design that an evaluator has, at its time, with the start of its search, in plan order; whether its
  /// constraints are linear. Empty, or why it cannot be in a lane.
  const char* set_design(int lane, const Evaluator& evaluator, std::span<const double> q, bool is_linear);
  /// Another start.
  void set_start(int lane, std::span<const double> q);
  /// The lanes whose start misses the constraints by more than this, rad or length scales.
  LaneSet unmet(LaneSet lanes, double most);
  /// Searches in these lanes; those in which an equilibrium was found. `tolerance` as in EquilibriumOptions.
  LaneSet find(LaneSet lanes, double tolerance);
  /// Why a lane left the group.
  const char* why(int lane) const { return lanes_[static_cast<std::size_t>(lane)].why; }
  /// Where it is at rest, in plan order; the multipliers of the solver's rows; the largest residual of constraints, m.
  void take(int lane, std::span<double> q, std::span<double> lambda) const;
  double gap(int lane) const { return system_.told(rest_gap, lane) * system_.length(lane); }

 private:
  struct Lane {
    double last_shift, reach, energy, energy_size, extent, slope;
    double factor, before;  ///< of the step; the residual before a correction, or the step before a last one
    bool is_clipped, is_linear;
    const char* why = nullptr;
  };
  Lane& at_lane(int lane) { return lanes_[static_cast<std::size_t>(lane)]; }
  void leave(LaneSet& lanes, int lane, const char* why);
  void prepare(LaneSet& lanes);
  void choose_shifts(LaneSet& lanes);
  LaneSet judge_steps(LaneSet& lanes, double tolerance);
  void search(LaneSet& lanes);
  void judge_energies(LaneSet& lanes, LaneSet& working, LaneSet restored);
  LaneSet restore(LaneSet& lanes, LaneSet working);
  LaneSet correct_all(LaneSet& lanes, LaneSet going, bool anew);
  bool is_restored(int lane) const;
  void go(LaneSet lanes, bool whole);
  void finish(LaneSet& lanes, double tolerance);
  LaneSet settle(LaneSet& lanes);
  void check(LaneSet& lanes, double tolerance);

  LaneStaticSystem system_;
  LaneNumbers base_, start_;  // where a step begins, where the search began
  std::array<Lane, static_cast<std::size_t>(lane_count)> lanes_{};
};

}  // namespace catena
