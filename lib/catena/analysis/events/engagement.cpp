#include "catena/analysis/events/engagement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// A constraint is engaged where it holds already, to what of a motion is known, in length scales or rad.
constexpr double misfit = thresholds::same_value;

}  // namespace

std::vector<double> residuals_of(Evaluator& evaluator, std::span<const double> q, int element) {
  const Plan& plan = evaluator.plan();
  evaluator.set_configuration(q);
  std::vector<double> phi(static_cast<std::size_t>(plan.rows)), own;
  evaluator.phi(phi);
  for (std::size_t row = 0; row < phi.size(); ++row) {
    if (plan.row_element[row] == element) own.push_back(phi[row]);
  }
  return own;
}

Report check_fit(Evaluator& evaluator, std::span<const double> q, int element) {
  Report report;
  const Plan& plan = evaluator.plan();
  const double length = evaluator.length_scale();
  auto row = static_cast<std::size_t>(std::max(0, plan.element_row[static_cast<std::size_t>(element)]));
  for (const double phi : residuals_of(evaluator, q, element)) {
    const bool angle = plan.row_is_angle[row++] != 0;
    if (std::abs(phi) <= misfit * (angle ? 1 : length)) continue;
    report.status = Status::inconsistent;
    report.message = fmt::format(
        "\"{}\" cannot be engaged at t = {:.12g} s: it misses by {:.3g} {}; an event must happen where it holds",
        evaluator.model().element_name(element), evaluator.time(), std::abs(phi), angle ? "rad" : "m");
    return report;
  }
  return report;
}

}  // namespace catena
