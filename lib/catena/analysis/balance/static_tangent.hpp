// The unsymmetric matrix of static equilibrium, for forces without a potential.
//
//   [ K + s W   Phi_q^T ]        K = -dQ/dq + sum lambda Phi_qq,   W = (1, 1, radius^2)
//   [ Phi_q       -E    ]        s: damping, N/m;   E: compliance, m/N
//
// E is tiny and makes the matrix regular where equations depend on each other; refined solutions are those of the
// matrix without E. Functions of time are frozen at the evaluator's time. Singular: a motion without stiffness in the
// sense of the rows (K^T w = 0) as well as of the columns (K v = 0).
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/assembly/systems/tangent.hpp"
#include "catena/linalg/factorization/factorization.hpp"

namespace catena {

class StaticTangent {
 public:
  explicit StaticTangent(StaticSystem& system);

  /// Values at the configuration where the system is, E = 0.
  void fill(std::span<const double> lambda, double damping);
  /// E of every row, until the next fill.
  void set_compliance(double e) { matrix_.set_compliance(e); }
  /// False where a pivot vanishes.
  bool factorize();
  /// Solves for x = [columns; rows] in place. False where the residual stays large.
  bool solve(std::span<double> x);
  /// The same without E, refined until rounding ends the gain; `transposed`: with the transposed matrix.
  void solve_to_rounding(std::span<const double> given, std::span<double> x, bool transposed = false);

  /// y = K x over columns, as filled last, damping included.
  void multiply_stiffness(std::span<const double> x, std::span<double> y) const { matrix_.multiply(x, y); }
  /// Largest |K_ij| as filled last, angles over the arms, N/m.
  double largest_stiffness() const { return matrix_.largest_stiffness(system_.matrix().inverse_arms()); }

 private:
  StaticSystem& system_;
  Tangent matrix_;
  Factorization factorization_;
  std::vector<double> weight_, correction_;  // W
  bool usable_ = false;
};

}  // namespace catena
