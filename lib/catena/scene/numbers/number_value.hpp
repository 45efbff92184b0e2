// One number of a scene, compiled: a constant, a parameter, a replicate variable or an expression.
//
// 16 bytes, whatever it is: expressions live in a pool, each distinct text once, so that a block repeated a million
// times is read once and evaluated as often as needed. Evaluation is a template on the scalar: derivatives with respect
// to parameters run through every number of a scene.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/scene/numbers/expression.hpp"

namespace catena {

class NumberValue {
 public:
  enum class Kind : std::uint8_t { invalid, constant, parameter, loop_variable, expression };

  NumberValue() : number_(0) {}
  static NumberValue constant(double number, std::size_t offset = 0) {
    NumberValue value(Kind::constant, offset);
    value.number_ = number;
    return value;
  }
  /// A parameter, replicate variable or expression by its number.
  static NumberValue reference(Kind kind, std::uint32_t index, std::size_t offset) {
    NumberValue value(kind, offset);
    value.index_ = index;
    return value;
  }

  Kind kind() const { return kind_; }
  /// False for a value that could not be read: the error is in the diagnostics, and the value evaluates to NaN.
  bool valid() const { return kind_ != Kind::invalid; }
  bool is_constant() const { return kind_ == Kind::constant; }
  double number() const { return number_; }       ///< of a constant
  std::uint32_t index() const { return index_; }  ///< of anything else
  std::size_t offset() const { return offset_; }  ///< where it stands in its source

 private:
  NumberValue(Kind kind, std::size_t offset) : kind_(kind), offset_(static_cast<std::uint32_t>(offset)), number_(0) {}

  Kind kind_ = Kind::invalid;
  std::uint32_t offset_ = 0;
  union {
    double number_;
    std::uint32_t index_;
  };
};

/// The expressions of a scene, equal texts in the same scope kept once.
class ExpressionPool {
 public:
  /// The number of the expression `text` (the part after "="), parsed if it is new. Positions are bytes in `text`.
  Parsed<std::uint32_t> add(std::string_view text, const ExpressionScope& scope);
  const Expression& operator[](std::uint32_t index) const { return expressions_[index]; }
  std::size_t size() const { return expressions_.size(); }

 private:
  std::vector<Expression> expressions_;
  std::map<std::string, std::uint32_t, std::less<>> index_;  // by replicate variables and text
};

/// The value of a number; NaN if it is invalid. `loop_variables` as in the scope in which it was read. Throws
/// ExpressionError.
template <class S>
S evaluate(const NumberValue& value, const ExpressionPool& pool, std::span<const S> parameters,
           std::span<const double> loop_variables, TableSet<S> tables = {}) {
  switch (value.kind()) {
    case NumberValue::Kind::constant:
      return S(value.number());
    case NumberValue::Kind::parameter:
      return parameters[value.index()];
    case NumberValue::Kind::loop_variable:
      return S(loop_variables[value.index()]);
    case NumberValue::Kind::expression:
      return pool[value.index()].template evaluate<S>(parameters, loop_variables, tables);
    case NumberValue::Kind::invalid:
      break;
  }
  return S(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace catena
