#include "catena/results/number_format.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace catena {
namespace {

constexpr int digits = 6;

std::string to_text(double value, std::chars_format format, int precision) {
  // Fixed format is used below 10^7 only. Adding zero takes the sign off a zero.
  char buffer[64];
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, value + 0.0, format, precision).ptr);
  // A number rounded to zero has no sign.
  if (text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

/// Where the decimals of a number end: at the exponent, if it has one.
std::size_t decimals_end(const std::string& text) { return std::min(text.find('e'), text.size()); }

/// How many of the characters before decimals_end() are zeros, the point itself included if nothing is left behind it.
std::size_t trailing_zeros(const std::string& text) {
  const std::size_t point = text.find('.'), end = decimals_end(text);
  if (point == std::string::npos) return 0;
  const std::size_t last = text.find_last_not_of('0', end - 1);
  return end - (last == point ? point : last + 1);
}

}  // namespace

void append_exact(std::string& out, double value) {
  if (!std::isfinite(value)) return;
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::vector<std::string> format_column(std::span<const double> values) {
  double largest = 0;
  for (double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  const int exponent = largest > 0 ? static_cast<int>(std::floor(std::log10(largest))) : 0;
  const bool fixed = exponent > -4 && exponent < digits;
  const int decimals = fixed ? std::max(0, digits - 1 - exponent) : digits - 1;
  const auto format = fixed ? std::chars_format::fixed : std::chars_format::scientific;

  std::vector<std::string> text;
  std::size_t strip = std::string::npos;  // zeros that all numbers have
  for (double value : values) {
    text.push_back(std::isfinite(value) ? to_text(value, format, decimals) : "-");
    if (std::isfinite(value)) strip = std::min(strip, trailing_zeros(text.back()));
  }
  for (std::string& number : text) {
    if (number != "-") number.erase(decimals_end(number) - strip, strip);
  }
  return text;
}

std::string format_number(double value) { return format_column(std::span(&value, 1)).front(); }

}  // namespace catena
