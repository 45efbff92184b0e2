#include "catena/scene/numbers/number_reader.hpp"

#include <fmt/format.h>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/quantity.hpp"

namespace catena {
namespace {

/// `a mass, for example "2 kg"`.
std::string wanted(const ExpectedDimension& expected) {
  if (!expected) return "a number, for example 0.5, \"120 mm\" or \"=2*a\"";
  return describe(*expected) + ", for example " + example(*expected);
}

std::string bare_number(std::string_view text, const ExpectedDimension& expected) {
  if (!expected) return fmt::format("{0} is a number in quotes: write {1}, or give it a unit", in_quotes(text), text);
  const std::string unit = si_unit(*expected);
  if (*expected == Dimension{}) return fmt::format("{} is a number in quotes: write {}", in_quotes(text), text);
  return fmt::format("{} is a number in quotes: write {} (in {}) or \"{} {}\"", in_quotes(text), text, unit, text,
                     unit);
}

}  // namespace

std::string FieldName::text() const {
  return owner.empty() ? in_quotes(key) : in_quotes(key) + " of " + std::string(owner);
}

NumberValue NumberReader::wrong(const JsonValue& value, std::size_t position_in_text, std::string message) {
  const std::size_t offset =
      position_in_text == 0 ? value.offset() : value.source().offset_in_string(value.offset(), position_in_text);
  diagnostics_.error(value.source(), offset, std::move(message));
  return {};
}

void NumberReader::not_expected(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field,
                                std::string_view given) {
  wrong(value, 0, fmt::format("{} must be {}; {}", field.text(), wanted(expected), given));
}

NumberValue NumberReader::read(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field) {
  dimension_.reset();
  if (value.is(JsonKind::number)) return NumberValue::constant(value.number(), value.offset());
  if (value.is(JsonKind::string)) return read_text(value, expected, field);
  not_expected(value, expected, field, "this is " + std::string(describe(value.kind())));
  return {};
}

NumberValue NumberReader::read_text(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field) {
  const std::string_view text = value.text();
  if (text.empty()) {
    not_expected(value, expected, field, "this text is empty");
    return {};
  }
  const char first = text[0];
  if (first == '=') return read_expression(value, field);
  const bool quantity = (first >= '0' && first <= '9') || first == '+' || first == '-' || first == '.';
  return quantity ? read_quantity(value, expected, field) : read_parameter(value, expected, field);
}

bool NumberReader::check(const JsonValue& value, const ExpectedDimension& expected, const FieldName& field) {
  if (!expected || !dimension_ || *dimension_ == *expected) return true;
  not_expected(value, expected, field, fmt::format("{} is {}", in_quotes(value.text()), describe(*dimension_)));
  return false;
}

NumberValue NumberReader::read_quantity(const JsonValue& value, const ExpectedDimension& expected,
                                        const FieldName& field) {
  const Parsed<Quantity> quantity = parse_quantity(value.text());
  if (!quantity) return wrong(value, quantity.error.position, field.text() + ": " + quantity.error.message);
  if (!quantity->has_unit) return wrong(value, 0, field.text() + ": " + bare_number(value.text(), expected));
  dimension_ = quantity->dimension;
  if (!check(value, expected, field)) return {};
  return NumberValue::constant(quantity->value, value.offset());
}

NumberValue NumberReader::read_expression(const JsonValue& value, const FieldName& field) {
  const Parsed<std::uint32_t> number = pool_.add(value.text().substr(1), scope());
  if (!number) return wrong(value, number.error.position + 1, field.text() + ": " + number.error.message);
  return NumberValue::reference(NumberValue::Kind::expression, *number, value.offset());
}

NumberValue NumberReader::read_parameter(const JsonValue& value, const ExpectedDimension& expected,
                                         const FieldName& field) {
  const std::string_view name = value.text();
  for (std::size_t i = loop_variables_.size(); i-- > 0;) {
    if (loop_variables_[i] != name) continue;
    return NumberValue::reference(NumberValue::Kind::loop_variable, static_cast<std::uint32_t>(i), value.offset());
  }
  const int parameter = parameters_.find(name);
  if (parameter < 0) {
    std::string hint = "; an expression begins with =";
    if (is_identifier(name)) {
      hint = NearMiss(name).consider_all(parameters_.all()).hint();
      if (hint.empty()) hint = "; a quantity begins with a digit, an expression with =";
    }
    return wrong(value, 0, fmt::format("{}: unknown parameter {}{}", field.text(), in_quotes(name), hint));
  }
  dimension_ = parameters_.dimension(parameter);
  if (!check(value, expected, field)) return {};
  parameters_.note_use(parameter, expected);
  return NumberValue::reference(NumberValue::Kind::parameter, static_cast<std::uint32_t>(parameter), value.offset());
}

std::array<NumberValue, 2> NumberReader::read_pair(const JsonValue& value, const ExpectedDimension& expected,
                                                   const FieldName& field) {
  if (!value.is(JsonKind::array) || value.size() != 2) {
    const std::string given =
        value.is(JsonKind::array) ? fmt::format("a list of {}", value.size()) : std::string(describe(value.kind()));
    wrong(value, 0, fmt::format("{} must be a list of two numbers [x, y]; this is {}", field.text(), given));
    return {};
  }
  auto element = value.elements().begin();
  const NumberValue x = read(*element, expected, field);
  ++element;
  return {x, read(*element, expected, field)};
}

std::vector<NumberValue> NumberReader::read_list(const JsonValue& value, const ExpectedDimension& expected,
                                                 const FieldName& field) {
  if (!value.is(JsonKind::array)) {
    wrong(value, 0, fmt::format("{} must be a list of numbers; this is {}", field.text(), describe(value.kind())));
    return {};
  }
  std::vector<NumberValue> numbers;
  numbers.reserve(value.size());
  for (const JsonValue& element : value.elements()) numbers.push_back(read(element, expected, field));
  return numbers;
}

}  // namespace catena
