#include "catena/analysis/sensitivity/phases/cable_kinks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Steps are at most some radians of the fastest swing long: a quarter of one does not pass a kink twice.
constexpr int quarters = 4;

using Cables = std::vector<ElementEntry<ElasticCable<double>, double>>;

double slack_of(const Evaluator& evaluator, const Cables::value_type& cable) {
  const Plan& plan = evaluator.plan();
  const auto frame = [&](int body) {
    return evaluator.ground_frame(body < 0 ? plan.bodies : plan.plan_body[at(body)]);
  };
  return cable.element.slack(frame(cable.i), frame(cable.j));
}

}  // namespace

CableKinks::CableKinks(const Model& model) : side_(std::get<Cables>(model.forces).size(), 0) {}

std::string CableKinks::passed(const MotionStretch& stretch) {
  if (side_.empty()) return {};
  for (int n = 0; n <= quarters; ++n) {
    const double t = n == quarters ? stretch.to : stretch.from + (stretch.to - stretch.from) * n / quarters;
    const std::optional<Snapshot> there = stretch.at(t);
    if (!there) return {};
    const auto& cables = std::get<Cables>(there->evaluator.model().forces);
    for (std::size_t k = 0; k < cables.size(); ++k) {
      const double slack = slack_of(there->evaluator, cables[k]);
      if (std::abs(slack) <= thresholds::closed_gap * cables[k].element.length) continue;
      const int side = slack > 0 ? 1 : -1;
      if (side_[k] == -side)
        return fmt::format(
            "by t = {:.9g} s cable \"{}\" has become {}: its force bends there, at an instant that moves with the "
            "parameters, and derivatives are not carried over that",
            t, there->evaluator.model().element_name(cables[k].id), side > 0 ? "slack" : "taut");
      side_[k] = side;
    }
  }
  return {};
}

}  // namespace catena
