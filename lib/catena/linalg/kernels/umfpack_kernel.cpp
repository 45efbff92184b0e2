#include "catena/linalg/kernels/umfpack_kernel.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "catena/linalg/kernels/blas_threads.hpp"
#include "catena/linalg/kernels/build_options.hpp"

#if CATENA_HAS_UMFPACK

#include <suitesparse/umfpack.h>

namespace catena {

struct UmfpackKernel::Handles {
  double control[UMFPACK_CONTROL];
  double info[UMFPACK_INFO];
  void* symbolic = nullptr;
  void* numeric = nullptr;
  std::vector<double> work;      // UMFPACK's own, n without its refinement
  std::vector<double> solution;  // UMFPACK solves from one vector into another
  std::vector<int> index_work;

  Handles() {
    umfpack_di_defaults(control);
    control[UMFPACK_IRSTEP] = 0;  // refinement is done, and counted, one level above
  }
  ~Handles() {
    umfpack_di_free_numeric(&numeric);
    umfpack_di_free_symbolic(&symbolic);
  }
  // UMFPACK starts with 0.7 of the bound of its symbolic analysis, which small dense fronts exceed: it is enlarged
  // twice, by more than is needed. Beyond 128 kB malloc takes that from the operating system at every factorization: 42
  // page faults each, a third of the time of radau on Andrews' squeezer. From the second factorization on a fourth more
  // than the last one needed is reserved (a negative control is a size); UMFPACK enlarges it where other pivots fill
  // more.
  void reserve_what_was_needed() {
    if (const double needed = info[UMFPACK_VARIABLE_PEAK]; needed > 0) control[UMFPACK_ALLOC_INIT] = -1.25 * needed;
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;

  void solve(int system, std::span<double> x) {
    for (std::size_t begin = 0; begin < x.size(); begin += solution.size()) {
      std::span<double> column = x.subspan(begin, solution.size());
      // Without UMFPACK's own refinement the matrix itself is not read.
      umfpack_di_wsolve(system, nullptr, nullptr, nullptr, solution.data(), column.data(), numeric, control, nullptr,
                        index_work.data(), work.data());
      std::copy(solution.begin(), solution.end(), column.begin());
    }
  }
};

UmfpackKernel::UmfpackKernel() : handles_(std::make_unique<Handles>()) {}

FactorResult UmfpackKernel::analyze(const SparsePattern& pattern) {
  handles_ = std::make_unique<Handles>();
  Handles& h = *handles_;
  const int n = pattern.columns;
  use_single_threaded_blas();
  const int outcome = umfpack_di_symbolic(n, n, pattern.column_start.data(), pattern.row_index.data(), nullptr,
                                          &h.symbolic, h.control, h.info);
  if (outcome != UMFPACK_OK) return {FactorStatus::out_of_memory, -1};
  h.work.resize(static_cast<std::size_t>(n));
  h.solution.resize(static_cast<std::size_t>(n));
  h.index_work.resize(static_cast<std::size_t>(n));
  return {};
}

bool UmfpackKernel::is_analyzed() const { return handles_->symbolic != nullptr; }

FactorResult UmfpackKernel::factor(const SparsePattern& pattern, std::span<const double> values) {
  Handles& h = *handles_;
  umfpack_di_free_numeric(&h.numeric);
  const int outcome = umfpack_di_numeric(pattern.column_start.data(), pattern.row_index.data(), values.data(),
                                         h.symbolic, &h.numeric, h.control, h.info);
  h.reserve_what_was_needed();
  if (outcome == UMFPACK_WARNING_singular_matrix) return {FactorStatus::singular, -1};
  if (outcome != UMFPACK_OK) return {FactorStatus::out_of_memory, -1};
  return {};
}

void UmfpackKernel::solve(std::span<double> x) { handles_->solve(UMFPACK_A, x); }

void UmfpackKernel::solve_transposed(std::span<double> x) { handles_->solve(UMFPACK_At, x); }

double UmfpackKernel::rcond() const { return handles_->info[UMFPACK_RCOND]; }

#else

namespace catena {

struct UmfpackKernel::Handles {};

UmfpackKernel::UmfpackKernel() = default;
FactorResult UmfpackKernel::analyze(const SparsePattern&) { return {FactorStatus::unavailable, -1}; }
bool UmfpackKernel::is_analyzed() const { return false; }
FactorResult UmfpackKernel::factor(const SparsePattern&, std::span<const double>) {
  return {FactorStatus::unavailable, -1};
}
void UmfpackKernel::solve(std::span<double>) {}
void UmfpackKernel::solve_transposed(std::span<double>) {}
double UmfpackKernel::rcond() const { return 0; }

#endif

UmfpackKernel::~UmfpackKernel() = default;
UmfpackKernel::UmfpackKernel(UmfpackKernel&&) noexcept = default;
UmfpackKernel& UmfpackKernel::operator=(UmfpackKernel&&) noexcept = default;

}  // namespace catena
