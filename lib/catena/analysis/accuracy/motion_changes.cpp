#include "catena/analysis/accuracy/motion_changes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catena {

void MotionChanges::add(const std::vector<ContactEvent>& events) {
  for (const ContactEvent& event : events) {
    const bool jolts = event.kind == "impact" || event.kind == "contact";
    all_.push_back({fmt::format("element {}", event.element), std::string(event.kind), event.t, jolts});
  }
}

void MotionChanges::add(const std::vector<Jolt>& jolts) {
  for (const Jolt& jolt : jolts) {
    for (const int driver : jolt.drivers) all_.push_back({fmt::format("element {}", driver), "jump", jolt.t, true});
    if (jolt.drivers.empty()) all_.push_back({"events " + jolt.event, "jump", jolt.t, true, true});
  }
}

// What an event does to velocities is told by its jolt.
void MotionChanges::add(const std::vector<EventRecord>& records) {
  for (const EventRecord& record : records)
    all_.push_back({fmt::format("event {}", record.event), "event", record.t, false, true});
}

void MotionChanges::sort() {
  std::stable_sort(all_.begin(), all_.end(), [](const MotionChange& a, const MotionChange& b) { return a.of < b.of; });
}

std::size_t MotionChanges::most_of_one() const {
  std::size_t most = 0, count = 0;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    count = k > 0 && all_[k].of == all_[k - 1].of ? count + 1 : 1;
    most = std::max(most, count);
  }
  return most;
}

std::string MotionChanges::difference(const MotionChanges& other) const {
  const std::size_t common = std::min(all_.size(), other.all_.size());
  std::size_t k = 0;
  while (k < common && all_[k].of == other.all_[k].of && all_[k].kind == other.all_[k].kind) ++k;
  if (k == all_.size() && k == other.all_.size()) return {};
  const MotionChange& change = k < all_.size() ? all_[k] : other.all_[k];
  return fmt::format("one of {} changes, the other of {}; first apart at t = {:.9g} s ({})", all_.size(),
                     other.all_.size(), change.t, change.kind);
}

}  // namespace catena
