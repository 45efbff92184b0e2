#include "catena/scene/reading/own_column_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "catena/scene/numbers/name_rules.hpp"
#include "catena/scene/numbers/quantity.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

constexpr std::array<std::string_view, 2> own_column_keys{"value", "unit"};

void report_in_text(const JsonValue& value, std::size_t position, std::string message, Diagnostics& diagnostics) {
  diagnostics.error(value.source(), value.source().offset_in_string(value.offset(), position), std::move(message));
}

/// Compiles a text; where it is not the one at `value` places in it are not told.
bool parse(const JsonValue& value, std::string_view text, const ExpressionScope& scope, OwnColumnTemplate& column,
           Diagnostics& diagnostics) {
  const bool as_written = text == value.text();
  Parsed<Expression> expression = Expression::parse(text.substr(1), scope);
  if (!expression) {
    const std::string& message = expression.error.message;
    if (as_written)
      report_in_text(value, expression.error.position + 1, message, diagnostics);
    else
      report(value, fmt::format("in the expression {}: {}", in_quotes(text), message), diagnostics);
    return false;
  }
  column.expression = std::move(*expression);
  for (NamedInput& input : column.inputs) input.position = as_written ? input.position : 0;
  return true;
}

/// Compiles the expression at `value`; false, with a report, if it is none.
bool compile(const JsonValue& value, OwnColumnTemplate& column, const SceneTemplate& scene, Diagnostics& diagnostics) {
  column.place = value;
  if (!value.is(JsonKind::string) || !value.text().starts_with('=')) {
    report(value, fmt::format("column {} must be an expression in quotes that begins with =", in_quotes(column.name)),
           diagnostics);
    return false;
  }
  ExpressionScope scope{&scene.parameters.names()};
  scope.columns = &column.inputs;
  return parse(value, value.text(), scope, column, diagnostics);
}

/// Values of columns are in SI units and radians, whatever they are called.
void read_unit(const JsonValue& value, OwnColumnTemplate& column, Diagnostics& diagnostics) {
  const std::string_view text = read_string(value, {"unit", "column " + in_quotes(column.name)}, diagnostics);
  if (!value.is(JsonKind::string) || text == "1") return;
  const Parsed<Quantity> quantity = parse_quantity("1 " + std::string(text));
  if (!quantity) {
    report(value, quantity.error.message, diagnostics);
  } else if (quantity->value != 1) {
    report(value,
           fmt::format("the expression's value is in SI units and radians: its unit is {}, not {}",
                       in_quotes(si_unit(quantity->dimension)), in_quotes(text)),
           diagnostics);
  } else {
    column.unit = text;
  }
}

std::string name_problem(std::string_view name, const SceneTemplate& scene) {
  if (scene.parameters.names().find(name) >= 0)
    return fmt::format("a parameter is called {} already; choose another name", in_quotes(name));
  return element_name_problem(name);
}

}  // namespace

void read_own_columns(const JsonValue& object, SceneTemplate& scene, Diagnostics& diagnostics) {
  if (!object.is(JsonKind::object)) {
    report(object,
           fmt::format("\"columns\" must be an object of names and expressions; this is {}", describe(object.kind())),
           diagnostics);
    return;
  }
  for (const JsonMember member : object.members()) {
    OwnColumnTemplate column;
    column.name = member.name();
    if (const std::string problem = name_problem(column.name, scene); !problem.empty()) {
      report(member.key, problem, diagnostics);
      continue;
    }
    JsonValue value = member.value;
    if (value.is(JsonKind::object)) {
      std::array<JsonValue, own_column_keys.size()> v;
      read_members(value, own_column_keys, "column " + in_quotes(column.name), v, diagnostics);
      if (v[1]) read_unit(v[1], column, diagnostics);
      if (!v[0]) {
        report(value, fmt::format("column {} needs a \"value\"", in_quotes(column.name)), diagnostics);
        continue;
      }
      value = v[0];
    }
    if (compile(value, column, scene, diagnostics)) scene.own_columns.push_back(std::move(column));
  }
}

std::string column_name(const JsonValue& value, SceneTemplate& scene, Diagnostics& diagnostics) {
  if (!value.is(JsonKind::string)) {
    report(value, fmt::format("a column is named by a text; this is {}", describe(value.kind())), diagnostics);
    return {};
  }
  return column_name(value, std::string(value.text()), {}, scene, diagnostics);
}

std::string column_name(const JsonValue& place, std::string text, const LoopValues& loop, SceneTemplate& scene,
                        Diagnostics& diagnostics) {
  if (!text.starts_with('=')) return text;
  const auto is_known = [&](const std::string& name) {
    return std::any_of(scene.own_columns.begin(), scene.own_columns.end(),
                       [&](const OwnColumnTemplate& column) { return column.name == name; });
  };
  if (loop.names.empty() && is_known(text)) return text;
  OwnColumnTemplate column;
  column.place = place;
  ExpressionScope scope{&scene.parameters.names(), loop.names};
  scope.columns = &column.inputs;
  if (!parse(place, text, scope, column, diagnostics)) return {};
  column.name = text;
  if (column.expression.bind(loop.values)) {
    for (std::size_t n = 0; n < loop.names.size(); ++n)
      column.name += fmt::format("{}{} = {}", n == 0 ? " at " : ", ", loop.names[n], loop.values[n]);
  }
  if (is_known(column.name)) return column.name;
  scene.own_columns.push_back(std::move(column));
  return scene.own_columns.back().name;
}

}  // namespace catena
