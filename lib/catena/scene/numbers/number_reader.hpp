// From a JSON value to a compiled number, with the checks every field has: a JSON number (SI, radians), a quantity
// whose dimension must be the field's, an expression, or the name of a parameter.
//
// Text beginning with a digit, sign or dot is a quantity, with = an expression, else a parameter. A parameter that was
// itself given as a quantity carries its dimension, so `"mass": "l"` with l = "120 mm" is found; the dimension of
// an expression is not known and not checked.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/json/json_document.hpp"
#include "catena/scene/numbers/number_value.hpp"
#include "catena/scene/numbers/unit.hpp"

namespace catena {

/// Name of a field in messages: `"mass" of body "crank"`.
struct FieldName {
  std::string_view key;
  std::string_view owner = {};  ///< such as `body "crank"`; may be empty

  std::string text() const;
};

/// The dimension a field wants; without one it takes any (the value of a parameter).
using ExpectedDimension = std::optional<Dimension>;

class NumberReader {
 public:
  /// The three must outlive the reader.
  NumberReader(const ParameterNames& parameters, ExpressionPool& pool, Diagnostics& diagnostics)
      : parameters_(parameters), pool_(pool), diagnostics_(diagnostics) {}

  /// Makes an integer variable known, until the matching leave_block().
  void enter_block(std::string_view variable) { loop_variables_.emplace_back(variable); }
  void leave_block() { loop_variables_.pop_back(); }
  ExpressionScope scope() const { return {&parameters_, loop_variables_}; }

  /// Never fails: a value that cannot be read is reported and gives an invalid number, which evaluates to NaN.
  NumberValue read(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field);
  NumberValue read(const JsonValue& value, UnitKind expected, const FieldName& field) {
    return read(value, ExpectedDimension(dimension_of(expected)), field);
  }
  /// Two numbers [x, y].
  std::array<NumberValue, 2> read_pair(const JsonValue& value, const ExpectedDimension& expected,
                                       const FieldName& field);
  /// Any number of numbers [a, b, ...].
  std::vector<NumberValue> read_list(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field);

  /// The dimension of the value last read: of a quantity, or of a parameter that has one.
  const std::optional<Dimension>& dimension() const { return dimension_; }

 private:
  NumberValue read_text(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field);
  NumberValue read_quantity(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field);
  NumberValue read_expression(const JsonValue& value, const FieldName& field);
  NumberValue read_parameter(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field);
  bool check(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field);
  NumberValue wrong(const JsonValue& value, std::size_t position_in_text, std::string message);
  void not_expected(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field,
                    std::string_view given);

  const ParameterNames& parameters_;
  ExpressionPool& pool_;
  Diagnostics& diagnostics_;
  std::vector<std::string> loop_variables_;
  std::optional<Dimension> dimension_;
};

}  // namespace catena
