#include "catena/linalg/kernels/klu_kernel.hpp"

#include <suitesparse/klu.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "catena/linalg/kernels/elimination_list.hpp"

namespace catena {
namespace {

// A full factorization bounds the entries of L by 1 / pivot tolerance = 1e3. Kept pivots may exceed that tenfold before
// new ones are worth their price (about that of ten refactorizations): the backward error stays near 1e4 * 2e-16.
constexpr double largest_multiplier = 1e4;

// Entries of the scaled matrix are about one, so multipliers above the limit need a pivot below this one, unless
// elimination has let entries grow tenfold before; that would show as an earlier small pivot.
constexpr double harmless_pivot = 1e-3;

// Rows whose entries have grown so much since they were scaled show as pivots above the largest there was.
constexpr double outgrown = 1e3;

/// KLU takes pointers to data that it does not change as non-const.
int* mutable_data(std::span<const int> data) { return const_cast<int*>(data.data()); }

/// Every right-hand side entry by entry; by nothing where `factor` is empty.
void multiply(std::span<double> x, std::span<const double> factor) {
  for (std::size_t start = 0; !factor.empty() && start < x.size(); start += factor.size()) {
    for (std::size_t k = 0; k < factor.size(); ++k) x[start + k] *= factor[k];
  }
}

FactorResult result_of(const klu_common& common) {
  if (common.status == KLU_OUT_OF_MEMORY || common.status == KLU_TOO_LARGE) return {FactorStatus::out_of_memory, -1};
  if (common.status == KLU_SINGULAR) return {FactorStatus::singular, common.singular_col};
  return {FactorStatus::ok, -1};
}

/// The largest magnitude of a column of L below its unit diagonal. KLU keeps the columns of a block in one array of
/// doubles: `length` row indices, padded to whole doubles, then as many values.
double largest_of(const double* block_factors, int start, int length) {
  const std::size_t index_space =
      (static_cast<std::size_t>(length) * sizeof(int) + sizeof(double) - 1) / sizeof(double);
  const double* multiplier = block_factors + start + index_space;
  double largest = 0;
  for (int k = 0; k < length; ++k) largest = std::abs(multiplier[k]) <= largest ? largest : std::abs(multiplier[k]);
  return largest;
}

/// Orders rows and columns of every diagonal block by AMD, as klu_analyze does, which klu_analyze_given leaves out.
bool order_within_blocks(const SparsePattern& pattern, klu_symbolic& symbolic) {
  std::vector<int> place_of_row(static_cast<std::size_t>(symbolic.n));
  for (int k = 0; k < symbolic.n; ++k) place_of_row[symbolic.P[k]] = k;
  std::vector<int> start, index, order, rows, columns;
  for (int block = 0; block < symbolic.nblocks; ++block) {
    const int first = symbolic.R[block], end = symbolic.R[block + 1], size = end - first;
    symbolic.Lnz[block] = 0.5 * size * (size + 1.0);
    if (size <= 3) continue;
    start.assign(1, 0);
    index.clear();
    for (int k = first; k < end; ++k) {
      const int column = symbolic.Q[k];
      for (int p = pattern.column_start[column]; p < pattern.column_start[column + 1]; ++p)
        if (place_of_row[pattern.row_index[p]] >= first) index.push_back(place_of_row[pattern.row_index[p]] - first);
      start.push_back(static_cast<int>(index.size()));
    }
    order.resize(static_cast<std::size_t>(size));
    double info[AMD_INFO];
    if (amd_order(size, start.data(), index.data(), order.data(), nullptr, info) < AMD_OK) return false;
    symbolic.Lnz[block] = info[AMD_LNZ] + size;
    rows.assign(symbolic.P + first, symbolic.P + end);
    columns.assign(symbolic.Q + first, symbolic.Q + end);
    for (int k = 0; k < size; ++k) {
      symbolic.P[first + k] = rows[order[k]];
      symbolic.Q[first + k] = columns[order[k]];
    }
  }
  return true;
}

}  // namespace

struct KluKernel::Handles {
  klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  std::vector<int> block_of_place;
  std::vector<double> row_scale, column_unit;  // 1 / R; D, empty: ones
  std::vector<double> entry_scale, scaled;     // per entry of the matrix
  std::optional<EliminationList> list;         // factors in place of KLU's, where all blocks are small
  double least = 0, largest = 0;               // magnitudes of pivots, not finite if one is not
  double largest_at_first = 0;                 // where the pivots were chosen

  Handles() {
    klu_defaults(&common);
    common.scale = -1;  // not by KLU
  }
  ~Handles() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;

  std::size_t size() const { return static_cast<std::size_t>(symbolic->n); }
  const double* pivots() const { return list ? list->pivots().data() : static_cast<const double*>(numeric->Udiag); }
  void choose_scale(const SparsePattern& pattern, std::span<const double> values);
  double* scale(std::span<const double> values);
  std::int64_t measure_pivots();
  std::int64_t measure_few_pivots();
  bool pivots_suit();
  bool column_suits(int place) const;
};

/// Rows of length one by their largest magnitude, in the columns' units.
void KluKernel::Handles::choose_scale(const SparsePattern& pattern, std::span<const double> values) {
  const auto unit = [&](int column) { return column_unit.empty() ? 1.0 : column_unit[column]; };
  row_scale.assign(size(), 0.0);
  for (int c = 0; c < pattern.columns; ++c) {
    for (int k = pattern.column_start[c]; k < pattern.column_start[c + 1]; ++k) {
      double& most = row_scale[pattern.row_index[k]];
      most = std::max(most, std::abs(values[k]) * unit(c));
    }
  }
  for (double& value : row_scale) value = value > 0 && std::isfinite(1 / value) ? 1 / value : 1;
  entry_scale.resize(values.size());
  scaled.resize(values.size());
  for (int c = 0; c < pattern.columns; ++c) {
    for (int k = pattern.column_start[c]; k < pattern.column_start[c + 1]; ++k)
      entry_scale[k] = row_scale[pattern.row_index[k]] * unit(c);
  }
}

double* KluKernel::Handles::scale(std::span<const double> values) {
  for (std::size_t k = 0; k < values.size(); ++k) scaled[k] = values[k] * entry_scale[k];
  return scaled.data();
}

/// The same of a few.
std::int64_t KluKernel::Handles::measure_few_pivots() {
  double low = std::numeric_limits<double>::infinity(), high = 0, total = 0;
  std::int64_t suspects = 0;
  const double* const pivot = pivots();
  for (std::size_t k = 0; k < size(); ++k) {
    const double magnitude = std::abs(pivot[k]);
    low = magnitude < low ? magnitude : low;
    high = magnitude > high ? magnitude : high;
    total += magnitude;
    suspects += magnitude >= harmless_pivot ? 0 : 1;
  }
  least = low;
  largest = high;
  if (!std::isfinite(total)) least = largest = std::numeric_limits<double>::quiet_NaN();
  return suspects;
}

/// Their least and largest magnitude; returns how many are not harmless. In lanes, since compilers may not change the
/// order of comparisons.
std::int64_t KluKernel::Handles::measure_pivots() {
  constexpr std::size_t lanes = 8;
  // Of a few pivots setting up the lanes costs more than all else.
  if (size() < 4 * lanes) return measure_few_pivots();
  double low[lanes], high[lanes] = {}, sum[lanes] = {}, few[lanes] = {};
  std::fill(low, low + lanes, std::numeric_limits<double>::infinity());
  const double* pivot = pivots();
  const auto take = [&](std::size_t k, std::size_t lane) {
    const double magnitude = std::abs(pivot[k]);
    low[lane] = magnitude < low[lane] ? magnitude : low[lane];
    high[lane] = magnitude > high[lane] ? magnitude : high[lane];
    sum[lane] += magnitude;
    few[lane] += magnitude >= harmless_pivot ? 0.0 : 1.0;
  };
  std::size_t k = 0;
  for (; k + lanes <= size(); k += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) take(k + lane, lane);
  }
  for (; k < size(); ++k) take(k, 0);
  double total = 0, suspects = 0;
  for (std::size_t lane = 0; lane < lanes; ++lane) total += sum[lane], suspects += few[lane];
  least = *std::min_element(low, low + lanes);
  largest = *std::max_element(high, high + lanes);
  if (!std::isfinite(total)) least = largest = std::numeric_limits<double>::quiet_NaN();
  return static_cast<std::int64_t>(suspects);
}

bool KluKernel::Handles::pivots_suit() {
  std::int64_t suspects = measure_pivots();
  if (!(largest <= outgrown * largest_at_first)) return false;
  for (int k = 0; suspects > 0 && k < symbolic->n; ++k) {
    if (std::abs(pivots()[k]) >= harmless_pivot) continue;
    --suspects;
    if (!column_suits(k)) return false;
  }
  return true;
}

/// Whether a column with a small pivot kept its multipliers within the limit.
bool KluKernel::Handles::column_suits(int place) const {
  if (!(std::abs(pivots()[place]) > 0)) return false;
  const int block = block_of_place[place];
  if (symbolic->R[block + 1] - symbolic->R[block] == 1) return true;  // no L below a single pivot
  if (list) return list->largest_multiplier(place) <= largest_multiplier;
  const auto* factors = static_cast<const double*>(numeric->LUbx[block]);
  return largest_of(factors, numeric->Lip[place], numeric->Llen[place]) <= largest_multiplier;
}

KluKernel::KluKernel() : handles_(std::make_unique<Handles>()) {}
KluKernel::~KluKernel() = default;
KluKernel::KluKernel(KluKernel&&) noexcept = default;
KluKernel& KluKernel::operator=(KluKernel&&) noexcept = default;

FactorResult KluKernel::analyze(const SparsePattern& pattern, std::span<const int> row_of_column) {
  handles_ = std::make_unique<Handles>();
  Handles& h = *handles_;
  h.symbolic = klu_analyze_given(pattern.columns, mutable_data(pattern.column_start), mutable_data(pattern.row_index),
                                 mutable_data(row_of_column), nullptr, &h.common);
  if (h.symbolic == nullptr || !order_within_blocks(pattern, *h.symbolic)) return {FactorStatus::out_of_memory, -1};
  h.block_of_place.resize(h.size());
  for (int block = 0; block < h.symbolic->nblocks; ++block)
    std::fill(h.block_of_place.begin() + h.symbolic->R[block], h.block_of_place.begin() + h.symbolic->R[block + 1],
              block);
  return {};
}

FactorResult KluKernel::factor(const SparsePattern& pattern, std::span<const double> values, double pivot_tolerance) {
  Handles& h = *handles_;
  klu_free_numeric(&h.numeric, &h.common);
  h.list.reset();
  h.common.tol = pivot_tolerance;
  h.choose_scale(pattern, values);
  h.numeric = klu_factor(mutable_data(pattern.column_start), mutable_data(pattern.row_index), h.scale(values),
                         h.symbolic, &h.common);
  if (h.numeric == nullptr) return result_of(h.common);
  for (std::size_t k = 0; k < h.size(); ++k) {
    if (!std::isfinite(h.pivots()[k])) {
      klu_free_numeric(&h.numeric, &h.common);
      return {FactorStatus::not_finite, h.symbolic->Q[k]};
    }
  }
  if (EliminationList::serves(block_starts())) {
    h.list.emplace(pattern, EliminationList::Order{pivot_rows(), column_order(), block_starts()}, h.entry_scale);
    h.list->factor(values);
  }
  h.measure_pivots();
  h.largest_at_first = std::max(h.largest, 1.0);
  return {};
}

bool KluKernel::refactor(const SparsePattern& pattern, std::span<const double> values) {
  Handles& h = *handles_;
  if (h.list) {
    h.list->factor(values);
    return h.pivots_suit();
  }
  return klu_refactor(mutable_data(pattern.column_start), mutable_data(pattern.row_index), h.scale(values), h.symbolic,
                      h.numeric, &h.common) &&
         h.pivots_suit();
}

void KluKernel::set_column_units(std::span<const double> units) {
  handles_->column_unit.assign(units.begin(), units.end());
}

bool KluKernel::has_factors() const { return handles_->numeric != nullptr; }

void KluKernel::solve(std::span<double> x) {
  Handles& h = *handles_;
  if (h.list) {
    for (std::size_t k = 0; k < x.size(); k += h.size())
      h.list->solve(x.subspan(k, h.size()), h.row_scale, h.column_unit);
    return;
  }
  multiply(x, h.row_scale);
  klu_solve(h.symbolic, h.numeric, h.symbolic->n, static_cast<int>(x.size() / h.size()), x.data(), &h.common);
  multiply(x, h.column_unit);
}

bool KluKernel::solves_in_lanes() const { return handles_->list.has_value(); }

void KluKernel::solve(std::span<Lanes> x) { handles_->list->solve(x, handles_->row_scale, handles_->column_unit); }

void KluKernel::solve_transposed(std::span<double> x) {
  Handles& h = *handles_;
  if (h.list) {
    for (std::size_t k = 0; k < x.size(); k += h.size())
      h.list->solve_transposed(x.subspan(k, h.size()), h.row_scale, h.column_unit);
    return;
  }
  multiply(x, h.column_unit);
  klu_tsolve(h.symbolic, h.numeric, h.symbolic->n, static_cast<int>(x.size() / h.size()), x.data(), &h.common);
  multiply(x, h.row_scale);
}

double KluKernel::rcond() const {
  const Handles& h = *handles_;
  return h.least > 0 ? h.least / h.largest : 0;
}

std::span<const int> KluKernel::block_starts() const {
  return {handles_->symbolic->R, static_cast<std::size_t>(handles_->symbolic->nblocks) + 1};
}

std::span<const int> KluKernel::column_order() const { return {handles_->symbolic->Q, handles_->size()}; }

std::span<const int> KluKernel::row_order() const { return {handles_->symbolic->P, handles_->size()}; }

std::span<const double> KluKernel::row_scale() const { return handles_->row_scale; }

std::span<const int> KluKernel::pivot_rows() const { return {handles_->numeric->Pnum, handles_->size()}; }

std::span<const double> KluKernel::pivots() const { return {handles_->pivots(), handles_->size()}; }

}  // namespace catena
