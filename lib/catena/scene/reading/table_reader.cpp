// The scene's tables and laws of state: from JSON to templates.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/reading/data_file.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

constexpr std::array<std::string_view, 5> table_keys{"x", "y", "points", "end", "beyond"};
constexpr std::array<std::string_view, 3> table_end_words{"natural", "clamped", "periodic"};

}  // namespace

void SceneReading::table_functions(const JsonValue& object, std::span<const std::string> names) {
  std::vector<TableFunction> tables;
  for (const JsonMember member : object.members()) {
    TableFunction& table = tables.emplace_back();
    table.name = names[tables.size() - 1];
    table.place = member.value;
    const std::string owner = "table " + in_quotes(table.name);
    std::array<JsonValue, table_keys.size()> v;
    if (!read_members_or_file(member.value, table_keys, 2, owner, v, diagnostics)) continue;
    if (v[3]) {
      if (const int word = read_word(v[3], table_end_words, {"end", owner}, diagnostics); word >= 0)
        table.end = static_cast<SplineEnd>(word);
    }
    if (v[2]) {
      if (v[0] || v[1]) error(v[2], fmt::format("{} has \"points\", or \"x\" and \"y\", not both", owner));
      const std::vector<NumberValue> pairs = pair_list(
          v[2], {}, {}, {table_keys[2], owner}, {.repeats = table.end == SplineEnd::periodic, .beside = table_keys});
      for (std::size_t k = 0; k < pairs.size(); ++k) (k % 2 == 0 ? table.x : table.y).push_back(pairs[k]);
    } else {
      for (std::size_t k = 0; k < 2; ++k) {
        if (!v[k]) error(member.value, fmt::format("{} needs {}", owner, in_quotes(table_keys[k])));
        if (v[k]) (k == 0 ? table.x : table.y) = number_list(v[k], {}, {table_keys[k], owner});
      }
      if (v[0] && v[1] && !table.x.empty() && !table.y.empty() && table.x.size() != table.y.size())
        error(v[1], fmt::format("{}: {} places x, but {} values y", owner, table.x.size(), table.y.size()));
    }
    table.beyond = beyond(v[4], table.end, owner);
  }
  scene.parameters.define_tables(std::move(tables), scene.expressions, diagnostics);
}

int SceneReading::state_law(const JsonValue& value, const FieldName& field) {
  if (!value.is(JsonKind::string) || !value.text().starts_with('=')) return -1;
  StateLawTemplate law;
  law.place = value;
  ExpressionScope scope = numbers.scope();
  scope.columns = &law.inputs;
  const auto wrong = [&](std::size_t position, const std::string& message) {
    diagnostics.error(value.source(), value.source().offset_in_string(value.offset(), position + 1),
                      field.text() + ": " + message);
  };
  Parsed<Expression> expression = Expression::parse(value.text().substr(1), scope);
  const auto is_column = [&](const NamedInput& input) {
    return input.name == "t" || input.name.find('.') != std::string::npos ||
           std::any_of(this->scene.own_columns.begin(), this->scene.own_columns.end(),
                       [&](const OwnColumnTemplate& own) { return own.name == input.name; });
  };
  // A bare name that is nothing else is a parameter that does not exist: numbers report it.
  const auto first = std::find_if(law.inputs.begin(), law.inputs.end(), is_column);
  if (first == law.inputs.end()) return -1;
  FunctionTemplate function;
  function.offset = static_cast<std::uint32_t>(value.offset());
  function.numbers.resize(1);
  if (!expression) {
    wrong(expression.error.position, expression.error.message);
  } else {
    law.expression = std::move(*expression);
    function.kind = FunctionTemplate::Kind::state;
    function.state = static_cast<int>(this->scene.state_laws.size());
    for (const NamedInput& input : law.inputs) {
      law.patterns.push_back(-1);
      if (!is_column(input)) {
        wrong(input.position,
              fmt::format("there is no column or parameter {}{}", in_quotes(input.name),
                          NearMiss(input.name).consider_all(this->scene.parameters.names().all()).hint()));
      } else if (NameTemplate::has_braces(input.name)) {
        Parsed<NameTemplate> pattern = NameTemplate::parse(input.name, numbers.scope());
        if (!pattern) {
          wrong(input.position, pattern.error.message);
          continue;
        }
        law.patterns.back() = static_cast<int>(this->scene.patterns.size());
        this->scene.patterns.push_back(std::move(*pattern));
      }
    }
    this->scene.state_laws.push_back(std::move(law));
  }
  this->scene.indirect.functions.push_back(std::move(function));
  return static_cast<int>(this->scene.indirect.functions.size()) - 1;
}

}  // namespace catena
