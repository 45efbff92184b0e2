// The constraints that are called redundant, where rows of Phi_q depend on each other.
//
// Any row of a vanishing combination  sum_r w_r row_r = 0  may be left out. Reports name the one that an engineer would
// remove: of the elements with the fewest rows (a gear rather than a pin, a driver rather than a slide) the one that
// comes last in the scene. It follows from the others of its combination; Gauss-Jordan elimination leaves one redundant
// row in every combination. The same weights test whether right-hand sides agree:
// w^T nu = 0, else the drivers of the combination contradict each other.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "catena/assembly/plan.hpp"
#include "catena/linalg/rank/rank_revealing.hpp"

namespace catena {

struct RedundantRow {
  int row = -1;
  std::map<int, double> combination;  ///< weight of every row in it, 1 of this one; empty: not known
};

/// As many rows as there are dependent ones, ascending. Where there are very many: those that the rank analysis left
/// out, which is not always what an engineer would remove.
std::vector<RedundantRow> choose_redundant_rows(const Plan& plan, const RankReport& rank);

/// Whether w^T b vanishes but for rounding; b: one value a row.
bool agrees(const RedundantRow& redundant, std::span<const double> b);

}  // namespace catena
