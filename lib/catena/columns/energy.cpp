#include "catena/columns/energy.hpp"

namespace catena {
namespace {

/// Calls f(body, plan_body, velocity of the centroid, angular velocity) for every body.
template <class F>
void for_each_moving(const Snapshot& snapshot, F&& f) {
  const Plan& plan = snapshot.evaluator.plan();
  for (int p = 0; p < plan.moving; ++p) {
    const auto& body =
        snapshot.evaluator.model().bodies[static_cast<std::size_t>(plan.model_body[static_cast<std::size_t>(p)])];
    const double* v = snapshot.qd.data() + 3 * p;
    f(body, p, Vec2<double>{v[0], v[1]}, v[2]);
  }
}

}  // namespace

double kinetic_energy(const Snapshot& snapshot) {
  double twice = 0;
  for_each_moving(snapshot, [&](const auto& body, int, const Vec2<double>& v, double omega) {
    twice += body.mass * squared_norm(v) + body.inertia * omega * omega;
  });
  return twice / 2;
}

double total_energy(const Snapshot& snapshot) {
  return kinetic_energy(snapshot) + snapshot.evaluator.potential_energy() + snapshot.contact_energy;
}

Momentum momentum(const Snapshot& snapshot) {
  Momentum sum;
  for_each_moving(snapshot, [&](const auto& body, int p, const Vec2<double>& v, double omega) {
    sum.linear += body.mass * v;
    sum.angular += body.mass * cross(snapshot.evaluator.ground_frame(p).origin(), v) + body.inertia * omega;
  });
  return sum;
}

int body_without_mass(const Model& model, const Plan& plan) {
  for (int p = 0; p < plan.moving; ++p) {
    const int b = plan.model_body[static_cast<std::size_t>(p)];
    const auto& body = model.bodies[static_cast<std::size_t>(b)];
    if (!body.has_mass || (!body.has_inertia && !body.particle)) return b;
  }
  return -1;
}

}  // namespace catena
