#include "catena/analysis/dynamics/implicit/rattle.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/dynamics/implicit/implicit_step.hpp"
#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
Rattle::Rattle(Motion motion, double step, double horizon) : motion_(motion), step_(step) {
  for (std::vector<double>* y : {&y_, &y_before_, &y_new_, &slope_, &slope_before_}) y->assign(motion_.size(), 0.0);
  half_.assign(motion_.coordinates(), 0.0);
  scale_.horizon = horizon;
  scale_.length = motion_.length_scale();
  scale_.set_masses(motion_.equations().masses().mass);
}

bool Rattle::start(double t, std::span<const double> y) {
  t_ = t_before_ = from_ = t;
  steps_ = 0;
  std::copy(y.begin(), y.end(), y_.begin());
  if (!motion_.derivative(t_, Side::after, y_, slope_)) return false;
  curve_places_ = motion_.equations().evaluator().curve_places();
  observe(0);
  return true;
}

void Rattle::observe(double h) { implicit_step::observe(motion_, scale_, t_, h, y_, slope_); }

bool Rattle::advance(double limit) {
  Evaluator& evaluator = motion_.equations().evaluator();
  evaluator.take_turns(motion_.q(std::span(y_)));
  evaluator.go_to_curve_places(curve_places_);
  const double next = from_ + static_cast<double>(steps_ + 1) * step_;
  // A rest of a step that is longer by as little is rounding of time.
  const bool lands = next >= limit - thresholds::same_instant * step_;
  t_new_ = lands ? limit : next;
  const double h = t_new_ - t_;
  culprit_ = -1;
  if (!find_places(h) || !find_velocities(h)) return false;
  const std::size_t n = motion_.coordinates();
  for (std::size_t k = 2 * n; k < y_.size(); ++k) y_new_[k] = y_[k] + h / 2 * (slope_before_[k] + slope_[k]);
  y_before_.swap(y_);
  y_.swap(y_new_);
  t_before_ = t_;
  t_ = t_new_;
  ++steps_;
  if (lands) from_ = t_, steps_ = 0;
  curve_places_ = evaluator.curve_places();
  ++evaluator.counters.steps;
  observe(h);
  return true;
}

// The first line: with accelerations in place of M^-1 Q, which differ from it along the constraints alone.
bool Rattle::find_places(double h) {
  EquationsOfMotion& equations = motion_.equations();
  const std::size_t n = motion_.coordinates();
  // Factors of q: the last evaluation may have been at another place, where a row was given.
  if (!motion_.derivative(t_, t_ == from_ ? Side::after : Side::before, y_, slope_before_)) return false;
  std::copy(y_.begin(), y_.end(), y_new_.begin());
  for (std::size_t c = 0; c < n; ++c) y_new_[c] += h * (y_[n + c] + h / 2 * slope_before_[n + c]);
  equations.evaluator().set_time(t_new_, Side::before);
  // With the factors of the beginning: each correction takes a digit or more where a step is of use at all.
  position_residual_ = equations.project_position(motion_.q(std::span(y_new_)), thresholds::most_bisections);
  if (!(position_residual_ < RungeKutta::largest_residual)) return false;
  for (std::size_t c = 0; c < n; ++c) half_[c] = (y_new_[c] - y_[c]) / h;
  return true;
}

// The second line: v1 in the forces is repeated until it is the result. Each gains at least a factor of two where a
// step is of use.
bool Rattle::find_velocities(double h) {
  const std::size_t n = motion_.coordinates();
  const std::span<double> v = motion_.qd(std::span(y_new_));
  std::copy(half_.begin(), half_.end(), v.begin());
  for (int k = 0; k < thresholds::most_bisections; ++k) {
    if (!motion_.derivative(t_new_, Side::before, y_new_, slope_)) return false;
    double change = 0, size = 0;
    std::vector<double>& last = y_before_;  // is overwritten at the end of the step
    std::copy(v.begin(), v.end(), last.begin());
    for (std::size_t c = 0; c < n; ++c) v[c] = half_[c] + h / 2 * slope_[n + c];
    motion_.equations().project_velocity(v, scale_.rate());
    for (std::size_t c = 0; c < motion_.moving(); ++c) {
      const double unit = c % 3 == 2 ? 1 : scale_.length;
      change = std::max(change, std::abs(v[c] - last[c]) / unit);
      size = std::max({size, std::abs(v[c]) / unit, h * std::abs(slope_[n + c]) / unit});
    }
    if (!std::isfinite(change)) return false;
    // Accelerations are those of the velocities before this repetition: of the result to rounding.
    if (change <= thresholds::carried_rounding * size) return true;
  }
  return false;
}

void Rattle::interpolate(double t, std::span<double> y) {
  implicit_step::interpolate({t_before_, t_, y_before_, y_, slope_before_, slope_}, t, motion_.coordinates(), y);
}

IntegratorMemory Rattle::memory() const {
  IntegratorMemory memory = scale_.memory();
  memory.step = step_;
  return memory;
}

}  // namespace catena
