#include "catena/analysis/motion/mass_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace catena {
namespace {

std::string lacks(std::string_view body, bool inertia) {
  if (!inertia) {
    return fmt::format("body \"{}\" has no mass: motions and modes need the mass and inertia of every body that moves",
                       body);
  }
  return fmt::format(
      "body \"{}\" has a mass but no inertia: give its inertia about the centroid, or make it a particle", body);
}

// A thousandth of the least mass, but not so small that rounding in the sums it enters would dominate.
double small_mass(const std::vector<double>& mass) {
  double least = std::numeric_limits<double>::infinity(), largest = 0;
  for (std::size_t c = 0; c < mass.size(); ++c) {
    if (c % 3 == 2 || !(mass[c] > 0)) continue;
    least = std::min(least, mass[c]);
    largest = std::max(largest, mass[c]);
  }
  return largest > 0 ? std::max(1e-3 * least, 1e-9 * largest) : 1;
}

}  // namespace

Report MassMatrix::load(const Evaluator& evaluator) {
  Report report;
  const Plan& plan = evaluator.plan();
  const Model& model = evaluator.model();
  const auto size = static_cast<std::size_t>(3 * plan.moving);
  mass.assign(size, 0.0);
  substitute.assign(size, 0.0);
  massless.clear();
  for (std::size_t c = 0; c < size; ++c) {
    if (plan.column[c] < 0) continue;
    const int b = plan.model_body[c / 3];
    const auto& body = model.bodies[static_cast<std::size_t>(b)];
    const bool angle = c % 3 == 2;
    if (!(angle ? body.has_inertia : body.has_mass)) {
      report.status = Status::refused;
      report.message = lacks(model.body_name(b), angle);
      return report;
    }
    mass[c] = angle ? body.inertia : body.mass;
    if (!(mass[c] > 0)) massless.push_back(static_cast<int>(c));
  }
  if (massless.empty()) return report;
  const double small = small_mass(mass);
  const std::vector<double> radius = evaluator.attachment_radii();
  for (int c : massless) {
    const double arm = radius[static_cast<std::size_t>(c / 3)];
    substitute[static_cast<std::size_t>(c)] = c % 3 == 2 ? small * arm * arm : small;
  }
  return report;
}

}  // namespace catena
