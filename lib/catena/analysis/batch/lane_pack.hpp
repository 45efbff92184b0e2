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
  friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.v / b.v); }
  friend Pack abs(const Pack& a) { return Pack(xsimd::abs(a.v)); }
  friend Mask operator<(const Pack& a, const Pack& b) { return a.v < b.v; }
  friend Mask operator>(const Pack& a, const Pack& b) { return a.v > b.v; }
  friend Mask operator<=(const Pack& a, const Pack& b) { return a.v <= b.v; }
  friend Mask operator>=(const Pack& a, const Pack& b) { return a.v >= b.v; }
  friend Pack select(const Mask& which, const Pack& a, const Pack& b) { return Pack(xsimd::select(which, a.v, b.v)); }
  /// The larger one; b where a is not a number.
  friend Pack larger(const Pack& a, const Pack& b) { return select(a.v > b.v, a, b); }
};

}  // namespace catena
