#include "catena/analysis/pose/jacobian_rank.hpp"

#include <algorithm>

#include "catena/base/at.hpp"

namespace catena {

std::vector<double> jacobian_values(Evaluator& evaluator, std::span<const double> q) {
  std::vector<double> values(at(evaluator.plan().trash_slot()) + 1);
  evaluator.start_jacobian(values);
  evaluator.set_configuration(q);
  evaluator.jacobian(values);
  values.pop_back();  // where entries of what cannot move go
  return values;
}

RankReport jacobian_rank(const Evaluator& evaluator, const SparsePattern& pattern, std::span<const double> values,
                         const RankOptions& options) {
  const Plan& plan = evaluator.plan();
  const auto unit = [&](int column) { return plan.coordinate[at(column)] % 3 == 2 ? 1.0 : evaluator.length_scale(); };
  std::vector<double> scaled(values.begin(), values.end());
  for (int c = 0; c < pattern.columns; ++c) {
    for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) scaled[at(k)] *= unit(c);
  }
  RankReport rank = reveal_rank(pattern, scaled, options);
  // D y, with the free column's entry 1 as before.
  SparseVectors& vectors = rank.right_null_vectors;
  for (int v = 0; v < vectors.count(); ++v) {
    const double first = unit(vectors.indices(v).front());
    for (int k = vectors.start[at(v)]; k < vectors.start[at(v) + 1]; ++k) {
      vectors.value[at(k)] *= unit(vectors.index[at(k)]) / first;
    }
  }
  return rank;
}

std::vector<char> empty_rows(const Plan& plan) {
  std::vector<char> empty(at(plan.rows), 1);
  for (int row : plan.jacobian.row_index) {
    if (row < plan.rows) empty[at(row)] = 0;
  }
  return empty;
}

int acting_rows(const Plan& plan) {
  const std::vector<char> empty = empty_rows(plan);
  return static_cast<int>(std::count(empty.begin(), empty.end(), 0));
}

}  // namespace catena
