// The operations of expressions, each evaluated with any scalar: plain numbers, or dual numbers that carry derivatives.
//
//   loads                a constant, a parameter, the variable of a repeated block, a column of results
//   two operands         a + b, a - b, a b, a / b, a^b, atan2(a, b), min(a, b), max(a, b)
//   one operand          -a, sin, cos, tan, asin, acos, atan, sqrt, exp, log, abs, a table of one's own
//
// Angles in radians. Where an operation has no value (division by zero, log of a negative number) the result is not
// finite, as arithmetic has it, and the caller tests for that where it needs a finite number. min, max and abs take the
// derivative of the branch that counts; of two equal operands the first one does.
#pragma once

#include <cmath>
#include <cstdint>

#include "catena/base/dual.hpp"

namespace catena {

enum class Operation : std::uint8_t {
  constant,
  parameter,
  loop_variable,
  column,
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
  abs,
  table  ///< which one is said beside the operation: apply() does not know it
};

/// How many values an operation takes from the stack: none, one or two.
constexpr int operands(Operation operation) {
  if (operation <= Operation::column) return 0;
  return operation <= Operation::max ? 2 : 1;
}

/// The value of an operation with two operands.
template <class S>
S apply(Operation operation, const S& a, const S& b) {
  using std::atan2, std::pow;
  switch (operation) {
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::power:
      return pow(a, b);
    case Operation::atan2:
      return atan2(a, b);
    case Operation::min:
      return b < a ? b : a;
    default:
      return a < b ? b : a;  // max
  }
}

/// The value of an operation with one operand.
template <class S>
S apply(Operation operation, const S& a) {
  using std::abs, std::acos, std::asin, std::atan, std::cos, std::exp, std::log, std::sin, std::sqrt, std::tan;
  switch (operation) {
    case Operation::negate:
      return -a;
    case Operation::sin:
      return sin(a);
    case Operation::cos:
      return cos(a);
    case Operation::tan:
      return tan(a);
    case Operation::asin:
      return asin(a);
    case Operation::acos:
      return acos(a);
    case Operation::atan:
      return atan(a);
    case Operation::sqrt:
      return sqrt(a);
    case Operation::exp:
      return exp(a);
    case Operation::log:
      return log(a);
    default:
      return abs(a);
  }
}

}  // namespace catena
