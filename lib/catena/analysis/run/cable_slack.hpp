// The slack L - l of every elastic cable, and rope over pulleys, that acts as a force: f = k max(-slack, 0) bends where
// it changes its sign. Units: m.
#pragma once

#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {

/// Calls f(slack, length, id) for every cable, and then for every rope, at the evaluator's configuration.
template <class F>
void for_each_slack(const Evaluator& evaluator, F&& f) {
  const Plan& plan = evaluator.plan();
  const auto frame = [&](int body) {
    return evaluator.ground_frame(body < 0 ? plan.bodies : plan.plan_body[at(body)]);
  };
  const auto& forces = evaluator.model().forces;
  for (const auto& cable : std::get<std::vector<ElementEntry<ElasticCable<double>, double>>>(forces))
    f(cable.element.slack(frame(cable.i), frame(cable.j)), cable.element.length, cable.id);
  // The pieces of a rope follow each other.
  const auto& ropes = std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(forces);
  for (std::size_t first = 0; first < ropes.size();) {
    f(rope_slack<double>(ropes, static_cast<int>(first), frame), ropes[first].element.length, ropes[first].id);
    first += at(std::max(ropes[first].element.pieces, 1));
  }
}

}  // namespace catena
