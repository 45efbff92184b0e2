// The matrix of Newton's method for implicit steps: that of the linearised motion, shifted by mu (1/s), real or
// complex.
//
//   (mu I - J) x = r,   J = d[qd, qdd] / d[q, qd],   x = [x_q, x_v],  r = [r_q, r_v]
//
//   [ mu^2 M + mu C + K   Phi_q^T ] [x_q]   [ M (r_v + mu r_q) + C r_q    ]
//   [ Phi_q                 -E    ] [ . ] = [ Phi_q (r_v + mu r_q) / mu^2 ],     x_v = mu x_q - r_q
//
// K = -dQ/dq + sum lambda Phi_qq and C = -dQ/dqd, at one state. C and what contacts add to both are found by
// differences over groups of columns that no row shares (A. Curtis, M. Powell, J. Reid 1974): exact where forces are
// linear in velocities, and cheap: of a run of twenty rods with a damper at each pin all of linearize() takes 2 % of
// the instructions, the factorizations behind it 67 %. What changes in Phi_q itself is left out: of the order (h
// omega)^2 beside mu^2 M, it costs Newton's method a part of its speed and its solution nothing. E, a 1e-10 part of
// every row's own resistance, keeps the matrix regular where rows are redundant. A complex system is solved as a real
// one of twice the size. Units: SI.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "catena/analysis/dynamics/integrators/motion.hpp"
#include "catena/assembly/systems/tangent.hpp"
#include "catena/linalg/factorization/factorization.hpp"

namespace catena {

class ImplicitMatrix {
 public:
  explicit ImplicitMatrix(const Motion& motion);

  /// Takes K, C and Phi_q at the state of the last evaluation, which was at (t, y). False: not finite.
  bool linearize(double t, Side side, std::span<const double> y);
  /// Factors of the real system. False: it is singular.
  bool factorize(double real);
  /// The same of the complex one.
  bool factorize(std::complex<double> pair);
  /// Solves for r, of size 2 coordinates, in place.
  void solve(std::span<double> r);
  /// The same for `re` + i `im`.
  void solve(std::span<double> re, std::span<double> im);

 private:
  using Complex = std::complex<double>;
  void analyze_pair();
  void group_columns();
  void add_differences(double t, Side side, std::span<const double> y);
  template <class Visit>
  void visit_groups(Visit&& visit);
  template <class N>
  N diagonal(std::size_t entry, N mu) const;
  void find_compliance(double mu);
  template <class N>
  void fill_right_hand_side(N mu, std::span<const N> r_q, std::span<const N> r_v, std::span<N> out) const;

  Motion motion_;
  const Plan& plan_;
  std::size_t columns_, rows_;
  Tangent tangent_;
  Factorization real_, pair_;
  Counters& counters_;
  double mu_ = 0;
  Complex nu_;                                     // the shifts of the factors at hand
  std::vector<std::vector<int>> groups_;           // of columns
  std::vector<double> jacobian_, base_, damping_;  // by entries of the pattern: K with Phi_q, and C
  std::vector<int> mass_slot_, compliance_slot_;   // entries of diagonals, per column and per row
  std::vector<double> values_, pair_values_;
  std::vector<int> pair_slot_;  // four an entry: re re, re im, im re, im im
  std::vector<double> loads_, moved_loads_, moved_, x_;
  std::vector<Complex> pair_r_, pair_x_;
};

}  // namespace catena
