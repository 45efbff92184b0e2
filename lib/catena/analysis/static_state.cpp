#include "catena/analysis/static_state.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

}  // namespace

std::vector<double> configuration_of(const Evaluator& evaluator, const SystemState& state) {
  std::vector<double> q = evaluator.given_configuration();
  if (state.q.empty()) return q;
  const Plan& plan = evaluator.plan();
  for (int p = 0; p < plan.moving; ++p) {
    const std::size_t source = 3 * at(plan.model_body[at(p)]), target = 3 * at(p);
    q[target] = state.q[source] - evaluator.origin(p).x;
    q[target + 1] = state.q[source + 1] - evaluator.origin(p).y;
    q[target + 2] = state.q[source + 2];
  }
  return q;
}

SystemState state_of(const Evaluator& evaluator, double t, std::span<const double> q) {
  const Plan& plan = evaluator.plan();
  SystemState state{t, std::vector<double>(3 * at(plan.bodies)), {}};
  for (int p = 0; p < plan.bodies; ++p) {
    const std::size_t target = 3 * at(plan.model_body[at(p)]), source = 3 * at(p);
    const Vec2<double> origin = evaluator.origin(p);
    state.q[target] = q[source] + origin.x;
    state.q[target + 1] = q[source + 1] + origin.y;
    state.q[target + 2] = q[source + 2];
  }
  return state;
}

}  // namespace catena
