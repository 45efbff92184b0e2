#include "catena/scene/numbers/parameter_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/name_rules.hpp"

namespace catena {
namespace {

constexpr std::array<std::string_view, 3> keys{"value", "min", "max"};

}  // namespace

ParameterTable ParameterTable::read(const JsonValue& object, ExpressionPool& pool, Diagnostics& diagnostics,
                                    std::span<const std::string> tables) {
  ParameterTable table;
  for (const std::string& name : tables) table.names_.add_table(name);
  if (!object) return table;
  if (!object.is(JsonKind::object)) {
    diagnostics.error(
        object.source(), object.offset(),
        fmt::format("\"parameters\" must be an object of names and numbers; this is {}", describe(object.kind())));
    return table;
  }
  // All names first: definitions may use each other in any order.
  for (const JsonMember member : object.members()) {
    const std::string problem = parameter_name_problem(member.name());
    if (!problem.empty()) diagnostics.error(object.source(), member.key.offset(), problem);
    table.names_.add(member.name());
  }
  table.definitions_.resize(table.names_.size());
  NumberReader reader(table.names_, pool, diagnostics);
  for (const JsonMember member : object.members()) {
    table.read_definition(table.names_.find(member.name()), member.value, reader, diagnostics);
  }
  if (tables.empty()) table.find_order(pool, diagnostics);
  return table;
}

void ParameterTable::define_tables(std::vector<TableFunction> tables, const ExpressionPool& pool,
                                   Diagnostics& diagnostics) {
  tables_ = std::move(tables);
  for (TableFunction& table : tables_) {
    for (std::vector<NumberValue>* list : {&table.x, &table.y}) {
      for (NumberValue& number : *list) {
        if (number.kind() != NumberValue::Kind::expression) continue;
        for (const Instruction& instruction : pool[number.index()].code()) {
          if (instruction.operation != Operation::table) continue;
          diagnostics.error(table.place.source(), number.offset(),
                            fmt::format("the entries of table {} may not use tables", in_quotes(table.name)));
          number = NumberValue();
          break;
        }
      }
    }
  }
  find_order(pool, diagnostics);
}

void ParameterTable::read_definition(int index, const JsonValue& value, NumberReader& reader,
                                     Diagnostics& diagnostics) {
  Definition& definition = definitions_[static_cast<std::size_t>(index)];
  const std::string owner = "parameter " + in_quotes(names_.all()[static_cast<std::size_t>(index)]);
  definition.source = definition.limit_source = &value.source();
  JsonValue number = value;
  if (value.is(JsonKind::object)) {
    for (const JsonMember member : value.members()) {
      if (std::find(keys.begin(), keys.end(), member.name()) != keys.end()) continue;
      diagnostics.error(value.source(), member.key.offset(),
                        fmt::format("unknown key {} in {}{}", in_quotes(member.name()), owner,
                                    NearMiss(member.name()).consider_all(keys).hint()));
    }
    number = value.find("value");
    if (!number) {
      diagnostics.error(value.source(), value.offset(), owner + " needs a \"value\"");
      return;
    }
  }
  definition.value = reader.read(number, ExpectedDimension(), {"value", owner});
  const std::optional<Dimension> dimension = reader.dimension();
  names_.set_dimension(index, dimension);
  if (!value.is(JsonKind::object)) return;
  if (const JsonValue least = value.find("min")) definition.least = reader.read(least, dimension, {"min", owner});
  if (const JsonValue most = value.find("max")) definition.greatest = reader.read(most, dimension, {"max", owner});
}

void ParameterTable::set(const JsonValue& object, ExpressionPool& pool, Diagnostics& diagnostics) {
  if (!object.is(JsonKind::object)) {
    diagnostics.error(
        object.source(), object.offset(),
        fmt::format("\"set\" must be an object of parameters and numbers; this is {}", describe(object.kind())));
    return;
  }
  NumberReader reader(names_, pool, diagnostics);
  for (const JsonMember member : object.members()) {
    const int index = names_.find(member.name());
    if (index < 0) {
      diagnostics.error(object.source(), member.key.offset(),
                        fmt::format("unknown parameter {}{}", in_quotes(member.name()),
                                    NearMiss(member.name()).consider_all(names_.all()).hint()));
      continue;
    }
    // A parameter keeps its unit: fields that refer to it were checked against that.
    Definition& definition = definitions_[static_cast<std::size_t>(index)];
    const std::string owner = "parameter " + in_quotes(member.name());
    definition.value = reader.read(member.value, names_.dimension_of_value(index), {"value", owner});
    definition.source = &member.value.source();
  }
  find_order(pool, diagnostics);
}

std::vector<int> ParameterTable::needs(int index, const ExpressionPool& pool) const {
  const NumberValue& value = definitions_[static_cast<std::size_t>(index)].value;
  std::vector<int> found;
  const auto collect = [&](const NumberValue& number) {
    if (number.kind() == NumberValue::Kind::parameter) found.push_back(static_cast<int>(number.index()));
    if (number.kind() != NumberValue::Kind::expression) return;
    for (const Instruction& instruction : pool[number.index()].code()) {
      if (instruction.operation == Operation::parameter) found.push_back(static_cast<int>(instruction.index));
    }
  };
  collect(value);
  for (const int used : used_tables(index, pool)) {
    for (const NumberValue& number : tables_[static_cast<std::size_t>(used)].x) collect(number);
    for (const NumberValue& number : tables_[static_cast<std::size_t>(used)].y) collect(number);
  }
  return found;
}

std::vector<int> ParameterTable::used_tables(int index, const ExpressionPool& pool) const {
  const NumberValue& value = definitions_[static_cast<std::size_t>(index)].value;
  std::vector<int> found;
  if (tables_.empty() || value.kind() != NumberValue::Kind::expression) return found;
  for (const Instruction& instruction : pool[value.index()].code()) {
    if (instruction.operation == Operation::table) found.push_back(static_cast<int>(instruction.index));
  }
  return found;
}

// Depth-first search with a stack of its own: a chain of definitions may be as long as the list.
void ParameterTable::find_order(const ExpressionPool& pool, Diagnostics& diagnostics) {
  enum class State : char { fresh, open, done, in_circle };
  struct Visit {
    int index;
    std::vector<int> needs;
    std::size_t next = 0;
  };
  std::vector<State> state(definitions_.size(), State::fresh);
  std::vector<Visit> path;
  order_.clear();
  for (int start = 0; start < static_cast<int>(definitions_.size()); ++start) {
    if (state[static_cast<std::size_t>(start)] != State::fresh) continue;
    path.push_back({start, needs(start, pool)});
    state[static_cast<std::size_t>(start)] = State::open;
    while (!path.empty()) {
      Visit& visit = path.back();
      State& mine = state[static_cast<std::size_t>(visit.index)];
      if (visit.next == visit.needs.size()) {
        if (mine == State::open) {
          mine = State::done;
          order_.push_back(visit.index);
        }
        path.pop_back();
        continue;
      }
      const int needed = visit.needs[visit.next++];
      State& theirs = state[static_cast<std::size_t>(needed)];
      if (theirs == State::fresh) {
        theirs = State::open;
        path.push_back({needed, needs(needed, pool)});
      } else if (theirs == State::open) {
        std::vector<int> circle;
        auto member = path.end();
        do {
          --member;
          circle.insert(circle.begin(), member->index);
          state[static_cast<std::size_t>(member->index)] = State::in_circle;
        } while (member->index != needed);
        report_circle(circle, diagnostics);
      }
    }
  }
}

void ParameterTable::report_circle(std::span<const int> circle, Diagnostics& diagnostics) const {
  constexpr std::size_t longest = 20;
  std::string chain;
  for (std::size_t i = 0; i < std::min(circle.size(), longest); ++i) {
    chain += names_.all()[static_cast<std::size_t>(circle[i])] + " -> ";
  }
  if (circle.size() > longest) chain += "... -> ";
  const Definition& first = definitions_[static_cast<std::size_t>(circle[0])];
  diagnostics.error(
      *first.source, first.value.offset(),
      "parameters depend on each other in a circle: " + chain + names_.all()[static_cast<std::size_t>(circle[0])]);
}

std::pair<double, double> ParameterTable::limits(int index, const ExpressionPool& pool,
                                                 std::span<const double> values) const {
  const Definition& definition = definitions_[static_cast<std::size_t>(index)];
  const auto limit = [&](const std::optional<NumberValue>& number, double none) {
    try {
      return number ? catena::evaluate<double>(*number, pool, values, {}, tables<double>(pool, values)) : none;
    } catch (const ExpressionError&) {
      return none;  // reported where the values were checked
    }
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {limit(definition.least, -infinity), limit(definition.greatest, infinity)};
}

bool ParameterTable::check_limits(int index, double value, std::span<const double> values, const ExpressionPool& pool,
                                  Diagnostics& diagnostics) const {
  const Definition& definition = definitions_[static_cast<std::size_t>(index)];
  const auto limit = [&](const std::optional<NumberValue>& number, double none) {
    if (!number) return none;
    try {
      return catena::evaluate<double>(*number, pool, values, {}, tables<double>(pool, values));
    } catch (const ExpressionError& error) {
      report(error, *number, *definition.limit_source, diagnostics);
      return none;
    }
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double least = limit(definition.least, -infinity), greatest = limit(definition.greatest, infinity);
  const bool below = value < least;
  if (!below && !(value > greatest)) return true;
  diagnostics.error(*definition.source, definition.value.offset(),
                    fmt::format("parameter {} is {}, {} {}", in_quotes(names_.all()[static_cast<std::size_t>(index)]),
                                value, below ? "less than its min" : "more than its max", below ? least : greatest));
  return false;
}

void ParameterTable::report(const ExpressionError& error, const NumberValue& value, const SourceText& source,
                            Diagnostics& diagnostics) {
  // One byte more for the "=" before the expression.
  report_evaluation(source, value.offset(), error.position + 1, error.what(), {}, {}, diagnostics);
}

}  // namespace catena
