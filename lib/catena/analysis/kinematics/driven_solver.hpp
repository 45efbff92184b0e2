// Position, velocity and acceleration of a kinematically driven mechanism: Newton-Raphson on Phi(q, t) = 0, then one
// refined solve each with the factorization at hand (apps/manual/kinematics.md#driven-motion).
//
//   Phi_q dq = -Phi        Phi_q qd = nu        Phi_q qdd = gamma
//
// The square matrix consists of a maximal independent set of equations, all of them where rows == columns. Singular
// where that matrix is: the outcome reports it, and the caller decides. A factorization is kept while it converges: the
// distance of the configuration from where it was made bounds the rate of convergence. Velocities and accelerations are
// refined against the true Jacobian, so that they are exact whichever factors were used.
// Nothing allocates after the first solve.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/pose/scaling.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/linalg/factorization/factorization.hpp"

namespace catena {

struct NewtonOutcome {
  bool converged = false;
  int iterations = 0;
  double residual = 0;          ///< largest row residual at the end, in units of the length scale or rad
  double first_correction = 0;  ///< size of the first correction: how far the start was off
  double first_turn = 0;        ///< its largest angle, rad
  double contraction = 0;       ///< largest ratio of successive corrections above rounding
  FactorResult factor;          ///< why there was no factorization, if so
};

/// One instant of a driven motion, in plan order. Rates that are not known are empty.
struct DrivenInstant {
  double t = 0;
  std::span<const double> q, qd, qdd;
};

class DrivenSolver {
 public:
  explicit DrivenSolver(Evaluator& evaluator);

  /// Uses these rows, as many as there are columns, ascending. The default is all rows, if they are as many.
  void use_rows(std::vector<int> rows);
  /// Exchanges rows in use at q for others that make the matrix better conditioned; false: there are none.
  bool exchange_rows(std::span<const double> q);
  bool is_square() const { return static_cast<int>(rows_.size()) == plan_.columns; }

  /// Factors the matrix at q, at the evaluator's time; returns its crude reciprocal condition number, 0 if singular.
  double factor_at(std::span<const double> q);
  /// The same of the last factorization.
  double rcond() const { return factored_.rcond; }
  /// Newton from q, at the evaluator's time; q is left at the last iterate.
  NewtonOutcome solve_position(std::span<double> q);
  /// Velocities at the configuration of the last solve_position. `qd` holds a start if `has_start`.
  bool solve_velocity(std::span<double> qd, bool has_start);
  /// Accelerations; qd must be the velocities.
  bool solve_acceleration(std::span<const double> qd, std::span<double> qdd, bool has_start);
  /// Solves Phi_q change = rows for the rows in use, with the factors at hand: how all coordinates answer where these
  /// equations are off. Not refined. False if there are no factors.
  bool respond(std::span<const double> rows, std::span<double> change);
  /// Solves Phi_q^T lambda = rhs (columns) for the rows in use; lambda has one entry a row of the plan, others zero.
  bool solve_multipliers(std::span<const double> rhs, std::span<double> lambda);

  /// Residuals, nu and gamma of all equations at the last evaluation, to check those that are not solved with.
  std::span<const double> phi() const { return phi_; }
  /// The largest part of rates, and of multipliers, that refinement left to be corrected in any solve since the last
  /// forget_left(): next correction, as it was predicted, over the largest entry; rates in length scales and rad.
  double left_of_rates() const { return left_.of_rates; }
  double left_of_multipliers() const { return left_.of_multipliers; }
  void forget_left() { left_.of_rates = left_.of_multipliers = 0; }
  /// Phi_q at the last configuration, current after solve_velocity.
  std::span<const double> jacobian();
  const Factorization& factorization() const { return factorization_; }
  /// The distance of every block of the last factorization from a singular one (see Factorization::block_margins).
  std::span<const BlockMargin> block_margins();
  /// Sets the configuration and returns the largest residual of the rows in use, in length scales or rad.
  double residual_at(std::span<const double> q);
  /// The distance of two configurations: the larger of the largest angle, rad, and the largest shift in length scales
  /// (of a structure much longer than these: in hundredths of its extent). `angle`: the angle alone.
  double distance(std::span<const double> a, std::span<const double> b, double* angle) const;
  /// The size of a rate, measured in the same way.
  double rate_size(std::span<const double> rate, double* angle = nullptr) const;
  /// Left and right null vector of the matrix near a singular configuration, by inverse iteration with the factors at
  /// the last configuration: over the rows of the plan and over all coordinates, Euclidean length one. False if there
  /// are no factors.
  bool null_vectors(std::span<double> w, std::span<double> z);
  /// Largest entry of a vector over all rows, in units of the length scale or rad.
  double row_norm(std::span<const double> r) const { return scaling_.row_norm(r); }
  /// Largest entry of rates over all coordinates, in length scales or rad.
  double rate_norm(std::span<const double> rates) const;
  /// Residual of the rows that are not solved with, in units of the length scale or rad; `worst`: its row.
  double redundant_residual(std::span<const double> residual_of_all, int* worst) const;

  double tolerance = 1e-12;  ///< on residuals, relative to the length scale

 private:
  template <class Entry>
  double motion_size(Entry&& entry, double* angle) const;
  void evaluate_at(std::span<const double> q);
  bool factors_serve() const;
  double refinement_rate() const;
  bool factors_refine() const;
  bool values_never_changed(std::span<const double> values);
  bool factorize();
  Scaling::Size subtract_step(std::span<double> q);
  /// rest -= Phi_q x.
  void subtract_product(std::span<const double> values, std::span<const double> x, std::span<double> rest) const;
  /// x = Phi_q^-1 rhs_ by refinement of the start in x (columns), against the true Jacobian at q_.
  bool solve_refined(std::span<double> x, bool has_start);
  bool is_solved_to_rounding(std::span<const double> values, std::span<const double> x);
  bool solve_rate(std::span<double> rate, bool has_start);
  double gather_rows(std::span<const double> all, std::span<double> chosen) const;
  void to_columns(std::span<const double> coordinates, std::span<double> columns) const;
  void to_coordinates(std::span<const double> columns, std::span<double> coordinates) const;

  Evaluator& evaluator_;
  const Plan& plan_;
  std::vector<int> rows_;
  Scaling scaling_;
  bool all_rows_ = false;
  /// The rows in use.
  struct {
    SparsePattern pattern;
    std::vector<int> gather;           // entry -> slot in the full Jacobian (empty: the same)
    std::vector<double> values;        // if not all rows are in use
    std::vector<double> first_values;  // of the first factorization, until they change
    bool analyzed = false, values_changed = false;
  } matrix_;
  Factorization factorization_;
  /// Where it was factored last.
  struct {
    std::vector<double> q;  // columns
    double t = 0;
    double gap = 0;  // from q_ to here: how much worse than exact the factors are
    double rcond = 0;
    bool valid = false;
    FactorResult result;
  } factored_;
  bool jacobian_valid_ = false;
  std::vector<double> values_;                    // full Jacobian
  std::vector<char> in_use_;                      // per row
  std::vector<double> phi_, rhs_, residual_all_;  // all rows
  std::vector<double> step_, x_, q_;              // columns
  std::vector<double> terms_;                     // all rows
  double motion_unit_ = 1;                        // m: what shifts are compared with in distance()
  double extent_ = 0;                             // norm of q_
  struct {
    double of_rates = 0, of_multipliers = 0;
  } left_;  // by refinement, as parts of the largest
};

}  // namespace catena
