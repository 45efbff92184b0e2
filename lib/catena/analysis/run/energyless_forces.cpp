#include "catena/analysis/run/energyless_forces.hpp"

#include <fmt/format.h>

#include "catena/columns/state_laws.hpp"

namespace catena {

std::string forces_without_energy(const Model& model) {
  if (model.laws.empty()) return "forces that turn with their body have no energy";
  return fmt::format("laws of state such as {} have no energy", describe_law(model, 0));
}

std::string refused_without_energy(const Model& model, std::string_view what) {
  if (!model.laws.empty()) {
    return fmt::format(
        "laws of state such as {} have no energy, and {} not built; springs, curves and functions "
        "of time have one",
        describe_law(model, 0), what);
  }
  return fmt::format(
      "follower forces have no energy, and {} not built; give the forces in ground "
      "axes",
      what);
}

}  // namespace catena
