#include "catena/scene/numbers/name_template.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace catena {
namespace {

constexpr double largest_integer = 9007199254740992.0;  // 2^53: beyond it doubles skip integers

}  // namespace

Parsed<NameTemplate> NameTemplate::parse(std::string_view text, const ExpressionScope& scope) {
  NameTemplate result;
  std::size_t at = 0;
  for (;;) {
    const std::size_t brace = text.find_first_of("{}", at);
    if (brace == std::string_view::npos) break;
    if (text[brace] == '}') return TextError{brace, "this } was never opened"};
    const std::size_t close = text.find('}', brace);
    if (close == std::string_view::npos) return TextError{brace, "this { is not closed"};
    const std::string_view formula = text.substr(brace + 1, close - brace - 1);
    Parsed<Expression> expression = Expression::parse(formula, scope);
    if (!expression) return TextError{brace + 1 + expression.error.position, expression.error.message};
    result.pieces_.push_back(
        {std::string(text.substr(at, brace - at)), brace + 1, std::string(formula), std::move(*expression)});
    at = close + 1;
  }
  result.tail_ = text.substr(at);
  return result;
}

void NameTemplate::append_to(std::string& out, std::span<const double> parameters,
                             std::span<const double> loop_variables) const {
  for (const Piece& piece : pieces_) {
    out += piece.text;
    double value = 0;
    try {
      value = piece.expression.evaluate<double>(parameters, loop_variables);
    } catch (const ExpressionError& error) {
      throw ExpressionError(piece.position + error.position, error.what());
    }
    const double nearest = std::round(value);
    if (!(std::abs(value - nearest) <= 1e-9 * std::max(1.0, std::abs(value))) || std::abs(nearest) > largest_integer) {
      throw ExpressionError(piece.position,
                            fmt::format("a name needs an integer here, but {} is {}", piece.formula, value));
    }
    char digits[24];
    const auto [end, code] = std::to_chars(digits, digits + sizeof digits, static_cast<long long>(nearest));
    out.append(digits, end);
  }
  out += tail_;
}

std::string NameTemplate::sample() const {
  std::string text;
  for (const Piece& piece : pieces_) text += piece.text + '0';
  return text + tail_;
}

}  // namespace catena
