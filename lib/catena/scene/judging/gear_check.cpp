#include "catena/scene/judging/gear_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "catena/elements/constraints/gear.hpp"

namespace catena {
namespace {

constexpr std::size_t most_sentences = 5;
// Of the radii: dimensions in a scene are rarely given to more digits.
constexpr double fit = 1e-4;

}  // namespace

std::vector<std::string> gears_that_do_not_fit(const Evaluator& evaluator) {
  std::vector<std::string> sentences;
  const Plan& plan = evaluator.plan();
  const auto centre = [&](int body, const Vec2<double>& point) {
    return evaluator.ground_frame(body < 0 ? plan.bodies : plan.plan_body[static_cast<std::size_t>(body)]).point(point);
  };
  for (const auto& entry : std::get<std::vector<ElementEntry<Gear<double>, double>>>(evaluator.model().constraints)) {
    if (sentences.size() == most_sentences) break;
    const Gear<double>& gear = entry.element;
    const double apart = norm(centre(entry.j, gear.s_j) - centre(entry.i, gear.s_i));
    const double radii = gear.internal ? std::abs(gear.radius_i - gear.radius_j) : gear.radius_i + gear.radius_j;
    if (std::abs(apart - radii) <= fit * (gear.radius_i + gear.radius_j)) continue;
    sentences.push_back(
        fmt::format("the wheels of gear \"{}\" do not touch: their centres are {:.6g} m apart, the {} of the radii is "
                    "{:.6g} m",
                    evaluator.model().element_name(entry.id), apart, gear.internal ? "difference" : "sum", radii));
  }
  return sentences;
}

}  // namespace catena
