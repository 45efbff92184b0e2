#include "catena/analysis/sensitivity/phases/cable_kinks.hpp"

#include <fmt/format.h>

#include <algorithm>
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
using Ropes = std::vector<ElementEntry<ElasticRope<double>, double>>;

/// Calls f(slack, length, id) for every cable, and then for every rope, whose pieces follow each other.
template <class F>
void for_each_slack(const Evaluator& evaluator, F&& f) {
  const Plan& plan = evaluator.plan();
  const auto frame = [&](int body) {
    return evaluator.ground_frame(body < 0 ? plan.bodies : plan.plan_body[at(body)]);
  };
  for (const auto& cable : std::get<Cables>(evaluator.model().forces))
    f(cable.element.slack(frame(cable.i), frame(cable.j)), cable.element.length, cable.id);
  const Ropes& ropes = std::get<Ropes>(evaluator.model().forces);
  for (std::size_t first = 0; first < ropes.size();) {
    const std::size_t end = first + at(std::max(ropes[first].element.pieces, 1));
    double slack = ropes[first].element.length;
    for (std::size_t k = first; k < end; ++k) slack -= ropes[k].element.way(frame(ropes[k].i), frame(ropes[k].j));
    f(slack, ropes[first].element.length, ropes[first].id);
    first = end;
  }
}

}  // namespace

CableKinks::CableKinks(const Model& model)
    : side_(std::get<Cables>(model.forces).size() + std::get<Ropes>(model.forces).size(), 0) {}

std::string CableKinks::passed(const MotionStretch& stretch) {
  if (side_.empty()) return {};
  std::string why;
  for (int n = 0; n <= quarters && why.empty(); ++n) {
    const double t = n == quarters ? stretch.to : stretch.from + (stretch.to - stretch.from) * n / quarters;
    const std::optional<Snapshot> there = stretch.at(t);
    if (!there) return {};
    std::size_t k = 0;
    for_each_slack(there->evaluator, [&](double slack, double length, int id) {
      int& known = side_[k++];
      if (std::abs(slack) <= thresholds::closed_gap * length) return;
      const int side = slack > 0 ? 1 : -1;
      if (known == -side && why.empty())
        why = fmt::format(
            "by t = {:.9g} s {} \"{}\" has become {}: its force bends there, at an instant that moves with the "
            "parameters, and steps do not end there where a law of state reads a cable or the error is estimated: "
            "derivatives are not carried over that",
            t, there->evaluator.model().element_type(id), there->evaluator.model().element_name(id),
            side > 0 ? "slack" : "taut");
      known = side;
    });
  }
  return why;
}

}  // namespace catena
