#include "catena/assembly/systems/kkt_structure.hpp"

#include <algorithm>
#include <new>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/linalg/factorization/symmetric_factorization.hpp"

namespace catena {
namespace {

constexpr int turning_only = -2, nowhere = -1;

// Calls f(row, column) for every place that the second derivatives of a block's elements are written to, in the order
// of the slots: row >= column of the matrix, or (turning_only, body), or (nowhere, 0).
template <class Written, class Block, class F>
void visit_places(const Written& written, const Block& block, const Plan& plan, F&& f) {
  const bool turns = only_turning(written);
  for (int e = 0; e < block.size(); ++e) {
    for (const HessianEntry& entry : written) {
      const auto coordinate_of = [&](int local) {
        const int body = local < 3 ? block.body_i[at(e)] : block.body_j[at(e)];
        return body < plan.moving ? 3 * body + local % 3 : -1;
      };
      const int first = coordinate_of(entry.row), second = coordinate_of(entry.column);
      const int row = first < 0 ? -1 : plan.column[at(first)], column = second < 0 ? -1 : plan.column[at(second)];
      if (row < 0 || column < 0) {
        f(nowhere, 0);
      } else if (turns) {
        f(turning_only, first / 3);
      } else {
        f(std::max(row, column), std::min(row, column));
      }
    }
  }
}

template <class F>
void visit_hessians(const Plan& plan, F&& f) {
  for_each_list(plan.blocks, [&](const auto& block, int type) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    constexpr auto written = written_hessian<E>();
    visit_places(written, block, plan, [&](int row, int column) { f(true, type, row, column); });
  });
  for_each_list(plan.forces, [&](const auto& block, int type) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    constexpr auto written = written_stiffness<E>();
    visit_places(written, block, plan, [&](int row, int column) { f(false, type, row, column); });
  });
}

void list_rows(const SparsePattern& jacobian, KktStructure& s) {
  s.row_start.assign(at(jacobian.rows) + 1, 0);
  for (int r : jacobian.row_index) ++s.row_start[at(r) + 1];
  for (int r = 0; r < jacobian.rows; ++r) s.row_start[at(r) + 1] += s.row_start[at(r)];
  s.row_entry.resize(jacobian.row_index.size());
  std::vector<int> next(s.row_start.begin(), s.row_start.end() - 1);
  for (int k = 0; k < jacobian.entries(); ++k) s.row_entry[at(next[at(jacobian.row_index[at(k)])]++)] = k;
}

// Bodies by minimum degree, every constraint row after the last of its bodies.
void choose_order(const Plan& plan, const std::vector<int>& column_of_entry, KktStructure& s) {
  const auto body_of_column = [&](int column) { return plan.coordinate[at(column)] / 3; };
  std::vector<MatrixEntry> pairs;
  for (int b = 0; b < plan.moving; ++b) pairs.push_back({b, b});
  const auto tie = [&](int a, int b) {
    const MatrixEntry pair{std::max(a, b), std::min(a, b)};
    if (a != b && (pair.row != pairs.back().row || pair.column != pairs.back().column)) pairs.push_back(pair);
  };
  for (int c = 0; c < s.columns; ++c) {
    for (int k = s.pattern.column_start[at(c)]; k < s.pattern.column_start[at(c) + 1]; ++k) {
      const int row = s.pattern.row_index[at(k)];
      if (row >= s.columns) break;
      tie(body_of_column(row), body_of_column(c));
    }
  }
  for (int r = 0; r < s.rows; ++r) {
    const auto body = [&](int k) { return body_of_column(column_of_entry[at(s.row_entry[at(k)])]); };
    for (int a = s.row_start[at(r)]; a < s.row_start[at(r) + 1]; ++a) {
      // Entries of one body stand side by side.
      if (a > s.row_start[at(r)] && body(a) == body(a - 1)) continue;
      for (int b = s.row_start[at(r)]; b < a; ++b) tie(body(a), body(b));
    }
  }
  SymmetricFactorization bodies;
  Counters unused;
  if (!bodies.analyze(build_pattern(plan.moving, plan.moving, pairs).pattern, {}, unused).ok()) throw std::bad_alloc();

  // Columns of body b: first_column[b] ... first_column[b + 1] - 1, ascending with b.
  std::vector<int> first_column(at(plan.moving) + 1, s.columns), place(at(plan.moving)), last_place(at(s.rows), -1);
  for (int c = s.columns - 1; c >= 0; --c) first_column[at(body_of_column(c))] = c;
  for (int k = 0; k < plan.moving; ++k) place[at(bodies.order()[at(k)])] = k;
  for (int r = 0; r < s.rows; ++r) {
    for (int k = s.row_start[at(r)]; k < s.row_start[at(r) + 1]; ++k) {
      const int body = body_of_column(column_of_entry[at(s.row_entry[at(k)])]);
      last_place[at(r)] = std::max(last_place[at(r)], place[at(body)]);
    }
  }
  // Rows by the place of their last body, a counting sort; rows of immobile bodies come first, they touch nothing.
  std::vector<int> start(at(plan.moving) + 2, 0), sorted(at(s.rows));
  for (int p : last_place) ++start[at(p + 2)];
  for (std::size_t p = 1; p < start.size(); ++p) start[p] += start[p - 1];
  std::vector<int> next(start.begin(), start.end() - 1);
  for (int r = 0; r < s.rows; ++r) sorted[at(next[at(last_place[at(r)] + 1)]++)] = r;

  s.order.reserve(at(s.columns + s.rows));
  for (int k = -1; k < plan.moving; ++k) {
    if (k >= 0) {
      const int body = bodies.order()[at(k)], first = first_column[at(body)];
      if (first < s.columns && body_of_column(first) == body) s.node_start.push_back(static_cast<int>(s.order.size()));
      for (int c = first; c < s.columns && body_of_column(c) == body; ++c) s.order.push_back(c);
    }
    for (int n = start[at(k + 1)], element = -1; n < start[at(k + 2)]; ++n) {
      const int row = sorted[at(n)], own = plan.row_element[at(row)];
      if (own != element || k < 0) s.node_start.push_back(static_cast<int>(s.order.size()));
      element = own;
      s.order.push_back(s.columns + row);
    }
  }
  s.node_start.push_back(static_cast<int>(s.order.size()));
}

}  // namespace

KktStructure::KktStructure(const Plan& plan) : columns(plan.columns), rows(plan.rows), moving(plan.moving) {
  const SparsePattern& phi_q = plan.jacobian;
  list_rows(phi_q, *this);
  std::vector<int> column_of_entry(at(phi_q.entries()));
  for (int c = 0; c < columns; ++c) {
    for (int k = phi_q.column_start[at(c)]; k < phi_q.column_start[at(c) + 1]; ++k) column_of_entry[at(k)] = c;
  }

  std::vector<MatrixEntry> places;
  for (int c = 0; c < columns; ++c) places.push_back({c, c});
  for (int k = 0; k < phi_q.entries(); ++k) {
    places.push_back({columns + phi_q.row_index[at(k)], column_of_entry[at(k)]});
  }
  const std::size_t hessians = places.size();
  visit_hessians(plan, [&](bool, int, int row, int column) {
    if (row >= 0) places.push_back({row, column});
  });

  SlottedPattern slotted = build_pattern(columns + rows, columns + rows, places);
  places = {};
  pattern = std::move(slotted.pattern);
  const auto slot = slotted.slot.begin();
  diagonal.assign(slot, slot + columns);
  jacobian.assign(slot + columns, slot + static_cast<std::ptrdiff_t>(hessians));
  for (int r = 0; r < rows; ++r) {
    const int length = row_start[at(r) + 1] - row_start[at(r)];
    product_count += length * (length + 1) / 2;
  }
  std::size_t next = hessians;
  visit_hessians(plan, [&](bool constraint, int type, int row, int column) {
    std::vector<int>& slots = constraint ? hessian.constraints[at(type)] : hessian.forces[at(type)];
    slots.push_back(row >= 0 ? slotted.slot[next++] : row == turning_only ? turning(column) : trash());
  });
  choose_order(plan, column_of_entry, *this);
}

std::vector<MatrixEntry> KktStructure::factored_places() const {
  std::vector<MatrixEntry> places(at(entries()));
  for (int c = 0; c < columns; ++c) {
    for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
      places[at(k)] = {pattern.row_index[at(k)], c};
    }
  }
  places.reserve(at(factored()));
  for (int r = 0; r < rows; ++r) {
    const auto column = [&](int k) { return places[at(jacobian[at(row_entry[at(k)])])].column; };
    for (int a = row_start[at(r)]; a < row_start[at(r) + 1]; ++a) {
      for (int b = row_start[at(r)]; b <= a; ++b) places.push_back({column(a), column(b)});
    }
  }
  for (int r = 0; r < rows; ++r) places.push_back({columns + r, columns + r});
  return places;
}

}  // namespace catena
