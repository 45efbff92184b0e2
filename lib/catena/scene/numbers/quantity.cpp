#include "catena/scene/numbers/quantity.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/decimal.hpp"

namespace catena {
namespace {

struct Unit {
  std::string_view name;
  double numerator, denominator;  // SI value of one unit = numerator / denominator
  Dimension dimension;
};

constexpr Dimension length{1, 0, 0, 0}, mass{0, 1, 0, 0}, time{0, 0, 1, 0}, angle{0, 0, 0, 1};
constexpr Dimension force = mass * length / (time * time);

constexpr Unit units[] = {
    {"m", 1, 1, length},
    {"mm", 1, 1000, length},
    {"cm", 1, 100, length},
    {"km", 1000, 1, length},
    {"in", 254, 10000, length},
    {"ft", 3048, 10000, length},
    {"kg", 1, 1, mass},
    {"g", 1, 1000, mass},
    {"t", 1000, 1, mass},
    {"lb", 45359237, 1e8, mass},
    {"s", 1, 1, time},
    {"ms", 1, 1000, time},
    {"min", 60, 1, time},
    {"Hz", 1, 1, {0, 0, -1, 0}},
    {"rad", 1, 1, angle},
    {"deg", std::numbers::pi, 180, angle},
    {"rev", 2 * std::numbers::pi, 1, angle},
    {"rpm", 2 * std::numbers::pi, 60, angle / time},
    {"N", 1, 1, force},
    {"kN", 1000, 1, force},
    {"lbf", 44482216152605, 1e13, force},  // lb x 9.80665 m/s^2
    {"Pa", 1, 1, force / (length * length)},
    {"psi", 44482216152605, 6451600000, force / (length * length)},  // lbf / in^2
    {"J", 1, 1, force* length},
    {"W", 1, 1, force* length / time},
};

const Unit* find_unit(std::string_view name) {
  for (const Unit& unit : units) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

std::string unknown_unit(std::string_view name) {
  NearMiss near(name);
  for (const Unit& unit : units) near.consider(unit.name);
  std::string hint = near.hint();
  if (hint.empty())
    hint = "; known are m mm cm km in ft, kg g t lb, s ms min, Hz, rad deg rev, rpm, N kN lbf, Pa psi, J, W";
  return "unknown unit " + in_quotes(name) + hint;
}

class QuantityParser {
 public:
  explicit QuantityParser(std::string_view text) : text_(text) {}

  Parsed<Quantity> parse() {
    if (!read_number()) return error_;
    skip_blanks();
    bool divide = false;
    // "5 1/s" and "5 /s" are usual for reciprocal units.
    if (rest().starts_with("1/")) ++at_;
    if (rest().starts_with("/")) divide = step();
    while (at_ < text_.size()) {
      if (!read_unit(divide)) return error_;
      skip_blanks();
      divide = rest().starts_with("/");
      if (divide || rest().starts_with("*")) step();
    }
    if (pending_) return fail(text_.size(), "a unit is missing at the end");
    result_.value = result_.value * numerator_ / denominator_;
    if (!std::isfinite(result_.value)) return fail(0, "this quantity is too large");
    return result_;
  }

 private:
  std::string_view rest() const { return text_.substr(at_); }
  TextError fail(std::size_t position, std::string message) { return error_ = {position, std::move(message)}; }
  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  /// Over an operator, after which a unit must follow.
  bool step() {
    ++at_;
    skip_blanks();
    return pending_ = true;
  }

  bool read_number() {
    const bool sign = text_.starts_with('+') || text_.starts_with('-');
    std::size_t digit = sign ? 1 : 0;
    if (text_.substr(digit).starts_with('.')) ++digit;
    if (digit >= text_.size() || text_[digit] < '0' || text_[digit] > '9') {
      fail(0, "expected a number before the unit; an expression begins with =");
      return false;
    }
    const std::size_t begin = text_.starts_with('+') ? 1 : 0;
    const Decimal number = read_decimal(text_.substr(begin));
    if (number.too_large) {
      fail(0, "this number is too large");
      return false;
    }
    result_.value = number.value;
    at_ = begin + number.length;
    return true;
  }

  bool read_unit(bool divide) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::string_view(" /*^").find(text_[at_]) == std::string_view::npos) ++at_;
    const std::string_view name = text_.substr(begin, at_ - begin);
    const Unit* unit = find_unit(name);
    if (!unit) {
      const bool arithmetic = name.empty() || std::string_view("0123456789.+-()=").find(name[0]) != name.npos;
      fail(begin, arithmetic ? "expected a unit here; an expression begins with =" : unknown_unit(name));
      return false;
    }
    int exponent = 1;
    if (rest().starts_with("^")) {
      const char* const from = text_.data() + at_ + 1;
      const auto [end, code] = std::from_chars(from, text_.data() + text_.size(), exponent);
      if (code != std::errc() || exponent < -9 || exponent > 9 || exponent == 0) {
        fail(at_ + 1, "an exponent is a whole number from 1 to 9 or from -9 to -1");
        return false;
      }
      at_ = static_cast<std::size_t>(end - text_.data());
    }
    apply(*unit, divide ? -exponent : exponent);
    return true;
  }

  void apply(const Unit& unit, int exponent) {
    for (int i = 0; i < std::abs(exponent); ++i) {
      numerator_ *= exponent > 0 ? unit.numerator : unit.denominator;
      denominator_ *= exponent > 0 ? unit.denominator : unit.numerator;
    }
    result_.dimension = result_.dimension * power(unit.dimension, exponent);
    result_.has_unit = true;
    pending_ = false;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool pending_ = false;  // an operator waits for its unit
  Quantity result_;
  double numerator_ = 1, denominator_ = 1;
  TextError error_;
};

}  // namespace

Parsed<Quantity> parse_quantity(std::string_view text) { return QuantityParser(text).parse(); }

}  // namespace catena
