// The equations of motion of a mechanism as a right-hand side: accelerations from positions and velocities, and the
// projections that keep both on the constraints (apps/manual/dynamics.md#equations-of-motion).
//
//   accelerations   [M, Phi_q^T; Phi_q, 0] [qdd; lambda] = [Q; gamma]
//   positions       q -= M^-1 Phi_q^T S^-1 Phi(q), repeated with the factors at hand until Phi is rounding
//   velocities      qd -= M^-1 Phi_q^T S^-1 (Phi_q qd - nu): the least change in the mass metric
//
// Vectors have plan.coordinates() entries, three a body in plan order, of which those of moving bodies are written.
// Nothing here allocates after the first call of accelerations().
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "catena/analysis/motion/mass_matrix.hpp"
#include "catena/analysis/motion/state_loads.hpp"
#include "catena/analysis/pose/scaling.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/systems/constraint_solver.hpp"
#include "catena/base/status.hpp"

namespace catena {

class EquationsOfMotion {
 public:
  explicit EquationsOfMotion(Evaluator& evaluator);
  /// With the masses of others of the same model, and with what they know of the structure of its equations.
  EquationsOfMotion(Evaluator& evaluator, const EquationsOfMotion& like);

  /// Takes over the masses; a report naming the body if a mass or inertia is missing.
  Report use_masses();
  /// Chooses the small masses that replace zero ones from the constrained masses at q and the evaluator's time.
  /// Allocates; does nothing without massless coordinates.
  void weigh_massless(std::span<const double> q);
  /// Whether accelerations at q and the evaluator's time are unique in spite of massless coordinates: whether M is
  /// positive definite where the constraints leave freedom.
  Report check_massless(std::span<const double> q);
  /// The body whose massless coordinate nothing determined at the last accelerations(), in words; empty: none.
  std::string undetermined() const;

  /// qdd at (t, q, qd); `side` where a function of time jumps at t. False: something is not finite. `stabilisation`, s
  /// in 1/s: constraints that are not met return to zero by Phi'' + 2 s Phi' + s^2 Phi = 0.
  bool accelerations(double t, Side side, std::span<const double> q, std::span<const double> qd, std::span<double> qdd,
                     double stabilisation = 0);
  /// Forces beside those of the model's elements, from now on; nullptr: none.
  void attach(StateLoads* loads) { state_loads_ = loads; }
  StateLoads* state_loads() { return state_loads_; }
  const StateLoads* state_loads() const { return state_loads_; }
  /// Solves [M, Phi_q^T; Phi_q, 0] [qdd; lambda] = [loads; gamma] with the factors at hand.
  void solve_motion(std::span<const double> loads, std::span<const double> gamma, std::span<double> qdd,
                    std::span<double> lambda) {
    system_.solve_motion(loads, gamma, qdd, lambda, evaluator_.counters);
  }
  /// The same for four right-hand sides at once.
  void solve_motion(std::span<const Lanes> loads, std::span<const Lanes> gamma, std::span<Lanes> qdd,
                    std::span<Lanes> lambda, SchurLanes& scratch) {
    system_.solve_motion(loads, gamma, qdd, lambda, scratch, evaluator_.counters);
  }
  /// The same for rows of `width` right-hand sides, see ConstraintSolver.
  void solve_motion_rows(std::span<double> x, std::span<double> rows, std::size_t width, SchurRows& scratch) {
    system_.solve_motion_rows(x, rows, width, scratch, evaluator_.counters);
  }
  /// Multipliers of the solver's rows at the last accelerations().
  std::span<const double> multipliers() const { return lambda_; }

  /// Generalized forces of gravity and force elements at the last accelerations().
  std::span<const double> applied_forces() const { return loads_; }

  // The following functions use the factors, the configuration and the time of the last accelerations() or factorize().

  /// Factors at (t, q) without computing accelerations.
  bool factorize(double t, Side side, std::span<const double> q);
  /// Largest residual of positions, in length scales or rad.
  double position_residual(std::span<const double> q);
  /// Moves q onto the constraints. Returns the largest residual left, in length scales or rad.
  double project_position(std::span<double> q, int max_iterations);
  /// Projects qd onto the velocities that the constraints allow at the configuration left by project_position(), until
  /// the residual is rounding compared with the velocities `rate` (1/s), at most twice. Returns the residual of qd as
  /// it was.
  double project_velocity(std::span<double> qd, double rate);
  /// Directions among the equations that are not solved for, see ConstraintSolver and RedundantRows. The next use
  /// factors again.
  void leave_out(SparseVectors directions) {
    system_.leave_out(std::move(directions));
    factored_ = false;
  }
  const SparseVectors& left_out() const { return system_.left_out(); }
  std::vector<double> row_sizes() const { return system_.row_sizes(); }
  void solve_rows(std::span<double> x) { system_.solve_rows(x, evaluator_.counters); }
  /// Removes from x approximately the part that the constraints do not allow, for estimates of errors.
  void remove_forbidden(std::span<double> x);
  /// See ConstraintSolver: near zero where constraints depend on each other.
  double smallest_pivot_ratio() const { return plan_.rows > 0 ? system_.smallest_pivot_ratio() : 1; }
  int weakest_row() const { return system_.weakest_row(); }
  /// Whether constraints that are solved for depend on each other, in a singular position.
  bool is_singular() const { return plan_.rows > 0 && system_.is_regularised(); }
  /// Whether multipliers are not unique: there, and always where constraints are redundant.
  bool is_dependent() const { return is_singular() || left_out().count() > 0; }

  Evaluator& evaluator() { return evaluator_; }
  const Plan& plan() const { return plan_; }
  const MassMatrix& masses() const { return masses_; }

 private:
  bool evaluate_jacobian(double t, Side side, std::span<const double> q);
  void stabilise(std::span<const double> qd, double rate);

  Evaluator& evaluator_;
  const Plan& plan_;
  MassMatrix masses_;
  Scaling scaling_;
  ConstraintSolver system_;
  StateLoads* state_loads_ = nullptr;
  bool factored_ = false, weighed_ = false;
  std::vector<double> jacobian_, gamma_, lambda_, loads_, residual_, multipliers_, change_;
};

}  // namespace catena
