// The work on one small block of block_factorization.hpp, its shape known to the compiler: c columns, r rows below.
// A panel has height c + r and is stored by columns; after the elimination D stands on its diagonal.
#pragma once

#include <type_traits>

namespace catena::detail {

constexpr int most_columns = 6, most_below = 6;

/// A number for every small shape, from 1; 0 for all others.
constexpr int shape_code(int columns, int below) {
  return columns <= most_columns && below <= most_below ? 1 + (columns - 1) * (most_below + 1) + below : 0;
}

/// Eliminates the columns; the updates of the rest go to rest[slot[0]], rest[slot[1]], ... Result: c, or how many
/// columns came before a pivot that is zero.
template <int c, int r>
inline int eliminate(double* panel, double* pivots, double* rest, const int* slot) {
  constexpr int h = c + r;
  double a[c * h];
  for (int i = 0; i < c * h; ++i) a[i] = panel[i];
  double weight[c * h];  // L D: the columns before they are divided by their pivots
  for (int k = 0; k < c; ++k) {
    const double d = a[k * h + k];
    pivots[k] = d;
    if (d == 0) return k;
    const double inverse = 1 / d;
    for (int i = k + 1; i < h; ++i) {
      weight[k * h + i] = a[k * h + i];
      a[k * h + i] *= inverse;
    }
    for (int j = k + 1; j < c; ++j) {
      for (int i = j; i < h; ++i) a[j * h + i] -= a[k * h + i] * weight[k * h + j];
    }
  }
  for (int i = 0; i < c * h; ++i) panel[i] = a[i];
  for (int j = c; j < h; ++j) {
    for (int i = j; i < h; ++i) {
      double sum = 0;
      for (int k = 0; k < c; ++k) sum += a[k * h + i] * weight[k * h + j];
      rest[*slot++] -= sum;
    }
  }
  return c;
}

/// y := L^-1 y: `own` is the block's part of y, `rows` the places of the rows below. V: numbers, or several in lanes.
template <int c, int r, class V>
inline void forward(const double* panel, const int* rows, V* own, V* y) {
  constexpr int h = c + r;
  V value[c];
  for (int k = 0; k < c; ++k) {
    value[k] = own[k];
    for (int j = 0; j < k; ++j) value[k] -= panel[j * h + k] * value[j];
    own[k] = value[k];
  }
  for (int i = 0; i < r; ++i) {
    V sum{};
    for (int k = 0; k < c; ++k) sum += panel[k * h + c + i] * value[k];
    y[rows[i]] -= sum;
  }
}

/// y := L^-T D^-1 y, the rows below being solved already.
template <int c, int r, class V>
inline void backward(const double* panel, const int* rows, V* own, const V* y) {
  constexpr int h = c + r;
  V value[c];
  for (int k = 0; k < c; ++k) value[k] = own[k] / panel[k * h + k];
  for (int i = 0; i < r; ++i) {
    const V known = y[rows[i]];
    for (int k = 0; k < c; ++k) value[k] -= panel[k * h + c + i] * known;
  }
  for (int k = c - 1; k >= 0; --k) {
    for (int j = k + 1; j < c; ++j) value[k] -= panel[k * h + j] * value[j];
    own[k] = value[k];
  }
}

/// Calls f(constant c, constant r) for the shape with this code. False for code 0.
template <class F>
inline bool with_shape(int code, F&& f) {
  const auto call = [&]<int c, int r>() { f(std::integral_constant<int, c>(), std::integral_constant<int, r>()); };
  switch (code) {
#define CATENA_SHAPE(c, r)            \
  case shape_code(c, r):              \
    call.template operator()<c, r>(); \
    return true;
#define CATENA_SHAPES(c) \
  CATENA_SHAPE(c, 0)     \
  CATENA_SHAPE(c, 1)     \
  CATENA_SHAPE(c, 2)     \
  CATENA_SHAPE(c, 3)     \
  CATENA_SHAPE(c, 4)     \
  CATENA_SHAPE(c, 5)     \
  CATENA_SHAPE(c, 6)
    CATENA_SHAPES(1)
    CATENA_SHAPES(2)
    CATENA_SHAPES(3)
    CATENA_SHAPES(4)
    CATENA_SHAPES(5)
    CATENA_SHAPES(6)
#undef CATENA_SHAPES
#undef CATENA_SHAPE
    default:
      return false;
  }
}

}  // namespace catena::detail
