#include "catena/analysis/run/weightless_bodies.hpp"

#include <fmt/format.h>

#include "catena/analysis/run/name_list.hpp"
#include "catena/base/at.hpp"

namespace catena {

std::string remark_on_weightless(const Model& model, const Plan& plan) {
  if (model.gravity.x == 0 && model.gravity.y == 0) return {};
  NameList names;
  for (int p = 0; p < plan.moving; ++p) {
    const int body = plan.model_body[at(p)];
    if (!model.bodies[at(body)].has_mass) names.add(model.body_name(body));
  }
  if (names.count() == 0) return {};
  return fmt::format("no mass is given for {}: the weight of {} is left out; give \"mass\": 0 where none is meant",
                     names.text(), names.count() == 1 ? "this body" : "these bodies");
}

}  // namespace catena
