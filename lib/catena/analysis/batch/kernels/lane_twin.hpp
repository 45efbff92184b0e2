// Two packs side by side as one: what one waits for, the other computes meanwhile.
//
// Steps of an elimination follow from each other, and each takes its numbers from memory: one pack alone would wait
// most of the time. Members instead of an array: compilers keep these in registers.
#pragma once

#include <xsimd/xsimd.hpp>

namespace catena {

template <class M>
struct TwinMask {
  M a, b;

  friend TwinMask operator&&(const TwinMask& x, const TwinMask& y) { return {x.a && y.a, x.b && y.b}; }
  friend TwinMask operator||(const TwinMask& x, const TwinMask& y) { return {x.a || y.a, x.b || y.b}; }
  friend TwinMask operator!(const TwinMask& x) { return {!x.a, !x.b}; }
  friend bool any(const TwinMask& x) { return xsimd::any(x.a || x.b); }
  friend bool all(const TwinMask& x) { return xsimd::all(x.a && x.b); }
};

/// V: a batch of xsimd's.
template <class V>
struct Twin {
  using batch_bool_type = TwinMask<typename V::batch_bool_type>;
  static constexpr std::size_t size = 2 * V::size;
  V a, b;

  Twin() = default;
  explicit Twin(double value) : a(value), b(value) {}
  Twin(const V& first, const V& second) : a(first), b(second) {}

  static Twin load_aligned(const double* from) { return {V::load_aligned(from), V::load_aligned(from + V::size)}; }
  void store_aligned(double* to) const {
    a.store_aligned(to);
    b.store_aligned(to + V::size);
  }

  friend Twin operator+(const Twin& x, const Twin& y) { return {x.a + y.a, x.b + y.b}; }
  friend Twin operator-(const Twin& x, const Twin& y) { return {x.a - y.a, x.b - y.b}; }
  friend Twin operator-(const Twin& x) { return {-x.a, -x.b}; }
  friend Twin operator*(const Twin& x, const Twin& y) { return {x.a * y.a, x.b * y.b}; }
  friend Twin operator/(const Twin& x, const Twin& y) { return {x.a / y.a, x.b / y.b}; }
  friend Twin sqrt(const Twin& x) { return {xsimd::sqrt(x.a), xsimd::sqrt(x.b)}; }
  friend Twin atan2(const Twin& y, const Twin& x) { return {xsimd::atan2(y.a, x.a), xsimd::atan2(y.b, x.b)}; }
  friend Twin round(const Twin& x) { return {xsimd::round(x.a), xsimd::round(x.b)}; }
  friend Twin abs(const Twin& x) { return {xsimd::abs(x.a), xsimd::abs(x.b)}; }
  friend Twin max(const Twin& x, const Twin& y) { return {xsimd::max(x.a, y.a), xsimd::max(x.b, y.b)}; }
  friend Twin select(const batch_bool_type& which, const Twin& x, const Twin& y) {
    return {xsimd::select(which.a, x.a, y.a), xsimd::select(which.b, x.b, y.b)};
  }
  friend batch_bool_type operator<(const Twin& x, const Twin& y) { return {x.a < y.a, x.b < y.b}; }
  friend batch_bool_type operator>(const Twin& x, const Twin& y) { return {x.a > y.a, x.b > y.b}; }
  friend batch_bool_type operator<=(const Twin& x, const Twin& y) { return {x.a <= y.a, x.b <= y.b}; }
  friend batch_bool_type operator>=(const Twin& x, const Twin& y) { return {x.a >= y.a, x.b >= y.b}; }
};

}  // namespace catena
