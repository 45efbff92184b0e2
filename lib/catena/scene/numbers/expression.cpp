#include "catena/scene/numbers/expression.hpp"

#include <fmt/format.h>

#include "catena/scene/numbers/expression_functions.hpp"

namespace catena {

namespace {

std::string_view operator_sign(Operation operation) {
  switch (operation) {
    case Operation::add:
      return "+";
    case Operation::subtract:
      return "-";
    case Operation::multiply:
      return "*";
    case Operation::divide:
      return "/";
    case Operation::power:
      return "^";
    default:
      return "";
  }
}

}  // namespace

bool Expression::bind(std::span<const double> loop_variables) {
  bool any = false;
  for (Instruction& instruction : code_) {
    if (instruction.operation != Operation::loop_variable) continue;
    instruction.operation = Operation::constant;
    instruction.number = loop_variables[instruction.index];
    any = true;
  }
  return any;
}

bool is_expression_word(std::string_view name) { return name == "pi" || find_function(name) != nullptr; }

bool is_identifier(std::string_view name) {
  if (name.empty() || !starts_name(name[0])) return false;
  for (const char c : name) {
    if (!starts_name(c) && !is_digit(c)) return false;
  }
  return true;
}

void Expression::fail_outside(const Instruction& instruction, double x, double first, double last) {
  throw ExpressionError(
      instruction.position,
      fmt::format("the table reaches from {} to {}, and {} is asked for; \"beyond\" says what lies there", first, last,
                  x));
}

void Expression::fail(const Instruction& instruction, double a, double b) {
  const Operation operation = instruction.operation;
  if (operation == Operation::divide && b == 0) {
    throw ExpressionError(instruction.position, fmt::format("division by zero: {} / {}", a, b));
  }
  std::string what;
  if (const std::string_view sign = operator_sign(operation); !sign.empty()) {
    what = fmt::format("{} {} {}", a, sign, b);
  } else {
    for (const ExpressionFunction& function : expression_functions) {
      if (function.operation != operation) continue;
      what = function.values == 1 ? fmt::format("{}({})", function.name, a)
                                  : fmt::format("{}({}, {})", function.name, a, b);
    }
  }
  throw ExpressionError(instruction.position, what + " has no finite value");
}

}  // namespace catena
