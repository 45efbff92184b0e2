#include "catena/results/number_format.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace catena {
namespace {

constexpr int digits = 6;
constexpr int most_decimals = 400;  // more than doubles have

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

/// Decimals of a number with this error that are right to half a unit of the last one; below zero: whole tens.
int right_decimals(double error) {
  return error > 0 ? static_cast<int>(std::floor(-std::log10(2 * error))) : most_decimals;
}

/// With as many digits as `right` decimals of it leave, none at all where it is smaller than those.
std::string to_scientific(double value, int right) {
  const int exponent = value != 0 ? static_cast<int>(std::floor(std::log10(std::abs(value)))) : 0;
  const int shown = std::min(digits, exponent + right + 1);
  return shown > 0 || right == most_decimals ? to_text(value, std::chars_format::scientific, std::max(shown, 1) - 1)
                                             : "0";
}

/// Neither "-" nor a number without any, which is shown as it is.
bool has_decimals(const std::string& text) { return text.find('.') != std::string::npos; }

}  // namespace

void append_exact(std::string& out, double value) {
  if (!std::isfinite(value)) return;
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::vector<std::string> format_column(std::span<const double> values, std::span<const double> errors) {
  double largest = 0;
  for (double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  const int exponent = largest > 0 ? static_cast<int>(std::floor(std::log10(largest))) : 0;
  const bool fixed = exponent > -4 && exponent < digits;
  const int decimals = std::max(0, digits - 1 - exponent);

  std::vector<std::string> text;
  std::size_t strip = std::string::npos;  // zeros that all numbers have
  for (std::size_t k = 0; k < values.size(); ++k) {
    const int right = errors.empty() ? most_decimals : right_decimals(errors[k]);
    if (!std::isfinite(values[k])) {
      text.emplace_back("-");
    } else if (fixed && right >= 0) {
      text.push_back(to_text(values[k], std::chars_format::fixed, std::min(decimals, right)));
    } else {
      text.push_back(to_scientific(values[k], right));
    }
    if (has_decimals(text.back())) strip = std::min(strip, trailing_zeros(text.back()));
  }
  for (std::string& number : text) {
    if (has_decimals(number)) number.erase(decimals_end(number) - strip, strip);
  }
  return text;
}

std::string format_number(double value) { return format_column(std::span(&value, 1)).front(); }

}  // namespace catena
