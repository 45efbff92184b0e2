// The changes of a motion on which two runs of it must agree if their difference is to be the error of one: contacts
// that open, close, stick and slip, events of the list, velocities of drivers that jump.
//
// Two runs agree where every element, and every event, has the same changes in the same order. Changes of different
// elements may come in any order: those of parts that fall side by side do at one instant, to rounding.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/motion/impulses.hpp"
#include "catena/analysis/motion/motion_memory.hpp"

namespace catena {

struct MotionChange {
  std::string of;  ///< element or event, of this list
  std::string kind;
  double t = 0;
  bool jolts = false;    ///< velocities jump, not accelerations alone
  bool has_row = false;  ///< a row lies at it, with what holds before it
};

class MotionChanges {
 public:
  void add(const std::vector<ContactEvent>& events);
  void add(const std::vector<Jolt>& jolts);
  void add(const std::vector<EventRecord>& records);
  /// In an order that two runs that agree have in common.
  const std::vector<MotionChange>& all() const { return all_; }
  /// Puts them into that order.
  void sort();
  /// Changes of the one that has most of them.
  std::size_t most_of_one() const;
  /// The first place at which the two differ, in words; nothing: they agree. Both are sorted.
  std::string difference(const MotionChanges& other) const;

 private:
  std::vector<MotionChange> all_;
};

/// Of an analysis that is over, sorted: Dynamics, DynamicsWithEvents, DynamicsOfIslands.
template <class Analysis>
MotionChanges changes_of(const Analysis& analysis) {
  MotionChanges changes;
  if constexpr (requires { analysis.contact_events(); }) changes.add(analysis.contact_events());
  if constexpr (requires { analysis.records(); }) changes.add(analysis.records());
  changes.add(analysis.jolts());
  changes.sort();
  return changes;
}

}  // namespace catena
