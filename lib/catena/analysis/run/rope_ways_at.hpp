// The model of an analysis that begins at some state: its ropes lie there as they can (model/rope_routes.hpp).
#pragma once

#include <memory>
#include <vector>

#include "catena/analysis/run/system_state.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/model/rope_routes.hpp"

namespace catena {

/// The ways of a model's ropes, place by place.
class RopeWaysAt {
 public:
  explicit RopeWaysAt(std::shared_ptr<const Model> model) : model_(std::move(model)), routes_(rope_routes(*model_)) {
    for (const RopeRoute& route : routes_) laid_.push_back(route.memory);
  }

  bool any() const { return !routes_.empty(); }
  const std::shared_ptr<const Model>& model() const { return model_; }
  /// Whether any rope has met or left a pulley since the given configuration.
  bool has_changed() const { return has_changed_; }
  /// Finds them where the evaluator is, or at a state; true: some have changed, or lie in a direction from which the
  /// next half turn is not known, and model() is another one. Throws ModelError where a rope has none, with its name.
  bool find(const Evaluator& evaluator);
  bool find(const SystemState& state);
  /// The same for those without stiffness alone, along a motion that is looked at now and then: from one look to the
  /// next no tangent may turn by half a turn.
  bool follow(const Evaluator& evaluator);

 private:
  std::shared_ptr<const Model> model_;
  bool follow(RopeRoute& route, std::shared_ptr<const RouteWatch>& watch, const Evaluator& evaluator,
              std::shared_ptr<Model>& changed);

  std::vector<RopeRoute> routes_;
  std::vector<RopeMemory> laid_;                            // by route, as its elements lie
  std::vector<std::shared_ptr<const RouteWatch>> watches_;  // by route, once they are followed
  bool has_changed_ = false;
};

}  // namespace catena
