#include "catena/analysis/dynamics/balance_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/columns/energy.hpp"
#include "catena/elements/forces/spring_damper.hpp"

namespace catena {
namespace {

// Of tolerance x energy. In 31,000 checks of random redundant mechanisms the median was 4e-4; the largest was 9 at
// tolerances down to 1e-10 and 19 at 1e-11, where it comes with errors of thirty times the tolerance. Rounding near
// flat positions may exceed this at 1e-12, too, and is reported.
constexpr double permitted = 10;
// Of the potential energy, whose parts may cancel; steps add up to some hundred roundings.
constexpr double rounding = thresholds::carried_rounding;
// Of loads that constraints balance: sums of a dozen terms.
constexpr double rounding_of_balance = 16 * std::numeric_limits<double>::epsilon();

}  // namespace

bool BalanceWatch::conserves(const Evaluator& evaluator) {
  const Model& model = evaluator.model();
  if (!model.functions.empty() || !model.laws.empty()) return false;
  // One whose ends are at one place has no direction there, and shows no loss.
  for (const auto& spring : std::get<std::vector<ElementEntry<SpringDamper<double>, double>>>(model.forces)) {
    if (spring.element.c != 0) return false;
  }
  std::vector<double> motion(static_cast<std::size_t>(evaluator.plan().coordinates()), 0.0);
  // No two coordinates alike, so that nothing cancels by symmetry.
  for (int k = 0; k < 3 * evaluator.plan().moving; ++k) {
    motion[static_cast<std::size_t>(k)] = std::sin(1.0 + k) * (k % 3 == 2 ? 1 : evaluator.length_scale());
  }
  return evaluator.dissipation(motion) == 0 && evaluator.load_power(motion) == 0;
}

void BalanceWatch::begin(const Snapshot& start, const MassMatrix& masses, double tolerance, bool work_known,
                         bool drifts) {
  tolerance_ = tolerance;
  drifts_ = drifts;
  work_known_ = work_known;
  largest_kinetic_ = kinetic_energy(start);
  least_potential_ = largest_potential_ = start.evaluator.potential_energy() + start.contact_energy;
  initial_ = work_known ? start.initial_energy : largest_kinetic_ + least_potential_;
  missing_ = 0;
  weight_ = 0;
  length_ = start.evaluator.length_scale();
  const Model& model = start.evaluator.model();
  for (const auto& body : model.bodies) weight_ += body.fixed ? 0 : body.mass;
  weight_ *= std::hypot(model.gravity.x, model.gravity.y) * length_;
  t_ = start.t;
  squared_times_ = 0;
  mass_.assign(static_cast<std::size_t>(start.evaluator.plan().coordinates()), 0.0);
  std::copy(masses.mass.begin(), masses.mass.end(), mass_.begin());
}

void BalanceWatch::observe(const Snapshot& state) {
  const double kinetic = kinetic_energy(state), potential = state.evaluator.potential_energy() + state.contact_energy;
  largest_kinetic_ = std::max(largest_kinetic_, kinetic);
  least_potential_ = std::min(least_potential_, potential);
  largest_potential_ = std::max(largest_potential_, potential);
  // Rows and ends of phases lie before the end of a step that was seen.
  if (state.t > t_) {
    squared_times_ += (state.t - t_) * (state.t - t_);
    t_ = state.t;
  }
  missing_ = kinetic + potential - initial_ - (work_known_ ? state.work - state.dissipated : 0);
}

// What velocities, of which a motion that sets out has hardly any, are not known to, J.
double BalanceWatch::unknown_of_velocities(std::span<const double> accelerations) const {
  double work = 0;
  for (std::size_t c = 0; c < std::min(mass_.size(), accelerations.size()); ++c)
    work += mass_[c] * std::abs(accelerations[c]) * (c % 3 == 2 ? 1 : length_);
  return permitted * tolerance_ * std::sqrt(largest_kinetic_ * work);
}

Report BalanceWatch::check(double t, std::span<const double> loads, std::span<const double> accelerations) const {
  Report report;
  // Energies that are not finite cannot be checked; the integration then ends by itself.
  if (!std::isfinite(missing_)) return report;
  const double energy = this->energy();
  const double size = std::max({weight_, std::abs(least_potential_), std::abs(largest_potential_), std::abs(initial_)});
  const double drift = drifts_ ? tolerance_ * weight_ : 0;
  const double allowed = permitted * tolerance_ * energy + drift + rounding * size;
  if (std::abs(missing_) <= allowed) return report;
  // Where nothing moves and nothing weighs, the work of loads is all there is.
  double most = 0, all = 0, free = 0;
  for (std::size_t c = 0; c < loads.size(); ++c) {
    const bool turns = c % 3 == 2;
    most = std::max(most, std::abs(loads[c]) * (turns ? 1 : length_));
    all += std::abs(loads[c]) / (turns ? length_ : 1);
    if (mass_[c] > 0) free += std::abs(loads[c]) / mass_[c] * (turns ? length_ : 1);
  }
  // Places are known to tolerance x length scale, on which loads work: what a motion that has hardly begun may be wrong
  // by.
  const double unknown = (tolerance_ + rounding) * most + rounding_of_balance * free * all * squared_times_ +
                         unknown_of_velocities(accelerations);
  if (std::abs(missing_) <= allowed + unknown) return report;
  report.status = Status::not_converged;
  report.message = fmt::format(
      "the motion up to t = {:.12g} s is wrong: {:.3g} J of energy {} without a cause, of {:.3g} J in "
      "motion, much more than a tolerance of {:.3g} explains; likely cause: a position that is singular or nearly "
      "so, or very stiff forces; a smaller tolerance may do",
      t, std::abs(missing_), missing_ > 0 ? "appeared" : "disappeared", energy, tolerance_);
  return report;
}

}  // namespace catena
