// What constraints exert where velocities jump: a blow falls, a constraint is engaged, the velocity of a driver jumps.
//
//   M (qd+ - qd-) + Phi_q^T p = P        P: impulses of blows and contacts
//
// p has one entry a row of the solver and the signs of multipliers: reactions follow from it as from lambda, in N s and
// N m s (apps/manual/dynamics.md#impulses). Of a driver  load = p dPhi/dc:  positive pushes the value up. Singular
// case: where rows depend on each other p is not unique; the least that does the same is given (minimum_norm.hpp).
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/base/vec2.hpp"

namespace catena {

struct ConstraintImpulse {
  int element = -1;
  double x = 0, y = 0, moment = 0;  ///< on j, or on the one body of an absolute constraint, at its point; N s, N m s
  double load = 0;                  ///< of a driver, N s or N m s; else 0
};

/// An instant at which velocities jump.
struct Jolt {
  double t = 0;
  std::string event;         ///< the events that act, by name; empty: velocities of drivers jump
  std::vector<int> drivers;  ///< these, by number of the element
  std::vector<ConstraintImpulse> impulses;
};

/// p of a change of velocities by constraints alone (P = 0), with the factors at hand.
std::vector<double> impulse_of_change(EquationsOfMotion& equations, std::span<const double> before,
                                      std::span<const double> after);

/// The impulses that are more than rounding, compared with each other and with the momenta of the velocities qd behind
/// the jump, in the order of the elements; from p at the configuration q, where the factors are.
std::vector<ConstraintImpulse> impulses_of(EquationsOfMotion& equations, std::span<const double> q,
                                           std::span<const double> qd, std::vector<double> p);

/// The drivers whose velocity is another one behind t than before; `from`: an earlier instant since which their
/// functions are smooth.
std::vector<int> drivers_that_jump(Evaluator& evaluator, double from, double t);

/// The work of drivers at a jump at t, by element: load x (c'- + c'+) / 2, J.
std::vector<std::pair<int, double>> work_of_drivers(Evaluator& evaluator, const Jolt& jolt);

}  // namespace catena
