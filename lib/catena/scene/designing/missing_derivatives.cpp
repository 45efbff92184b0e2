#include "catena/scene/designing/missing_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

/// Whether the results depend on where the analysis starts, and not only on the parameters. Driven motions and
/// equilibria find their own place; the modes of an equilibrium are differentiated with its place.
bool depends_on_start(std::string_view type, std::string_view before) {
  if (before.empty()) return false;
  if (type == "modes") return before != "equilibrium" && before != "path";
  return type == "dynamics" || type == "assemble";
}

/// Whether the instant of the first row moves, or one beside another, and the measure with it. A run begins at 0, or at
/// its first instant if that lies before.
bool begins_with(const AnalysisTask& task, const TaskNumber& number, const MeasureResult& measure) {
  const auto is_own = [&](const PlacedMeasure& placed) { return placed.request.name == measure.name; };
  const auto own = std::find_if(task.measures.begin(), task.measures.end(), is_own);
  if (own == task.measures.end() || !task.at || number.item >= task.at->size()) return true;
  const double t = (*task.at)[number.item];
  const auto as = [&](auto&& compare) { return std::count_if(task.at->begin(), task.at->end(), compare); };
  const bool first = as([&](double other) { return other <= t; }) == 1;
  const bool alone = as([&](double other) { return other == t; }) == 1;
  return !alone || (first && (t < 0 || own->request.kind == MeasureKind::first));
}

bool records_or_stops(const AnalysisTask& task, const TaskNumber& number) {
  const EventRequest& event = task.events[number.item];
  constexpr int record_action = 0, stop_action = 1;
  return !event.impulse && (event.action == record_action || event.action == stop_action);
}

bool is_instant_of_event(const AnalysisTask& task, const MeasureResult& measure) {
  return std::any_of(task.measures.begin(), task.measures.end(), [&](const PlacedMeasure& placed) {
    return placed.request.name == measure.name && placed.request.field == "events" && placed.request.part == "t";
  });
}

/// Whether what follows from the number is in the measure's gradient already, or the measure does not depend on it.
bool is_in_gradient(const AnalysisTask& task, const TaskNumber& number, const MeasureResult& measure) {
  if (measure.of_rows_alone) return false;
  // analysis_rows.cpp adds what a moving instant makes of it, or takes it out.
  using Place = TaskNumber::Place;
  if (number.place == Place::measured_instant || number.place == Place::path_point) return true;
  if (number.place == Place::instant) return task.description->timed && !begins_with(task, number, measure);
  // Events that are recorded leave the motion alone; one that stopped it is in the instant at which the run ended, one
  // that acted in the motion. Of fields the instants of events have derivatives, by what moves these.
  const bool is_field = std::isnan(measure.by_last_instant);
  if (task.type() != "dynamics") return number.place == Place::event && records_or_stops(task, number) && !is_field;
  const bool of_event =
      number.place == Place::event || number.place == Place::impulse || number.place == Place::struck_point;
  return of_event && (!is_field || is_instant_of_event(task, measure));
}

}  // namespace

void MissingDerivatives::take_out(MeasureResult& measure, std::size_t parameter, const std::string& why,
                                  AnalysisResult& result) const {
  measure.gradient.resize(design_.parameters.size(), std::numeric_limits<double>::quiet_NaN());
  measure.gradient[parameter] = std::numeric_limits<double>::quiet_NaN();
  if (!measure.trouble.empty()) return;
  measure.trouble = why;
  result.report.warnings.push_back(fmt::format("measure \"{}\": {}", measure.name, why));
}

void MissingDerivatives::complete(const AnalysisTask& task, const ParameterSeeds& seeds, AnalysisResult& result) const {
  const auto moving = models_.moving_numbers(task, seeds, design_.parameters);
  for (std::size_t p = 0; p < moving.size(); ++p) {
    for (MeasureResult& measure : result.measures) {
      if (depends_on_start(task.type(), before_)) {
        take_out(measure, p,
                 fmt::format("{} goes on from the end of {}, which moves with the parameters: such derivatives are not "
                             "built; give it \"from\": \"initial\" if it may start from the scene",
                             task.type(), before_),
                 result);
      } else if (!why_[p].empty()) {
        take_out(measure, p, why_[p], result);
      }
      for (const SceneModels::MovingNumber& one : moving[p]) {
        const TaskNumber& number = one.number;
        if (is_in_gradient(task, number, measure)) continue;
        if (number.is_of_measure() && task.measures[number.item].request.name != measure.name) continue;
        const std::string_view key = number.place == TaskNumber::Place::key ? number.key->name : std::string_view();
        if (key == "every" && !measure.of_rows_alone) continue;
        if (key == "until" && std::isfinite(measure.by_last_instant) && p < measure.gradient.size()) {
          measure.gradient[p] += measure.by_last_instant * one.rate;
          continue;
        }
        take_out(measure, p,
                 fmt::format("{} of {} depends on \"{}\", and the derivative of this measure by it is not built",
                             number.name(), task.type(), design_.names[p]),
                 result);
      }
    }
  }
  // No measure is without a derivative and without a reason.
  for (MeasureResult& measure : result.measures) {
    for (std::size_t p = 0; p < measure.gradient.size() && measure.trouble.empty(); ++p) {
      if (std::isnan(measure.gradient[p]))
        take_out(measure, p, fmt::format("the derivative of what {} reports here is not built", task.type()), result);
    }
  }
}

void MissingDerivatives::go_on_from(const AnalysisTask& task, const ParameterSeeds& seeds,
                                    const ParameterSeeds& values_at_end) {
  before_ = task.type();
  const auto moving = models_.moving_numbers(task, seeds, design_.parameters);
  // A path that did not end where it was told to ended at a point of its own, which the parameters move.
  bool ends_by_itself = false;
  for (const ParameterSeed<double>& value : values_at_end)
    ends_by_itself = ends_by_itself || value.value != task.number("to", value.value);
  for (std::size_t p = 0; p < why_.size(); ++p) {
    if (!moving[p].empty())
      why_[p] =
          fmt::format("{} of the {} before depends on \"{}\": derivatives of what goes on from there are not built",
                      moving[p].front().number.name(), task.type(), design_.names[p]);
    else if (ends_by_itself)
      why_[p] = fmt::format(
          "the {} before ended before its parameter had reached \"to\", at a value that moves with the "
          "parameters: derivatives of what goes on from there are not built",
          task.type());
  }
}

void MissingDerivatives::start_anew() {
  before_.clear();
  why_.assign(why_.size(), {});
}

}  // namespace catena
