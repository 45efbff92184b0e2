#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "catena/linalg/factorization/symmetric_factorization.hpp"
#include "catena/linalg/patterns/column_order.hpp"
#include "catena/linalg/rank/column_dependencies.hpp"
#include "catena/linalg/rank/upper_trapezoid.hpp"

namespace catena {
namespace {

// Exactly dependent columns leave pivots of about (rounding + shift) * (1 + |c|^2), c the coefficients of their
// combination: below the square of gram_tolerance for |c| up to 300. Without a shift a pivot might be exactly zero.
constexpr double shift = 1e-15;
// The square root of rounding, with some room: what cancellation leaves below it is taken as nothing.
constexpr double negligible_coefficient = 1e-7;

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

/// Tells dependent from independent columns by their pivots. A pivot that is nothing but rounding error makes the ones
/// after it unreliable; the columns found dependent are therefore removed, and the rest is judged again.
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

/// R of A = Q R from A^T A = L D L^T: D^(1/2) L^T, its columns the rows of L. Rows of dependent columns, whose pivots
/// were replaced, are left out.
struct TrapezoidArrays {
  std::vector<std::int64_t> column_start;
  std::vector<std::int64_t> row_index;
  std::vector<double> values;
};

TrapezoidArrays trapezoid_of(const SymmetricFactorization& factors, const std::vector<int>& dependent) {
  const auto n = static_cast<std::size_t>(factors.size());
  std::vector<bool> is_dependent(n, false);
  for (int column : dependent) is_dependent[column] = true;
  const FactorColumns l = factors.factor_columns();
  TrapezoidArrays r;
  r.column_start.assign(n + 1, 0);
  for (int pass = 0; pass < 2; ++pass) {  // count, then fill
    std::int64_t row = 0;
    std::vector<std::int64_t> next(r.column_start.begin(), r.column_start.end() - 1);
    for (std::size_t j = 0; j < n; ++j) {
      if (is_dependent[factors.order()[j]]) continue;
      const double root = std::sqrt(l.value[l.start[j]]);
      for (int p = l.start[j]; p < l.start[j] + l.length[j]; ++p) {
        if (pass == 0) {
          ++r.column_start[static_cast<std::size_t>(l.row[p]) + 1];
        } else {
          const auto place = static_cast<std::size_t>(next[l.row[p]]++);
          r.row_index[place] = row;
          r.values[place] = p == l.start[j] ? root : root * l.value[p];
        }
      }
      ++row;
    }
    if (pass == 1) break;
    for (std::size_t k = 0; k < n; ++k) r.column_start[k + 1] += r.column_start[k];
    r.row_index.resize(static_cast<std::size_t>(r.column_start[n]));
    r.values.resize(r.row_index.size());
  }
  return r;
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

  const TrapezoidArrays arrays = trapezoid_of(factors, result.dependent);
  UpperTrapezoid r(arrays.column_start, arrays.row_index, arrays.values);
  r.append_null_vectors(factors.order(), negligible_coefficient, result.null_vectors);
  return result;
}

}  // namespace catena
