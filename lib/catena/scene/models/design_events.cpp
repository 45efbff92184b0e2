#include "catena/scene/models/design_events.hpp"

#include <algorithm>

#include "catena/analysis/events/event_watch.hpp"

namespace catena {
namespace {

/// A number of the task with derivatives by the parameters of a group.
template <class IsMeant>
DesignScalar lifted_number(double value, const std::vector<std::vector<SceneModels::MovingNumber>>& moving,
                           std::size_t group, IsMeant&& is_meant) {
  DesignScalar result(value);
  for (std::size_t p = 0; p < static_cast<std::size_t>(parameters_at_once); ++p) {
    const std::size_t k = group * static_cast<std::size_t>(parameters_at_once) + p;
    if (k >= moving.size()) break;
    for (const SceneModels::MovingNumber& one : moving[k]) {
      if (is_meant(one.number)) result.d[p] += one.rate;
    }
  }
  return result;
}

DesignStrike strike_with_derivatives(const EventRequest::Impulse& impulse, std::size_t event, std::size_t group,
                                     const DesignModel& model,
                                     const std::vector<std::vector<SceneModels::MovingNumber>>& moving) {
  const auto pair = [&](const std::array<double, 2>& values, TaskNumber::Place place) {
    const auto part = [&](std::size_t n) {
      return lifted_number(values[n], moving, group, [&](const TaskNumber& number) {
        return number.place == place && number.item == event && number.part == n;
      });
    };
    return Vec2<DesignScalar>{part(0), part(1)};
  };
  DesignStrike strike;
  strike.body = model.find_body(impulse.body);
  const Vec2<DesignScalar>* const named =
      impulse.point.empty() ? nullptr : model.find_point(strike.body, impulse.point);
  const Vec2<DesignScalar> origin = model.bodies[static_cast<std::size_t>(strike.body)].origin;
  strike.point = named ? *named : origin + pair(impulse.local, TaskNumber::Place::struck_point);
  strike.impulse = pair(impulse.value, TaskNumber::Place::impulse);
  return strike;
}

}  // namespace

bool acts(const EventRequest& event) {
  const auto action = static_cast<EventAction>(event.action);
  return event.impulse || action == EventAction::release || action == EventAction::engage;
}

bool reads_events(const PlacedMeasure& measure) {
  return measure.request.kind == MeasureKind::field && measure.request.field == "events";
}

PhasedDesign phased_design(const DesignModels& designs, const std::vector<double>& sizes, const AnalysisTask& task,
                           const std::vector<std::vector<SceneModels::MovingNumber>>& moving,
                           const std::shared_ptr<const Model>& model, const PlanOptions& options, const Plan& plan,
                           const ColumnSources& sources) {
  PhasedDesign design;
  design.contacts = contact_points(model);
  design.sizes = sizes;
  design.parameters = static_cast<int>(moving.size());
  for (const std::shared_ptr<const DesignModel>& one : designs)
    design.models.push_back(with_slides(one, design.contacts));
  PlanOptions all = options;
  std::vector<int> released;
  ColumnSources untimed = sources;
  untimed.timed = false;
  for (std::size_t e = 0; e < task.events.size(); ++e) {
    const EventRequest& request = task.events[e];
    if (acts(request) && !request.impulse) {
      const int element = model->find_element(request.element);
      all.keep_elements.push_back(element);
      if (static_cast<EventAction>(request.action) == EventAction::engage) released.push_back(element);
    }
    const std::string name[] = {request.column};
    DesignEvent event{ColumnSet::resolve(*design.contacts.model, plan, name, untimed), request.value, {}, {}};
    for (std::size_t p = 0; p < moving.size(); ++p) {
      double rate = 0;
      for (const SceneModels::MovingNumber& one : moving[p])
        rate += one.number.place == TaskNumber::Place::event && one.number.item == e ? one.rate : 0;
      event.value_rate.push_back(rate);
    }
    for (std::size_t k = 0; request.impulse && k < design.models.size(); ++k)
      event.strikes.push_back(strike_with_derivatives(*request.impulse, e, k, *design.models[k], moving));
    design.events.push_back(std::move(event));
  }
  all.one_sided = all.friction = true;
  for (const ContactPoint& point : design.contacts.points) {
    all.keep_elements.push_back(point.kind == ContactKind::joint ? point.joint : point.element);
    if (point.has_friction()) all.keep_elements.push_back(point.slide);
  }
  design.all_rows = design.open_rows = all;
  for (const ContactPoint& point : design.contacts.points) {
    if (point.kind != ContactKind::joint) released.push_back(point.element);
    if (point.has_friction()) released.push_back(point.slide);
  }
  for (const int friction : model->frictions()) {
    released.push_back(friction);
    const bool is_place = std::any_of(design.contacts.points.begin(), design.contacts.points.end(),
                                      [&](const ContactPoint& point) { return point.element == friction; });
    if (!is_place) design.all_rows.released_elements.push_back(friction);
  }
  design.open_rows.released_elements = released;
  return design;
}

}  // namespace catena
