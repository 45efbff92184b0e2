#include "catena/analysis/state_conversion.hpp"

#include <algorithm>

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

}  // namespace

void take_over_places(const Evaluator& evaluator, const SystemState& state, std::span<double> q) {
  if (state.q.empty()) return;
  const Plan& plan = evaluator.plan();
  for (int p = 0; p < plan.moving; ++p) {
    const std::size_t source = 3 * at(plan.model_body[at(p)]), target = 3 * at(p);
    q[target] = state.q[source] - evaluator.origin(p).x;
    q[target + 1] = state.q[source + 1] - evaluator.origin(p).y;
    q[target + 2] = state.q[source + 2];
  }
}

std::vector<double> configuration_of(const Evaluator& evaluator, const SystemState& state) {
  std::vector<double> q = evaluator.given_configuration();
  take_over_places(evaluator, state, q);
  return q;
}

std::vector<double> velocities_of(const Evaluator& evaluator, const SystemState& state) {
  if (state.qd.empty()) return {};
  const Plan& plan = evaluator.plan();
  std::vector<double> qd(at(plan.coordinates()), 0.0);
  for (int p = 0; p < plan.moving; ++p) std::copy_n(&state.qd[3 * at(plan.model_body[at(p)])], 3, &qd[3 * at(p)]);
  return qd;
}

SystemState state_of(const Evaluator& evaluator, double t, std::span<const double> q, std::span<const double> qd) {
  const Plan& plan = evaluator.plan();
  SystemState state{t, std::vector<double>(3 * at(plan.bodies)), {}};
  if (!qd.empty()) state.qd.resize(state.q.size());
  for (int p = 0; p < plan.bodies; ++p) {
    const std::size_t target = 3 * at(plan.model_body[at(p)]), source = 3 * at(p);
    const Vec2<double> origin = evaluator.origin(p);
    state.q[target] = q[source] + origin.x;
    state.q[target + 1] = q[source + 1] + origin.y;
    state.q[target + 2] = q[source + 2];
    if (!qd.empty()) std::copy_n(&qd[source], 3, &state.qd[target]);
  }
  return state;
}

}  // namespace catena
