#include "catena/linalg/rank/rank_revealing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>

#include "catena/linalg/patterns/matching.hpp"

namespace catena {
namespace {

// A row kept by less than this many tolerances leaves the rank in doubt.
constexpr double margin = 10;

/// diag(row) A diag(column), every row of length one, every column near it.
struct ScaledMatrix {
  std::vector<double> values;
  std::vector<double> row;
  std::vector<double> column;
};

std::vector<double> row_lengths(const SparsePattern& pattern, std::span<const double> values) {
  // Largest magnitudes first, so that squares neither overflow nor vanish.
  std::vector<double> largest(static_cast<std::size_t>(pattern.rows), 0.0), sum(largest);
  for (std::size_t k = 0; k < values.size(); ++k)
    largest[pattern.row_index[k]] = std::max(largest[pattern.row_index[k]], std::abs(values[k]));
  for (std::size_t k = 0; k < values.size(); ++k) {
    const int row = pattern.row_index[k];
    if (largest[row] > 0) sum[row] += (values[k] / largest[row]) * (values[k] / largest[row]);
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = largest[i] * std::sqrt(sum[i]);
  return sum;
}

void scale_rows_to_one(const SparsePattern& pattern, ScaledMatrix& scaled) {
  std::vector<double> factor = row_lengths(pattern, scaled.values);
  for (double& value : factor) value = value > 0 ? 1 / value : 1;
  for (std::size_t k = 0; k < scaled.values.size(); ++k) scaled.values[k] *= factor[pattern.row_index[k]];
  for (std::size_t i = 0; i < factor.size(); ++i) scaled.row[i] *= factor[i];
}

ScaledMatrix scale(const SparsePattern& pattern, std::span<const double> values) {
  // Columns below this fraction of the longest are not enlarged further: they may hold nothing but rounding errors.
  constexpr double shortest_column = 1e-5;
  ScaledMatrix scaled{{values.begin(), values.end()},
                      std::vector<double>(static_cast<std::size_t>(pattern.rows), 1.0),
                      std::vector<double>(static_cast<std::size_t>(pattern.columns), 1.0)};
  scale_rows_to_one(pattern, scaled);
  std::vector<double> length(scaled.column.size());
  for (int j = 0; j < pattern.columns; ++j) {
    const auto begin = scaled.values.begin() + pattern.column_start[j];
    const auto end = scaled.values.begin() + pattern.column_start[j + 1];
    length[j] = std::sqrt(std::inner_product(begin, end, begin, 0.0));
  }
  const double longest = length.empty() ? 0 : *std::max_element(length.begin(), length.end());
  for (int j = 0; j < pattern.columns && longest > 0; ++j) {
    scaled.column[j] = 1 / std::max(length[j], shortest_column * longest);
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) scaled.values[k] *= scaled.column[j];
  }
  scale_rows_to_one(pattern, scaled);
  return scaled;
}

/// Evaluates combinations of columns. Holds the sums of one combination at a time, zero between calls.
class CombinationCheck {
 public:
  CombinationCheck(const SparsePattern& pattern, std::span<const double> values)
      : pattern_(pattern), values_(values), sum_(static_cast<std::size_t>(pattern.rows), 0.0) {}

  /// Largest component of the sum of coefficient * column relative to its largest term, 0 for a sum without terms.
  double residual(std::span<const int> columns, std::span<const double> coefficients) {
    double largest_term = 0, largest_sum = 0;
    for (std::size_t e = 0; e < columns.size(); ++e) {
      for (int k = pattern_.column_start[columns[e]]; k < pattern_.column_start[columns[e] + 1]; ++k) {
        const double term = coefficients[e] * values_[k];
        sum_[pattern_.row_index[k]] += term;
        largest_term = std::max(largest_term, std::abs(term));
      }
    }
    for (int column : columns) {
      for (int k = pattern_.column_start[column]; k < pattern_.column_start[column + 1]; ++k) {
        largest_sum = std::max(largest_sum, std::abs(sum_[pattern_.row_index[k]]));
        sum_[pattern_.row_index[k]] = 0;
      }
    }
    return largest_term > 0 ? largest_sum / largest_term : 0;
  }

 private:
  const SparsePattern& pattern_;
  std::span<const double> values_;
  std::vector<double> sum_;
};

/// Null vectors of the matrix before scaling, in ascending order of their dependent columns (first indices).
SparseVectors unscaled(const SparseVectors& vectors, const std::vector<double>& scale) {
  std::vector<int> order(static_cast<std::size_t>(vectors.count()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return vectors.indices(a).front() < vectors.indices(b).front(); });
  SparseVectors result;
  for (int v : order) {
    const double unit = scale[vectors.indices(v).front()];
    for (std::size_t e = 0; e < vectors.values(v).size(); ++e) {
      result.index.push_back(vectors.indices(v)[e]);
      result.value.push_back(vectors.values(v)[e] * scale[vectors.indices(v)[e]] / unit);
    }
    result.start.push_back(static_cast<int>(result.index.size()));
  }
  return result;
}

/// The whole answer for a matrix of zeros, which the factorizations need not see.
ColumnDependencies all_dependent(int columns, int most_null_vectors) {
  ColumnDependencies result;
  result.dependent.resize(static_cast<std::size_t>(columns));
  std::iota(result.dependent.begin(), result.dependent.end(), 0);
  for (int j = 0; columns <= most_null_vectors && j < columns; ++j) {
    result.null_vectors.index.push_back(j);
    result.null_vectors.value.push_back(1);
    result.null_vectors.start.push_back(j + 1);
  }
  return result;
}

std::string warning_for(const RankReport& report, int column_rank, int structural_rank, double tolerance) {
  if (column_rank != report.rank)
    return "the rank is not definite: " + std::to_string(report.rank) + " by rows, " + std::to_string(column_rank) +
           " by columns";
  if (report.rank > structural_rank) return "the rank found exceeds what the pattern allows";
  if (report.smallest_kept <= margin * tolerance || report.worst_residual > tolerance)
    return "the rank is not definite: row " + std::to_string(report.weakest_row) + " is nearly dependent on others";
  if (report.approximate) return "rank from pivots of A A^T: without SPQR, angles below 1e-5 count as dependent";
  return {};
}

/// Where all rows are independent the columns that a matching leaves over are free: a part of the matrix that
/// determines its columns has as many rows, which match them.
ColumnDependencies dependencies_by_matching(const Matching& matching, int columns) {
  ColumnDependencies result;
  result.dependent = matching.unmatched_columns;
  for (int c = 0; c < columns; ++c) {
    if (matching.row_of_column[static_cast<std::size_t>(c)] >= 0) result.independent.push_back(c);
  }
  return result;
}

/// Whether the kernel is there and the values are finite.
FactorStatus can_be_analysed(std::span<const double> values, const RankOptions& options, bool by_qr) {
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    return FactorStatus::not_finite;
  const bool known = by_qr || options.kernel == Kernel::cholmod || options.kernel == Kernel::automatic;
  return known ? FactorStatus::ok : FactorStatus::unavailable;
}

}  // namespace

RankReport reveal_rank(const SparsePattern& pattern, std::span<const double> values, const RankOptions& options) {
  if (values.size() != pattern.row_index.size())
    throw std::invalid_argument("reveal_rank: as many values as the pattern has entries are needed");
  RankReport report;
  const bool by_qr =
      options.kernel == Kernel::spqr || (options.kernel == Kernel::automatic && is_compiled_in(Kernel::spqr));
  report.status = can_be_analysed(values, options, by_qr);
  if (!report.ok()) return report;

  const ScaledMatrix scaled = scale(pattern, values);
  const SlottedPattern turned = transpose(pattern);
  std::vector<double> turned_values(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) turned_values[turned.slot[k]] = scaled.values[k];

  const double tolerance = by_qr ? options.tolerance : std::max(options.tolerance, gram_tolerance);
  const auto analyse = [&](const SparsePattern& matrix, std::span<const double> entries, int most) {
    ColumnDependencies found = entries.empty() ? all_dependent(matrix.columns, most)
                               : by_qr         ? dependencies_by_qr(matrix, entries, tolerance, most)
                                               : dependencies_by_gram_matrix(matrix, entries, most);
    CombinationCheck check(matrix, entries);
    for (int v = 0; v < found.null_vectors.count(); ++v)
      report.worst_residual =
          std::max(report.worst_residual, check.residual(found.null_vectors.indices(v), found.null_vectors.values(v)));
    std::sort(found.independent.begin(), found.independent.end());
    std::sort(found.dependent.begin(), found.dependent.end());
    if (found.status != FactorStatus::ok) report.status = found.status;
    return found;
  };
  ColumnDependencies by_rows = analyse(turned.pattern, turned_values, options.most_dependencies);
  const Matching matching = maximum_matching(pattern);
  const int nullity = pattern.columns - static_cast<int>(by_rows.independent.size());
  // More free columns than null vectors are wanted need no null vectors.
  const bool matched = by_qr && report.ok() && by_rows.dependent.empty() && nullity > options.most_null_vectors &&
                       static_cast<int>(matching.unmatched_columns.size()) == nullity;
  ColumnDependencies by_columns = matched ? dependencies_by_matching(matching, pattern.columns)
                                          : analyse(pattern, scaled.values, options.most_null_vectors);
  if (!report.ok()) return report;

  report.rank = static_cast<int>(by_rows.independent.size());
  report.approximate = !by_qr;
  report.smallest_kept = by_rows.smallest_kept;
  report.weakest_row = by_rows.weakest;
  report.independent_rows = std::move(by_rows.independent);
  report.dependent_rows = std::move(by_rows.dependent);
  report.left_null_vectors = unscaled(by_rows.null_vectors, scaled.row);
  report.free_columns = std::move(by_columns.dependent);
  report.right_null_vectors = unscaled(by_columns.null_vectors, scaled.column);
  const int column_rank = static_cast<int>(by_columns.independent.size());
  const int structural_rank = matching.structural_rank;
  report.verified = column_rank == report.rank && report.rank <= structural_rank &&
                    report.smallest_kept > margin * tolerance && report.worst_residual <= tolerance;
  report.warning = warning_for(report, column_rank, structural_rank, tolerance);
  return report;
}

}  // namespace catena
