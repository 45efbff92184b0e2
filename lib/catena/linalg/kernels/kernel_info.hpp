// The direct factorizations catena knows, and which of them this build contains. UMFPACK and SPQR (both GPL) can be
// left out of a build; requests for them are then answered by `unavailable`.
#pragma once

#include <string>
#include <string_view>

namespace catena {

enum class Kernel {
  automatic,  ///< KLU, checked by the residual where asked, UMFPACK as the fallback
  klu,        ///< LU with block triangular form; refactors with kept pivots
  cholmod,    ///< simplicial LDL^T or LL^T of symmetric matrices
  umfpack,    ///< LU with true pivoting at every factorization: robust, ten times dearer
  spqr,       ///< QR: rank, redundancy, null space
};

/// Name as users write it: "automatic", "klu", ...
std::string_view to_string(Kernel kernel);

/// Whether this build contains the kernel; `automatic` always is.
bool is_compiled_in(Kernel kernel);

/// One line for --version and error messages, e.g. "KLU 1.3.9, CHOLMOD 3.0.14, UMFPACK 5.7.9; without SPQR".
std::string kernel_summary();

}  // namespace catena
