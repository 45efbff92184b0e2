// Events of an analysis: from what a scene asks for to what an analysis watches, and from what happened to the entries
// of the results "events" and "impulses".
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/events/event_watch.hpp"
#include "catena/analysis/motion/impulses.hpp"
#include "catena/results/analysis_result.hpp"
#include "catena/scene/reading/analysis_task.hpp"

namespace catena {

/// The task's events, in its order; `held`: SystemState::held of where the motion begins.
std::vector<Event> events_of(const AnalysisTask& task, const Model& model, const std::vector<int>& held = {});

class EventEntries {
 public:
  explicit EventEntries(const Model& model) : model_(model) {}

  /// Events of the task; changes of contacts; jumps of velocities.
  void add(const AnalysisTask& task, std::span<const EventRecord> records);
  void add(std::span<const ContactEvent> events);
  void add(std::span<const Jolt> jolts);
  /// The field "events" by time, what is added first first where times are equal, also if it is empty where `always`;
  /// and "impulses" if there are some.
  void give(AnalysisResult& result, bool always);

 private:
  const Model& model_;
  std::vector<std::pair<double, FieldRecord>> events_;
  std::vector<FieldRecord> impulses_;
};

}  // namespace catena
