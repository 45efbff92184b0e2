// Where the second derivatives of every element go in a symmetric matrix: one list of slots an element type.
//
//   K = V_qq + sum_r lambda_r (Phi_r)_qq
//
// Elements whose second derivatives involve only the angles of their bodies (pins, dead loads) do not write into the
// matrix but into one number a body, the stiffness h against turning, which equilibrium treats separately. All others
// write to the lower triangle over the coordinates that their second derivatives involve.
#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "catena/elements/force_element.hpp"
#include "catena/model/element_lists.hpp"

namespace catena {

/// Which second derivatives are wanted.
enum class Curvature {
  exact,
  convex,  ///< of every element's block, turning aside, the nearest one without negative eigenvalues
};

/// Slots of all elements in plan order, as many an element as its type writes.
struct HessianSlots {
  std::array<std::vector<int>, std::tuple_size_v<ConstraintLists<double>>> constraints;
  std::array<std::vector<int>, std::tuple_size_v<ForceLists<double>>> forces;
};

/// Replaces a symmetric matrix, its lower triangle given row by row, by the nearest one without negative eigenvalues.
/// size <= 6.
void keep_positive_part(double* lower, int size);

namespace detail {

template <std::size_t n>
constexpr std::array<bool, 6> concerned(const std::array<HessianEntry, n>& pattern) {
  std::array<bool, 6> mask{};
  for (const HessianEntry& e : pattern) {
    mask[static_cast<std::size_t>(e.row)] = true;
    mask[static_cast<std::size_t>(e.column)] = true;
  }
  return mask;
}

template <std::size_t n>
constexpr std::size_t concerned_count(const std::array<HessianEntry, n>& pattern) {
  std::size_t count = 0;
  for (bool b : concerned(pattern)) count += b;
  return count;
}

template <std::size_t size>
constexpr auto triangle_over(const std::array<bool, 6>& mask) {
  std::array<HessianEntry, size*(size + 1) / 2> entries{};
  std::size_t k = 0;
  for (signed char r = 0; r < 6; ++r) {
    for (signed char c = 0; c <= r; ++c) {
      if (mask[static_cast<std::size_t>(r)] && mask[static_cast<std::size_t>(c)]) entries[k++] = {r, c};
    }
  }
  return entries;
}

}  // namespace detail

/// The places that a constraint type writes: turning alone, or the triangle over the coordinates concerned.
template <class E>
consteval auto written_hessian() {
  constexpr auto pattern = hessian_pattern<E>();
  if constexpr (only_turning(pattern)) {
    return pattern;
  } else {
    return detail::triangle_over<detail::concerned_count(pattern)>(detail::concerned(pattern));
  }
}

/// The same for a force type.
template <class E>
consteval auto written_stiffness() {
  constexpr auto pattern = stiffness_pattern<E>();
  if constexpr (only_turning(pattern)) {
    return pattern;
  } else {
    return detail::triangle_over<detail::concerned_count(pattern)>(detail::concerned(pattern));
  }
}

namespace detail {

/// Adds an element's second derivatives, a full 6 x 6 matrix or the values of `pattern`, to its slots.
template <std::size_t written_size, std::size_t size>
void scatter_hessian(const std::array<HessianEntry, written_size>& written,
                     const std::array<HessianEntry, size>& pattern, const double* entries, bool convex, const int* slot,
                     double* values) {
  if constexpr (written_size == size) {
    double own[written_size];
    for (std::size_t k = 0; k < size; ++k) own[k] = entries[k];
    if (convex) {
      int rows = 0;
      while (static_cast<std::size_t>(rows * (rows + 1) / 2) < written_size) ++rows;
      keep_positive_part(own, rows);
    }
    for (std::size_t k = 0; k < size; ++k) values[slot[k]] += own[k];
  } else {
    double own[written_size] = {};
    for (std::size_t k = 0, p = 0; k < written_size; ++k) {
      const bool same = p < size && written[k].row == pattern[p].row && written[k].column == pattern[p].column;
      if (same) own[k] = entries[p++];
    }
    scatter_hessian(written, written, own, convex, slot, values);
  }
}

}  // namespace detail
}  // namespace catena
