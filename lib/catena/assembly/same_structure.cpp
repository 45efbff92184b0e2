#include "catena/assembly/same_structure.hpp"

#include <stdexcept>
#include <string>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {

void require_same_count(std::size_t plan, std::size_t model, const char* what) {
  if (plan == model) return;
  throw std::invalid_argument("the model has " + std::to_string(model) + " " + what +
                              ", but the analysis was made for a model with " + std::to_string(plan));
}

void require_same_structure(const Model& known, const Model& model, const Plan& plan) {
  require_same_count(known.bodies.size(), model.bodies.size(), "bodies");
  require_same_count(known.elements.size(), model.elements.size(), "elements");
  const auto differs = [&](const std::string& name) {
    throw std::invalid_argument(
        "\"" + name + "\" differs from the element of this number in the model that the analysis was made for");
  };
  for (std::size_t b = 0; b < known.bodies.size(); ++b) {
    const auto &was = known.bodies[b], &is = model.bodies[b];
    if (was.fixed != is.fixed || was.particle != is.particle)
      differs(std::string(model.body_name(static_cast<int>(b))));
  }
  for (std::size_t e = 0; e < known.elements.size(); ++e) {
    const ElementRecord &was = known.elements[e], &is = model.elements[e];
    const bool same_list = (was.kind == ElementKind::force) == (is.kind == ElementKind::force);
    if (!same_list || was.type != is.type || was.index != is.index) {
      differs(model.element_name(static_cast<int>(e)));
    }
  }
  const auto compare = [&](const auto& all) {
    for_each_list(all(known), all(model), [&](const auto& list, const auto& other, int) {
      for (std::size_t k = 0; k < list.size(); ++k) {
        const bool same = list[k].i == other[k].i && list[k].j == other[k].j;
        if (!same && !plan.is_released(other[k].id)) differs(model.element_name(other[k].id));
      }
    });
  };
  compare([](const Model& m) -> const auto& { return m.constraints; });
  compare([](const Model& m) -> const auto& { return m.forces; });
  require_same_count(known.laws.size(), model.laws.size(), "laws of state");
}

}  // namespace catena
