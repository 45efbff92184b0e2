#include "catena/analysis/sensitivity/saddle_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catena/base/at.hpp"
#include "catena/linalg/rank/rank_revealing.hpp"

namespace catena {
namespace {

// Pivots further apart than this, in a matrix scaled by rows, are rounding: the matrix is singular.
constexpr double regular = 1e-15;
// Up to so many unknowns a matrix that is stored in full costs less than the sparse one of twice as many rows and its
// checks: at 9, five times less; elimination grows with the third power.
constexpr int most_dense = 24;
// Of the terms of a row: solutions are good to rounding x condition, and what a parameter asks of one row alone is of
// the size of its terms.
constexpr double contradicting = 1e-6;

/// Pairs of moving bodies that an element of the plan ties, each once, the lower number first.
std::vector<std::pair<int, int>> tied_pairs(const Plan& plan) {
  std::vector<std::pair<int, int>> pairs;
  const auto take = [&](const auto& block) {
    for (int e = 0; e < block.size(); ++e) {
      const int i = block.body_i[at(e)], j = block.body_j[at(e)];
      if (i < plan.moving && j < plan.moving && i != j) pairs.emplace_back(std::min(i, j), std::max(i, j));
    }
  };
  for_each_list(plan.blocks, [&](const auto& block, int) { take(block); });
  for_each_list(plan.forces, [&](const auto& block, int) { take(block); });
  for (const auto& [i, j] : plan.law_pairs) pairs.emplace_back(std::min(i, j), std::max(i, j));
  for (int b = 0; b < plan.moving; ++b) pairs.emplace_back(b, b);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace

SaddleSystem::SaddleSystem(std::shared_ptr<const Plan> plan, SaddleBlock block)
    : plan_(std::move(plan)), block_(block) {
  if (block_ == SaddleBlock::elements) pairs_ = tied_pairs(*plan_);
}

void SaddleSystem::leave_out(std::vector<int> rows) {
  if (rows == left_out_ && rows_known_) return;
  left_out_ = std::move(rows);
  rows_known_ = false;
}

// A maximal independent set among the rows that hold.
void SaddleSystem::choose_rows(std::span<const double> jacobian) {
  std::vector<int> held, place(at(plan_->rows), -1);
  for (int r = 0; r < plan_->rows; ++r) {
    if (std::binary_search(left_out_.begin(), left_out_.end(), r)) continue;
    place[at(r)] = static_cast<int>(held.size());
    held.push_back(r);
  }
  std::vector<MatrixEntry> entries;
  std::vector<double> values;
  for (int c = 0; c < plan_->columns; ++c) {
    for (int k = plan_->jacobian.column_start[at(c)]; k < plan_->jacobian.column_start[at(c) + 1]; ++k) {
      const int row = place[at(plan_->jacobian.row_index[at(k)])];
      if (row < 0) continue;
      entries.push_back({row, c});
      values.push_back(jacobian[at(k)]);
    }
  }
  const SlottedPattern slotted = build_pattern(static_cast<int>(held.size()), plan_->columns, entries);
  std::vector<double> sorted(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) sorted[at(slotted.slot[k])] = values[k];
  const RankReport rank = reveal_rank(slotted.pattern, sorted);
  rows_.clear();
  dependent_.clear();
  for (const int r : rank.independent_rows) rows_.push_back(held[at(r)]);
  for (const int r : rank.dependent_rows) dependent_.push_back(held[at(r)]);
  rows_known_ = true;
  analyzed_ = false;
}

int SaddleSystem::block_of(int body_i, int body_j) const {
  return static_cast<int>(std::lower_bound(pairs_.begin(), pairs_.end(), std::pair(body_i, body_j)) - pairs_.begin());
}

bool SaddleSystem::make_pattern() {
  const int columns = plan_->columns, size = columns + static_cast<int>(rows_.size());
  dense_ = block_ == SaddleBlock::none && 2 * columns == size && columns > 0 && columns <= most_dense;
  std::vector<MatrixEntry> entries;
  if (block_ == SaddleBlock::diagonal) {
    for (int c = 0; c < columns; ++c) entries.push_back({c, c});
  }
  const auto column = [&](int body, int k) { return plan_->column[at(3 * body + k)]; };
  std::vector<int> entry_of_pair;  // -1 where a coordinate is no unknown
  for (const auto& [i, j] : pairs_) {
    for (int direction = 0; direction < 2; ++direction) {
      for (int k = 0; k < 9; ++k) {
        const int row = column(direction == 0 ? i : j, k / 3), col = column(direction == 0 ? j : i, k % 3);
        const bool there = row >= 0 && col >= 0;
        entry_of_pair.push_back(there ? static_cast<int>(entries.size()) : -1);
        if (there) entries.push_back({row, col});
      }
    }
  }
  place_of_row_.assign(at(plan_->rows), -1);
  for (std::size_t k = 0; k < rows_.size(); ++k) place_of_row_[at(rows_[k])] = static_cast<int>(k);
  const std::size_t first = entries.size();
  std::vector<int> used;
  for (int c = 0; c < columns; ++c) {
    for (int k = plan_->jacobian.column_start[at(c)]; k < plan_->jacobian.column_start[at(c) + 1]; ++k) {
      const int row = place_of_row_[at(plan_->jacobian.row_index[at(k)])];
      if (row < 0) continue;
      used.push_back(k);
      entries.push_back({columns + row, c});
      entries.push_back({c, columns + row});
    }
  }
  const SlottedPattern slotted = build_pattern(size, size, entries);
  pattern_ = slotted.pattern;
  diagonal_slot_.clear();
  for (int c = 0; block_ == SaddleBlock::diagonal && c < columns; ++c) diagonal_slot_.push_back(slotted.slot[at(c)]);
  pair_slot_.clear();
  for (const int entry : entry_of_pair) pair_slot_.push_back(entry < 0 ? -1 : slotted.slot[at(entry)]);
  jacobian_slot_.assign(at(plan_->jacobian.entries()), -1);
  transposed_slot_ = jacobian_slot_;
  for (std::size_t k = 0; k < used.size(); ++k) {
    jacobian_slot_[at(used[k])] = slotted.slot[first + 2 * k];
    transposed_slot_[at(used[k])] = slotted.slot[first + 2 * k + 1];
  }
  find_dependent_entries();
  solution_.resize(at(size));
  if (!dense_) return factorization_.analyze(pattern_, Kernel::automatic, counters_).ok();
  find_dense_slots();
  return true;
}

// Entries of Phi_q in rows that depend on others.
void SaddleSystem::find_dependent_entries() {
  std::vector<int> place_of_dependent(at(plan_->rows), -1);
  for (std::size_t k = 0; k < dependent_.size(); ++k) place_of_dependent[at(dependent_[k])] = static_cast<int>(k);
  dependent_entries_.clear();
  for (int c = 0; c < plan_->columns && !dependent_.empty(); ++c) {
    for (int k = plan_->jacobian.column_start[at(c)]; k < plan_->jacobian.column_start[at(c) + 1]; ++k) {
      const int place = place_of_dependent[at(plan_->jacobian.row_index[at(k)])];
      if (place >= 0) dependent_entries_.push_back({place, c, k, 0});
    }
  }
  asked_.assign(dependent_.size(), 0.0);
}

// Places of the entries of Phi_q where it is stored in full, row after row.
void SaddleSystem::find_dense_slots() {
  const int columns = plan_->columns;
  full_.slot.assign(at(plan_->jacobian.entries()), -1);
  for (int c = 0; c < columns; ++c) {
    for (int k = plan_->jacobian.column_start[at(c)]; k < plan_->jacobian.column_start[at(c) + 1]; ++k) {
      const int row = place_of_row_[at(plan_->jacobian.row_index[at(k)])];
      if (row >= 0) full_.slot[at(k)] = row * columns + c;
    }
  }
  full_.solution.resize(at(2 * columns));
  full_.side.resize(at(columns));
  full_.places.resize(at(columns));
}

bool SaddleSystem::begin(std::span<const double> jacobian) {
  if (!rows_known_) choose_rows(jacobian);
  if (!analyzed_) {
    if (!make_pattern()) return false;
    analyzed_ = true;
  }
  for (DependentEntry& entry : dependent_entries_) entry.value = jacobian[at(entry.entry)];
  if (dense_) {
    const std::span<double> entries = full_.factors.begin(plan_->columns);
    for (std::size_t k = 0; k < full_.slot.size(); ++k) {
      if (full_.slot[k] >= 0) entries[at(full_.slot[k])] = jacobian[k];
    }
    return true;
  }
  values_.assign(pattern_.row_index.size(), 0.0);
  for (std::size_t k = 0; k < jacobian_slot_.size(); ++k) {
    if (jacobian_slot_[k] < 0) continue;
    values_[at(jacobian_slot_[k])] = jacobian[k];
    values_[at(transposed_slot_[k])] = jacobian[k];
  }
  return true;
}

void SaddleSystem::add_diagonal(int coordinate, double value) {
  const int column = plan_->column[at(coordinate)];
  if (column < 0) return;
  if (block_ == SaddleBlock::diagonal) {
    values_[at(diagonal_slot_[at(column)])] += value;
  } else {
    const int body = coordinate / 3, k = coordinate % 3;
    values_[at(pair_slot_[at(18 * block_of(body, body) + 4 * k)])] += value;
  }
}

void SaddleSystem::add_element(int body_i, int body_j, const ElementMatrix& matrix) {
  const int body[2] = {body_i, body_j};
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      if (body[a] >= plan_->moving || body[b] >= plan_->moving) continue;
      // A body's own block stands once: its transposed copy stays zero.
      const bool forwards = body[a] <= body[b];
      const int first = 18 * block_of(std::min(body[a], body[b]), std::max(body[a], body[b])) + (forwards ? 0 : 9);
      for (int k = 0; k < 9; ++k) {
        const int slot = pair_slot_[at(first + k)];
        if (slot >= 0) values_[at(slot)] += matrix[at(6 * (3 * a + k / 3) + 3 * b + k % 3)];
      }
    }
  }
}

bool SaddleSystem::factorize() {
  if (dense_) {
    ++counters_.factorizations;
    return full_.factors.factorize() && full_.factors.rcond() > regular;
  }
  return factorization_.factorize(values_, counters_).ok() && factorization_.rcond() > regular;
}

// solution_, [f; b] in, [x; lambda] out: x follows from b, lambda from f.
void SaddleSystem::solve_dense() {
  const std::size_t columns = at(plan_->columns);
  const std::span<double> sides(solution_), found(full_.solution);
  full_.factors.solve<double>(sides.subspan(columns), found.first(columns));
  full_.factors.solve_transposed<double>(sides.first(columns), found.subspan(columns));
  std::swap(solution_, full_.solution);
}

void SaddleSystem::solve_places(std::span<const Lanes> b, std::span<Lanes> x) {
  for (std::size_t k = 0; k < rows_.size(); ++k) full_.side[k] = b[at(rows_[k])];
  full_.factors.solve<Lanes>(full_.side, full_.places);
  for (std::size_t c = 0; c < full_.places.size(); ++c) x[at(plan_->coordinate[c])] = full_.places[c];
}

bool SaddleSystem::solve(std::span<double> f, std::span<double> b) {
  const std::size_t columns = at(plan_->columns);
  for (std::size_t c = 0; c < columns; ++c) solution_[c] = f[at(plan_->coordinate[c])];
  for (std::size_t k = 0; k < rows_.size(); ++k) solution_[columns + k] = b[at(rows_[k])];
  for (std::size_t k = 0; k < dependent_.size(); ++k) asked_[k] = b[at(dependent_[k])];
  // A side that is not a number, of a parameter that has no derivatives, has a solution that is none.
  const bool is_number = std::all_of(solution_.begin(), solution_.end(), [](double x) { return !std::isnan(x); });
  if (!is_number)
    std::fill(solution_.begin(), solution_.end(), std::numeric_limits<double>::quiet_NaN());
  else if (dense_)
    solve_dense();
  else if (!factorization_.solve_checked(values_, solution_, counters_).ok())
    return false;
  for (std::size_t c = 0; c < columns; ++c) f[at(plan_->coordinate[c])] = solution_[c];
  std::fill(b.begin(), b.end(), 0.0);
  for (std::size_t k = 0; k < rows_.size(); ++k) b[at(rows_[k])] = solution_[columns + k];
  return true;
}

// Terms are counted with the largest change of all coordinates of their kind, m or rad: what is zero but for rounding
// contradicts nothing.
int SaddleSystem::contradicted_row() const {
  if (dependent_.empty()) return -1;
  double largest[2] = {};
  for (int c = 0; c < plan_->columns; ++c) {
    double& most = largest[plan_->coordinate[at(c)] % 3 == 2 ? 1 : 0];
    most = std::max(most, std::abs(solution_[at(c)]));
  }
  std::vector<double> left = asked_, terms(asked_.size());
  for (std::size_t k = 0; k < terms.size(); ++k) terms[k] = std::abs(asked_[k]);
  for (const DependentEntry& entry : dependent_entries_) {
    left[at(entry.place)] -= entry.value * solution_[at(entry.column)];
    terms[at(entry.place)] += std::abs(entry.value) * largest[plan_->coordinate[at(entry.column)] % 3 == 2 ? 1 : 0];
  }
  int worst = -1;
  double most = contradicting;
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (!(std::abs(left[k]) > most * terms[k])) continue;
    most = std::abs(left[k]) / terms[k];
    worst = dependent_[k];
  }
  return worst;
}

std::string describe_contradiction(const Model& model, const Plan& plan, int row) {
  return fmt::format(
      "\"{}\" depends on other constraints, and a parameter moves it or these alone: beside the present value no "
      "configuration meets them all, and there is no derivative by it; let the parameter move all of them",
      model.element_name(plan.row_element[at(row)]));
}

}  // namespace catena
