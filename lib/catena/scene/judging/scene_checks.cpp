#include "catena/scene/judging/scene_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catena/columns/own_columns.hpp"
#include "catena/model/joint_damping.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

/// For a "did you mean": names of at most some thousand elements.
std::vector<std::string> element_names(const Model& model) {
  std::vector<std::string> names;
  for (int e = 0; e < static_cast<int>(std::min<std::size_t>(model.elements.size(), 2000)); ++e)
    names.push_back(model.element_name(e));
  return names;
}

}  // namespace

// The names of columns are checked once the model is there; with errors before, half of it may be missing.
void SceneChecks::check_columns(const std::vector<PlacedName>& names) {
  std::vector<NamedColumn> found;
  for (const PlacedName& placed : names) {
    found.clear();
    const std::optional<UnknownColumn> unknown = find_columns(model_, placed.name, found);
    if (!unknown || diagnostics_.full() || diagnostics_.reported(placed.place.source(), placed.place.offset()))
      continue;
    diagnostics_.error(placed.place.source(), placed.place.offset(),
                       fmt::format("unknown column {}: {}{}", in_quotes(placed.name), unknown->message,
                                   NearMiss(placed.name).consider_all(unknown->candidates).hint()));
  }
}

// Formulas name columns, and may do so in a circle.
void SceneChecks::check_own_columns() {
  std::vector<NamedColumn> found;
  const auto in_text = [](const JsonValue& text, std::size_t position) {
    return text.source().offset_in_string(text.offset(), position + 1);  // one byte for the "=" before it
  };
  for (const OwnColumnTemplate& column : scene_.own_columns) {
    if (model_.names.find(column.name) >= 0) {
      report(column.place, fmt::format("the name {} is used twice: a body or element has it", in_quotes(column.name)),
             diagnostics_);
    }
    for (const NamedInput& input : column.inputs) {
      found.clear();
      const std::optional<UnknownColumn> unknown = find_columns(model_, input.name, found);
      if (!unknown && found.size() == 1) continue;
      // In a repeated block a place is reported once.
      if (diagnostics_.reported(column.place.source(), in_text(column.place, input.position))) continue;
      std::string message = unknown
                                ? fmt::format("unknown column {}: {}{}", in_quotes(input.name), unknown->message,
                                              NearMiss(input.name).consider_all(unknown->candidates).hint())
                                : fmt::format("{} stands for {} columns; an expression wants one, such as {}",
                                              in_quotes(input.name), found.size(), in_quotes(found.front().info.name));
      if (unknown && input.name.find('.') == std::string::npos) {
        const std::string hint = NearMiss(input.name).consider_all(scene_.parameters.names().all()).hint();
        message = fmt::format("there is no column or parameter {}{}", in_quotes(input.name),
                              hint.empty() ? NearMiss(input.name).consider_all(unknown->candidates).hint() : hint);
      }
      diagnostics_.error(column.place.source(), in_text(column.place, input.position), std::move(message));
    }
  }
  if (!diagnostics_.ok()) return;
  OwnInputs inputs(model_.own_columns.size());
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const std::optional<UnknownColumn> circle = find_own_inputs(model_, static_cast<int>(k), inputs);
    if (!circle) continue;
    report(scene_.own_columns[k].place, circle->message, diagnostics_);
    return;
  }
}

void SceneChecks::check_measure(const PlacedMeasure& measure) {
  check_columns(measure.columns);
  std::vector<NamedColumn> found;
  for (const PlacedName& column : measure.columns) {
    found.clear();
    if (find_columns(model_, column.name, found) || found.size() == 1) continue;
    report(column.place,
           fmt::format("a measure wants one column; {} stands for {} of them, such as {}", in_quotes(column.name),
                       found.size(), in_quotes(found.front().info.name)),
           diagnostics_);
  }
}

void SceneChecks::check_event(const EventRequest& event) {
  // In a repeated block a place is reported once.
  for (const JsonValue& place :
       {event.place, event.value_place, event.element_place, event.impulse ? event.impulse->place : JsonValue()}) {
    if (place && diagnostics_.reported(place.source(), place.offset())) return;
  }
  check_columns({{event.column, event.place}});
  std::vector<NamedColumn> found;
  if (!find_columns(model_, event.column, found) && found.size() > 1) {
    report(event.place,
           fmt::format("\"when\" of an event wants one column; {} stands for {} of them, such as {}",
                       in_quotes(event.column), found.size(), in_quotes(found.front().info.name)),
           diagnostics_);
  }
  if (found.size() == 1) check_event_value(event, found.front().info);
  if (event.impulse) check_impulse(*event.impulse);
  if (event.element.empty()) return;
  const int element = model_.find_element(event.element);
  if (element < 0) {
    report(event.element_place,
           fmt::format("there is no constraint {} to release or engage{}", in_quotes(event.element),
                       NearMiss(event.element).consider_all(element_names(model_)).hint()),
           diagnostics_);
  } else if (const ElementKind kind = model_.elements[static_cast<std::size_t>(element)].kind;
             kind == ElementKind::force || kind == ElementKind::gap) {
    report(event.element_place,
           fmt::format("{} is a force; only constraints and drivers are released or engaged", in_quotes(event.element)),
           diagnostics_);
  } else if (has_damping(model_, element)) {
    report(
        event.element_place,
        fmt::format("{} has damping \"c\", which would go on without it: a joint that is released or engaged may not "
                    "have any; give the bodies a bushing instead",
                    in_quotes(event.element)),
        diagnostics_);
  }
}

// The unit of a formula is not known.
void SceneChecks::check_event_value(const EventRequest& event, const ColumnInfo& column) {
  if (!event.value_dimension || column.unit == UnitKind::own) return;
  const Dimension wanted = dimension_of(column.unit);
  if (*event.value_dimension == wanted) return;
  report(event.value_place,
         fmt::format("\"value\" of an event that watches {} must be {}, for example {}; this is {}",
                     in_quotes(event.column), describe(wanted), example(wanted), describe(*event.value_dimension)),
         diagnostics_);
}

void SceneChecks::check_impulse(const EventRequest::Impulse& impulse) {
  const int body = model_.find_body(impulse.body);
  if (body < 0) {
    NearMiss near(impulse.body);
    for (const auto& known : model_.bodies) near.consider(model_.names[known.name]);
    report(impulse.place,
           body == ground ? std::string("an impulse acts on a body, not on the ground")
                          : fmt::format("there is no body {} to strike{}", in_quotes(impulse.body), near.hint()),
           diagnostics_);
  } else if (!impulse.point.empty() && !model_.find_point(body, impulse.point)) {
    report(impulse.place, fmt::format("body {} has no point {}", in_quotes(impulse.body), in_quotes(impulse.point)),
           diagnostics_);
  }
}

// Of the analysis itself, not of those inside of it: they may be of another model.
void SceneChecks::check_task(const AnalysisTask& task) {
  check_columns(task.outputs);
  for (const EventRequest& event : task.events) check_event(event);
  for (const PlacedMeasure& measure : task.measures) check_measure(measure);
}

}  // namespace catena
