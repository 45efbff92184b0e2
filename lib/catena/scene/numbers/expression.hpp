// Expressions such as crank/2 + 0.1: parsed once into a few instructions of a stack machine, evaluated with any scalar.
//
// + - * / ^ with the usual ranks (^ binds to the right and before a sign: -2^2 = -4, 2^-1 = 0.5), parentheses, pi,
// sin cos tan asin acos atan atan2 sqrt exp log abs min max, parameters by name, and inside replicate blocks the
// integer variables of the blocks (the innermost first, before a parameter of the same name). SI units and radians.
//
// Singular cases: a division by zero, or any operation whose value is not finite, throws ExpressionError at the
// operation. An operand that is NaN already (a parameter with a reported error) passes silently, so that each error is
// reported once. Derivatives of dual numbers may be infinite where the function has no slope (sqrt at 0).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "catena/base/dual.hpp"
#include "catena/scene/json/text_error.hpp"
#include "catena/scene/numbers/parameter_names.hpp"

namespace catena {

/// A value that does not exist: division by zero, square root of a negative number ...
struct ExpressionError : std::runtime_error {
  ExpressionError(std::size_t position_, const std::string& message)
      : std::runtime_error(message), position(position_) {}
  std::size_t position;  ///< byte in the expression's text
};

/// What names mean in an expression.
struct ExpressionScope {
  const ParameterNames* parameters = nullptr;
  std::span<const std::string> loop_variables = {};  ///< outermost first
};

enum class Operation : std::uint8_t {
  constant,
  parameter,
  loop_variable,
  add,
  subtract,
  multiply,
  divide,
  power,
  atan2,
  min,
  max,
  negate,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sqrt,
  exp,
  log,
  abs
};

struct Instruction {
  Operation operation;
  std::uint32_t position;  // byte in the text, for errors
  union {
    double number;        // constant
    std::uint32_t index;  // parameter, loop_variable
  };
};

class Expression {
 public:
  /// Reads the whole of `text`, which is the part after "=". Positions of errors are bytes in it.
  static Parsed<Expression> parse(std::string_view text, const ExpressionScope& scope);

  /// The value with the parameters in their order and the loop variables as in the scope. Throws ExpressionError.
  template <class S>
  S evaluate(std::span<const S> parameters, std::span<const double> loop_variables) const;

  std::span<const Instruction> code() const { return code_; }

 private:
  friend class ExpressionParser;
  static constexpr std::size_t deepest_stack = 32;

  [[noreturn]] static void fail(const Instruction& instruction, double a, double b);

  std::vector<Instruction> code_;
};

/// Whether a name is a function or constant of the language, so that no parameter can have it.
bool is_expression_word(std::string_view name);
/// Whether a name can stand in an expression: letters, digits, _ and anything beyond ASCII, no digit first.
bool is_identifier(std::string_view name);

template <class S>
S Expression::evaluate(std::span<const S> parameters, std::span<const double> loop_variables) const {
  using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::exp, std::log, std::pow, std::sin,
      std::sqrt, std::tan;
  std::array<S, deepest_stack> stack;
  S* top = stack.data();  // one after the last value; parsing has made sure that it stays inside
  for (const Instruction& instruction : code_) {
    S result{};
    double a = 0, b = 0;  // the operands, for the message
    const auto one = [&]() -> const S& { return a = value_of(*--top), *top; };
    const auto two = [&](auto&& function) {
      top -= 2;
      a = value_of(top[0]);
      b = value_of(top[1]);
      return function(top[0], top[1]);
    };
    switch (instruction.operation) {
      case Operation::constant:
        *top++ = S(instruction.number);
        continue;
      case Operation::parameter:
        *top++ = parameters[instruction.index];
        continue;
      case Operation::loop_variable:
        *top++ = S(loop_variables[instruction.index]);
        continue;
      case Operation::add:
        result = two([](const S& x, const S& y) -> S { return x + y; });
        break;
      case Operation::subtract:
        result = two([](const S& x, const S& y) -> S { return x - y; });
        break;
      case Operation::multiply:
        result = two([](const S& x, const S& y) -> S { return x * y; });
        break;
      case Operation::divide:
        result = two([](const S& x, const S& y) -> S { return x / y; });
        break;
      case Operation::power:
        result = two([](const S& x, const S& y) -> S { return pow(x, y); });
        break;
      case Operation::atan2:
        result = two([](const S& y, const S& x) -> S { return atan2(y, x); });
        break;
      case Operation::min:
        result = two([](const S& x, const S& y) -> S { return y < x ? y : x; });
        break;
      case Operation::max:
        result = two([](const S& x, const S& y) -> S { return x < y ? y : x; });
        break;
      case Operation::negate:
        result = -one();
        break;
      case Operation::sin:
        result = sin(one());
        break;
      case Operation::cos:
        result = cos(one());
        break;
      case Operation::tan:
        result = tan(one());
        break;
      case Operation::asin:
        result = asin(one());
        break;
      case Operation::acos:
        result = acos(one());
        break;
      case Operation::atan:
        result = atan(one());
        break;
      case Operation::sqrt:
        result = sqrt(one());
        break;
      case Operation::exp:
        result = exp(one());
        break;
      case Operation::log:
        result = log(one());
        break;
      case Operation::abs:
        result = abs(one());
        break;
    }
    if (!std::isfinite(value_of(result)) && !std::isnan(a) && !std::isnan(b)) fail(instruction, a, b);
    *top++ = result;
  }
  return stack[0];
}

}  // namespace catena
