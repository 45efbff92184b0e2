#include "catena/base/status.hpp"

#include <array>
#include <cstddef>

namespace catena {

std::string_view to_string(Status status) {
  static constexpr std::array<std::string_view, 13> names = {
      "ok",         "not_assembled", "under_driven",  "singular",       "lock_up",   "bifurcation", "inconsistent",
      "infeasible", "unbounded",     "not_converged", "step_too_small", "cancelled", "refused"};
  return names[static_cast<std::size_t>(status)];
}

}  // namespace catena
