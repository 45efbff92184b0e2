#include "catena/scene/running/own_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace catena {
namespace {

template <class List, class NameOf>
bool has(const List& list, std::string_view name, NameOf&& name_of) {
  return std::any_of(list.begin(), list.end(), [&](const auto& entry) { return name_of(entry) == name; });
}

bool is_measure(const AnalysisTask& task, std::string_view name) {
  return has(task.measures, name, [](const PlacedMeasure& measure) { return measure.request.name; });
}

}  // namespace

std::optional<std::string> differentiated(const AnalysisTask& task, std::string_view name,
                                          const ParameterNames& parameters) {
  for (const int parameter : task.design_parameters) {
    const std::string end = fmt::format(")/d({})", parameters.all()[static_cast<std::size_t>(parameter)]);
    if (name.starts_with("d(") && name.ends_with(end)) return std::string(name.substr(2, name.size() - 2 - end.size()));
  }
  return {};
}

bool has_by_itself(const AnalysisTask& task, std::string_view name, const ParameterNames& parameters) {
  const std::string_view type = task.type();
  const int parameter = parameters.find(name);
  if (type == "path" || type == "buckling") return parameter >= 0 && task.word("parameter") == parameter;
  if (type == "modes")
    return has(std::array{"mode", "omega2", "omega"}, name, [](std::string_view own) { return own; });
  if (type == "sweep") {
    return name == "design" || name == "status" ||
           (parameter >= 0 && has(task.sweep.over, name,
                                  [&](const SweepRange& range) {
                                    return parameters.all()[static_cast<std::size_t>(range.parameter)];
                                  })) ||
           std::any_of(task.of.begin(), task.of.end(), [&](const auto& inner) { return is_measure(inner, name); });
  }
  if (type == "optimise") {
    return name == "objective" ||
           has(task.goal.relations, name, [](const DesignRelation& relation) { return relation.text; }) ||
           has(task.goal.variables, name, [&](const DesignVariable& variable) {
             return parameters.all()[static_cast<std::size_t>(variable.parameter)];
           });
  }
  // A wrong one may have no inner analysis.
  return type == "sensitivity" && !task.of.empty() && has_by_itself(task.of.front(), name, parameters);
}

std::optional<std::string> why_no_outputs(const std::vector<AnalysisTask>& tasks, const std::vector<std::string>& names,
                                          const ParameterNames& parameters) {
  const auto takes_columns = [](const AnalysisTask& task) { return task.description->find("outputs") != nullptr; };
  if (tasks.empty() || std::any_of(tasks.begin(), tasks.end(), takes_columns)) return {};
  for (const std::string& name : names) {
    const auto is_own = [&](const AnalysisTask& task) { return has_by_itself(task, name, parameters); };
    if (std::any_of(tasks.begin(), tasks.end(), is_own)) continue;
    const std::string_view type = tasks.front().type();
    return fmt::format("--outputs: {} gives no column \"{}\"{}", type, name,
                       type == "sweep" ? ": designs have their parameters, measures and status; a measure of its "
                                         "analysis, {\"final\": column}, makes a number of a column"
                                       : "");
  }
  return {};
}

}  // namespace catena
