// The model of an analysis that begins at some state: its ropes lie there as they can (model/rope_routes.hpp).
//
// From one place to the next the ways go on continuously, if no tangent turns by nearly half a turn between. Where one
// does, and at a first place of which nothing is known, the place alone decides. A rope that is wound further than its
// place tells keeps to the nearest of the ways that the next place allows: that is its way in a place of rest as well
// as another one, but not in a motion, which it ends.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/analysis/run/system_state.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/model/rope_routes.hpp"

namespace catena {

/// The frames of the bodies that a route passes, by node, at a state with places.
std::vector<Frame<double>> frames_at(const RopeRoute& route, const SystemState& state);

/// Has the routes of a model go on from what a state says of them. Throws std::invalid_argument if it is of other ones.
void take_up(std::span<RopeRoute> routes, const SystemState& state);

/// The ways of a model's ropes, place by place.
class RopeWaysAt {
 public:
  explicit RopeWaysAt(std::shared_ptr<const Model> model);

  bool any() const { return !routes_.empty(); }
  const std::shared_ptr<const Model>& model() const { return model_; }
  const std::vector<RopeRoute>& routes() const { return routes_; }
  /// Whether any rope has met or left a pulley since the given configuration.
  bool has_changed() const { return has_changed_; }
  /// Whether all lie over the pulleys of the given configuration, with its turns: derivatives are those of such ropes.
  bool lie_as_given() const { return lie_as(given_); }
  /// The same of these, an earlier routes().
  bool lie_as(std::span<const RopeRoute> others) const;
  /// An analysis begins at the state, with what it says of ropes; at the given configuration where it has no places.
  /// True: model() is another one. Throws ModelError where a rope has no way, with its name.
  bool begin(const SystemState& state);
  /// Goes on to where the evaluator is; true: some ropes have met or left a pulley, or lie in a direction from which
  /// the next half turn is not known, and model() is another one. Throws ModelError as begin().
  bool find(const Evaluator& evaluator) { return find(evaluator, true); }
  /// The same for those without stiffness alone, along a motion that is looked at now and then.
  bool follow(const Evaluator& evaluator) { return find(evaluator, false); }
  /// How far the ropes are wound at a place within half a turn of the last one.
  std::vector<RopeTurns> turns(const SystemState& state) const;

 private:
  bool find(const Evaluator& evaluator, bool elastic);
  /// Finds the way of a route where its bodies are; true: another one is to be laid.
  bool look(std::size_t r, std::vector<Frame<double>> frames, bool in_motion);
  bool lay_ways(std::span<const char> changed);

  std::shared_ptr<const Model> model_;
  std::vector<RopeRoute> routes_;
  std::vector<RopeRoute> given_;                  // as they lie in the given configuration
  std::vector<RopeRoute> laid_;                   // as their elements lie
  std::vector<std::vector<Frame<double>>> last_;  // by route, the last place; empty: nothing is known
  bool has_changed_ = false;
};

}  // namespace catena
