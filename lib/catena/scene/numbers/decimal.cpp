#include "catena/scene/numbers/decimal.hpp"

#include <algorithm>
#include <charconv>

namespace catena {
namespace {

/// Of a number that no double holds: whether its first significant digit stands before the decimal point.
bool is_large(std::string_view digits) {
  const std::size_t e = std::min(digits.find_first_of("eE"), digits.size());
  const std::string_view mantissa = digits.substr(0, e);
  const auto point = static_cast<long>(std::min(mantissa.find('.'), mantissa.size()));
  const auto first = static_cast<long>(std::min(mantissa.find_first_of("123456789"), mantissa.size()));
  long exponent = 0;
  if (e < digits.size()) {
    const bool negative = digits.substr(e + 1).starts_with('-');
    const std::size_t sign = negative || digits.substr(e + 1).starts_with('+') ? 1 : 0;
    const char* const begin = digits.data() + e + 1 + sign;
    if (std::from_chars(begin, digits.data() + digits.size(), exponent).ec != std::errc()) return !negative;
    if (negative) exponent = -exponent;
  }
  return point - first + exponent > 0;
}

}  // namespace

Decimal read_decimal(std::string_view text) {
  Decimal result;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), result.value);
  if (code == std::errc::invalid_argument) return result;
  result.length = static_cast<std::size_t>(end - text.data());
  if (code != std::errc()) {
    result.value = 0;
    result.too_large = is_large(text.substr(0, result.length));
  }
  return result;
}

}  // namespace catena
