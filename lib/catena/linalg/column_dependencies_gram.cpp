#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "catena/linalg/column_dependencies.hpp"
#include "catena/linalg/column_order.hpp"
#include "catena/linalg/symmetric_factorization.hpp"

namespace catena {
namespace {

// Exactly dependent columns leave pivots of about (rounding + shift) * (1 + |c|^2), c the coefficients of their
// combination: below the square of gram_tolerance for |c| up to 300. Without a shift a pivot might be exactly zero.
constexpr double shift = 1e-15;
constexpr double negligible_coefficient = 1e-9;
constexpr std::int64_t most_products = 400'000'000;

struct GramMatrix {
  SparsePattern lower;
  std::vector<double> values;
};

/// Lower triangle of A^T A from the products within every row of A. Nothing when a row is so long that the result would
/// not fit.
bool form_gram_matrix(const SparsePattern& pattern, std::span<const double> values, GramMatrix& gram) {
  const SlottedPattern turned = transpose(pattern);
  const SparsePattern& rows = turned.pattern;
  std::vector<double> row_values(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) row_values[turned.slot[k]] = values[k];
  std::int64_t products = pattern.columns;
  for (int i = 0; i < rows.columns; ++i) {
    const std::int64_t length = rows.column_start[i + 1] - rows.column_start[i];
    products += length * (length + 1) / 2;
  }
  if (products > most_products) return false;
  std::vector<MatrixEntry> entries;
  std::vector<double> summands;
  entries.reserve(static_cast<std::size_t>(products));
  summands.reserve(static_cast<std::size_t>(products));
  for (int j = 0; j < pattern.columns; ++j) {  // a full diagonal, also for empty columns
    entries.push_back({j, j});
    summands.push_back(0);
  }
  for (int i = 0; i < rows.columns; ++i) {
    for (int p = rows.column_start[i]; p < rows.column_start[i + 1]; ++p) {
      for (int q = rows.column_start[i]; q <= p; ++q) {
        entries.push_back({rows.row_index[p], rows.row_index[q]});
        summands.push_back(row_values[p] * row_values[q]);
      }
    }
  }
  SlottedPattern built = build_pattern(pattern.columns, pattern.columns, entries);
  gram.lower = std::move(built.pattern);
  gram.values.assign(gram.lower.row_index.size(), 0.0);
  for (std::size_t k = 0; k < entries.size(); ++k) gram.values[built.slot[k]] += summands[k];
  return true;
}

/// The rows and columns of a Gram matrix that belong to the columns kept.
GramMatrix restricted(const GramMatrix& gram, const std::vector<int>& kept) {
  std::vector<int> place(static_cast<std::size_t>(gram.lower.columns), -1);
  for (std::size_t k = 0; k < kept.size(); ++k) place[kept[k]] = static_cast<int>(k);
  GramMatrix part;
  part.lower.rows = part.lower.columns = static_cast<int>(kept.size());
  for (int column : kept) {
    for (int k = gram.lower.column_start[column]; k < gram.lower.column_start[column + 1]; ++k) {
      if (place[gram.lower.row_index[k]] < 0) continue;
      part.lower.row_index.push_back(place[gram.lower.row_index[k]]);
      part.values.push_back(gram.values[k]);
    }
    part.lower.column_start.push_back(static_cast<int>(part.lower.row_index.size()));
  }
  return part;
}

/// Tells dependent from independent columns by their pivots. A pivot that is nothing but rounding error makes the ones
/// after it unreliable; so what was found dependent is taken out of play, and the rest is judged again.
FactorResult classify(const SparsePattern& pattern, const GramMatrix& gram, SymmetricFactorization& factors,
                      Counters& counters, ColumnDependencies& result) {
  constexpr int most_rounds = 20;
  const std::vector<int> order = order_columns_by_need(pattern);
  FactorResult outcome =
      factors.analyze(gram.lower, {.ordering = SymmetricOrdering::given, .permutation = order}, counters);
  std::vector<double> values = gram.values;
  std::vector<bool> dependent(order.size(), false);
  bool settled = false;
  for (int round = 0; outcome.ok() && !settled && round < most_rounds; ++round) {
    outcome = factors.factorize(values, shift, counters);
    settled = true;
    for (int column = 0; outcome.ok() && column < pattern.columns; ++column) {
      if (dependent[column] || factors.pivot(column) > gram_tolerance * gram_tolerance) continue;
      dependent[column] = true;
      settled = false;
      values[gram.lower.column_start[column]] += 1;  // the diagonal comes first: a pivot of one couples to nothing
    }
  }
  for (int column = 0; outcome.ok() && column < pattern.columns; ++column) {
    (dependent[column] ? result.dependent : result.independent).push_back(column);
    const double kept = std::sqrt(std::max(0.0, factors.pivot(column)));
    if (!dependent[column] && (result.weakest < 0 || kept < result.smallest_kept)) {
      result.smallest_kept = kept;
      result.weakest = column;
    }
  }
  return outcome;
}

/// Least-squares coefficients of column `dependent` in the independent ones, by the normal equations. Their squared
/// condition is mended by refinement with the residual of the columns themselves.
void append_null_vector(const SparsePattern& pattern, std::span<const double> values, int dependent,
                        SymmetricFactorization& factors, Counters& counters, ColumnDependencies& result) {
  constexpr int refinements = 2;
  std::vector<double> residual(static_cast<std::size_t>(pattern.rows), 0.0);
  const auto add_column = [&](int column, double factor) {
    for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k)
      residual[pattern.row_index[k]] += factor * values[k];
  };
  const std::vector<int>& kept = result.independent;
  std::vector<double> coefficients(kept.size(), 0.0), correction(kept.size());
  add_column(dependent, 1);
  for (int step = 0; step <= refinements && !kept.empty(); ++step) {
    for (std::size_t i = 0; i < kept.size(); ++i) {
      double sum = 0;
      for (int k = pattern.column_start[kept[i]]; k < pattern.column_start[kept[i] + 1]; ++k)
        sum += values[k] * residual[pattern.row_index[k]];
      correction[i] = sum;
    }
    factors.solve(correction, counters);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      coefficients[i] += correction[i];
      add_column(kept[i], -correction[i]);
    }
  }
  SparseVectors& vectors = result.null_vectors;
  vectors.index.push_back(dependent);
  vectors.value.push_back(1);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (std::abs(coefficients[i]) <= negligible_coefficient) continue;
    vectors.index.push_back(kept[i]);
    vectors.value.push_back(-coefficients[i]);
  }
  vectors.start.push_back(static_cast<int>(vectors.index.size()));
}

}  // namespace

ColumnDependencies dependencies_by_gram_matrix(const SparsePattern& pattern, std::span<const double> values,
                                               int most_null_vectors) {
  ColumnDependencies result;
  GramMatrix gram;
  if (!form_gram_matrix(pattern, values, gram)) {
    result.status = FactorStatus::out_of_memory;
    return result;
  }
  Counters counters;  // of this analysis alone
  SymmetricFactorization factors;
  result.status = classify(pattern, gram, factors, counters, result).status;
  if (result.status != FactorStatus::ok) return result;
  if (static_cast<int>(result.dependent.size()) > most_null_vectors) return result;

  const GramMatrix kept = restricted(gram, result.independent);
  FactorResult outcome = factors.analyze(kept.lower, {}, counters);
  if (outcome.ok()) outcome = factors.factorize(kept.values, 0, counters);
  result.status = outcome.status;
  if (!outcome.ok()) return result;
  for (int column : result.dependent) append_null_vector(pattern, values, column, factors, counters, result);
  return result;
}

}  // namespace catena
