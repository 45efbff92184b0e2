// Expressions such as crank/2 + 0.1: parsed once into a few instructions of a stack machine, evaluated with any scalar.
//
// + - * / ^ with the usual ranks (^ binds to the right and before a sign: -2^2 = -4, 2^-1 = 0.5), parentheses, pi,
// sin cos tan asin acos atan atan2 sqrt exp log abs min max, the scene's tables as functions p(x), parameters by name,
// and inside replicate blocks the integer variables of the blocks (the innermost first, before a parameter of the same
// name). SI units and radians.
//
// Singular cases: a division by zero, or any operation whose value is not finite, throws ExpressionError at the
// operation. An operand that is NaN already (a parameter with a reported error) passes silently, so that each error is
// reported once. Derivatives of dual numbers may be infinite where the function has no slope (sqrt at 0).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "catena/base/formula.hpp"
#include "catena/scene/json/text_error.hpp"
#include "catena/scene/numbers/parameter_names.hpp"

namespace catena {

/// A value that does not exist: division by zero, square root of a negative number ...
struct ExpressionError : std::runtime_error {
  ExpressionError(std::size_t position_, const std::string& message)
      : std::runtime_error(message), position(position_) {}
  std::size_t position;  ///< byte in the expression's text
};

/// A column that an expression names, and the byte of its text at which it does so first.
struct NamedInput {
  std::string name;
  std::size_t position = 0;
};

/// What names mean in an expression.
struct ExpressionScope {
  const ParameterNames* parameters = nullptr;
  std::span<const std::string> loop_variables = {};  ///< outermost first
  /// Where columns may be named: the list that takes them up, each once, numbered as the instructions have them. A name
  /// is then a column unless it is a parameter's; one that is no plain identifier stands in single quotes.
  std::vector<NamedInput>* columns = nullptr;
};

/// The tables of a scene by their numbers; one that could not be made, which was reported, is null.
template <class S>
using TableSet = std::span<const typename Formula<S>::Table>;

struct Instruction {
  Operation operation;
  std::uint32_t position;  // byte in the text, for errors
  union {
    double number;        // constant
    std::uint32_t index;  // parameter, loop_variable, column, table
  };
};

class Expression {
 public:
  /// Reads the whole of `text`, which is the part after "=". Positions of errors are bytes in it.
  static Parsed<Expression> parse(std::string_view text, const ExpressionScope& scope);

  /// The value with the parameters in their order and the loop variables as in the scope. Throws ExpressionError.
  template <class S>
  S evaluate(std::span<const S> parameters, std::span<const double> loop_variables, TableSet<S> tables = {}) const;

  /// Puts the values of loop variables in their places. False: none is named.
  bool bind(std::span<const double> loop_variables);

  /// The same as a formula over the columns that were named, with the values of all else in it. A table that is null
  /// makes it a number that is not finite. Loop variables that are bound need no values.
  template <class S>
  Formula<S> formula(std::span<const S> parameters, std::span<const double> loop_variables, TableSet<S> tables) const;

  std::span<const Instruction> code() const { return code_; }

 private:
  friend class ExpressionParser;
  static constexpr std::size_t deepest_stack = Formula<double>::deepest_stack;

  [[noreturn]] static void fail(const Instruction& instruction, double a, double b);
  [[noreturn]] static void fail_outside(const Instruction& instruction, double x, double first, double last);
  /// A table at x; throws where it ends.
  template <class S>
  static S look_up(const Instruction& instruction, TableSet<S> tables, const S& x);

  std::vector<Instruction> code_;
};

/// Whether a name is a function or constant of the language, so that no parameter can have it.
bool is_expression_word(std::string_view name);
/// Whether a name can stand in an expression: letters, digits, _ and anything beyond ASCII, no digit first.
bool is_identifier(std::string_view name);

template <class S>
S Expression::look_up(const Instruction& instruction, TableSet<S> tables, const S& x) {
  const typename Formula<S>::Table table = instruction.index < tables.size() ? tables[instruction.index] : nullptr;
  if (!table || std::isnan(value_of(x))) return S(std::numeric_limits<double>::quiet_NaN());
  if (!table->curve.covers(value_of(x)))
    fail_outside(instruction, value_of(x), table->curve.first(), table->curve.last());
  return table->curve.evaluate(x).f;
}

template <class S>
S Expression::evaluate(std::span<const S> parameters, std::span<const double> loop_variables,
                       TableSet<S> tables) const {
  std::array<S, deepest_stack> stack;
  S* top = stack.data();  // one after the last value; parsing has made sure that it stays inside
  for (const Instruction& instruction : code_) {
    switch (operands(instruction.operation)) {
      case 0:
        if (instruction.operation == Operation::constant) {
          *top++ = S(instruction.number);
        } else if (instruction.operation == Operation::parameter) {
          *top++ = parameters[instruction.index];
        } else {
          *top++ = S(loop_variables[instruction.index]);
        }
        break;
      case 1: {
        if (instruction.operation == Operation::table) {
          top[-1] = look_up<S>(instruction, tables, top[-1]);
          break;
        }
        const double a = value_of(top[-1]);  // the operand, for the message
        top[-1] = apply(instruction.operation, top[-1]);
        if (!std::isfinite(value_of(top[-1])) && !std::isnan(a)) fail(instruction, a, 0);
        break;
      }
      default: {
        --top;
        const double a = value_of(top[-1]), b = value_of(top[0]);
        top[-1] = apply(instruction.operation, top[-1], top[0]);
        if (!std::isfinite(value_of(top[-1])) && !std::isnan(a) && !std::isnan(b)) fail(instruction, a, b);
      }
    }
  }
  return stack[0];
}

template <class S>
Formula<S> Expression::formula(std::span<const S> parameters, std::span<const double> loop_variables,
                               TableSet<S> tables) const {
  Formula<S> formula;
  for (const Instruction& instruction : code_) {
    if (instruction.operation == Operation::constant) {
      formula.push_constant(S(instruction.number));
    } else if (instruction.operation == Operation::parameter) {
      formula.push_constant(parameters[instruction.index]);
    } else if (instruction.operation == Operation::loop_variable) {
      formula.push_constant(S(loop_variables[instruction.index]));
    } else if (instruction.operation == Operation::column) {
      formula.push_input(instruction.index);
    } else if (instruction.operation == Operation::table) {
      if (instruction.index < tables.size() && tables[instruction.index]) {
        formula.push_table(tables[instruction.index]);
      } else {
        formula.push_constant(S(std::numeric_limits<double>::quiet_NaN()));
        formula.push(Operation::multiply);
      }
    } else {
      formula.push(instruction.operation);
    }
  }
  return formula;
}

}  // namespace catena
