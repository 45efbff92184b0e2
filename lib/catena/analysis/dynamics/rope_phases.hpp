// The ways of ropes in a motion: a phase ends where a straight line comes to touch a pulley, or leaves one, or a
// tangent has turned so far that its angle is counted anew (model/rope_routes.hpp).
//
//   touched   c passes zero from above         beside    c passes zero from below, or an end comes into the circle
//
// c: angle of contact, rad.
#pragma once

#include <memory>
#include <vector>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/events/event_watch.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/base/status.hpp"
#include "catena/model/rope_routes.hpp"

namespace catena {

inline constexpr std::string_view met_pulley = "wrap", left_pulley = "unwrap";

class RopePhases {
 public:
  explicit RopePhases(const Model& model) : routes_(rope_routes(model)) {}

  bool any() const { return !routes_.empty(); }
  /// As they lie in the present phase.
  const std::vector<RopeRoute>& routes() const { return routes_; }
  /// Finds the ways where the evaluator is, going on from what `state` says of ropes; `model` becomes one with these
  /// where it has others.
  Report start(const SystemState& state, const Evaluator& evaluator, std::shared_ptr<const Model>& model);
  /// What ends the present phase, behind the transitions there are. `length`: the length scale.
  void add_transitions(std::vector<Transition>& transitions, double length);
  /// Transition k of these ended it, where the evaluator is: `model` becomes one with the next way.
  Report change(std::size_t k, const Evaluator& evaluator, std::shared_ptr<const Model>& model);
  /// How far the ropes are wound at a place of the present phase.
  std::vector<RopeTurns> turns(const SystemState& state) const;
  /// What happened since this was called last.
  std::vector<ContactEvent> take_events() { return std::move(events_); }

 private:
  enum class End : unsigned char { contact, circle, turned };
  struct Watched {
    std::size_t route;
    int node;
    End ends;
  };
  Report lay_out(std::size_t route, const Evaluator& evaluator, Model& model);

  std::vector<RopeRoute> routes_;
  std::vector<std::shared_ptr<const RouteWatch>> watches_;  // by route
  std::vector<Watched> watched_;                            // by transition
  std::vector<ContactEvent> events_;
};

}  // namespace catena
