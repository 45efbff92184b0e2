// Outcome of a factorization: numerical failures are values, not exceptions.
#pragma once

#include <string_view>

namespace catena {

enum class FactorStatus {
  ok,
  singular,       ///< a pivot vanished (or no full matching of rows and columns exists); `index` names the column
  not_finite,     ///< a pivot is infinite or not a number: the values are bad
  out_of_memory,  ///< the kernel could not allocate
  unavailable,    ///< the kernel asked for is not in this build, or does not serve this kind of matrix
  inaccurate,     ///< factored, but the residual stays above the tolerance with every kernel at hand
};

std::string_view to_string(FactorStatus status);

struct [[nodiscard]] FactorResult {
  FactorStatus status = FactorStatus::ok;
  int index = -1;  ///< row or column (in the caller's numbering) concerned, -1 when none

  bool ok() const { return status == FactorStatus::ok; }
};

}  // namespace catena
