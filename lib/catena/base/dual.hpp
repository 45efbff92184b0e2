// Dual numbers: a value and its derivatives with respect to N independent variables, carried forward exactly.
//
//   (v, d) + (w, e) = (v + w, d + e)      (v, d) (w, e) = (v w, w d + v e)      f(v, d) = (f(v), f'(v) d)
//
// They nest: Dual<Dual<double, N>, N> carries second derivatives. Comparisons look at the value alone, so branches
// follow the branch of the value. Singular where the function itself is (sqrt, log, division at 0): the derivative is
// then non-finite, as the mathematics says. Source: Griewank and Walther, Evaluating Derivatives, ch. 3.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

namespace catena {

template <class T, int N>
struct Dual {
  T v{};
  std::array<T, N> d{};

  constexpr Dual() = default;
  template <class U>
  requires std::convertible_to<U, T>
  constexpr Dual(const U& value) : v(value) {}  // a constant: converts silently, as numbers do
  constexpr Dual(const T& value, const std::array<T, N>& derivatives) : v(value), d(derivatives) {}

  /// The independent variable number `index`.
  static constexpr Dual variable(const T& value, int index) {
    Dual r(value);
    r.d[static_cast<std::size_t>(index)] = T(1);
    return r;
  }

  friend constexpr Dual operator+(const Dual& a, const Dual& b) {
    Dual r(a.v + b.v);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = a.d[i] + b.d[i];
    return r;
  }
  friend constexpr Dual operator-(const Dual& a, const Dual& b) {
    Dual r(a.v - b.v);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = a.d[i] - b.d[i];
    return r;
  }
  friend constexpr Dual operator-(const Dual& a) {
    Dual r(-a.v);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = -a.d[i];
    return r;
  }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) {
    Dual r(a.v * b.v);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = a.d[i] * b.v + a.v * b.d[i];
    return r;
  }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    const T q = a.v / b.v;
    Dual r(q);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = (a.d[i] - q * b.d[i]) / b.v;
    return r;
  }
  constexpr Dual& operator+=(const Dual& b) { return *this = *this + b; }
  constexpr Dual& operator-=(const Dual& b) { return *this = *this - b; }
  constexpr Dual& operator*=(const Dual& b) { return *this = *this * b; }
  constexpr Dual& operator/=(const Dual& b) { return *this = *this / b; }
  friend constexpr bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend constexpr bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend constexpr bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend constexpr bool operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
  friend constexpr bool operator==(const Dual& a, const Dual& b) { return a.v == b.v; }

  /// f(a) from f's value and slope at a.v: the chain rule, used by every elementary function.
  friend constexpr Dual chain(const Dual& a, const T& value, const T& slope) {
    Dual r(value);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = slope * a.d[i];
    return r;
  }

  friend Dual sin(const Dual& a) {
    using std::cos, std::sin;
    return chain(a, sin(a.v), cos(a.v));
  }
  friend Dual cos(const Dual& a) {
    using std::cos, std::sin;
    return chain(a, cos(a.v), -sin(a.v));
  }
  friend Dual tan(const Dual& a) {
    using std::tan;
    const T t = tan(a.v);
    return chain(a, t, T(1) + t * t);
  }
  friend Dual asin(const Dual& a) {
    using std::asin, std::sqrt;
    return chain(a, asin(a.v), T(1) / sqrt(T(1) - a.v * a.v));
  }
  friend Dual acos(const Dual& a) {
    using std::acos, std::sqrt;
    return chain(a, acos(a.v), T(-1) / sqrt(T(1) - a.v * a.v));
  }
  friend Dual atan(const Dual& a) {
    using std::atan;
    return chain(a, atan(a.v), T(1) / (T(1) + a.v * a.v));
  }
  friend Dual tanh(const Dual& a) {
    using std::tanh;
    const T t = tanh(a.v);
    return chain(a, t, T(1) - t * t);
  }
  friend Dual exp(const Dual& a) {
    using std::exp;
    const T e = exp(a.v);
    return chain(a, e, e);
  }
  friend Dual log(const Dual& a) {
    using std::log;
    return chain(a, log(a.v), T(1) / a.v);
  }
  friend Dual sqrt(const Dual& a) {
    using std::sqrt;
    const T s = sqrt(a.v);
    return chain(a, s, T(0.5) / s);
  }
  friend Dual abs(const Dual& a) { return a.v < T(0) ? -a : a; }
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    const T r2 = x.v * x.v + y.v * y.v;
    Dual r(atan2(y.v, x.v));
    for (std::size_t i = 0; i < N; ++i) r.d[i] = (x.v * y.d[i] - y.v * x.d[i]) / r2;
    return r;
  }
  friend Dual pow(const Dual& a, const Dual& b) {
    using std::log, std::pow;
    const T p = pow(a.v, b.v);
    // 0^0 counts as constant; elsewhere a zero exponent may vary and keeps its mixed derivative.
    const T slope_base = a.v == T(0) && b.v == T(0) ? T(0) : b.v * pow(a.v, b.v - T(1));
    // log of a non-positive base is needed only where the exponent itself varies.
    const T slope_exponent = a.v > T(0) ? p * log(a.v) : T(0);
    Dual r(p);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = slope_base * a.d[i] + slope_exponent * b.d[i];
    return r;
  }
};

/// The plain double under any nesting of autodiff scalars.
constexpr double value_of(double a) { return a; }
template <class T, int N>
constexpr double value_of(const Dual<T, N>& a) {
  return value_of(a.v);
}

}  // namespace catena
