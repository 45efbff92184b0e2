#include "catena/analysis/contact/unclear_friction.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catena/analysis/contact/contact_points.hpp"

namespace catena {

Report refuse_unclear_friction(const Model& model, std::span<const int> ambiguous) {
  for (const ContactPoint& point : joints_with_friction(model)) {
    if (!std::binary_search(ambiguous.begin(), ambiguous.end(), point.joint)) continue;
    return {Status::refused,
            fmt::format(
                "friction \"{}\" needs the reaction of {} \"{}\", which is not unique, since constraints depend "
                "on each other; take away what repeats it, or the friction",
                model.element_name(point.element), model.element_type(point.joint), model.element_name(point.joint)),
            {}};
  }
  return {};
}

}  // namespace catena
