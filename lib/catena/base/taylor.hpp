// Second-order Taylor arithmetic in time: a value with its first and second time derivative.
//
//   (f, f', f'') (g, g', g'') = (f g, f' g + f g', f'' g + 2 f' g' + f g'')
//   F(f, f', f'')             = (F(f), F'(f) f', F'(f) f'' + F''(f) f'^2)
//
// Evaluating a constraint with q(t) = q + qd t (no second derivative) gives Phi, Phi_q qd + Phi_t and, as second
// derivative, -gamma. Singular where F is. Source: Griewank and Walther, Evaluating Derivatives, ch. 13.
#pragma once

#include <cmath>
#include <concepts>

#include "catena/base/dual.hpp"

namespace catena {

template <class T>
struct Taylor {
  T f{}, d{}, dd{};

  constexpr Taylor() = default;
  template <class U>
  requires std::convertible_to<U, T>
  constexpr Taylor(const U& constant) : f(constant) {}
  constexpr Taylor(const T& value, const T& first, const T& second) : f(value), d(first), dd(second) {}

  friend constexpr Taylor operator+(const Taylor& a, const Taylor& b) { return {a.f + b.f, a.d + b.d, a.dd + b.dd}; }
  friend constexpr Taylor operator-(const Taylor& a, const Taylor& b) { return {a.f - b.f, a.d - b.d, a.dd - b.dd}; }
  friend constexpr Taylor operator-(const Taylor& a) { return {-a.f, -a.d, -a.dd}; }
  friend constexpr Taylor operator*(const Taylor& a, const Taylor& b) {
    return {a.f * b.f, a.d * b.f + a.f * b.d, a.dd * b.f + T(2) * a.d * b.d + a.f * b.dd};
  }
  friend constexpr Taylor operator/(const Taylor& a, const Taylor& b) {
    const T q = a.f / b.f;
    const T qd = (a.d - q * b.d) / b.f;
    return {q, qd, (a.dd - T(2) * qd * b.d - q * b.dd) / b.f};
  }
  constexpr Taylor& operator+=(const Taylor& b) { return *this = *this + b; }
  constexpr Taylor& operator-=(const Taylor& b) { return *this = *this - b; }
  constexpr Taylor& operator*=(const Taylor& b) { return *this = *this * b; }
  constexpr Taylor& operator/=(const Taylor& b) { return *this = *this / b; }
  friend constexpr bool operator<(const Taylor& a, const Taylor& b) { return a.f < b.f; }
  friend constexpr bool operator>(const Taylor& a, const Taylor& b) { return a.f > b.f; }
  friend constexpr bool operator<=(const Taylor& a, const Taylor& b) { return a.f <= b.f; }
  friend constexpr bool operator>=(const Taylor& a, const Taylor& b) { return a.f >= b.f; }
  friend constexpr bool operator==(const Taylor& a, const Taylor& b) { return a.f == b.f; }

  /// F(a) from F's value, slope and curvature at a.f.
  friend constexpr Taylor chain(const Taylor& a, const T& value, const T& slope, const T& curvature) {
    return {value, slope * a.d, slope * a.dd + curvature * a.d * a.d};
  }

  friend Taylor sin(const Taylor& a) {
    using std::cos, std::sin;
    const T s = sin(a.f), c = cos(a.f);
    return chain(a, s, c, -s);
  }
  friend Taylor cos(const Taylor& a) {
    using std::cos, std::sin;
    const T s = sin(a.f), c = cos(a.f);
    return chain(a, c, -s, -c);
  }
  friend Taylor exp(const Taylor& a) {
    using std::exp;
    const T e = exp(a.f);
    return chain(a, e, e, e);
  }
  friend Taylor log(const Taylor& a) {
    using std::log;
    const T r = T(1) / a.f;
    return chain(a, log(a.f), r, -r * r);
  }
  friend Taylor sqrt(const Taylor& a) {
    using std::sqrt;
    const T s = sqrt(a.f);
    const T slope = T(0.5) / s;
    return chain(a, s, slope, -slope / (T(2) * a.f));
  }
  friend Taylor abs(const Taylor& a) { return a.f < T(0) ? -a : a; }
  friend Taylor tanh(const Taylor& a) {
    using std::tanh;
    const T t = tanh(a.f), slope = T(1) - t * t;
    return chain(a, t, slope, T(-2) * t * slope);
  }
  /// Angle of (x, y): theta' = (x y' - y x') / r^2.
  friend Taylor atan2(const Taylor& y, const Taylor& x) {
    using std::atan2;
    const T r2 = x.f * x.f + y.f * y.f;
    const T first = (x.f * y.d - y.f * x.d) / r2;
    const T r2_rate = T(2) * (x.f * x.d + y.f * y.d);
    return {atan2(y.f, x.f), first, (x.f * y.dd - y.f * x.dd - first * r2_rate) / r2};
  }
};

template <class T>
constexpr double value_of(const Taylor<T>& a) {
  return value_of(a.f);
}

}  // namespace catena
