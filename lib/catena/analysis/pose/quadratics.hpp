// Quadratic equations in a few unknowns, and their real roots.
//
//   F_i(a) = c_i + L_i a + a^T Q_i a = 0,  i = 1 ... m, in k unknowns
//
// Found by Levenberg and Marquardt's method from many starts, the same ones every time: all roots with great
// probability, though not with certainty, for k up to about six. Coefficients should be of size one. Roots closer than
// a thousandth of their size count as one: double roots are located no more accurately.
#pragma once

#include <span>
#include <vector>

namespace catena {

struct Quadratics {
  /// F below this counts as zero; so does a coefficient below this part of the terms that it is the sum of.
  static constexpr double vanishing = 1e-6;

  std::size_t k = 0;
  std::vector<double> constant;                // per polynomial
  std::vector<std::vector<double>> linear;     // k each
  std::vector<std::vector<double>> quadratic;  // k x k each, symmetric

  /// f: one value a polynomial; jacobian: polynomials x k, row by row.
  void evaluate(std::span<const double> a, std::vector<double>& f, std::vector<double>& jacobian) const;
};

/// The real roots; `first` is taken as one, unless empty. Sorted by their distance from the first, or from zero.
std::vector<std::vector<double>> real_roots(const Quadratics& system, const std::vector<double>& first);

}  // namespace catena
