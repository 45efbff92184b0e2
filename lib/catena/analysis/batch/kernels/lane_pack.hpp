// A pack of numbers, one a lane, as a scalar that elements, dual numbers and Taylor series compute with.
//
// Instruction sets are xsimd's; a pack begins as zero, as every scalar of base/ does. Comparisons give masks, not
// truth: code that branches on a value does not compile with packs.
#pragma once

#include <xsimd/xsimd.hpp>

namespace catena {

template <class V>
struct Pack {
  using Mask = typename V::batch_bool_type;
  static constexpr int size = static_cast<int>(V::size);
  V v;

  Pack() : v(0.0) {}
  Pack(double value) : v(value) {}  // a constant: converts silently, as numbers do
  explicit Pack(const V& value) : v(value) {}

  static Pack load(const double* from) { return Pack(V::load_aligned(from)); }
  void store(double* to) const { v.store_aligned(to); }

  friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.v + b.v); }
  friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.v - b.v); }
  friend Pack operator-(const Pack& a) { return Pack(-a.v); }
  friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.v * b.v); }
  Pack& operator+=(const Pack& a) { return *this = *this + a; }
  Pack& operator-=(const Pack& a) { return *this = *this - a; }
  friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.v / b.v); }
  friend Pack sqrt(const Pack& a) { return Pack(sqrt(a.v)); }
  friend Pack atan2(const Pack& y, const Pack& x) { return Pack(atan2(y.v, x.v)); }
  friend Pack round(const Pack& a) { return Pack(round(a.v)); }
  friend Pack abs(const Pack& a) { return Pack(abs(a.v)); }
  friend Mask operator<(const Pack& a, const Pack& b) { return a.v < b.v; }
  friend Mask operator>(const Pack& a, const Pack& b) { return a.v > b.v; }
  friend Mask operator<=(const Pack& a, const Pack& b) { return a.v <= b.v; }
  friend Mask operator>=(const Pack& a, const Pack& b) { return a.v >= b.v; }
  friend Pack select(const Mask& which, const Pack& a, const Pack& b) { return Pack(select(which, a.v, b.v)); }
  /// The larger one; which of them where one is not a number differs between processors.
  friend Pack larger(const Pack& a, const Pack& b) { return Pack(max(a.v, b.v)); }
};

/// Cosine and sine as in base/sincos.hpp, of angles up to 1e5 rad: those beyond are not reduced.
template <class V>
void sincos(const Pack<V>& angle, Pack<V>& cosine, Pack<V>& sine) {
  using P = Pack<V>;
  constexpr double to_integer = 0x1.8p52;
  const P n = (angle * P(0x1.45f306dc9c883p-1) + P(to_integer)) - P(to_integer);
  const P coarse = angle - n * P(0x1.921fb544p+0), r = coarse - n * P(0x1.0b4611a6p-34);
  const P tail = ((coarse - r) - n * P(0x1.0b4611a6p-34)) - n * P(0x1.3198a2e037073p-69);
  const P z = r * r;
  const auto series = [&](double a, double b, double c, double d, double e, double f) {
    return P(a) + z * (P(b) + z * (P(c) + z * (P(d) + z * (P(e) + z * P(f)))));
  };
  const P s = series(-1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04,
                     2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10);
  const P c = series(4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
                     -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11);
  const P half = P(0.5) * z, head = P(1) - half;
  const P sin_r = r + (r * z * s + tail * head);
  const P cos_r = head + (((P(1) - head) - half) + (z * z * c - r * tail));
  // n modulo 4 without integers: odd quarters exchange the two.
  const P quarter = n - P(4) * ((n * P(0.25) + P(to_integer)) - P(to_integer));  // -2 ... 2
  const P odd = abs(abs(quarter) - P(1));                                        // 0 for odd quarters, else 1
  const typename P::Mask exchanged = odd < P(0.5);
  const P a = select(exchanged, cos_r, sin_r), b = select(exchanged, sin_r, cos_r);
  sine = select(abs(quarter) > P(1.5), -a, select(quarter < P(-0.5), -a, a));
  cosine = select(abs(quarter) > P(1.5), -b, select(quarter > P(0.5), -b, b));
}

}  // namespace catena
