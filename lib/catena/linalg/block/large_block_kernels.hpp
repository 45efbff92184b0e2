// The dense work on one large block of block_factorization.hpp: a trapezoid `panel` of `height` rows and c columns,
// stored by columns, and the updates that its elimination makes to the rest.
//
// Columns are eliminated in groups of at most `group`, a constant of the compiler: their update of another column is
// one pass over it.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace catena::detail {

constexpr int group = 6;

/// Columns first ... first + c - 1 of the panel, to which all earlier ones have been applied: L below, D on the
/// diagonal, also in `pivots` (of all columns). Result: c, or how many columns came before a pivot that is zero.
template <int c>
int factor_group(double* panel, int height, int first, double* pivots) {
  for (int k = 0; k < c; ++k) {
    double* const own = panel + static_cast<std::size_t>(first + k) * static_cast<std::size_t>(height);
    const double d = own[first + k];
    pivots[first + k] = d;
    // Not finite ones are looked for afterwards, all together.
    if (d == 0) return k;
    const double inverse = 1 / d;
    for (int j = k + 1; j < c; ++j) {
      double* const other = panel + static_cast<std::size_t>(first + j) * static_cast<std::size_t>(height);
      const double factor = own[first + j] * inverse;
      for (int i = first + j; i < height; ++i) other[i] -= factor * own[i];
    }
    for (int i = first + k + 1; i < height; ++i) own[i] *= inverse;
  }
  return c;
}

/// Column -= L D L^T of one group: `l` points at the group's first column, in the row of the column's own diagonal;
/// `count` rows from there on.
template <int c>
void update_column(const double* l, int height, const double* pivots, double* column, int count) {
  double weight[c];
  for (int k = 0; k < c; ++k) weight[k] = l[static_cast<std::size_t>(k) * static_cast<std::size_t>(height)] * pivots[k];
  for (int i = 0; i < count; ++i) {
    double sum = column[i];
    for (int k = 0; k < c; ++k)
      sum -= l[static_cast<std::size_t>(k) * static_cast<std::size_t>(height) + i] * weight[k];
    column[i] = sum;
  }
}

/// A group of c columns of the panel, and its update of the columns after it.
template <int c>
int eliminate_group(double* panel, int height, int columns, int first, double* pivots) {
  const int done = factor_group<c>(panel, height, first, pivots);
  if (done < c) return done;
  const double* const l = panel + static_cast<std::size_t>(first) * static_cast<std::size_t>(height);
  for (int j = first + c; j < columns; ++j) {
    update_column<c>(l + j, height, pivots + first,
                     panel + static_cast<std::size_t>(j) * static_cast<std::size_t>(height) + j, height - j);
  }
  return c;
}

/// Calls f with min(count, group) as a constant.
template <class F>
auto with_group(int count, F&& f) {
  switch (count) {
    case 1:
      return f(std::integral_constant<int, 1>());
    case 2:
      return f(std::integral_constant<int, 2>());
    case 3:
      return f(std::integral_constant<int, 3>());
    case 4:
      return f(std::integral_constant<int, 4>());
    case 5:
      return f(std::integral_constant<int, 5>());
    default:
      return f(std::integral_constant<int, group>());
  }
}

/// The columns of a block. Result: `columns`, or how many came before a pivot that is zero.
inline int eliminate_columns(double* panel, int height, int columns, double* pivots) {
  int first = 0;
  while (first < columns) {
    const auto [done, all] = with_group(columns - first, [&](auto c) {
      return std::pair(eliminate_group<c>(panel, height, columns, first, pivots), int{c});
    });
    first += done;
    if (done < all) break;
  }
  return first;
}

/// Column j of the update of a block whose columns are eliminated, from its diagonal on: `count` values, to which it is
/// added.
inline void add_update(const double* panel, int height, int columns, const double* pivots, int j, double* column,
                       int count) {
  for (int first = 0; first < columns;) {
    first += with_group(columns - first, [&](auto c) {
      const double* const l = panel + static_cast<std::size_t>(first) * static_cast<std::size_t>(height);
      update_column<c>(l + columns + j, height, pivots + first, column, count);
      return int{c};
    });
  }
}

/// y := L^-1 y of the block's columns, `own` being their part of y; the contributions to the rows below, whose places
/// in y are `rows`, are subtracted there. V: numbers, or several in lanes.
template <class V>
inline void solve_forward(const double* panel, int height, int columns, const int* rows, V* own, V* y) {
  for (int first = 0; first < columns;) {
    first += with_group(columns - first, [&](auto c) {
      const double* const l = panel + static_cast<std::size_t>(first) * static_cast<std::size_t>(height);
      V value[c];
      for (int k = 0; k < c; ++k) {
        value[k] = own[first + k];
        for (int j = 0; j < k; ++j)
          value[k] -= l[static_cast<std::size_t>(j) * static_cast<std::size_t>(height) + first + k] * value[j];
        own[first + k] = value[k];
      }
      const auto subtract_row = [&](int i, V& from) {
        V sum{};
        for (int k = 0; k < c; ++k)
          sum += l[static_cast<std::size_t>(k) * static_cast<std::size_t>(height) + i] * value[k];
        from -= sum;
      };
      for (int i = first + c; i < columns; ++i) subtract_row(i, own[i]);
      for (int i = columns; i < height; ++i) subtract_row(i, y[rows[i - columns]]);
      return int{c};
    });
  }
}

/// y := L^-T D^-1 y of the block's columns, the rows below being solved already.
template <class V>
inline void solve_backward(const double* panel, int height, int columns, const int* rows, V* own, const V* y) {
  for (int left = columns; left > 0;) {
    left -= with_group(left, [&](auto c) {
      const int first = left - c;
      const double* const l = panel + static_cast<std::size_t>(first) * static_cast<std::size_t>(height);
      const auto entry = [&](int i, int k) {
        return l[static_cast<std::size_t>(k) * static_cast<std::size_t>(height) + i];
      };
      V value[c];
      for (int k = 0; k < c; ++k) value[k] = own[first + k] / entry(first + k, k);
      for (int i = columns; i < height; ++i) {
        const V known = y[rows[i - columns]];
        for (int k = 0; k < c; ++k) value[k] -= entry(i, k) * known;
      }
      for (int i = left; i < columns; ++i) {
        for (int k = 0; k < c; ++k) value[k] -= entry(i, k) * own[i];
      }
      for (int k = c - 1; k >= 0; --k) {
        for (int j = k + 1; j < c; ++j) value[k] -= entry(first + j, k) * value[j];
        own[first + k] = value[k];
      }
      return int{c};
    });
  }
}

}  // namespace catena::detail
