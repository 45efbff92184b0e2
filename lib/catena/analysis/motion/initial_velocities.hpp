// Initial velocities that the constraints allow:
//
//   given components are kept where the constraints allow, else changed least in the mass metric;
//   omitted ones get the least kinetic energy
//
//   min |qd_given - given|_M first, then min qd_omitted^T M qd_omitted, both subject to Phi_q qd = nu
//
// found as a sequence of least changes in which given components weigh 10^4 times their mass and what is still missing
// of them is added to what is asked for (Bregman iteration): exact after a few rounds, with one factorization.
// A velocity is given for the origin of its author's frame. What is massless and not given has a small mass that is
// taken back from round to round: it follows what has mass and resists nothing.
// Singular: where no velocity meets all rows the mechanism is in a dead point (`lock_up`, dead_point.hpp), or rows
// contradict each other (`inconsistent`).
#pragma once

#include <optional>
#include <span>
#include <string>

#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/analysis/pose/singular_point.hpp"

namespace catena {

struct VelocityOutcome : Report {
  double changed = 0;         ///< change of the given component that was changed most, m/s or rad/s
  double changed_part = 0;    ///< the same in parts of the largest velocity, m/s by the length scale
  bool changed_turn = false;  ///< an angular velocity
  int changed_body = -1;      ///< whose it was, in the model's numbering
  double missed = 0;          ///< by what was asked for, of the equations, m/s; angles times the length scale
  std::optional<SingularPoint> dead_point;  ///< where the status is lock_up
};

/// What is asked of initial velocities, by coordinate of moving bodies: given ones are to be kept, and weigh so much;
/// what follows has no mass and is not given. Zero where there is no column.
struct WantedVelocities {
  std::vector<double> velocity, weight;
  std::vector<char> given, follows;
};

/// Of the model, or of an earlier analysis where `given` is not empty: see find_initial_velocities(). Of the masses the
/// small ones in place of zero must have been chosen. At the evaluator's configuration.
WantedVelocities wanted_velocities(const Evaluator& evaluator, const MassMatrix& masses, std::span<const double> given);

/// Most rounds in which what is missing of given velocities is added: each gains the ratio of the weights, 10^4, where
/// it can be had at all.
inline constexpr int rounds_of_velocities = 12;

/// Finds qd (size plan.coordinates()) at the evaluator's time and the assembled configuration q. `given`, if not empty,
/// are velocities of an earlier analysis, all of which count as given; otherwise those of the model do.
VelocityOutcome find_initial_velocities(EquationsOfMotion& equations, std::span<const double> q,
                                        std::span<const double> given, std::span<double> qd);

}  // namespace catena
