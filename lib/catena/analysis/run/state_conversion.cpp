#include "catena/analysis/run/state_conversion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "catena/analysis/run/released_elements.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

/// Throws unless `values` are three finite numbers a body, or none.
void check_values(const Model& model, std::span<const double> values, const char* what) {
  if (values.empty()) return;
  if (values.size() != 3 * model.bodies.size()) {
    throw std::invalid_argument("the state is of another model: it has " + std::to_string(values.size()) + " " + what +
                                ", and " + std::to_string(3 * model.bodies.size()) + " belong to " +
                                std::to_string(model.bodies.size()) + " bodies");
  }
  const auto wrong = std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
  if (wrong == values.end()) return;
  const auto body = static_cast<int>((wrong - values.begin()) / 3);
  throw std::invalid_argument("the state's " + std::string(what) + " of body \"" + std::string(model.body_name(body)) +
                              "\" are not finite");
}

}  // namespace

void take_over_places(Evaluator& evaluator, const SystemState& state, std::span<double> q) {
  if (!std::isfinite(state.t)) throw std::invalid_argument("the state's time is not finite");
  check_values(evaluator.model(), state.q, "places");
  check_values(evaluator.model(), state.qd, "velocities");
  evaluator.go_to_given_curve_places();
  if (state.q.empty()) return;
  const Plan& plan = evaluator.plan();
  for (int p = 0; p < plan.moving; ++p) {
    const std::size_t source = 3 * at(plan.model_body[at(p)]), target = 3 * at(p);
    q[target] = state.q[source] - evaluator.origin(p).x;
    q[target + 1] = state.q[source + 1] - evaluator.origin(p).y;
    q[target + 2] = state.q[source + 2];
  }
  evaluator.go_to_curve_places(state.curves);
}

Frame<double> frame_of(const Evaluator& evaluator, std::span<const double> q, int body) {
  const Model& model = evaluator.model();
  static_cast<void>(model.body_name(body));  // throws for an invalid number
  if (body < 0) return {};
  const int p = evaluator.plan().plan_body[at(body)];
  const Vec2<double> centre = evaluator.origin(p) + Vec2<double>{q[3 * at(p)], q[3 * at(p) + 1]};
  Frame<double> f = make_frame(centre.x, centre.y, q[3 * at(p) + 2]);
  const Vec2<double> origin = f.point(model.bodies[at(body)].origin);
  f.x = origin.x;
  f.y = origin.y;
  return f;
}

std::vector<double> configuration_of(Evaluator& evaluator, const SystemState& state) {
  std::vector<double> q = evaluator.given_configuration();
  take_over_places(evaluator, state, q);
  return q;
}

std::vector<double> velocities_of(const Evaluator& evaluator, const SystemState& state) {
  check_values(evaluator.model(), state.qd, "velocities");
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
  state.curves = evaluator.curve_places();
  std::vector<int> released;
  for (int e = 0; e < static_cast<int>(plan.released.size()); ++e) {
    if (plan.is_released(e)) released.push_back(e);
  }
  state.released = released_by_events(evaluator.model(), std::move(released));
  return state;
}

}  // namespace catena
