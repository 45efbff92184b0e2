// What holds from the start where events release and engage constraints.
//
// An element that events only release holds until then, one that they only engage does not before. Of one that they do
// both to, the first of these events in the list tells: a lock that is opened and closes again holds from the start, a
// clutch that closes and is opened later does not. When an event happens is not known before the motion is. A motion
// that goes on where another one with such events ended begins with what that has left: a motion cut in two is the
// whole one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/analysis/events/event_watch.hpp"
#include "catena/model/model.hpp"

namespace catena {

struct FirstActions {
  std::vector<int> released;           ///< elements that do not hold from the start
  std::vector<int> acted_on;           ///< elements that any event releases or engages
  std::vector<std::string> ambiguous;  ///< what is to be said of `released` that another event releases
};

FirstActions first_actions(std::span<const Event> events, const Model& model);

/// Of the elements that events release and engage, and of those that were held `before`, the ones that hold where these
/// are released; ascending.
std::vector<int> held_by_events(std::span<const Event> events, const std::vector<int>& released,
                                const std::vector<int>& before);

}  // namespace catena
