#include "catena/scene/models/given_designs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/scene/json/near_miss.hpp"

namespace catena {
namespace {

bool is_of_designs(const AnalysisTask& task) { return !task.of.empty(); }

/// The analyses that measures are taken of, and those from whose ends they go on.
std::vector<AnalysisTask> measured(std::vector<AnalysisTask>& tasks) {
  std::vector<AnalysisTask> kept;
  bool goes_on = false;
  for (auto task = tasks.rbegin(); task != tasks.rend(); ++task) {
    // `check` moves nothing.
    if (is_of_designs(*task) || task->type() == "check" || (task->measures.empty() && !goes_on)) continue;
    goes_on = !task->from_initial;
    kept.push_back(std::move(*task));
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

std::optional<std::string> wrong_names(const std::vector<std::string>& names, const ParameterNames& known) {
  if (names.empty()) return "the designs have no parameters: name one for each column of the table";
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (known.find(*name) < 0)
      return fmt::format("unknown parameter {}{}", in_quotes(*name), NearMiss(*name).consider_all(known.all()).hint());
    if (std::find(names.begin(), name, *name) != name)
      return fmt::format("the parameter {} is named twice", in_quotes(*name));
  }
  return {};
}

}  // namespace

std::optional<std::string> sweep_over_given(const std::vector<std::string>& names, std::span<const double> values,
                                            const ParameterTable& parameters, std::vector<AnalysisTask>& tasks) {
  const std::size_t width = names.size();
  if (auto why = wrong_names(names, parameters.names())) return why;
  if (values.size() % width != 0) return fmt::format("{} numbers are no table of {} columns", values.size(), width);
  const std::size_t count = values.size() / width;
  if (count == 0) return "there are no designs: the table has no rows";
  const auto odd = std::find_if_not(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  if (odd != values.end()) {
    const auto place = static_cast<std::size_t>(odd - values.begin());
    return fmt::format("design {}: parameter {} is {}, not a finite number", place / width,
                       in_quotes(names[place % width]), *odd);
  }
  AnalysisTask sweep;
  sweep.description = find_analysis_type("sweep");
  sweep.of = measured(tasks);
  if (sweep.of.empty()) return "no analysis of the scene has measures: there is nothing to be taken of its designs";
  sweep.from_initial = true;
  sweep.table = sweep.of.front().table;
  sweep.sweep.kind = SweepKind::together;
  for (std::size_t p = 0; p < width; ++p) {
    SweepRange range;
    range.parameter = parameters.names().find(names[p]);
    range.values.reserve(count);
    for (std::size_t k = 0; k < count; ++k) range.values.push_back(values[width * k + p]);
    sweep.sweep.over.push_back(std::move(range));
  }
  if (auto why = SweepPlan::trouble(sweep.sweep)) return why;
  tasks.clear();
  tasks.push_back(std::move(sweep));
  return {};
}

}  // namespace catena
