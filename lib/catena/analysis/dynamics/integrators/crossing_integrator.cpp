#include "catena/analysis/dynamics/integrators/crossing_integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

constexpr double usual_ratios_forgotten = 0.97;  // of what was usual, at every step

}  // namespace

CrossingIntegrator::CrossingIntegrator(Motion motion, const RungeKuttaOptions& options)
    : motion_(motion),
      runge_kutta_(motion, options),
      usual_ratio_(std::max(1e-300, options.usual_ratio)),
      energy_(motion, 0, motion.length_scale(),
              options.fixed_step > 0 ? StepEnergy::Tells::nothing : StepEnergy::of(motion)) {}

void CrossingIntegrator::forget_passages() {
  largest_ratio_ = 0;
  crossing_ = stepped_by_runge_kutta_ = false;
}

void CrossingIntegrator::observe_ratio() {
  const double ratio = motion_.equations().smallest_pivot_ratio();
  usual_ratio_ = std::max(usual_ratio_, ratio);
  largest_ratio_ = std::max(ratio, usual_ratios_forgotten * largest_ratio_);
}

bool CrossingIntegrator::dips() const {
  const double ratio = motion_.equations().smallest_pivot_ratio();
  return ratio < std::min(dependence::singular_passage * usual_ratio_, dependence::unusual * largest_ratio_);
}

bool CrossingIntegrator::step_by_runge_kutta(double limit, double first, ErrorScale& scale, std::span<double> slope) {
  if (!stepped_by_runge_kutta_ || runge_kutta_.time() != t_) {
    motion_.equations().evaluator().go_to_curve_places(curve_places_);
    if (!runge_kutta_.take_over(t_, y_, first, scale, usual_ratio_)) return false;
  }
  const bool advanced = runge_kutta_.advance(limit);
  culprit_ = runge_kutta_.culprit();
  if (!advanced) return false;
  t_before_ = t_;
  t_ = runge_kutta_.time();
  position_residual_ = runge_kutta_.position_residual();
  std::copy(runge_kutta_.state().begin(), runge_kutta_.state().end(), y_.begin());
  std::copy(runge_kutta_.slope().begin(), runge_kutta_.slope().end(), slope.begin());
  scale.take_over(runge_kutta_.scale());
  curve_places_ = motion_.equations().evaluator().curve_places();
  stepped_by_runge_kutta_ = true;
  observe_ratio();
  return true;
}

void CrossingIntegrator::tell_work(double t, double t_before, std::span<const double> y_before,
                                   std::span<double> y) const {
  energy_.restore_work(motion_, {.t = t, .h = t - t_before, .y_before = y_before, .y = y});
}

void CrossingIntegrator::tell_work_between(double t, std::span<double> y) const {
  if (!tells_work()) return;
  EquationsOfMotion& equations = motion_.equations();
  if (!equations.factorize(t, Side::after, motion_.q(std::span<const double>(y)))) return;
  equations.project_position(motion_.q(y), 4);
  equations.project_velocity(motion_.qd(y), rate());
  tell_work(t, t_, y_, y);
}

void CrossingIntegrator::find_unseen(double h, std::span<const double> begin, std::span<const double> end,
                                     std::span<double> unseen) {
  const std::size_t n = motion_.coordinates();
  y_inside_.assign(y_.begin(), y_.end());
  slope_inside_.resize(y_.size());
  std::fill(unseen.begin(), unseen.end(), 0.0);
  for (int stage = 1; stage < dormand_prince_8().stages; ++stage) {
    const double part = dormand_prince_8().c[static_cast<std::size_t>(stage)], s = part * h;
    if (part >= 1) continue;
    for (std::size_t c = 0; c < n; ++c) {
      y_inside_[c] = y_[c] + s * (y_[n + c] + s / 2 * begin[c]);
      y_inside_[n + c] = y_[n + c] + s * begin[c];
    }
    if (!motion_.derivative(t_ + s, Side::after, y_inside_, slope_inside_)) {
      std::fill(unseen.begin(), unseen.end(), std::numeric_limits<double>::infinity());
      return;
    }
    for (std::size_t c = 0; c < n; ++c) {
      const double straight = begin[c] + part * (end[c] - begin[c]);
      unseen[c] = std::max(unseen[c], std::abs(slope_inside_[n + c] - straight));
    }
  }
}

bool CrossingIntegrator::has_crossed() {
  ++crossing_steps_;
  return runge_kutta_.pivot_ratio() > dependence::behind_passage && !runge_kutta_.dips();
}

IntegratorMemory CrossingIntegrator::memory_of(const ErrorScale& scale, double step) const {
  IntegratorMemory memory = scale.memory();
  memory.step = step;
  memory.usual_ratio = usual_ratio_;
  return memory;
}

std::vector<std::string> CrossingIntegrator::remarks() const {
  std::vector<std::string> all;
  if (crossing_steps_ > 0)
    all.push_back(fmt::format("Runge-Kutta took {} steps across nearly singular positions", crossing_steps_));
  runge_kutta_.remark_on_branches(all);
  return all;
}

}  // namespace catena
