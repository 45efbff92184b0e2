#include "catena/linalg/kernels/factor_result.hpp"

namespace catena {

std::string_view to_string(FactorStatus status) {
  switch (status) {
    case FactorStatus::ok:
      return "ok";
    case FactorStatus::singular:
      return "singular";
    case FactorStatus::not_finite:
      return "not finite";
    case FactorStatus::out_of_memory:
      return "out of memory";
    case FactorStatus::unavailable:
      return "unavailable";
    case FactorStatus::inaccurate:
      return "inaccurate";
  }
  return "unknown";
}

}  // namespace catena
