#include "catena/columns/energy.hpp"

#include "catena/columns/energy_of.hpp"
#include "catena/columns/snapshot_state.hpp"

namespace catena {

double kinetic_energy(const Snapshot& snapshot) { return kinetic_energy_of(SnapshotState(snapshot)); }

double total_energy(const Snapshot& snapshot) {
  return kinetic_energy(snapshot) + snapshot.evaluator.potential_energy() + snapshot.contact_energy;
}

Momentum momentum(const Snapshot& snapshot) { return momentum_of(SnapshotState(snapshot)); }

int body_without_mass(const Model& model, const Plan& plan) {
  for (int p = 0; p < plan.moving; ++p) {
    const int b = plan.model_body[static_cast<std::size_t>(p)];
    const auto& body = model.bodies[static_cast<std::size_t>(b)];
    if (!body.has_mass || (!body.has_inertia && !body.particle)) return b;
  }
  return -1;
}

}  // namespace catena
