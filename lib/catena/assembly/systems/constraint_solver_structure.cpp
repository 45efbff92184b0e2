// ConstraintSolver: the pattern of S, its order of elimination, and the place of every product.
#include <algorithm>

#include "catena/assembly/systems/constraint_solver.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/kernels/cholmod_kernel.hpp"

namespace catena {

bool ConstraintSolver::analyze(Counters& counters) {
  const Plan& plan = *plan_;
  const SparsePattern& a = plan.jacobian;
  std::vector<char> varies(at(a.entries()) + 1, 0);
  for_each_list(plan.blocks, [&](const auto& block, int) {
    for (int slot : block.slot) varies[at(slot)] = 1;
  });
  for (int k = 0; k < 3 * plan.moving; ++k) {
    const Column column{k, column_start_[at(k)], column_start_[at(k) + 1]};
    if (column.first == column.last) continue;
    const bool any = std::any_of(varies.begin() + column.first, varies.begin() + column.last, [](char v) { return v; });
    (any ? places_.varying : places_.constant).push_back(column);
  }
  // The pattern of S in the plan's rows, for the order; then again, permuted, with the slot of every product.
  std::vector<MatrixEntry> entries;
  places_.pair_start.assign(1, 0);
  for (int r = 0, first = 0; r < plan.rows; ++r) {
    if (plan.row_element[at(r)] != plan.row_element[at(first)]) first = r;
    for (int other = first; other <= r; ++other) entries.push_back({r, other});
    places_.pair_start.push_back(static_cast<int>(entries.size()));
  }
  const std::size_t pairs = entries.size();
  const auto products = [&](const std::vector<Column>& columns) {
    for (const Column& column : columns) {
      for (int x = column.first; x < column.last; ++x) {
        for (int y = column.first; y <= x; ++y) entries.push_back({a.row_index[at(x)], a.row_index[at(y)]});
      }
    }
  };
  products(places_.varying);
  const std::size_t first_constant = entries.size();
  products(places_.constant);
  for (MatrixEntry& entry : entries) {
    const auto [first, last] = std::minmax(entry.row, entry.column);
    entry = {last, first};
  }
  const SlottedPattern built = build_pattern(plan.rows, plan.rows, entries);
  if (!analyze_factors(built.pattern, counters)) return false;
  const auto slots = [&](std::size_t begin, std::size_t end) {
    std::vector<int> list;
    for (std::size_t k = begin; k < end; ++k) list.push_back(factors_.slots()[at(built.slot[k])]);
    return list;
  };
  places_.pair_slot = slots(0, pairs);
  for (int r = 0; r < plan.rows; ++r)
    places_.diagonal.push_back(places_.pair_slot[at(places_.pair_start[at(r) + 1] - 1)]);
  places_.varying_slot = slots(pairs, first_constant);
  places_.constant_slot = slots(first_constant, entries.size());
  constant_values_.resize(factors_.values().size());
  diagonal_values_.resize(at(plan.rows));
  analyzed_ = true;
  place_left_out();
  return true;
}

// Rows of one element follow each other, so that a row and one before it are a pair.
void ConstraintSolver::place_left_out() {
  left_out_slot_.clear();
  if (!analyzed_) return;
  for (int k = 0; k < left_out_.count(); ++k) {
    const std::span<const int> rows = left_out_.indices(k);
    for (std::size_t a = 0; a < rows.size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        left_out_slot_.push_back(places_.pair_slot[at(places_.pair_start[at(rows[a]) + 1] - 1 - (rows[a] - rows[b]))]);
      }
    }
  }
}

// Rows of an element go together: they touch the same bodies. Elements by minimum degree.
bool ConstraintSolver::analyze_factors(const SparsePattern& lower, Counters& counters) {
  const Plan& plan = *plan_;
  std::vector<int> node(at(plan.rows)), node_first;
  for (int r = 0; r < plan.rows; ++r) {
    if (r == 0 || plan.row_element[at(r)] != plan.row_element[at(r - 1)]) node_first.push_back(r);
    node[at(r)] = static_cast<int>(node_first.size()) - 1;
  }
  const int nodes = static_cast<int>(node_first.size());
  node_first.push_back(plan.rows);
  std::vector<MatrixEntry> entries, pairs;
  for (int k = 0; k < nodes; ++k) pairs.push_back({k, k});
  for (int c = 0; c < lower.columns; ++c) {
    for (int e = lower.column_start[at(c)]; e < lower.column_start[at(c) + 1]; ++e) {
      const int row = lower.row_index[at(e)];
      entries.push_back({row, c});
      const MatrixEntry pair{node[at(row)], node[at(c)]};
      if (pair.row != pair.column && (pair.row != pairs.back().row || pair.column != pairs.back().column))
        pairs.push_back(pair);
    }
  }
  CholmodKernel orderer;
  if (!orderer.analyze(build_pattern(nodes, nodes, pairs).pattern, {}).ok()) return false;
  std::vector<int> order, node_start{0};
  for (int k : orderer.order()) {
    for (int r = node_first[at(k)]; r < node_first[at(k) + 1]; ++r) order.push_back(r);
    node_start.push_back(static_cast<int>(order.size()));
  }
  factors_.analyze(entries, order, node_start, counters);
  return true;
}

}  // namespace catena
