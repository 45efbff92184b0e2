// The equations of static equilibrium at one configuration, shared by all solvers and the certificate.
//
//   V_q + Phi_q^T lambda = 0,   Phi = 0        V_q = -Q, Q the applied forces at rest
//   (apps/manual/statics.md#equilibrium)
//
// Rows of one-sided elements are gaps, Psi >= 0 with lambda <= 0. Either all of them are inequalities (use_gaps, for
// optimisers: phi() and jacobian() hold them all, phi_norm() the part below zero), or some hold as equations and the
// others not at all (close_gaps: phi() and jacobian() hold zeros there, and lambda stays zero).
//
// Functions of time are frozen at the evaluator's time. Vectors over columns (forces, N or N m; changes, m or rad) and
// rows (lambda, Phi); configurations are in plan order. Nothing allocates after construction.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "catena/analysis/pose/scaling.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/systems/kkt_matrix.hpp"

namespace catena {

/// A solution of the linearised equations: the change of the coordinates and the new multipliers.
struct StaticStep {
  std::span<const double> change;  ///< columns
  std::span<const double> lambda;  ///< rows
  double residual = 0;             ///< relative one that refinement left
};

/// The kind of a constraint row: Phi = 0, Phi >= 0, Phi <= 0.
enum class RowSide : signed char { both, at_least, at_most };

class StaticSystem {
 public:
  explicit StaticSystem(Evaluator& evaluator);

  /// To be called after the evaluator's model changed: updates all values that depend on it.
  void take_over_model();
  /// Called between steps of every search: whether to continue. Empty: always.
  void watch(std::function<bool()> proceed) { proceed_ = std::move(proceed); }
  bool is_cancelled() const { return proceed_ && !proceed_(); }
  /// Evaluates forces, constraints and Phi_q at q (size coordinates()).
  void move_to(std::span<const double> q);
  /// Whether the constraints have no second derivatives, as bodies held at their centroids: determined once, at the
  /// first configuration.
  bool has_linear_constraints();
  bool has_gaps() const { return !plan_.gap_rows.empty(); }
  RowSide side(int row) const { return gaps_.is.empty() || !gaps_.is[at(row)] ? RowSide::both : RowSide::at_least; }
  /// All gaps as inequalities; move_to() comes next.
  void use_gaps();
  /// The gaps with closed[k] != 0, k counting plan().gap_rows, as equations, the others not at all; move_to() comes
  /// next.
  void close_gaps(std::span<const char> closed);
  /// Every gap at the present configuration, m or rad, closed or not, in the order of plan().gap_rows.
  void all_gaps(std::vector<double>& out);
  double energy() const { return evaluator_.potential_energy(); }
  std::span<const double> gradient() const { return gradient_; }  ///< V_q, columns
  std::span<const double> phi() const { return phi_; }
  std::span<const double> jacobian() const { return {jacobian_.data(), jacobian_.size() - 1}; }

  /// V_q + Phi_q^T lambda.
  void residual(std::span<const double> lambda, std::span<double> out) const;
  /// Largest component of forces over columns, moments divided by the body's radius, N.
  double force_norm(std::span<const double> forces) const;
  /// Largest change over columns: lengths in length scales, angles in rad.
  double change_norm(std::span<const double> change) const;
  /// Largest constraint residual in length scales or rad, of gaps only what is below zero unless they are closed.
  double phi_norm() const;
  /// Largest force in the mechanism: of V_q and of the constraints' parts of Phi_q^T lambda, N.
  double force_scale(std::span<const double> lambda) const;

  /// The force that residuals are compared with: force_scale at the last fill, N.
  double force_size() const { return force_; }
  /// Largest applied force so far, N.
  double load_size() const { return load_; }
  /// Largest sum of all applied forces' sizes so far, N: an upper bound of the force through one joint.
  double total_load() const { return total_load_; }
  /// Largest sum, over one coordinate, of gravity, forces and torques, N: at the configuration of the first call since
  /// the model or the time changed.
  double dead_load();
  bool has_springs() const { return springs_.any(); }

  /// Changes below this cannot be told from rounding of the coordinates: length scales or rad.
  double rounding_change() const { return thresholds::position_rounding * extent_ / length_; }

  /// Residual forces below this may be rounding: a stiff spring's length is known to so many digits only, N.
  double rounding_force() const { return 1e-14 * matrix_.largest_stiffness() * extent_; }

  /// A stiff spring that turns in a step, as a link of a chain does, lengthens to second order in the turn, and the
  /// force k (l - l0) that this gives exceeds what it will carry. From here on fill() takes the stiffness of such
  /// springs along their present lines, but at the length to which this change (columns, as in advance()) leads to
  /// first order, as if their tensions were unknowns; without a change, at their free length. To be called before the
  /// step is made.
  void foresee(std::span<const double> change = {}, double factor = 1, double largest_turn = 0);
  /// Back to present lengths: the exact K of the energy.
  void forget_lengths() { springs_.forget(); }

  /// Fills the matrix at the present configuration: K exact, or convex with h against turning made sqrt(h^2 + r^2), r
  /// the residual torque. `shift` N/m.
  void fill(std::span<const double> lambda, Curvature curvature, double shift);
  /// Fills the matrix with force / length x (1, 1, radius^2) instead of K.
  void fill_weights();
  FactorResult factorize();
  /// Whether the last factorize() left factors to solve with.
  bool has_factors() const { return has_factors_; }
  /// Solves for the Newton step with these right-hand sides: K change + Phi_q^T lambda = force, Phi_q change = gap.
  StaticStep solve(std::span<const double> force, std::span<const double> gap, double tolerance);
  /// The Newton step itself.
  StaticStep newton_step(double tolerance);

  /// q += factor x change; angles turned by at most `largest_turn` each.
  void advance(std::span<double> q, std::span<const double> change, double factor, double largest_turn) const;

  KktMatrix& matrix() { return matrix_; }
  Evaluator& evaluator() { return evaluator_; }
  const Evaluator& evaluator() const { return evaluator_; }
  const Plan& plan() const { return plan_; }
  double length() const { return length_; }  ///< what changes are compared with, m
  double extent() const { return extent_; }  ///< of the present coordinates, m: rounding grows with it
  std::span<const double> radius() const { return radius_; }

 private:
  void take_length();

  struct ForceSize {
    double largest = 0, sum = 0;
  };
  ForceSize measure(std::span<const double> forces) const;
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  Evaluator& evaluator_;
  const Plan& plan_;
  std::vector<double> radius_;
  KktMatrix matrix_;
  int linear_ = -1;  // -1: not asked yet
  bool has_factors_ = false;
  bool lacks_length_ = false;  // and none has been found yet
  double found_length_ = 0;    // where the scene gives none
  double length_, extent_ = 1, force_ = 1, load_ = 0, total_load_ = 0;
  Scaling scaling_;
  std::vector<double> rest_, loads_;  // zero velocities, Q; all coordinates
  struct {
    double size = 0, t = std::numeric_limits<double>::quiet_NaN();  // N; s
  } dead_load_;
  ForeseenSprings springs_;
  std::vector<double> foreseen_;  // all coordinates
  std::function<bool()> proceed_;
  std::vector<double> gradient_, jacobian_, phi_;
  std::vector<double> solution_, torque_;
  struct {
    std::vector<char> is;     // per row; empty: none is
    std::vector<int> open;    // rows left out
    bool one_sided = false;   // as inequalities
    std::vector<double> all;  // phi of all rows, as all_gaps() reads them
  } gaps_;
};

}  // namespace catena
