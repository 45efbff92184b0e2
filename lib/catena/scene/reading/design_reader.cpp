// Sensitivity and optimisation: the analyses inside, parameters, goals.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/evaluation.hpp"
#include "catena/scene/reading/analysis_reader.hpp"

namespace catena {
namespace {

bool can_be_inside(std::string_view type) {
  return type == "kinematics" || type == "inverse_dynamics" || type == "dynamics" || type == "equilibrium" ||
         type == "path" || type == "buckling" || type == "modes" || type == "assemble";
}

/// The names of all measures of the analyses inside, in order.
std::vector<std::string> measure_names(const AnalysisTask& task) {
  std::vector<std::string> names;
  for (const AnalysisTask& inner : task.of) {
    for (const PlacedMeasure& measure : inner.measures) names.push_back(measure.request.name);
  }
  return names;
}

}  // namespace

void AnalysisReader::read_inner_analyses(const JsonValue& value, AnalysisTask& task) {
  const bool list = value.is(JsonKind::array);
  if (list && task.type() == "sensitivity") {
    error(value, "\"of\" of sensitivity is one analysis");
    return;
  }
  const auto read = [&](const JsonValue& object) {
    AnalysisReader reader(scene_, *task.table, diagnostics_);
    std::optional<AnalysisTask> inner = reader.read(object, scene_outputs_);
    if (!inner) return;
    if (!can_be_inside(inner->type())) {
      error(object, fmt::format("{} cannot stand in \"of\": it takes analyses of mechanisms", inner->type()));
      return;
    }
    inner->set_parameters.insert(inner->set_parameters.end(), task.set_parameters.begin(), task.set_parameters.end());
    inner->changes_parameters = inner->changes_parameters || task.changes_parameters;
    task.of.push_back(std::move(*inner));
  };
  if (!list) return read(value);
  if (value.size() == 0) error(value, "\"of\" may not be an empty list");
  for (const JsonValue& object : value.elements()) read(object);
  const std::vector<std::string> names = measure_names(task);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), names[k]) !=
        names.begin() + static_cast<std::ptrdiff_t>(k))
      error(value, fmt::format("two analyses have a measure {}: give one another name", in_quotes(names[k])));
  }
}

void AnalysisReader::read_parameter_names(const JsonValue& list, AnalysisTask& task) {
  if (!list.is(JsonKind::array) || list.size() == 0) {
    error(list, "\"parameters\" must be a list of names of parameters");
    return;
  }
  for (const JsonValue& value : list.elements()) {
    const std::string_view name = read_string(value, {"parameters", task.type()}, diagnostics_);
    const int index = parameters_.names().find(name);
    if (value.is(JsonKind::string) && index < 0) {
      error(value, fmt::format("unknown parameter {}{}", in_quotes(name),
                               NearMiss(name).consider_all(parameters_.names().all()).hint()));
    }
    const auto& known = task.design_parameters;
    if (index >= 0 && std::find(known.begin(), known.end(), index) != known.end())
      error(value, fmt::format("parameter {} is listed twice", in_quotes(name)));
    else if (index >= 0)
      task.design_parameters.push_back(index);
  }
}

void AnalysisReader::read_variables(const JsonValue& object, AnalysisTask& task) {
  if (!object.is(JsonKind::object) || object.size() == 0) {
    error(object,
          "\"variables\" must be an object of parameters, each with its bounds: {\"a\": {\"min\": 0.1, \"max\": 1}}");
    return;
  }
  for (const JsonMember member : object.members()) read_variable(member, task);
}

void AnalysisReader::read_variable(const JsonMember& member, AnalysisTask& task) {
  constexpr std::array<std::string_view, 3> keys{"min", "max", "start"};
  const int index = parameters_.names().find(member.name());
  if (index < 0) {
    error(member.key, fmt::format("unknown parameter {}{}", in_quotes(member.name()),
                                  NearMiss(member.name()).consider_all(parameters_.names().all()).hint()));
    return;
  }
  const std::string owner = "variable " + in_quotes(member.name());
  std::array<JsonValue, keys.size()> v;
  if (!read_members(member.value, keys, owner, v, diagnostics_)) return;
  DesignVariable variable;
  variable.parameter = index;
  const std::optional<Dimension>& dimension = parameters_.names().dimension_of_value(index);
  const Evaluation<double> evaluation(member.value.source(), scene_.expressions, values_, diagnostics_, tables());
  const auto [least, greatest] = task.table->limits(index, scene_.expressions, values_);
  const auto take = [&](const JsonValue& value, std::string_view key, double otherwise) {
    return value ? evaluation(reading_.numbers.read(value, dimension, {key, owner})) : otherwise;
  };
  variable.least = take(v[0], "min", least);
  variable.greatest = take(v[1], "max", greatest);
  variable.start = take(v[2], "start", values_[static_cast<std::size_t>(index)]);
  if (!std::isfinite(variable.least) || !std::isfinite(variable.greatest)) {
    error(member.value, fmt::format("{} needs \"min\" and \"max\": the parameter has none of its own", owner));
  } else if (!(variable.least < variable.greatest)) {
    error(v[0] ? v[0] : member.value,
          fmt::format("{}: its min {} is not below its max {}", owner, variable.least, variable.greatest));
  } else if (variable.start < variable.least || variable.start > variable.greatest) {
    error(v[2] ? v[2] : member.value, fmt::format("{} starts at {}, which is not within {} ... {}", owner,
                                                  variable.start, variable.least, variable.greatest));
  }
  task.goal.variables.push_back(variable);
}

bool AnalysisReader::read_formula(const JsonValue& value, std::size_t from, std::size_t to, const AnalysisTask& task,
                                  DesignFormula& formula) {
  std::vector<NamedInput> inputs;
  ExpressionScope scope{&parameters_.names()};
  scope.columns = &inputs;
  const auto wrong = [&](std::size_t position, std::string message) {
    diagnostics_.error(value.source(), value.source().offset_in_string(value.offset(), from + position),
                       std::move(message));
    return false;
  };
  Parsed<Expression> expression = Expression::parse(value.text().substr(from, to - from), scope);
  if (!expression) return wrong(expression.error.position, expression.error.message);
  const std::vector<std::string> names = measure_names(task);
  for (const NamedInput& input : inputs) {
    const auto found = std::find(names.begin(), names.end(), input.name);
    if (found == names.end()) {
      return wrong(
          input.position,
          fmt::format("there is no measure or parameter {}{}", in_quotes(input.name),
                      NearMiss(input.name).consider_all(names).consider_all(parameters_.names().all()).hint()));
    }
    formula.measures.push_back(static_cast<int>(found - names.begin()));
  }
  formula.expression = std::move(*expression);
  return true;
}

void AnalysisReader::read_objective(const JsonValue& value, AnalysisTask& task) {
  if (!value.is(JsonKind::string) || value.text().empty()) {
    error(value, "the objective must be the name of a measure, or an expression that begins with =");
    return;
  }
  read_formula(value, value.text().starts_with('=') ? 1 : 0, value.text().size(), task, task.goal.objective);
}

void AnalysisReader::read_relations(const JsonValue& list, AnalysisTask& task) {
  if (!list.is(JsonKind::array)) {
    error(list, "\"subject_to\" must be a list of relations, such as \"=reach >= 0.3\"");
    return;
  }
  for (const JsonValue& value : list.elements()) read_relation(value, task);
}

void AnalysisReader::read_relation(const JsonValue& value, AnalysisTask& task) {
  const std::string_view text = value.is(JsonKind::string) ? value.text() : std::string_view();
  std::size_t sign = std::string_view::npos;
  for (const std::string_view relation : {"<=", ">=", "=="}) {
    const std::size_t place = text.find(relation, 1);
    if (place != std::string_view::npos) sign = place;
  }
  if (!text.starts_with('=') || sign == std::string_view::npos) {
    error(value, "a relation is an expression with <=, >= or == in it: \"=reach >= 0.3\"");
    return;
  }
  DesignRelation relation;
  relation.text = text.substr(1);
  relation.equality = text[sign] == '=';
  DesignFormula left, right;
  if (!read_formula(value, 1, sign, task, left) || !read_formula(value, sign + 2, text.size(), task, right)) return;
  const bool at_most = text[sign] != '>';
  relation.left = at_most ? std::move(left) : std::move(right);
  relation.right = at_most ? std::move(right) : std::move(left);
  task.goal.relations.push_back(std::move(relation));
}

bool AnalysisReader::varies(const DesignFormula& formula, const AnalysisTask& task) const {
  if (!formula.measures.empty()) return true;
  std::vector<char> seen(parameters_.names().size(), 0);
  std::vector<int> todo;
  // Whether an expression uses a table, whose entries may depend on anything; its parameters are looked at next.
  const auto uses_table = [&](const Expression& expression) {
    bool table = false;
    for (const Instruction& instruction : expression.code()) {
      table = table || instruction.operation == Operation::table;
      if (instruction.operation == Operation::parameter) todo.push_back(static_cast<int>(instruction.index));
    }
    return table;
  };
  if (uses_table(formula.expression)) return true;
  while (!todo.empty()) {
    const int index = todo.back();
    todo.pop_back();
    if (std::exchange(seen[static_cast<std::size_t>(index)], 1)) continue;
    for (const DesignVariable& variable : task.goal.variables) {
      if (variable.parameter == index) return true;
    }
    const NumberValue& value = task.table->definition(index);
    if (value.kind() == NumberValue::Kind::parameter) todo.push_back(static_cast<int>(value.index()));
    if (value.kind() == NumberValue::Kind::expression && uses_table(scene_.expressions[value.index()])) return true;
  }
  return false;
}

void AnalysisReader::check_design(const JsonValue& object, const AnalysisTask& task) {
  const JsonValue least = object.find("minimise"), most = object.find("maximise");
  if (static_cast<bool>(least) == static_cast<bool>(most)) {
    error(object, "optimise needs \"minimise\" or \"maximise\", one of them");
    return;
  }
  const DesignGoal& goal = task.goal;
  if (!diagnostics_.ok() || goal.variables.empty()) return;
  if (!varies(goal.objective, task))
    error(least ? least : most, "the objective is the same for every design: no measure and no variable is in it");
  const JsonValue list = object.find("subject_to");
  if (!list) return;
  std::size_t k = 0;
  for (const JsonValue& relation : list.elements()) {
    const bool any = varies(goal.relations[k].left, task) || varies(goal.relations[k].right, task);
    if (!any) error(relation, "this relation is the same for every design: no measure and no variable is in it");
    ++k;
  }
}

}  // namespace catena
