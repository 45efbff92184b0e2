// The functions expressions may call, for the parser and for messages. Private to scene.
#pragma once

#include <string_view>

#include "catena/scene/numbers/expression.hpp"

namespace catena {

struct ExpressionFunction {
  std::string_view name;
  Operation operation;
  int values;  // how many it takes; min and max take more as well
};

inline constexpr ExpressionFunction expression_functions[] = {
    {"sin", Operation::sin, 1},    {"cos", Operation::cos, 1},   {"tan", Operation::tan, 1},
    {"asin", Operation::asin, 1},  {"acos", Operation::acos, 1}, {"atan", Operation::atan, 1},
    {"sqrt", Operation::sqrt, 1},  {"exp", Operation::exp, 1},   {"log", Operation::log, 1},
    {"abs", Operation::abs, 1},    {"min", Operation::min, 2},   {"max", Operation::max, 2},
    {"atan2", Operation::atan2, 2}};

inline const ExpressionFunction* find_function(std::string_view name) {
  for (const ExpressionFunction& function : expression_functions) {
    if (function.name == name) return &function;
  }
  return nullptr;
}

inline constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// Letters, _ and every byte of a character beyond ASCII.
inline constexpr bool starts_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

}  // namespace catena
