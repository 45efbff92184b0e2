// The matrix of static equilibrium: filled in place, factored with an augmentation for which L D L^T exists, solved and
// refined against the matrix itself.
//
//   true      [ K    Phi_q^T ]        factored   [ K + Phi_q^T R Phi_q   Phi_q^T ]
//             [ Phi_q   -D   ]                   [ Phi_q                 -E      ]
//
// D = 0 where constraints hold; rows of gaps may have a compliance d > 0 (set_compliance). Their part of the second
// matrix follows from lambda = lambda' (1 + rho d): R holds rho / (1 + rho d), E holds eps + d (1 + rho d).
// Inertia of the factored one: n_- = m + p, p the number of negative eigenvalues of K on the null space of Phi_q,
// whatever the rank of Phi_q (apps/manual/statics.md#certificate). rho and eps are chosen row by row from the stiffness
// of the bodies the row touches, since a mechanism may hold springs and links over many orders of magnitude: rho
// comparable with K there, eps = 1e-10 / rho. Where rows depend on each other eps decides between their multipliers:
// the least ones; a row whose pivot is no larger than a few eps is reported as dependent.
//
// Why not ConstraintSolver: that one eliminates a diagonal W > 0 and factors S = Phi_q W^-1 Phi_q^T alone. K is neither
// diagonal nor definite, and no inverse of it exists where constraints alone hold a body; and stability is read from
// the signs of the pivots of the whole, which S does not have. Why not Tangent: that one holds both triangles for LU,
// whose pivots tell no inertia. All three are assembled from the values of the same Equations.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/systems/foreseen_springs.hpp"
#include "catena/assembly/systems/kkt_structure.hpp"
#include "catena/linalg/block/block_factorization.hpp"
#include "catena/linalg/factorization/refinement.hpp"

namespace catena {

class KktMatrix {
 public:
  /// `radius`: per plan body, the length in metres that corresponds to a radian (Evaluator::attachment_radii).
  KktMatrix(std::shared_ptr<const Plan> plan, std::span<const double> radius);

  void set_radius(std::span<const double> radius);
  /// Per column 1, or 1 / radius of the body where it is an angle: turns moments into forces, 1/m.
  std::span<const double> inverse_arms() const { return inverse_arms_; }

  const KktStructure& structure() const { return structure_; }

  /// d of every row, m/N (rad / (N m) where the row is in radians); empty: all zero. Counts from the next fill on.
  void set_compliance(std::span<const double> compliance) { compliance_.assign(compliance.begin(), compliance.end()); }

  /// Compare the matrix with the one factored last, and keep its factors where nothing changed (linear problems).
  void keep_equal_factors(bool keep) {
    if (keep != keep_equal_factors_) last_.clear();
    keep_equal_factors_ = keep;
  }
  /// Whether K does not depend on these multipliers: constraints without second derivatives at this configuration.
  bool constraints_are_linear(const Evaluator& evaluator);

  /// Fills K at the evaluator's configuration, except the stiffness against turning, which goes to turning(). Springs
  /// use foreseen lengths where these are active.
  void set_hessian(const Evaluator& evaluator, std::span<const double> lambda, Curvature curvature,
                   const ForeseenSprings* springs = nullptr);
  /// Per moving body, N m: may be changed between set_hessian and complete.
  std::span<double> turning() { return {values_.data() + structure_.turning(0), static_cast<std::size_t>(moving_)}; }
  /// Adds turning() to K and `shift` x (1, 1, radius^2) to its diagonal, N/m; writes Phi_q.
  void complete(std::span<const double> jacobian, double shift);
  /// Adds factor x weights (columns) to the diagonal of K: shifted eigenvalue problems.
  void add_diagonal(std::span<const double> weights, double factor);
  /// K := `stiffness` x (1, 1, radius^2) without anything else, N/m; writes Phi_q.
  void set_weights(std::span<const double> jacobian, double stiffness);

  /// The true matrix by slots of structure().pattern.
  std::span<const double> values() const { return {values_.data(), static_cast<std::size_t>(structure_.entries())}; }

  /// Factors; analyses first if needed. `least_stiffness`, N/m: assumed for a body without any stiffness.
  FactorResult factorize(double least_stiffness, Counters& counters);
  /// Solves the true equations for x = [columns; rows] in place. Residuals are compared with `force`, N, and `length`,
  /// m, and refined to `tolerance` of these, if rounding allows.
  Refinement solve(std::span<double> x, double force, double length, double tolerance, Counters& counters);
  /// Solves with the factors as they are, without refinement.
  void solve_unrefined(std::span<double> x, Counters& counters);
  /// y = true matrix times x, both of size columns + rows.
  void multiply(std::span<const double> x, std::span<double> y) const;
  /// y = K x alone, size columns.
  void multiply_stiffness(std::span<const double> x, std::span<double> y) const;
  /// Sum of |x_i K_ij x_j|: what rounding in x^T K x is measured against.
  double absolute_quadratic(std::span<const double> x) const;

  bool is_factorized() const { return factorization_.is_factorized(); }
  /// p: negative eigenvalues of K on the null space of Phi_q.
  int negative_modes() const;
  /// Constraint equations whose pivot vanished but for eps, ascending.
  std::vector<int> dependent_rows() const;
  /// Largest stiffness of a body, N/m.
  double largest_stiffness() const { return largest_stiffness_; }

 private:
  void clear();
  void write_jacobian(std::span<const double> jacobian);
  void choose_augmentation(double least_stiffness);

  std::shared_ptr<const Plan> plan_;
  KktStructure structure_;
  int moving_;
  std::vector<double> radius_, inverse_arms_;
  std::vector<double> values_;  // see KktStructure
  std::vector<double> last_;    // the true matrix of the last factorization, if factors are to be kept
  std::vector<double> rho_, eps_, stiffness_;
  std::vector<double> compliance_, softness_, last_softness_;  // asked for; of the numbers filled in; of those factored
  std::vector<double> right_hand_side_, residual_work_, correction_work_;
  BlockFactorization factorization_;
  bool analyzed_ = false, keep_equal_factors_ = false;
  double largest_stiffness_ = 0;
};

}  // namespace catena
