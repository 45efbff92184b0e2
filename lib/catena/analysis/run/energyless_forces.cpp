#include "catena/analysis/run/energyless_forces.hpp"

#include <fmt/format.h>

#include <cmath>

#include "catena/base/at.hpp"
#include "catena/columns/state_laws.hpp"

namespace catena {

std::string forces_without_energy(const Model& model) {
  if (model.laws.empty()) return "forces that turn with their body have no energy";
  return fmt::format("laws of state such as {} have no energy", describe_law(model, 0));
}

bool is_damped(const Evaluator& evaluator) {
  std::vector<double> qd(at(evaluator.plan().coordinates()), 0.0);
  for (int k = 0; k < 3 * evaluator.plan().moving; ++k) qd[at(k)] = std::sin(1.0 + k) + std::cos(0.7 * k * k);
  if (evaluator.dissipation(qd) != 0) return true;
  for (std::size_t k = 0; k < evaluator.laws().size(); ++k) {
    for (const int body : evaluator.laws()[k].bodies) {
      const std::array<double, 6> gradient = evaluator.law_gradient(static_cast<int>(k), body, {});
      if (gradient[3] != 0 || gradient[4] != 0 || gradient[5] != 0) return true;
    }
  }
  return false;
}

Report too_large_without_energy(const Model& model, int freedoms, int most_freedoms) {
  return {
      Status::refused,
      fmt::format("{}: their stiffness is unsymmetric, which dense algebra treats up to {} degrees of freedom; this "
                  "mechanism has {}",
                  forces_without_energy(model), most_freedoms, freedoms),
      {}};
}

}  // namespace catena
