#include "catena/analysis/pose/redundancy.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/singular_point.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Elimination among more rows than this would fill the matrix, for a list of names too long to read.
constexpr int most_rows = 200;
// Part of the largest weight of a combination below which a row may not take part.
constexpr double certain = 1e-4, rounding = 1e-11;

/// Rows of the element that a row belongs to.
int rows_of_element(const Plan& plan, int row) {
  const int element = plan.row_element[at(row)];
  int count = 0;
  for (int r = plan.element_row[at(element)]; r < plan.rows && plan.row_element[at(r)] == element; ++r) ++count;
  return count;
}

double largest_weight(const std::map<int, double>& combination) {
  double largest = 0;
  for (const auto& [row, weight] : combination) largest = std::max(largest, std::abs(weight));
  return largest;
}

}  // namespace

std::vector<RedundantRow> choose_redundant_rows(const Plan& plan, const RankReport& rank) {
  std::vector<RedundantRow> chosen;
  for (std::size_t k = 0; k < rank.dependent_rows.size(); ++k) {
    RedundantRow redundant{rank.dependent_rows[k], {}};
    if (static_cast<int>(k) < rank.left_null_vectors.count()) {
      const auto rows = rank.left_null_vectors.indices(static_cast<int>(k));
      const auto weights = rank.left_null_vectors.values(static_cast<int>(k));
      for (std::size_t n = 0; n < rows.size(); ++n) redundant.combination[rows[n]] += weights[n];
    }
    chosen.push_back(std::move(redundant));
  }
  if (static_cast<int>(chosen.size()) > most_rows || rank.left_null_vectors.count() == 0) return chosen;
  for (RedundantRow& redundant : chosen) {
    const double largest = largest_weight(redundant.combination);
    int best = -1, fewest = 0;
    for (const auto& [row, weight] : redundant.combination) {
      if (std::abs(weight) < certain * largest) continue;
      const int rows = rows_of_element(plan, row);
      const bool later = best < 0 || plan.row_element[at(row)] >= plan.row_element[at(best)];
      if (best < 0 || rows < fewest || (rows == fewest && later)) best = row, fewest = rows;
    }
    const double pivot = redundant.combination[best];
    for (auto& [row, weight] : redundant.combination) weight /= pivot;
    redundant.row = best;
    for (RedundantRow& other : chosen) {
      const auto found = other.combination.find(best);
      if (&other == &redundant || found == other.combination.end()) continue;
      const double factor = found->second, size = largest_weight(other.combination);
      for (const auto& [row, weight] : redundant.combination) {
        double& value = other.combination[row];
        value -= factor * weight;
        if (row == best || std::abs(value) <= rounding * size) other.combination.erase(row);
      }
    }
  }
  std::sort(chosen.begin(), chosen.end(), [](const RedundantRow& a, const RedundantRow& b) { return a.row < b.row; });
  return chosen;
}

bool agrees(const RedundantRow& redundant, std::span<const double> b) {
  double sum = 0, size = 0;
  for (const auto& [row, weight] : redundant.combination) {
    sum += weight * b[at(row)];
    size += std::abs(weight * b[at(row)]);
  }
  return !(std::abs(sum) > clear_disagreement * size);
}

}  // namespace catena
