#include "catena/analysis/events/first_actions.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catena {

FirstActions first_actions(std::span<const Event> events, const Model& model) {
  FirstActions first;
  for (std::size_t k = 0; k < events.size(); ++k) {
    const Event& event = events[k];
    if (event.action != EventAction::release && event.action != EventAction::engage) continue;
    const bool is_first =
        std::find(first.acted_on.begin(), first.acted_on.end(), event.element) == first.acted_on.end();
    first.acted_on.push_back(event.element);
    if (event.action != EventAction::engage || !is_first || event.is_held) continue;
    first.released.push_back(event.element);
    const auto releases = std::find_if(events.begin(), events.end(), [&](const Event& other) {
      return other.action == EventAction::release && other.element == event.element;
    });
    if (releases == events.end()) continue;
    first.ambiguous.push_back(fmt::format(
        "\"{}\" does not hold from the start, since event \"{}\" engages it and stands before \"{}\", which "
        "releases it; if it is to hold, put \"{}\" first in the list",
        model.element_name(event.element), event.name, releases->name, releases->name));
  }
  return first;
}

std::vector<int> held_by_events(std::span<const Event> events, const std::vector<int>& released,
                                const std::vector<int>& before) {
  std::vector<int> held = before;
  for (const Event& event : events) {
    if (event.action == EventAction::release || event.action == EventAction::engage) held.push_back(event.element);
  }
  std::erase_if(held, [&](int e) { return std::find(released.begin(), released.end(), e) != released.end(); });
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return held;
}

}  // namespace catena
