#include "catena/scene/running/event_entries.hpp"

#include <algorithm>

#include "catena/model/elastic_gaps.hpp"

namespace catena {
namespace {

Strike strike_of(const EventRequest::Impulse& impulse, const Model& model) {
  const int body = model.find_body(impulse.body);
  const Vec2<double>* const named = impulse.point.empty() ? nullptr : model.find_point(body, impulse.point);
  const Vec2<double> origin = model.bodies[static_cast<std::size_t>(body)].origin;
  return {body,
          named ? *named : origin + Vec2<double>{impulse.local[0], impulse.local[1]},
          {impulse.value[0], impulse.value[1]}};
}

/// The word of an event's action in the results.
std::string_view kind_of(const EventRequest& event) {
  if (event.impulse) return "impulse";
  const auto keys = event_keys();
  const auto action =
      std::find_if(keys.begin(), keys.end(), [](const AnalysisKey& key) { return key.name == "action"; });
  return action->words[static_cast<std::size_t>(event.action)];
}

}  // namespace

std::vector<Event> events_of(const AnalysisTask& task, const Model& model, const std::vector<int>& held) {
  // In the order of the keys' words.
  constexpr EventDirection directions[] = {EventDirection::any, EventDirection::up, EventDirection::down};
  constexpr EventAction actions[] = {EventAction::record, EventAction::stop, EventAction::release, EventAction::engage};
  std::vector<Event> events;
  for (const EventRequest& request : task.events) {
    events.push_back({request.name, request.column, request.value, directions[request.direction],
                      actions[request.action], request.element.empty() ? -1 : model.find_element(request.element)});
    Event& event = events.back();
    event.is_held = std::binary_search(held.begin(), held.end(), event.element);
    if (!request.impulse) continue;
    event.action = EventAction::strike;
    event.strike = strike_of(*request.impulse, model);
  }
  return events;
}

void EventEntries::add(const AnalysisTask& task, std::span<const EventRecord> records) {
  for (const EventRecord& record : records) {
    const EventRequest& request = task.events[static_cast<std::size_t>(record.event)];
    events_.push_back(
        {record.t,
         {{"name", record.name}, {"t", record.t}, {"row", record.row}, {"kind", std::string(kind_of(request))}}});
  }
}

void EventEntries::add(std::span<const ContactEvent> events) {
  for (const ContactEvent& event : events) {
    if (is_elastic_gap(model_, event.element)) continue;  // followed for its derivatives alone
    events_.push_back(
        {event.t, {{"name", model_.element_name(event.element)}, {"kind", std::string(event.kind)}, {"t", event.t}}});
  }
}

void EventEntries::add(std::span<const Jolt> jolts) {
  for (const Jolt& jolt : jolts) {
    std::string cause = jolt.event;
    for (const int driver : jolt.drivers) {
      const std::string name = model_.element_name(driver);
      events_.push_back({jolt.t, {{"name", name}, {"kind", std::string("jump")}, {"t", jolt.t}}});
      cause += (cause.empty() ? "" : ", ") + name;
    }
    for (const ConstraintImpulse& impulse : jolt.impulses) {
      FieldRecord record{{"element", model_.element_name(impulse.element)},
                         {"t", jolt.t},
                         {"event", cause},
                         {"px", impulse.x},
                         {"py", impulse.y},
                         {"moment", impulse.moment}};
      if (model_.elements[static_cast<std::size_t>(impulse.element)].kind == ElementKind::driver)
        record.emplace_back("load", impulse.load);
      impulses_.push_back(std::move(record));
    }
  }
}

void EventEntries::give(AnalysisResult& result, bool always) {
  if (!events_.empty() || always) {
    std::stable_sort(events_.begin(), events_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<FieldRecord> records;
    for (auto& [t, record] : events_) records.push_back(std::move(record));
    result.fields.push_back({"events", std::move(records)});
  }
  if (!impulses_.empty()) result.fields.push_back({"impulses", std::move(impulses_)});
}

}  // namespace catena
