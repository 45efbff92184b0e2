// The unsymmetric matrix of static equilibrium, for forces without a potential.
//
//   [ K + s W   Phi_q^T ]        K = -dQ/dq + sum lambda Phi_qq,   W = (1, 1, radius^2)
//   [ Phi_q       -E    ]        s: damping, N/m;   E: compliance, m/N
//
// Forces that turn with a body and laws of state make -dQ/dq unsymmetric, and a law ties its bodies to all that it
// reads: the pattern is taken from the elements themselves. E is tiny and makes the matrix regular where equations
// depend on each other; refined solutions are those of the matrix without E. Functions of time are frozen at the
// evaluator's time. Singular: a motion without stiffness in the sense of the rows (K^T w = 0) as well as of the columns
// (K v = 0).
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/linalg/factorization/factorization.hpp"

namespace catena {

class StaticTangent {
 public:
  /// The system must be at a configuration; the pattern is that of all later ones.
  explicit StaticTangent(StaticSystem& system);

  /// Values at the configuration where the system is. `compliance`: of every row.
  void fill(std::span<const double> lambda, double damping, double compliance);
  /// False where a pivot vanishes.
  bool factorize();
  /// Solves for x = [columns; rows] in place. False where the residual stays large.
  bool solve(std::span<double> x);
  /// The same without damping and E, refined until rounding ends the gain; `transposed`: with the transposed matrix.
  void solve_to_rounding(std::span<const double> given, std::span<double> x, bool transposed = false);

  /// y = K x or K^T x over columns, as filled last, damping included.
  void multiply_stiffness(std::span<const double> x, std::span<double> y, bool transposed = false) const;
  /// Largest |K_ij| as filled last, angles over the arms, N/m.
  double largest_stiffness() const;

 private:
  template <class F>
  void visit(std::span<const double> lambda, F&& entry);
  void multiply(std::span<const double> x, std::span<double> y, bool transposed) const;

  StaticSystem& system_;
  Factorization factorization_;
  std::vector<double> values_, correction_;
  std::vector<int> slot_, element_slot_;
  bool usable_ = false;
};

}  // namespace catena
