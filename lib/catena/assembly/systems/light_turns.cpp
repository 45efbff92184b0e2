#include "catena/assembly/systems/light_turns.hpp"

#include <algorithm>
#include <cstddef>

#include "catena/base/at.hpp"

namespace catena {
namespace {

/// The entry of a row in a column, 0 where it has none; rows of a column ascend.
double entry(const SparsePattern& pattern, std::span<const double> values, int column, int row) {
  if (column < 0) return 0;
  const auto begin = pattern.row_index.begin();
  const auto last = begin + pattern.column_start[at(column) + 1];
  const auto found = std::lower_bound(begin + pattern.column_start[at(column)], last, row);
  return found != last && *found == row ? values[static_cast<std::size_t>(found - begin)] : 0;
}

}  // namespace

double largest_turn(const Plan& plan, std::span<const double> masses, std::span<const double> jacobian) {
  const SparsePattern& pattern = plan.jacobian;
  double largest = 0;
  for (std::size_t c = 0; c + 2 < masses.size(); c += 3) {
    const double mass = masses[c], inertia = masses[c + 2];
    const int turn = plan.column[c + 2];
    if (!(mass > 0 && inertia > 0) || turn < 0) continue;
    double turned = 0, shifted = 0;
    for (int k = pattern.column_start[at(turn)]; k < pattern.column_start[at(turn) + 1]; ++k) {
      const int row = pattern.row_index[at(k)];
      const double x = entry(pattern, jacobian, plan.column[c], row);
      const double y = entry(pattern, jacobian, plan.column[c + 1], row);
      if (x == 0 && y == 0) continue;
      turned += jacobian[at(k)] * jacobian[at(k)];
      shifted += x * x + y * y;
    }
    if (shifted > 0) largest = std::max(largest, turned / shifted * mass / inertia);
  }
  return largest;
}

}  // namespace catena
