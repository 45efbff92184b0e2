#include "catena/linalg/patterns/elimination_tree.hpp"

#include <algorithm>

namespace catena {

std::vector<int> elimination_tree(const SparsePattern& later) {
  const int n = later.columns;
  const SlottedPattern earlier = transpose(later);
  // Paths to the root are shortened as they are walked.
  std::vector<int> parent(static_cast<std::size_t>(n), -1), ancestor(parent);
  for (int j = 0; j < n; ++j) {
    for (int k = earlier.pattern.column_start[j]; k < earlier.pattern.column_start[j + 1]; ++k) {
      for (int i = earlier.pattern.row_index[k]; i != -1 && i < j;) {
        const int next = ancestor[i];
        ancestor[i] = j;
        if (next == -1) parent[i] = j;
        i = next;
      }
    }
  }
  return parent;
}

std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> first_child(parent.size(), -1), next_sibling(parent.size(), -1), order, waiting;
  for (int k = n - 1; k >= 0; --k) {
    if (parent[k] < 0) continue;
    next_sibling[k] = first_child[parent[k]];
    first_child[parent[k]] = k;
  }
  order.reserve(parent.size());
  for (int root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    waiting.push_back(root);
    while (!waiting.empty()) {
      const int node = waiting.back(), child = first_child[node];
      if (child >= 0) {
        first_child[node] = next_sibling[child];
        waiting.push_back(child);
      } else {
        order.push_back(node);
        waiting.pop_back();
      }
    }
  }
  return order;
}

FactorStructure factor_structure(const SparsePattern& later, const std::vector<int>& parent) {
  const int n = later.columns;
  FactorStructure result;
  result.start.assign(static_cast<std::size_t>(n) + 1, 0);
  std::vector<int> first_child(parent.size(), -1), next_sibling(parent.size(), -1), met(parent.size(), -1);
  for (int j = 0; j < n; ++j) {
    result.start[j] = result.row.size();
    const auto add = [&](int row) {
      if (row == j || met[row] == j) return;
      met[row] = j;
      result.row.push_back(row);
    };
    for (int k = later.column_start[j]; k < later.column_start[j + 1]; ++k) add(later.row_index[k]);
    for (int c = first_child[j]; c >= 0; c = next_sibling[c]) {
      for (std::size_t k = result.start[c]; k < result.start[c + 1]; ++k) add(result.row[k]);
    }
    std::sort(result.row.begin() + static_cast<std::ptrdiff_t>(result.start[j]), result.row.end());
    result.start[j + 1] = result.row.size();
    if (parent[j] >= 0) {
      next_sibling[j] = first_child[parent[j]];
      first_child[parent[j]] = j;
    }
  }
  return result;
}

}  // namespace catena
