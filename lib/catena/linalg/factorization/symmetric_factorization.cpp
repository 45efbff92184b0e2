#include "catena/linalg/factorization/symmetric_factorization.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>

namespace catena {
namespace {

void check_lower_triangle(const SparsePattern& lower) {
  if (lower.rows != lower.columns) throw std::invalid_argument("SymmetricFactorization: the matrix must be square");
  for (int j = 0; j < lower.columns; ++j)
    if (lower.column_start[j] < lower.column_start[j + 1] && lower.row_index[lower.column_start[j]] < j)
      throw std::invalid_argument("SymmetricFactorization: entry above the diagonal");
}

}  // namespace

FactorResult SymmetricFactorization::analyze(const SparsePattern& lower, const SymmetricOptions& options,
                                             Counters& counters) {
  check_lower_triangle(lower);
  *this = SymmetricFactorization();
  if (lower.columns == 0) return {};
  ++counters.symbolic;
  const FactorResult result = kernel_.analyze(lower, options);
  if (!result.ok()) return result;
  order_.assign(kernel_.order().begin(), kernel_.order().end());
  prepare_upper_triangle(lower);
  residual_work_.resize(order_.size());
  correction_work_.resize(order_.size());
  return {};
}

/// CHOLMOD's row-wise factorization reads columns of the permuted upper triangle: its pattern is made once, and with
/// it the place in the caller's values from which every entry comes.
void SymmetricFactorization::prepare_upper_triangle(const SparsePattern& lower) {
  place_.resize(order_.size());
  for (int k = 0; k < size(); ++k) place_[order_[k]] = k;
  std::vector<MatrixEntry> entries(lower.row_index.size());
  for (int j = 0; j < lower.columns; ++j) {
    for (int k = lower.column_start[j]; k < lower.column_start[j + 1]; ++k) {
      const auto [first, last] = std::minmax(place_[lower.row_index[k]], place_[j]);
      entries[k] = {first, last};
    }
  }
  SlottedPattern built = build_pattern(lower.columns, lower.columns, entries);
  upper_ = std::move(built.pattern);
  upper_values_.resize(entries.size());
  source_.resize(entries.size());
  for (std::size_t k = 0; k < entries.size(); ++k) source_[built.slot[k]] = static_cast<int>(k);
}

FactorResult SymmetricFactorization::factorize(std::span<const double> values, double shift, Counters& counters) {
  if (values.size() != source_.size())
    throw std::invalid_argument("SymmetricFactorization: as many values as the pattern has entries are needed");
  references_are_current_ = false;
  factorized_ = size() == 0;
  if (factorized_) return {};
  for (std::size_t k = 0; k < source_.size(); ++k) upper_values_[k] = values[source_[k]];
  shift_ = shift;
  ++counters.factorizations;
  counters.refactorizations += factored_before_ ? 1 : 0;
  factored_before_ = true;
  FactorResult result = kernel_.factor(upper_, upper_values_, shift);
  if (result.index >= 0) result.index = order_[result.index];
  factorized_ = result.ok();
  return result;
}

void SymmetricFactorization::require_factors() const {
  if (!factorized_) throw std::logic_error("SymmetricFactorization: no valid factors to solve with");
}

void SymmetricFactorization::solve(std::span<double> x, Counters& counters) {
  require_factors();
  if (size() == 0) return;
  assert(x.size() % order_.size() == 0);
  counters.solves += static_cast<std::int64_t>(x.size() / order_.size());
  kernel_.solve(x);
}

std::int64_t SymmetricFactorization::factor_entries() const {
  if (size() == 0) return 0;
  const std::span<const int> counts = kernel_.column_counts();
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

FactorColumns SymmetricFactorization::factor_columns() const {
  require_factors();
  return size() == 0 ? FactorColumns{} : kernel_.columns();
}

double SymmetricFactorization::pivot(int row) const {
  require_factors();
  return kernel_.pivots()[place_[row]];
}

const std::vector<double>& SymmetricFactorization::pivot_references() const {
  require_factors();
  if (references_are_current_ || size() == 0) return pivot_references_;
  const std::span<const double> pivots = kernel_.pivots();
  pivot_references_.assign(static_cast<std::size_t>(size()), std::abs(shift_));
  bool signs_differ = false;
  for (int k = 0; k < size(); ++k) {
    // Columns of the upper triangle end with their diagonal entry, if there is one.
    const int last = upper_.column_start[k + 1] - 1;
    if (last >= upper_.column_start[k] && upper_.row_index[last] == k)
      pivot_references_[k] = std::abs(upper_values_[last] + shift_);
    signs_differ |= std::signbit(pivots[k]) != std::signbit(pivots[0]);
  }
  // With all pivots of one sign, sum_j l_kj^2 |d_j| + |d_k| is |a_kk + shift| itself.
  const FactorColumns columns = kernel_.columns();
  for (int j = 0; signs_differ && j < size(); ++j) {
    const double magnitude = std::abs(pivots[j]);
    for (int p = columns.start[j] + 1; p < columns.start[j] + columns.length[j]; ++p)
      pivot_references_[columns.row[p]] += columns.value[p] * columns.value[p] * magnitude;
  }
  references_are_current_ = true;
  return pivot_references_;
}

Inertia SymmetricFactorization::inertia(double zero_ratio) const {
  require_factors();
  Inertia result;
  if (size() == 0) return result;
  const std::span<const double> pivots = kernel_.pivots();
  const std::vector<double>* references = zero_ratio > 0 ? &pivot_references() : nullptr;
  for (int k = 0; k < size(); ++k) {
    const double d = pivots[k];
    if (references != nullptr && std::abs(d) <= zero_ratio * (*references)[k])
      ++result.zero;
    else
      ++(d > 0 ? result.positive : result.negative);
  }
  return result;
}

double SymmetricFactorization::pivot_ratio(int row) const {
  const double reference = pivot_references()[place_[row]];
  return std::abs(kernel_.pivots()[place_[row]]) / reference;
}

PivotRatio SymmetricFactorization::smallest_pivot_ratio() const {
  PivotRatio smallest;
  const std::vector<double>& references = pivot_references();
  if (size() == 0) return smallest;
  const std::span<const double> pivots = kernel_.pivots();
  for (int k = 0; k < size(); ++k) {
    const double ratio = std::abs(pivots[k]) / references[k];
    if (smallest.row < 0 || ratio < smallest.ratio) smallest = {ratio, order_[k]};
  }
  return smallest;
}

double SymmetricFactorization::rcond() const {
  if (!factorized_) return 0;
  return size() == 0 ? 1 : kernel_.rcond();
}

}  // namespace catena
