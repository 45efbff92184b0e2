// Reads a decimal number at the beginning of a text, in the same way for values, quantities and expressions: a number
// too small for a double is 0, one too large is an error.
#pragma once

#include <cstddef>
#include <string_view>

namespace catena {

struct Decimal {
  double value = 0;
  std::size_t length = 0;  ///< characters read; 0: no number stands here
  bool too_large = false;
};

/// Reads without a sign of plus, as in 12, .5, -0.5, 1e-3; independent of the locale.
Decimal read_decimal(std::string_view text);

}  // namespace catena
