#include "catena/analysis/batch/lane_evaluators.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {

LaneEvaluators::Lane::Lane(std::shared_ptr<const Plan> plan, const Model& model)
    : evaluator(std::move(plan), model, work),
      watched(evaluator),
      q(evaluator.given_configuration()),
      qd(q.size(), 0.0),
      forces(q.size(), 0.0) {}

// Made anew for each design: an evaluator would compare its model with the one before, which may be gone.
LaneEvaluators::Lane& LaneEvaluators::begin(int lane, const Model& model) {
  lanes_[at(lane)] = std::make_unique<Lane>(plan_, model);
  return *lanes_[at(lane)];
}

void LaneEvaluators::set_design(int lane, const Model& model) {
  are_one_ = false;
  begin(lane, model).begin_ropes();
}

void LaneEvaluators::Lane::begin_ropes() {
  lost = nullptr;
  // A pointer that owns nothing: the model outlives its use.
  ropes.emplace(std::shared_ptr<const Model>(std::shared_ptr<const Model>(), &evaluator.model()));
  if (!ropes->any()) return;
  try {
    if (ropes->begin({}) || !ropes->lie_as_given()) lost = "its ropes lie otherwise than given";
    for (const RopeRoute& route : ropes->routes()) {
      if (std::find(route.off.begin(), route.off.end(), 1) != route.off.end()) lost = "a rope lies beside a pulley";
    }
  } catch (const ModelError&) {
    lost = "a rope cannot lie over its pulleys";
  }
}

void LaneEvaluators::set_designs(const Model& model) {
  are_one_ = true;
  begin(0, model);
}

const char* LaneEvaluators::Lane::follow_ropes() {
  if (!ropes || !ropes->any()) return nullptr;
  try {
    if (ropes->follow(evaluator)) lost = "a rope comes to touch or to leave a pulley";
  } catch (const ModelError&) {
    lost = "a rope cannot lie over its pulleys";
  }
  return lost;
}

const char* LaneEvaluators::go_to(int lane, double t, const LaneNumbers& q, const LaneNumbers& qd) {
  Lane& own = lane_of(lane);
  if (own.lost) return own.lost;
  for (int n = 0; n < 3 * moving_; ++n) {
    const Vec2<double> origin = own.evaluator.origin(n / 3);
    own.q[at(n)] = q[n][lane] - (n % 3 == 0 ? origin.x : n % 3 == 1 ? origin.y : 0);
    own.qd[at(n)] = qd[n][lane];
    if (!std::isfinite(own.q[at(n)]) || !std::isfinite(own.qd[at(n)])) return "its places or velocities are not finite";
  }
  own.evaluator.set_time(t);
  own.evaluator.set_configuration(own.q);
  if (!own.watched.check_laws(own.qd).ok()) return "a force by a law of state is undefined";
  if (!own.watched.check_ropes().ok()) return "a rope is undefined";
  return own.follow_ropes();
}

void LaneEvaluators::find(int lane, LaneNumbers& applied) {
  Lane& own = lane_of(lane);
  own.evaluator.applied_forces(own.qd, own.forces);
  for (int n = 0; n < 3 * moving_; ++n) applied[n][lane] = own.forces[at(n)];
}

}  // namespace catena
