#include "catena/linalg/kernels/cholmod_kernel.hpp"

#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace catena {
namespace {

/// CHOLMOD's view of a triangle stored elsewhere; values may be absent.
cholmod_sparse triangle_view(const SparsePattern& pattern, double* values, int stored_triangle) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(pattern.columns);
  view.nzmax = pattern.row_index.size();
  view.p = const_cast<int*>(pattern.column_start.data());
  view.i = const_cast<int*>(pattern.row_index.data());
  view.x = values;
  view.stype = stored_triangle;
  view.itype = CHOLMOD_INT;
  view.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

void check_permutation(std::span<const int> permutation, int size) {
  std::vector<bool> met(static_cast<std::size_t>(size), false);
  bool valid = permutation.size() == met.size();
  for (std::size_t k = 0; valid && k < permutation.size(); ++k) {
    const int row = permutation[k];
    valid = row >= 0 && row < size && !met[row];
    if (valid) met[row] = true;
  }
  if (!valid) throw std::invalid_argument("SymmetricFactorization: not a permutation of the rows");
}

void check_groups(std::span<const int> groups, int size) {
  const bool valid =
      groups.size() == static_cast<std::size_t>(size) &&
      std::all_of(groups.begin(), groups.end(), [size](int group) { return group >= 0 && group < size; });
  if (!valid) throw std::invalid_argument("SymmetricFactorization: a group from 0 to n - 1 is needed for every row");
}

}  // namespace

struct CholmodKernel::Handles {
  cholmod_common common{};
  cholmod_factor* symbolic_and_numeric = nullptr;
  cholmod_dense* solve_work = nullptr;
  cholmod_dense* unused_work = nullptr;
  std::vector<double> pivots;

  Handles() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.nmethods = 1;
    common.grow2 = 0;  // columns of L get exactly the space that the analysis counted
  }
  ~Handles() {
    cholmod_free_dense(&solve_work, &common);
    cholmod_free_dense(&unused_work, &common);
    cholmod_free_factor(&symbolic_and_numeric, &common);
    cholmod_finish(&common);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;

  const cholmod_factor& factor() const { return *symbolic_and_numeric; }
};

CholmodKernel::CholmodKernel() : handles_(std::make_unique<Handles>()) {}
CholmodKernel::~CholmodKernel() = default;
CholmodKernel::CholmodKernel(CholmodKernel&&) noexcept = default;
CholmodKernel& CholmodKernel::operator=(CholmodKernel&&) noexcept = default;

FactorResult CholmodKernel::analyze(const SparsePattern& lower, const SymmetricOptions& options) {
  handles_ = std::make_unique<Handles>();
  cholmod_common& common = handles_->common;
  cholmod_sparse view = triangle_view(lower, nullptr, -1);
  std::vector<int> permutation;
  switch (options.ordering) {
    case SymmetricOrdering::amd:
      common.method[0].ordering = CHOLMOD_AMD;
      break;
    case SymmetricOrdering::natural:
      common.method[0].ordering = CHOLMOD_NATURAL;
      common.postorder = 0;
      break;
    case SymmetricOrdering::given:
      check_permutation(options.permutation, lower.columns);
      permutation.assign(options.permutation.begin(), options.permutation.end());
      common.method[0].ordering = CHOLMOD_GIVEN;
      common.postorder = 0;
      break;
    case SymmetricOrdering::grouped: {
      // The elimination tree's postorder, applied on top for locality, keeps neighbours in their order: of two rows
      // that share an entry of L the earlier one is a descendant of the later one.
      check_groups(options.groups, lower.columns);
      std::vector<int> groups(options.groups.begin(), options.groups.end());
      permutation.resize(static_cast<std::size_t>(lower.columns));
      if (!cholmod_camd(&view, nullptr, 0, groups.data(), permutation.data(), &common))
        return {FactorStatus::out_of_memory, -1};
      common.method[0].ordering = CHOLMOD_GIVEN;
      break;
    }
  }
  cholmod_factor* factor =
      cholmod_analyze_p(&view, permutation.empty() ? nullptr : permutation.data(), nullptr, 0, &common);
  if (factor == nullptr) return {FactorStatus::out_of_memory, -1};
  factor->is_ll = options.form == SymmetricForm::ll;
  handles_->symbolic_and_numeric = factor;
  return {};
}

std::span<const int> CholmodKernel::order() const {
  return {static_cast<const int*>(handles_->factor().Perm), handles_->factor().n};
}

std::span<const int> CholmodKernel::column_counts() const {
  return {static_cast<const int*>(handles_->factor().ColCount), handles_->factor().n};
}

FactorResult CholmodKernel::factor(const SparsePattern& upper, std::span<const double> values, double shift) {
  Handles& h = *handles_;
  // cholmod_factorize would permute A into a new matrix at every call; its row-wise kernel is used directly instead.
  cholmod_sparse view = triangle_view(upper, const_cast<double*>(values.data()), 1);
  double beta[2] = {shift, 0};
  cholmod_rowfac(&view, nullptr, beta, 0, h.factor().n, h.symbolic_and_numeric, &h.common);
  if (h.common.status < CHOLMOD_OK) return {FactorStatus::out_of_memory, -1};
  const int complete = static_cast<int>(h.factor().minor);
  const FactorColumns factored = columns();
  h.pivots.resize(h.factor().n);
  for (int k = 0; k < complete; ++k) {
    const double diagonal = factored.value[factored.start[k]];
    if (!std::isfinite(diagonal)) return {FactorStatus::not_finite, k};
    h.pivots[k] = h.factor().is_ll ? diagonal * diagonal : diagonal;
  }
  if (complete < upper.columns) return {FactorStatus::singular, complete};
  return {};
}

void CholmodKernel::solve(std::span<double> x) {
  constexpr std::size_t columns_at_once = 4;
  Handles& h = *handles_;
  const std::size_t n = h.factor().n;
  for (std::size_t begin = 0; begin < x.size(); begin += columns_at_once * n) {
    const std::span<double> part = x.subspan(begin, std::min(columns_at_once * n, x.size() - begin));
    cholmod_dense right_hand_side{};
    right_hand_side.nrow = right_hand_side.d = n;
    right_hand_side.ncol = part.size() / n;
    right_hand_side.nzmax = part.size();
    right_hand_side.x = part.data();
    right_hand_side.xtype = CHOLMOD_REAL;
    right_hand_side.dtype = CHOLMOD_DOUBLE;
    // Up to four columns are copied into the permuted workspace before a solution is written: one array serves as both.
    cholmod_dense in_place = right_hand_side;
    cholmod_dense* solution = &in_place;
    cholmod_solve2(CHOLMOD_A, h.symbolic_and_numeric, &right_hand_side, nullptr, &solution, nullptr, &h.solve_work,
                   &h.unused_work, &h.common);
    // CHOLMOD has narrowed its workspace to the number of columns and would not recognise it as large enough.
    h.solve_work->nrow = h.solve_work->d = h.solve_work->nzmax / n;
    h.solve_work->ncol = n;
  }
}

std::span<const double> CholmodKernel::pivots() const { return handles_->pivots; }

FactorColumns CholmodKernel::columns() const {
  const cholmod_factor& factor = handles_->factor();
  return {{static_cast<const int*>(factor.p), factor.n},
          {static_cast<const int*>(factor.nz), factor.n},
          static_cast<const int*>(factor.i),
          static_cast<const double*>(factor.x)};
}

double CholmodKernel::rcond() const { return cholmod_rcond(handles_->symbolic_and_numeric, &handles_->common); }

}  // namespace catena
