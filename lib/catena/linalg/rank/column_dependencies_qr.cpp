#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "catena/linalg/kernels/build_options.hpp"
#include "catena/linalg/rank/column_dependencies.hpp"

#if CATENA_HAS_SPQR

#include <suitesparse/SuiteSparseQR_C.h>

#include "catena/linalg/kernels/blas_threads.hpp"
#include "catena/linalg/patterns/column_order.hpp"
#include "catena/linalg/rank/upper_trapezoid.hpp"

namespace catena {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));

/// One SPQR factorization A(:, order) = Q R, R alone kept.
class QrFactors {
 public:
  QrFactors() {
    cholmod_l_start(&common_);
    common_.print = 0;
  }
  ~QrFactors() {
    if (permutation_ != nullptr)
      cholmod_l_free(column_start_.size() - 1, sizeof(SuiteSparse_long), permutation_, &common_);
    cholmod_l_free_sparse(&r_, &common_);
    cholmod_l_finish(&common_);
  }
  QrFactors(const QrFactors&) = delete;
  QrFactors& operator=(const QrFactors&) = delete;

  /// Factors the columns in the given order; SPQR may still move columns, and `order` with them. False: out of memory.
  bool factor(const SparsePattern& pattern, std::span<const double> values, double tolerance, std::vector<int>& order) {
    gather(pattern, values, order);
    cholmod_sparse view{};
    view.nrow = static_cast<std::size_t>(pattern.rows);
    view.ncol = static_cast<std::size_t>(pattern.columns);
    view.nzmax = row_index_.size();
    view.p = column_start_.data();
    view.i = row_index_.data();
    view.x = values_.data();
    view.itype = CHOLMOD_LONG;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    const SuiteSparse_long rank =
        SuiteSparseQR_C(SPQR_ORDERING_FIXED, tolerance, 0, 0, &view, nullptr, nullptr, nullptr, nullptr, &r_,
                        &permutation_, nullptr, nullptr, nullptr, &common_);
    if (rank < 0 || common_.status < CHOLMOD_OK || r_ == nullptr) return false;
    if (permutation_ != nullptr) {  // dead columns have been moved to the end
      const std::vector<int> given = order;
      for (std::size_t k = 0; k < order.size(); ++k) order[k] = given[permutation_[k]];
    }
    return true;
  }

  UpperTrapezoid trapezoid() const {
    const auto* start = static_cast<const std::int64_t*>(r_->p);
    const auto entries = static_cast<std::size_t>(start[r_->ncol]);
    return {{start, r_->ncol + 1},
            {static_cast<const std::int64_t*>(r_->i), entries},
            {static_cast<const double*>(r_->x), entries}};
  }

 private:
  void gather(const SparsePattern& pattern, std::span<const double> values, const std::vector<int>& order) {
    column_start_.assign(1, 0);
    row_index_.clear();
    values_.clear();
    for (int column : order) {
      for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k) {
        row_index_.push_back(pattern.row_index[k]);
        values_.push_back(values[k]);
      }
      column_start_.push_back(static_cast<std::int64_t>(row_index_.size()));
    }
  }

  cholmod_common common_{};
  cholmod_sparse* r_ = nullptr;
  SuiteSparse_long* permutation_ = nullptr;
  std::vector<std::int64_t> column_start_;
  std::vector<std::int64_t> row_index_;
  std::vector<double> values_;
};

}  // namespace

ColumnDependencies dependencies_by_qr(const SparsePattern& pattern, std::span<const double> values, double tolerance,
                                      int most_null_vectors) {
  use_single_threaded_blas();
  ColumnDependencies result;
  std::vector<int> order = order_columns_by_need(pattern);
  QrFactors factors;
  if (!factors.factor(pattern, values, tolerance, order)) {
    result.status = FactorStatus::out_of_memory;
    return result;
  }
  UpperTrapezoid r = factors.trapezoid();
  for (int i = 0; i < r.rank(); ++i) {
    result.independent.push_back(order[r.live()[i]]);
    const double kept = std::abs(r.diagonal()[i]);
    if (i == 0 || kept < result.smallest_kept) {
      result.smallest_kept = kept;
      result.weakest = result.independent.back();
    }
  }
  for (int place : r.dead()) result.dependent.push_back(order[place]);
  if (static_cast<int>(r.dead().size()) <= most_null_vectors)
    r.append_null_vectors(order, tolerance, result.null_vectors);
  return result;
}

}  // namespace catena

#else

namespace catena {

ColumnDependencies dependencies_by_qr(const SparsePattern&, std::span<const double>, double, int) {
  ColumnDependencies result;
  result.status = FactorStatus::unavailable;
  return result;
}

}  // namespace catena

#endif
