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
// At 9 unknowns a list of the entries costs a quarter of that. Its pivots are those of an earlier matrix: with all of
// them above this part of the largest, of a matrix whose rows and columns are scaled, no multiplier is much above a
// hundred, and solutions are as good to 2e-14 x condition; else the matrix is stored in full and pivots are chosen.
constexpr double well_pivoted = 1e-2;
// Of the terms of a row: solutions are good to rounding x condition, and what a parameter asks of one row alone is of
// the size of its terms.
constexpr double contradicting = 1e-6;

}  // namespace

SaddleSystem::SaddleSystem(std::shared_ptr<const Plan> plan, SaddleBlock block)
    : plan_(std::move(plan)), block_(block), tangent_(plan_, block) {}

void SaddleSystem::leave_out(std::vector<int> rows) {
  if (rows == left_out_ && rows_known_) return;
  left_out_ = std::move(rows);
  rows_known_ = false;
}

void SaddleSystem::use_rows_of(const SaddleSystem& other) {
  left_out_ = other.left_out_;
  rows_ = other.rows_;
  dependent_ = other.dependent_;
  rows_known_ = other.rows_known_;
  analyzed_ = false;
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
  // Of motions that are left nothing is asked.
  const RankReport rank = reveal_rank(slotted.pattern, sorted, {.most_null_vectors = 0});
  rows_.clear();
  dependent_.clear();
  for (const int r : rank.independent_rows) rows_.push_back(held[at(r)]);
  for (const int r : rank.dependent_rows) dependent_.push_back(held[at(r)]);
  rows_known_ = true;
  analyzed_ = false;
}

bool SaddleSystem::make_pattern() {
  const int columns = plan_->columns, size = columns + static_cast<int>(rows_.size());
  alone_is_solved_ = block_ == SaddleBlock::none && 2 * columns == size && columns > 0 && columns <= most_dense;
  place_of_row_.assign(at(plan_->rows), -1);
  for (std::size_t k = 0; k < rows_.size(); ++k) place_of_row_[at(rows_[k])] = static_cast<int>(k);
  if (!alone_is_solved_) tangent_.arrange(rows_);
  find_dependent_entries();
  solution_.resize(at(size));
  if (!alone_is_solved_) return factorization_.analyze(tangent_.pattern(), Kernel::automatic, counters_).ok();
  find_dense_slots();
  const bool all_rows = plan_->rows == columns;
  alone_.listed = all_rows && factorization_.analyze(plan_->jacobian, Kernel::automatic, counters_).ok();
  alone_.has_units = false;
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
  alone_.slot.assign(at(plan_->jacobian.entries()), -1);
  for (int c = 0; c < columns; ++c) {
    for (int k = plan_->jacobian.column_start[at(c)]; k < plan_->jacobian.column_start[at(c) + 1]; ++k) {
      const int row = place_of_row_[at(plan_->jacobian.row_index[at(k)])];
      if (row >= 0) alone_.slot[at(k)] = row * columns + c;
    }
  }
  alone_.solution.resize(at(2 * columns));
  alone_.side.resize(at(columns));
  alone_.places.resize(at(columns));
}

bool SaddleSystem::begin(std::span<const double> jacobian) {
  if (!rows_known_) choose_rows(jacobian);
  if (!analyzed_) {
    if (!make_pattern()) return false;
    analyzed_ = true;
  }
  for (DependentEntry& entry : dependent_entries_) entry.value = jacobian[at(entry.entry)];
  if (alone_is_solved_) {
    values_.assign(jacobian.begin(), jacobian.begin() + plan_->jacobian.entries());
    return true;
  }
  tangent_.begin(jacobian);
  return true;
}

void SaddleSystem::add_diagonal(int coordinate, double value) {
  const int column = plan_->column[at(coordinate)];
  if (column >= 0) tangent_.add_diagonal(column, value);
}

bool SaddleSystem::factorize() {
  if (alone_is_solved_) return factorize_alone();
  return factorization_.factorize(tangent_.values(), counters_).ok() && factorization_.rcond() > regular;
}

// Columns are scaled by their largest entries at the first matrix: pivots must not depend on the unit of length.
bool SaddleSystem::factorize_alone() {
  if (alone_.listed && !alone_.has_units) {
    std::vector<double> units(at(plan_->columns), 0.0);
    for (std::size_t c = 0; c < units.size(); ++c) {
      for (int k = plan_->jacobian.column_start[c]; k < plan_->jacobian.column_start[c + 1]; ++k)
        units[c] = std::max(units[c], std::abs(values_[at(k)]));
      units[c] = std::isnormal(units[c]) ? 1 / units[c] : 1;
    }
    factorization_.set_column_units(units);
    alone_.has_units = true;
  }
  alone_.in_list = alone_.listed && factorization_.factorize(values_, counters_).ok() &&
                   factorization_.rcond() > well_pivoted && factorization_.solves_in_lanes();
  if (alone_.in_list) return true;
  ++counters_.factorizations;
  const std::span<double> entries = alone_.factors.begin(plan_->columns);
  for (std::size_t k = 0; k < alone_.slot.size(); ++k) {
    if (alone_.slot[k] >= 0) entries[at(alone_.slot[k])] = values_[k];
  }
  return alone_.factors.factorize() && alone_.factors.rcond() > regular;
}

// solution_, [f; b] in, [x; lambda] out: x follows from b, lambda from f; of zero nothing follows.
void SaddleSystem::solve_alone() {
  const std::size_t columns = at(plan_->columns);
  const std::span<double> sides(solution_), found(alone_.solution);
  const auto is_zero = [](std::span<const double> side) {
    return std::all_of(side.begin(), side.end(), [](double entry) { return entry == 0; });
  };
  const bool asks_places = !is_zero(sides.subspan(columns)), asks_multipliers = !is_zero(sides.first(columns));
  if (alone_.in_list) {
    // The list takes rows in the order of the plan.
    const std::span<double> x = found.first(columns), lambda = found.subspan(columns);
    for (std::size_t k = 0; k < columns; ++k) x[at(rows_[k])] = sides[columns + k];
    if (asks_places) factorization_.solve(x, counters_);
    std::copy_n(sides.begin(), columns, sides.begin() + static_cast<std::ptrdiff_t>(columns));
    const std::span<double> f = sides.subspan(columns);
    if (asks_multipliers) factorization_.solve_transposed(f, counters_);
    for (std::size_t k = 0; k < columns; ++k) lambda[k] = f[at(rows_[k])];
    std::swap(solution_, alone_.solution);
    return;
  }
  std::fill(found.begin(), found.end(), 0.0);
  if (asks_places) alone_.factors.solve<double>(sides.subspan(columns), found.first(columns));
  if (asks_multipliers) alone_.factors.solve_transposed<double>(sides.first(columns), found.subspan(columns));
  std::swap(solution_, alone_.solution);
}

void SaddleSystem::solve_places(std::span<const Lanes> b, std::span<Lanes> x) {
  if (alone_.in_list) {
    std::copy(b.begin(), b.end(), alone_.side.begin());
    factorization_.solve(alone_.side, counters_);
    for (std::size_t c = 0; c < alone_.side.size(); ++c) x[at(plan_->coordinate[c])] = alone_.side[c];
    return;
  }
  for (std::size_t k = 0; k < rows_.size(); ++k) alone_.side[k] = b[at(rows_[k])];
  alone_.factors.solve<Lanes>(alone_.side, alone_.places);
  for (std::size_t c = 0; c < alone_.places.size(); ++c) x[at(plan_->coordinate[c])] = alone_.places[c];
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
  else if (alone_is_solved_)
    solve_alone();
  else if (!factorization_.solve_checked(tangent_.values(), solution_, counters_).ok())
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
