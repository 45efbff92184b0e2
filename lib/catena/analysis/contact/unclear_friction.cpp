#include "catena/analysis/contact/unclear_friction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "catena/analysis/contact/contact_points.hpp"

namespace catena {

namespace {

/// Of these elements the ones that hold for the time being: stops, contacts and cables that are closed, friction that
/// sticks.
std::string names_of_places(const Model& model, std::span<const int> elements) {
  const std::vector<int> gaps = model.gaps();
  std::string names;
  for (const int element : elements) {
    const bool closes = std::find(gaps.begin(), gaps.end(), element) != gaps.end();
    if (!closes && model.element_type(element) != "friction") continue;
    names +=
        fmt::format("{}{} \"{}\"", names.empty() ? "" : ", ", model.element_type(element), model.element_name(element));
  }
  return names;
}

}  // namespace

Report refuse_unclear_friction(const Model& model, std::span<const int> ambiguous, double t) {
  for (const ContactPoint& point : joints_with_friction(model)) {
    if (!std::binary_search(ambiguous.begin(), ambiguous.end(), point.joint)) continue;
    const std::string places = names_of_places(model, ambiguous);
    const std::string needs = fmt::format("friction \"{}\" needs the reaction of {} \"{}\", which is not unique",
                                          model.element_name(point.element), model.element_type(point.joint),
                                          model.element_name(point.joint));
    return {Status::refused,
            places.empty()
                ? needs + ", since constraints depend on each other; take away what repeats it, or the friction"
                : fmt::format("from t = {:.9g} s on {}: these share its loads: {}; give a stiffness k to what closes, "
                              "or friction that is smooth (\"vs\")",
                              t, needs, places),
            {}};
  }
  return {};
}

}  // namespace catena
