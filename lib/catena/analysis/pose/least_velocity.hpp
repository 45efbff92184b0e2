// The smallest velocities that meet the constraints, where nothing drives the rest of the motion.
//
//   min qd^T W qd  subject to  Phi_q qd = nu       =>   qd = W^-1 Phi_q^T mu,   (Phi_q W^-1 Phi_q^T) mu = nu
//
// W: the masses and inertias if every moving body has them (then the kinetic energy is least), else [1, 1, rho^2], rho
// the body's RMS attachment distance (apps/manual/kinematics.md#motion-of-least-velocity). Accelerations are the time
// derivative of these velocities:
//
//   Phi_q qdd = gamma,   qdd nearest (in W) to  w = W^-1 (sum_r mu_r d2Phi_r/dq2) qd
//
// since d(W^-1 Phi_q^T mu)/dt is w plus a vector in the span of W^-1 Phi_q^T. Where equations depend on each other mu
// is not unique, but qd and qdd are, as long as the rows do not contradict each other. Singular where nu prescribes a
// motion that the constraints exclude: velocity() then returns false. Nothing allocates after the first call.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/pose/scaling.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/systems/constraint_solver.hpp"

namespace catena {

class LeastVelocity {
 public:
  explicit LeastVelocity(Evaluator& evaluator);

  /// Whether W is the mass matrix.
  bool in_mass_metric() const { return in_mass_metric_; }
  /// qd (size coordinates()) at (t, q); `side` where a function of time jumps at t. False: no velocity meets all rows.
  bool velocity(double t, Side side, std::span<const double> q, std::span<double> qd);
  /// qdd where velocity() was called last; false: the rows contradict each other.
  bool acceleration(std::span<const double> qd, std::span<double> qdd);
  /// Moves q by the least change onto the constraints at time t, with the factors at hand while these serve. Returns
  /// the largest residual left, in length scales or rad.
  double project(double t, Side side, std::span<double> q);

  /// qd^T W x / qd^T W qd: the relative growth of the velocities where x is their derivative.
  double growth(std::span<const double> qd, std::span<const double> x) const;
  /// Largest entry of a rate in length scales or rad.
  double size(std::span<const double> rate) const;
  /// After velocity() failed, or where velocities grow without bound: the equation that carries most of the solution.
  int heaviest_row() const;
  /// mu of the last velocity(), by row.
  std::span<const double> multipliers() const { return mu_; }
  /// After velocity() or acceleration(): the elements with the largest residuals, the worst first; some of them
  /// contradict each other, and the least-squares solution meets each of them in part.
  std::vector<int> worst_elements() const;

 private:
  bool factorize(double t, Side side, std::span<const double> q);
  /// step_ = the least change towards rest_ = right-hand side - Phi_q start_; adds it to start_. False: rows are left.
  bool complete(std::span<const double> right_hand_side, std::span<double> out);

  Evaluator& evaluator_;
  const Plan& plan_;
  Scaling scaling_;
  ConstraintSolver solver_;
  bool in_mass_metric_ = false;
  std::vector<double> weight_;                      // per coordinate of a moving body
  std::vector<double> jacobian_;                    // values of Phi_q, and the scratch slot
  std::vector<double> right_, rest_, mu_, lambda_;  // per row
  std::vector<double> start_, step_;                // per coordinate of a moving body
  std::vector<double> turning_;                     // per coordinate
};

}  // namespace catena
