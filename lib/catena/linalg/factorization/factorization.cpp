#include "catena/linalg/factorization/factorization.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

#include "catena/linalg/patterns/matching.hpp"

namespace catena {
FactorResult Factorization::analyze(const SparsePattern& pattern, Kernel kernel, Counters& counters) {
  if (pattern.rows != pattern.columns) throw std::invalid_argument("Factorization: the matrix must be square");
  *this = Factorization();
  if (kernel == Kernel::cholmod || kernel == Kernel::spqr || !is_compiled_in(kernel))
    return {FactorStatus::unavailable, -1};
  pattern_ = pattern;
  kernel_ = kernel;
  umfpack_in_use_ = kernel == Kernel::umfpack;
  form_.structural_rank = size();
  if (size() == 0) return {};

  ++counters.symbolic;
  if (umfpack_in_use_) {
    form_.blocks = 1;
    form_.largest_block = size();
    form_.block_of_column.assign(static_cast<std::size_t>(size()), 0);
    form_.block_of_row = form_.block_of_column;
    return umfpack_.analyze(pattern_);
  }
  Matching matching = maximum_matching(pattern_);
  form_.structural_rank = matching.structural_rank;
  if (form_.structural_rank < size()) {
    form_.unmatched_rows = std::move(matching.unmatched_rows);
    form_.unmatched_columns = std::move(matching.unmatched_columns);
    return {FactorStatus::singular, form_.unmatched_columns.front()};
  }
  const FactorResult result = klu_.analyze(pattern_, matching.row_of_column);
  if (result.ok()) read_block_form();
  return result;
}

void Factorization::read_block_form() {
  const std::span<const int> start = klu_.block_starts();
  form_.block_start.assign(start.begin(), start.end());
  form_.blocks = static_cast<int>(start.size()) - 1;
  form_.block_of_column.resize(static_cast<std::size_t>(size()));
  form_.block_of_row.resize(static_cast<std::size_t>(size()));
  for (int block = 0; block < form_.blocks; ++block) {
    form_.largest_block = std::max(form_.largest_block, start[block + 1] - start[block]);
    for (int place = start[block]; place < start[block + 1]; ++place) {
      form_.block_of_column[klu_.column_order()[place]] = block;
      form_.block_of_row[klu_.row_order()[place]] = block;
    }
  }
}

void Factorization::set_column_units(std::span<const double> units) {
  if (units.size() != static_cast<std::size_t>(size()))
    throw std::invalid_argument("Factorization: as many units as columns are needed");
  klu_.set_column_units(units);
}

FactorResult Factorization::factorize(std::span<const double> values, Counters& counters) {
  if (values.size() != pattern_.row_index.size())
    throw std::invalid_argument("Factorization: as many values as the pattern has entries are needed");
  factorized_ = size() == 0;
  margins_are_current_ = false;
  if (factorized_) return {};
  if (form_.structural_rank < size()) return {FactorStatus::singular, form_.unmatched_columns.front()};
  if (kernel_ == Kernel::umfpack) return factor_by_umfpack(values, counters);

  umfpack_in_use_ = false;
  if (klu_.has_factors()) {
    ++counters.factorizations;
    ++counters.refactorizations;
    factorized_ = klu_.refactor(pattern_, values);
    pivots_are_fresh_ = false;
    if (factorized_) return {};
  }
  return factor_anew(values, usual_pivot_tolerance, counters);
}

FactorResult Factorization::factor_anew(std::span<const double> values, double pivot_tolerance, Counters& counters) {
  ++counters.factorizations;
  margins_are_current_ = false;
  const FactorResult result = klu_.factor(pattern_, values, pivot_tolerance);
  factorized_ = result.ok();
  pivots_are_fresh_ = true;
  parities_are_current_ = false;
  return result;
}

FactorResult Factorization::factor_by_umfpack(std::span<const double> values, Counters& counters) {
  ++counters.factorizations;
  const FactorResult result = umfpack_.factor(pattern_, values);
  factorized_ = result.ok();
  umfpack_in_use_ = true;
  return result;
}

void Factorization::require_factors() const {
  if (!factorized_) throw std::logic_error("Factorization: no valid factors to solve with");
}

void Factorization::solve_by_kernel_in_use(std::span<double> x) {
  if (umfpack_in_use_)
    umfpack_.solve(x);
  else
    klu_.solve(x);
}

void Factorization::solve(std::span<double> x, Counters& counters) {
  require_factors();
  if (size() == 0) return;
  assert(x.size() % static_cast<std::size_t>(size()) == 0);
  counters.solves += static_cast<std::int64_t>(x.size()) / size();
  solve_by_kernel_in_use(x);
}

void Factorization::solve(std::span<Lanes> x, Counters& counters) {
  if (!solves_in_lanes()) throw std::logic_error("Factorization: these factors do not solve in lanes");
  counters.solves += Lanes::count;
  klu_.solve(x);
}

void Factorization::solve_transposed(std::span<double> x, Counters& counters) {
  require_factors();
  if (size() == 0) return;
  assert(x.size() % static_cast<std::size_t>(size()) == 0);
  counters.solves += static_cast<std::int64_t>(x.size()) / size();
  if (umfpack_in_use_)
    umfpack_.solve_transposed(x);
  else
    klu_.solve_transposed(x);
}

double Factorization::rcond() const {
  if (!factorized_) return 0;
  if (size() == 0) return 1;
  return umfpack_in_use_ ? umfpack_.rcond() : klu_.rcond();
}

PivotInfo Factorization::smallest_pivot(int block) const {
  if (!factorized_ || umfpack_in_use_) throw std::logic_error("Factorization: pivots of blocks need KLU's factors");
  PivotInfo smallest{std::numeric_limits<double>::infinity(), -1};
  const std::span<const double> pivots = klu_.pivots();
  for (int place = form_.block_start[block]; place < form_.block_start[block + 1]; ++place) {
    const double magnitude = std::abs(pivots[place]);
    if (magnitude < smallest.magnitude) smallest = {magnitude, klu_.column_order()[place]};
  }
  return smallest;
}

std::string Factorization::describe(const FactorResult& result) const {
  switch (result.status) {
    case FactorStatus::ok:
      return "factored";
    case FactorStatus::singular:
      if (form_.structural_rank < size())
        return "the pattern of the matrix is singular: rank at most " + std::to_string(form_.structural_rank) + " of " +
               std::to_string(size());
      return result.index < 0 ? "the matrix is singular"
                              : "the matrix is singular: no pivot for column " + std::to_string(result.index);
    case FactorStatus::not_finite:
      return "the matrix holds values that are not finite, met at column " + std::to_string(result.index);
    case FactorStatus::out_of_memory:
      return "out of memory while factoring";
    case FactorStatus::unavailable:
      return "the kernel asked for is not in this build or does not factor unsymmetric matrices; at hand: " +
             kernel_summary();
    case FactorStatus::inaccurate:
      return "the residual stays above the tolerance with every kernel at hand";
  }
  return {};
}

}  // namespace catena
