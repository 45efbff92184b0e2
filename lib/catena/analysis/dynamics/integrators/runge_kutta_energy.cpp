// How fast the mechanism moves behind a step near a singular position, by the balance of energy of the step:
//
//   T1 = T0 + V0 - V1 + W          W = h sum b_s P_s,   P: loads without a potential, less what dampers take
//   v1 += a u,   a = (T1 - T(v1)) / (v1^T M u)
//
// At a sine d from the position, rounding of places makes accelerations wrong by eps / d^3, across the constraints.
// Projection removes that at the step's end, but the direction across has turned since by about h / radius, so that
// some h of it stays along the motion: after every passage the mechanism is a little too fast or too slow. Places are
// wrong by eps / d only, velocities by eps / d^2 and across, which changes energies by its square: the balance knows
// the speed better than the integral does, by d / h or more.
//
// u: what may be wrong. With one degree of freedom the velocity itself; else the error estimate of the step, which is
// that of the same stages, without the part across the constraints. Where u says nothing about the energy (v1^T M u
// near zero), or hardly anything moves, the velocity stays as it is. A step that is wrong by much more energy than its
// errors explain has lost its way and is not made. Symbols: T kinetic, V potential energy in J, M masses, v velocities,
// h the step in s, b_s weights of its stages.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"

namespace catena {
namespace {

// Pivot ratio below which steps are balanced, a sine of 0.1: there rounding is a thousand times that elsewhere.
constexpr double balanced_ratio = 1e-2;
// Rounding of energies, in their largest terms: potentials of weights may cancel.
constexpr double rounding_of_energy = 4 * std::numeric_limits<double>::epsilon();
// Times the energy that errors explain: in 60,000 steps the median was 0.1 and the largest 60; steps that lost their
// way had 1e6.
constexpr double unexplained = 1000;
// The least cosine between v1 and u; the largest a u, compared with v1.
constexpr double least_cosine = 0.1, largest_change = 1e-3;

}  // namespace

bool RungeKutta::watches_energy() const {
  return keeps_energy_ && projects() && (projecting_stages_ || start_ratio_ < balanced_ratio);
}

// At the evaluator's place, that of y.
void RungeKutta::note_power(std::size_t stage, std::span<const double> y) {
  Evaluator& evaluator = motion_.equations().evaluator();
  stage_power_[stage] = evaluator.load_power(motion_.qd(y)) - evaluator.dissipation(motion_.qd(y));
}

// Of the moving masses, and the potential at t, which loads that follow the time change; leaves the evaluator there.
RungeKutta::Energy RungeKutta::energy_of(double t, Side side, std::span<const double> y) {
  Evaluator& evaluator = motion_.equations().evaluator();
  evaluator.set_time(t, side);
  evaluator.set_configuration(motion_.q(y));
  const std::vector<double>& mass = motion_.equations().masses().mass;
  const std::span<const double> v = motion_.qd(y);
  Energy energy{.potential = evaluator.potential_energy()};
  for (std::size_t c = 0; c < mass.size(); ++c) energy.kinetic += 0.5 * mass[c] * v[c] * v[c];
  return energy;
}

// u, with the factors of the new point.
void RungeKutta::find_direction() {
  EquationsOfMotion& equations = motion_.equations();
  const bool single = equations.plan().columns - acting_rows_ + equations.left_out().count() == 1;
  const std::span<const double> from = motion_.qd(std::span<const double>(single ? y_new_ : error_));
  std::copy_n(from.begin(), direction_.size(), direction_.begin());
  if (!single) equations.remove_forbidden(direction_);
}

// The energy that the errors of the step may change: that which was accepted and that of rounding.
double RungeKutta::explained_by_errors(double h) const {
  const std::vector<double>& mass = motion_.equations().masses().mass;
  const std::span<const double> v = motion_.qd(std::span<const double>(y_new_));
  const std::span<const double> loads = motion_.equations().applied_forces();
  double energy = 0;
  for (std::size_t c = 0; c < mass.size(); ++c) {
    energy +=
        mass[c] * std::abs(v[c]) * scale_.velocity_unit(c, h, v[c]) + std::abs(loads[c]) * scale_.position_unit(c, h);
  }
  return (step_error_ + rounding_of_velocity(h)) * energy;
}

// Balances the step from y_ to y_new_, of size h, which was projected. False: more energy is missing than the error of
// the step and its rounding explain.
bool RungeKutta::restore_energy(double h) {
  const Side from = h > 0 ? Side::after : Side::before, to = h > 0 ? Side::before : Side::after;
  const Energy before = energy_of(t_new_ - h, from, y_), after = energy_of(t_new_, to, y_new_);
  double work = 0;
  for (const StageTerm& term : tableau().b) {
    work += h * term.weight * stage_power_[static_cast<std::size_t>(term.stage)];
  }
  const double missing = before.kinetic + before.potential + work - after.kinetic - after.potential;
  const double largest = std::max({before.kinetic, std::abs(before.potential), std::abs(after.potential), weight_});
  if (!(std::abs(missing) > rounding_of_energy * largest)) return true;
  if (!(std::abs(missing) < unexplained * explained_by_errors(h))) return false;
  find_direction();
  const std::vector<double>& mass = motion_.equations().masses().mass;
  const std::span<double> v = motion_.qd(std::span(y_new_));
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

}  // namespace catena
