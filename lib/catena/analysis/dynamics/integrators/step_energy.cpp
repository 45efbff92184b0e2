#include "catena/analysis/dynamics/integrators/step_energy.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Times the energy that errors explain: in 60,000 steps the median was 0.1 and the largest 60; steps that lost their
// way had 1e6.
constexpr double unexplained = 1000;
// The least cosine between v1 and u; the largest a u, compared with v1.
constexpr double least_cosine = 0.1, largest_change = 1e-3;

constexpr std::size_t first_driver = ErrorScale::work_of_loads + 1;  // of the drivers' integrals

struct StepEndEnergy {
  double kinetic = 0, potential = 0;
};

// Of the moving masses, and the potential at t, elastic contacts included, which loads that follow the time change;
// leaves the evaluator there.
StepEndEnergy energy_at(const Motion& motion, double t, Side side, std::span<const double> y) {
  Evaluator& evaluator = motion.equations().evaluator();
  evaluator.set_time(t, side);
  evaluator.set_configuration(motion.q(y));
  const std::vector<double>& mass = motion.equations().masses().mass;
  const std::span<const double> v = motion.qd(y);
  StepEndEnergy energy{.potential = evaluator.potential_energy()};
  if (const StateLoads* loads = motion.equations().state_loads()) energy.potential += loads->energy();
  for (std::size_t c = 0; c < mass.size(); ++c) energy.kinetic += 0.5 * mass[c] * v[c] * v[c];
  return energy;
}

// The energy that the errors of the step may change: that which was accepted and that of rounding.
double explained_by_errors(const Motion& motion, const BalancedStep& step) {
  const std::vector<double>& mass = motion.equations().masses().mass;
  const auto& [t, h, y_before, y, error] = step.ends;
  const std::span<const double> v = motion.qd(std::span<const double>(y));
  const std::span<const double> loads = motion.equations().applied_forces();
  double energy = 0;
  for (std::size_t c = 0; c < mass.size(); ++c) {
    energy += mass[c] * std::abs(v[c]) * step.scale.velocity_unit(c, h, v[c]) +
              std::abs(loads[c]) * step.scale.position_unit(c, h);
  }
  return step.errors * energy;
}

}  // namespace

// What drivers do follows from multipliers, which a singular position leaves open; losses of contacts are among the
// integrals of a motion, and not among the powers of stages here.
StepEnergy::Tells StepEnergy::of(const Motion& motion) {
  EquationsOfMotion& equations = motion.equations();
  const auto& elements = equations.evaluator().model().elements;
  const auto drives = [](const auto& element) { return element.kind == ElementKind::driver; };
  if (std::none_of(elements.begin(), elements.end(), drives))
    return equations.state_loads() ? Tells::nothing : Tells::speed;
  return motion.works() > 0 ? Tells::work : Tells::nothing;
}

StepEnergy::StepEnergy(const Motion& motion, std::size_t stages, double length, Tells tells)
    : power_(stages, 0.0),
      direction_(motion.moving()),
      acting_rows_(acting_rows(motion.equations().plan())),
      tells_(tells) {
  for (std::size_t c = 0; c < direction_.size(); c += 3) weight_ += motion.equations().masses().mass[c];
  const Vec2<double> gravity = motion.equations().evaluator().model().gravity;
  weight_ *= std::hypot(gravity.x, gravity.y) * length;
}

bool StepEnergy::watches(double ratio, bool crossing) const {
  return tells_ == Tells::speed && (crossing || ratio < dependence::singular_passage);
}

bool StepEnergy::tells_work(const Motion& motion) const { return tells_ == Tells::work && freedoms(motion) == 0; }

bool StepEnergy::leaves_drivers(const Motion& motion) const {
  return motion.works() > first_driver + 1 || !tells_work(motion);
}

int StepEnergy::freedoms(const Motion& motion) const {
  EquationsOfMotion& equations = motion.equations();
  return equations.plan().columns - acting_rows_ + equations.left_out().count();
}

void StepEnergy::note_power(const Motion& motion, std::size_t stage, std::span<const double> y) {
  Evaluator& evaluator = motion.equations().evaluator();
  power_[stage] = evaluator.load_power(motion.qd(y)) - evaluator.dissipation(motion.qd(y));
}

// u, with the factors of the new point.
void StepEnergy::find_direction(const Motion& motion, const BalancedEnds& step) {
  EquationsOfMotion& equations = motion.equations();
  const bool single = freedoms(motion) == 1;
  const std::span<const double> from = motion.qd(single ? std::span<const double>(step.y) : step.error);
  std::copy_n(from.begin(), direction_.size(), direction_.begin());
  if (!single) equations.remove_forbidden(direction_);
}

bool StepEnergy::restore(const Motion& motion, const BalancedStep& step) {
  const BalancedEnds& ends = step.ends;
  const double h = ends.h;
  const Side from = h > 0 ? Side::after : Side::before, to = h > 0 ? Side::before : Side::after;
  const StepEndEnergy before = energy_at(motion, ends.t - h, from, ends.y_before);
  const StepEndEnergy after = energy_at(motion, ends.t, to, ends.y);
  double work = 0;
  for (const StageTerm& term : step.weights) work += h * term.weight * power_[static_cast<std::size_t>(term.stage)];
  const double missing = before.kinetic + before.potential + work - after.kinetic - after.potential;
  const double largest = std::max({before.kinetic, std::abs(before.potential), std::abs(after.potential), weight_});
  // Potentials of weights may cancel.
  if (!(std::abs(missing) > thresholds::few_roundings * largest)) return true;
  if (!(std::abs(missing) < unexplained * explained_by_errors(motion, step))) return false;
  find_direction(motion, ends);
  const std::vector<double>& mass = motion.equations().masses().mass;
  const std::span<double> v = motion.qd(ends.y);
  double along = 0, square = 0;
  for (std::size_t c = 0; c < mass.size(); ++c) {
    along += mass[c] * v[c] * direction_[c];
    square += mass[c] * direction_[c] * direction_[c];
  }
  if (!(std::abs(along) > least_cosine * std::sqrt(2 * after.kinetic * square))) return true;
  const double a = missing / along;
  if (!(a * a * square < largest_change * largest_change * 2 * after.kinetic)) return true;
  for (std::size_t c = 0; c < direction_.size(); ++c) v[c] += a * direction_[c];
  return true;
}

void StepEnergy::restore_work(const Motion& motion, const BalancedEnds& step) const {
  if (!tells_work(motion)) return;
  const double h = step.h;
  const Side from = h > 0 ? Side::after : Side::before, to = h > 0 ? Side::before : Side::after;
  const StepEndEnergy before = energy_at(motion, step.t - h, from, step.y_before);
  const StepEndEnergy after = energy_at(motion, step.t, to, step.y);
  const std::size_t offset = 2 * motion.coordinates();
  const std::span<const double> old = step.y_before.subspan(offset);
  const std::span<double> work = step.y.subspan(offset);
  const double dissipated = EnergyAccount::dissipated(work) - EnergyAccount::dissipated(old);
  const double supplied = EnergyAccount::supplied(work) - EnergyAccount::supplied(old);
  const double missing = after.kinetic + after.potential + dissipated - before.kinetic - before.potential - supplied;
  const auto doubt = [&](std::size_t k) {
    return std::abs(step.error.empty() ? work[k] - old[k] : step.error[offset + k]);
  };
  double doubts = 0;
  for (std::size_t k = first_driver; k < work.size(); ++k) doubts += doubt(k);
  if (doubts > 0) {
    for (std::size_t k = first_driver; k < work.size(); ++k) work[k] += missing * (doubt(k) / doubts);
  } else if (work.size() == first_driver + 1) {
    const double largest = std::max({before.kinetic, std::abs(before.potential), std::abs(after.potential), weight_});
    if (std::abs(missing) > thresholds::few_roundings * largest) work[first_driver] += missing;
  }
}

}  // namespace catena
