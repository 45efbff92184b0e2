#include "catena/scene/reading/task_numbers.hpp"

#include <fmt/format.h>

#include <cmath>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/number_domain.hpp"

namespace catena {
namespace {

constexpr double most_rows = 1e9;

void set(AnalysisTask& task, const TaskNumber& number, double value) {
  switch (number.place) {
    case TaskNumber::Place::key:
      task.numbers[number.key->name] = value;
      break;
    case TaskNumber::Place::instant:
      (*task.at)[number.item] = value;
      break;
    case TaskNumber::Place::event:
      task.events[number.item].value = value;
      break;
    case TaskNumber::Place::struck_point:
      task.events[number.item].impulse->local[number.part] = value;
      break;
    case TaskNumber::Place::impulse:
      task.events[number.item].impulse->value[number.part] = value;
      break;
    case TaskNumber::Place::measured_instant:
      task.measures[number.item].request.at = value;
      break;
    case TaskNumber::Place::path_point:
      (number.part % 2 == 0 ? task.measures[number.item].request.points[number.part / 2].x
                            : task.measures[number.item].request.points[number.part / 2].y) = value;
      break;
    case TaskNumber::Place::fixed:
      break;
  }
}

}  // namespace

std::string TaskNumber::name() const {
  switch (place) {
    case Place::key:
    case Place::instant:
    case Place::fixed:
      return in_quotes(key->name);
    case Place::event:
      return fmt::format("\"value\" of event {}", item + 1);
    case Place::struck_point:
      return fmt::format("the point of the impulse of event {}", item + 1);
    case Place::impulse:
      return fmt::format("the impulse of event {}", item + 1);
    case Place::measured_instant:
      return fmt::format("\"at\" of measure {}", item + 1);
    case Place::path_point:
      return fmt::format("\"to\" of measure {}", item + 1);
  }
  return {};
}

std::optional<std::string> out_of_key(const AnalysisKey& key, double value) {
  if (key.kind == KeyKind::whole) {
    if (value >= 1 && value == std::round(value) && value <= 2e9) return {};
    return fmt::format("must be a whole number above zero; it is {}", value);
  }
  return fits(value, key.domain) ? std::nullopt : std::optional(out_of_domain(value, key.domain));
}

std::optional<std::string> too_many_rows(const AnalysisTask& task) {
  const double every = task.number("every", 0);
  if (!(every > 0) || !(task.number("until", 0) / every > most_rows)) return {};
  return fmt::format("{} would give more than {} rows", task.type(), most_rows);
}

std::optional<std::string> evaluate_numbers(AnalysisTask& task, const ExpressionPool& expressions,
                                            std::span<const double> parameters) {
  if (task.varying.empty()) return too_many_rows(task);
  const auto tables = task.table->tables<double>(expressions, parameters);
  for (const TaskNumber& number : task.varying) {
    double value = 0;
    try {
      value = evaluate<double>(number.value, expressions, parameters, number.loop_values, tables);
    } catch (const ExpressionError& error) {
      return fmt::format("{} of {}: {}", number.name(), task.type(), error.what());
    }
    if (!std::isfinite(value)) return fmt::format("{} of {} is not a number", number.name(), task.type());
    if (number.key) {
      if (const std::optional<std::string> why = out_of_key(*number.key, value))
        return fmt::format("{} of {} {}", number.name(), task.type(), *why);
    }
    if (number.place == TaskNumber::Place::fixed && value != number.as_read)
      return fmt::format(
          "{} of repeated events would become {}: their number may not change with a parameter that is "
          "swept, optimised or left behind by a path",
          number.name(), value);
    set(task, number, value);
  }
  return too_many_rows(task);
}

}  // namespace catena
