// The least change, in a weighted norm, that meets a set of linear constraints:
//
//   min 1/2 x^T W x   subject to   Phi_q x = b        =>   x = W^-1 Phi_q^T lambda,   (Phi_q W^-1 Phi_q^T) lambda = b
//
// W is diagonal and positive (a mass matrix, or the weights of assembly); W^-1 = 0 holds a coordinate where it is. The
// Schur complement is factored by Cholesky with 1e-12 of its diagonal added and the solution refined with the true
// Phi_q: exact where equations are independent; where they depend on each other consistently x is exact as well; of a
// contradictory b the part that can be met is met. Source: apps/manual/numerics.md#regularisation.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/assembly/plan.hpp"
#include "catena/base/counters.hpp"
#include "catena/linalg/factorization/symmetric_factorization.hpp"

namespace catena {

class ConstraintProjector {
 public:
  explicit ConstraintProjector(std::shared_ptr<const Plan> plan);

  /// Inverse weights of the columns, size columns, not negative.
  void set_inverse_weights(std::span<const double> inverse_weights);
  /// Factors Phi_q W^-1 Phi_q^T. `jacobian`: values of Phi_q; `damping`: part of the diagonal added on top, for steps
  /// that must stay short (0: none). Keeps a reference to the values for refinement.
  FactorResult factorize(std::span<const double> jacobian, Counters& counters, double damping = 0);
  /// Factors Phi_q W^-1 Phi_q^T + C, C = `compliance` > 0 on the diagonal: solve() then gives the x of least
  /// x^T W x + (Phi_q x - b)^T C^-1 (Phi_q x - b), in which rows need not be met. Keeps a reference to both.
  FactorResult factorize_compliant(std::span<const double> jacobian, std::span<const double> compliance,
                                   Counters& counters);
  /// The least x with Phi_q x = b. b: rows, x: columns, lambda: rows. Returns the largest relative residual left.
  double solve(std::span<const double> b, std::span<double> x, std::span<double> lambda, Counters& counters);
  /// Smallest pivot ratio of the last factorization: near zero where rows depend on each other.
  PivotRatio smallest_pivot_ratio() const { return schur_.smallest_pivot_ratio(); }
  /// The part of a row's diagonal entry that elimination left.
  double pivot(int row) const { return schur_.pivot(row); }

 private:
  struct Product {
    int first, second;  // entries of Phi_q in one column; first has the larger row
    int column;
    int slot;
  };
  void make_pattern();
  void multiply(std::span<const double> jacobian);
  FactorResult factorize_values(Counters& counters);

  std::shared_ptr<const Plan> plan_;
  SparsePattern pattern_;  // lower triangle
  std::vector<Product> products_;
  std::vector<int> diagonal_;
  std::vector<double> inverse_weights_, values_, work_;
  std::span<const double> jacobian_, compliance_;
  SymmetricFactorization schur_;
  bool analyzed_ = false;
};

}  // namespace catena
