// 50-digit arithmetic as a scalar for the rows of constraints, and the derivatives of those rows by central
// differences: with a step of 1e-12 they are exact to more digits than a double has, and owe nothing to the library's
// derivatives.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <iosfwd>

#include "catena/assembly/constraint_block.hpp"

namespace catena {

/// A scalar of 50 decimal digits. Its operations are compiled once: inlined into every element they would take minutes.
class Exact {
 public:
  using Number = boost::multiprecision::number<boost::multiprecision::cpp_dec_float<50>, boost::multiprecision::et_off>;

  Exact() = default;
  Exact(double value);

  Exact operator-() const;
  friend Exact operator+(const Exact& a, const Exact& b);
  friend Exact operator-(const Exact& a, const Exact& b);
  friend Exact operator*(const Exact& a, const Exact& b);
  friend Exact operator/(const Exact& a, const Exact& b);
  Exact& operator+=(const Exact& b) { return *this = *this + b; }
  Exact& operator-=(const Exact& b) { return *this = *this - b; }
  friend Exact sqrt(const Exact& a);
  friend Exact cos(const Exact& a);
  friend Exact sin(const Exact& a);
  friend Exact atan2(const Exact& y, const Exact& x);
  /// What the library looks for to find the double under any of its scalars.
  friend double value_of(const Exact& a);
  friend std::ostream& operator<<(std::ostream& out, const Exact& a);

 private:
  static Exact of(const Number& number);
  Number number_;
};

using Coordinates = std::array<double, 6>;  // x, y, phi of i and of j; or their rates

/// A constraint with everything its rows depend on.
template <class E>
struct ConstraintCase {
  E element;
  Coordinates q{}, qd{}, qdd{};
  Taylor<double> c;
  Vec2<double> ground;  ///< where the origin of the frames lies
  CurvePlace contact = {};
};

template <class E>
using ExactRows = std::array<Exact, static_cast<std::size_t>(E::rows)>;

inline Exact difference_step() { return 1e-12; }

/// The rows at q + offset, c + value_offset.
template <class E>
ExactRows<E> exact_rows(const ConstraintCase<E>& x, const std::array<Exact, 6>& offset, const Exact& value_offset) {
  const auto at = [&](std::size_t k) { return Exact(x.q[k]) + offset[k]; };
  const Frame<Exact> i = make_frame<Exact>(at(0), at(1), at(2)), j = make_frame<Exact>(at(3), at(4), at(5));
  ExactRows<E> rows;
  x.element.phi(Arguments<Exact>{i, j, Exact(x.c.f) + value_offset, x.ground, &x.contact}, rows.data());
  return rows;
}

template <class E>
ExactRows<E> exact_rows(const ConstraintCase<E>& x) {
  return exact_rows(x, {}, Exact(0));
}

/// Phi_q, 6 columns a row.
template <class E>
std::array<std::array<Exact, 6>, static_cast<std::size_t>(E::rows)> exact_jacobian(const ConstraintCase<E>& x) {
  std::array<std::array<Exact, 6>, static_cast<std::size_t>(E::rows)> result{};
  for (std::size_t k = 0; k < 6; ++k) {
    std::array<Exact, 6> offset{};
    offset[k] = difference_step();
    const auto after = exact_rows(x, offset, Exact(0));
    offset[k] = -difference_step();
    const auto before = exact_rows(x, offset, Exact(0));
    for (std::size_t r = 0; r < after.size(); ++r) result[r][k] = (after[r] - before[r]) / (2 * difference_step());
  }
  return result;
}

/// The rows at time t of the motion q + qd t, c + c' t + c'' t^2 / 2; without the bodies' motion if they rest.
template <class E>
ExactRows<E> exact_rows_at(const ConstraintCase<E>& x, const Exact& t, bool bodies_move) {
  std::array<Exact, 6> offset{};
  for (std::size_t k = 0; bodies_move && k < 6; ++k) offset[k] = t * Exact(x.qd[k]);
  return exact_rows(x, offset, t * Exact(x.c.d) + t * t * Exact(x.c.dd) / 2);
}

/// nu = -Phi_t.
template <class E>
ExactRows<E> exact_nu(const ConstraintCase<E>& x) {
  const Exact h = difference_step();
  const auto after = exact_rows_at(x, h, false), before = exact_rows_at(x, -h, false);
  ExactRows<E> nu;
  for (std::size_t r = 0; r < nu.size(); ++r) nu[r] = -(after[r] - before[r]) / (2 * h);
  return nu;
}

/// gamma: minus the second time derivative of the rows without accelerations.
template <class E>
ExactRows<E> exact_gamma(const ConstraintCase<E>& x) {
  const Exact h = difference_step();
  const auto after = exact_rows_at(x, h, true), at = exact_rows(x), before = exact_rows_at(x, -h, true);
  ExactRows<E> gamma;
  for (std::size_t r = 0; r < gamma.size(); ++r) gamma[r] = -(after[r] - 2 * at[r] + before[r]) / (h * h);
  return gamma;
}

/// sum_r lambda_r d2Phi_r / dq_a dq_b.
template <class E>
Exact exact_second_derivative(const ConstraintCase<E>& x, const double* lambda, std::size_t a, std::size_t b) {
  const Exact h = difference_step();
  const auto weighted = [&](int sign_a, int sign_b) {
    std::array<Exact, 6> offset{};
    offset[a] += sign_a * h;
    offset[b] += sign_b * h;
    const auto rows = exact_rows(x, offset, Exact(0));
    Exact sum = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) sum += lambda[r] * rows[r];
    return sum;
  };
  return (weighted(1, 1) - weighted(1, -1) - weighted(-1, 1) + weighted(-1, -1)) / (4 * h * h);
}

}  // namespace catena
