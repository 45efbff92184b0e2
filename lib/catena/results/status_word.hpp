// Columns whose values number a status: how they are written.
#pragma once

#include <cmath>
#include <string_view>

#include "catena/base/status.hpp"

namespace catena {

/// The status that a value numbers, by its name in result files; empty for what is no number.
inline std::string_view status_word(double value) {
  return std::isfinite(value) ? to_string(static_cast<Status>(static_cast<int>(value))) : std::string_view();
}

}  // namespace catena
