#include "catena/analysis/sensitivity/phases/cable_kinks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "catena/analysis/run/cable_slack.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// Steps are at most some radians of the fastest swing long: a quarter of one does not pass a kink twice.
constexpr int quarters = 4;

}  // namespace

CableKinks::CableKinks(const Model& model)
    : side_(std::get<std::vector<ElementEntry<ElasticCable<double>, double>>>(model.forces).size() +
                std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces).size(),
            0) {}

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
