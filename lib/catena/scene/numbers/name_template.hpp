// Names with expressions in braces: "link{k}", "link{k-1}.to". Compiled once, written as often as a block is repeated.
//
// The expressions must give integers (up to rounding, 1e-9 relative); they print without a decimal point, so a name's
// first dot is always one of the template's own. Writing appends to a buffer and allocates only while that grows.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/scene/numbers/expression.hpp"

namespace catena {

class NameTemplate {
 public:
  /// Reads the whole of `text`. Positions of errors are bytes in it.
  static Parsed<NameTemplate> parse(std::string_view text, const ExpressionScope& scope);
  /// Whether a text has braces at all: most names are written out and need no template.
  static bool has_braces(std::string_view text) { return text.find_first_of("{}") != std::string_view::npos; }

  /// Appends the name to `out`. Throws ExpressionError, at the byte of the template, where an expression has no value
  /// or none that is an integer.
  void append_to(std::string& out, std::span<const double> parameters, std::span<const double> loop_variables) const;

  /// The template with 0 for every expression: used to check the rules for names.
  std::string sample() const;

 private:
  struct Piece {
    std::string text;      // before the expression
    std::size_t position;  // of the expression in the template
    std::string formula;   // as written, for messages
    Expression expression;
  };
  std::vector<Piece> pieces_;
  std::string tail_;
};

}  // namespace catena
