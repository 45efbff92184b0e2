#include "catena/analysis/mass_matrix.hpp"

#include <fmt/format.h>

namespace catena {

Report MassMatrix::load(const Model& model, const Plan& plan) {
  Report report;
  const auto size = static_cast<std::size_t>(3 * plan.moving);
  mass.assign(size, 0.0);
  inverse.assign(size, 0.0);
  massless.clear();
  for (std::size_t c = 0; c < size; ++c) {
    if (plan.column[c] < 0) continue;
    const int b = plan.model_body[c / 3];
    const auto& body = model.bodies[static_cast<std::size_t>(b)];
    const bool angle = c % 3 == 2;
    if (!(angle ? body.has_inertia : body.has_mass)) {
      report.status = Status::refused;
      report.message = angle ? fmt::format(
                                   "body \"{}\" has a mass but no inertia: give its inertia about the centroid, "
                                   "or make it a particle",
                                   model.body_name(b))
                             : fmt::format(
                                   "body \"{}\" has no mass: dynamics needs the mass and inertia of every body "
                                   "that moves",
                                   model.body_name(b));
      return report;
    }
    mass[c] = angle ? body.inertia : body.mass;
    if (mass[c] > 0) {
      inverse[c] = 1 / mass[c];
    } else {
      massless.push_back(static_cast<int>(c));
    }
  }
  return report;
}

}  // namespace catena
