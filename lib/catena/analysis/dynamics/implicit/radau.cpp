#include "catena/analysis/dynamics/implicit/radau.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/dynamics/implicit/implicit_step.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

constexpr double first_step = 0.05;  // parts of the time scale, times the fourth root of the tolerance
constexpr double safety = 0.9;
constexpr double least_ratio = 0.2, most_ratio = 8;  // of steps that follow each other
// Steps that could be this much longer keep their length, and the factors with it (Hairer and Wanner).
constexpr double not_worth_it = 1.2;
constexpr double forgotten = 0.97;  // of what pivots were usual, at every step
constexpr int most_failures = 100;

}  // namespace

Radau::Radau(Motion motion, const RungeKuttaOptions& options)
    : motion_(motion), options_(options), runge_kutta_(motion, options), matrix_(motion) {
  for (std::vector<double>* y : {&y_, &y_before_, &y_new_, &y_stage_, &slope_, &error_}) y->assign(motion_.size(), 0.0);
  for (auto* stages : {&z_, &last_z_, &f_, &residual_}) {
    for (std::vector<double>& stage : *stages) stage.assign(motion_.size(), 0.0);
  }
  usual_ratio_ = std::max(usual_ratio_, options.usual_ratio);
  scale_.step_tolerance = options.tolerance;
  scale_.horizon = options.horizon;
  scale_.length = motion_.length_scale();
  scale_.set_masses(motion_.equations().masses().mass);
}

bool Radau::start(double t, std::span<const double> y) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  if (!motion_.derivative(t_, Side::after, y_, slope_)) return false;
  curve_places_ = motion_.equations().evaluator().curve_places();
  largest_ratio_ = 0;
  stepped_by_runge_kutta_ = false;
  observe(0);
  forget();
  return true;
}

// The next step knows of none before it.
void Radau::forget() {
  linearized_ = has_stages_ = rejected_ = crossing_ = false;
  first_ = true;
  factored_h_ = last_error_ = 0;
  h_ = scale_.rate() > 0 ? first_step * std::pow(scale_.tolerance(), 0.25) / scale_.rate()
                         : std::numeric_limits<double>::max();
}

void Radau::observe(double h) {
  implicit_step::observe(motion_, scale_, t_, h, y_, slope_);
  remember_ratio();
}

void Radau::remember_ratio() {
  const double ratio = motion_.equations().smallest_pivot_ratio();
  usual_ratio_ = std::max(usual_ratio_, ratio);
  largest_ratio_ = std::max(ratio, forgotten * largest_ratio_);
}

bool Radau::dips() const {
  const double ratio = motion_.equations().smallest_pivot_ratio();
  return ratio < std::min(dependence::singular_passage * usual_ratio_, dependence::unusual * largest_ratio_);
}

bool Radau::advance(double limit) {
  const bool fixed = options_.fixed_step > 0;
  if (fixed) h_ = options_.fixed_step;
  if (!crossing_) {
    motion_.equations().evaluator().take_turns(motion_.q(std::span(y_)));
    stepped_by_runge_kutta_ = false;
  }
  for (int failures = 0; !crossing_; ++failures) {
    motion_.equations().evaluator().go_to_curve_places(curve_places_);
    const double remaining = limit - t_;
    const bool lands = h_ * (fixed ? 1 + 1e-9 : 1.01) >= remaining;
    double h = lands ? remaining : h_;
    // Two equal steps in place of a long one and a tiny one.
    if (!lands && !fixed && 2 * h > remaining) h = remaining / 2;
    if ((h < scale_.smallest_step(t_) && !lands) || failures > most_failures) return false;
    t_new_ = lands ? limit : t_ + h;
    if (!prepare(h)) return false;
    predict(h);
    const Newton outcome = solve_stages(h);
    if (dips()) {
      crossing_ = true;
      break;
    }
    if (outcome != Newton::converged) {
      if (fixed && fresh_) return false;
      // A matrix of an earlier state is made anew first.
      ++motion_.equations().evaluator().counters.rejected;
      if (fresh_ || outcome == Newton::failed) h_ = h / 2;
      linearized_ = has_stages_ = false;
      continue;
    }
    sum_up_work(h);
    const double error = fixed ? 0 : std::max(error_of_step(h), error_of_work(h));
    if (!(error < 1)) {
      reject(h, error);
      continue;
    }
    if (finish()) {
      accept(h, error);
      return true;
    }
    culprit_ = -1;
    reject(h, 1e4);
    if (fixed) return false;
  }
  return advance_by_runge_kutta(limit);
}

// Takes the end of the step to the constraints and evaluates there.
bool Radau::finish() {
  for (std::size_t k = 0; k < y_.size(); ++k) y_new_[k] = y_[k] + z_[2][k];
  return implicit_step::project_end(motion_, t_new_, scale_.rate(), y_new_, position_residual_) &&
         motion_.derivative(t_new_, Side::before, y_new_, error_);
}

void Radau::accept(double h, double error) {
  y_before_.swap(y_);
  y_.swap(y_new_);
  slope_.swap(error_);
  last_z_.swap(z_);
  t_before_ = t_;
  t_ = t_new_;
  curve_places_ = motion_.equations().evaluator().curve_places();
  ++motion_.equations().evaluator().counters.steps;
  observe(h);
  // The step that the error asks for, and that which the course of errors foresees.
  const double factor = safety * (1 + 2.0 * most_corrections) / (corrections_ + 2.0 * most_corrections);
  double ratio = factor / std::pow(std::max(error, 1e-8), 0.25);
  if (last_error_ > 0) {
    const double course = factor * h / last_h_ * std::pow(last_error_ / std::pow(std::max(error, 1e-8), 2), 0.25);
    ratio = std::min(ratio, course);
  }
  last_error_ = std::max(error, 1e-2);
  ratio = std::clamp(ratio, least_ratio, rejected_ ? 1.0 : most_ratio);
  const bool keeps = convergence_ < keeps_matrix;
  h_ = keeps && ratio >= 1 && ratio <= not_worth_it ? h : h * ratio;
  linearized_ = keeps;
  fresh_ = first_ = rejected_ = false;
  has_stages_ = true;
  last_h_ = h;
}

void Radau::reject(double h, double error) {
  ++motion_.equations().evaluator().counters.rejected;
  h_ = first_ ? h / 10 : h * std::clamp(safety / std::pow(error, 0.25), least_ratio, 0.9);
  if (!std::isfinite(error)) h_ = h / 10;
  rejected_ = true;
  if (!fresh_) linearized_ = false;
}

void Radau::interpolate(double t, std::span<double> y) {
  if (stepped_by_runge_kutta_) return runge_kutta_.interpolate(t, y);
  const std::array<double, 3>& c = radau_tableau().c;
  const double s = (t - t_before_) / last_h_;
  std::copy(y_before_.begin(), y_before_.end(), y.begin());
  for (std::size_t j = 0; j < 3; ++j) {
    double weight = s / c[j];
    for (std::size_t k = 0; k < 3; ++k) {
      if (k != j) weight *= (s - c[k]) / (c[j] - c[k]);
    }
    for (std::size_t k = 0; k < y.size(); ++k) y[k] += weight * last_z_[j][k];
  }
}

// A step of Runge-Kutta, across a singular position.
bool Radau::advance_by_runge_kutta(double limit) {
  if (!stepped_by_runge_kutta_ || runge_kutta_.time() != t_) {
    motion_.equations().evaluator().go_to_curve_places(curve_places_);
    if (!runge_kutta_.take_over(t_, y_, h_, scale_, usual_ratio_)) return false;
  }
  const bool advanced = runge_kutta_.advance(limit);
  culprit_ = runge_kutta_.culprit();
  if (!advanced) return false;
  const double h = runge_kutta_.time() - t_;
  t_before_ = t_;
  t_ = runge_kutta_.time();
  position_residual_ = runge_kutta_.position_residual();
  std::copy(runge_kutta_.state().begin(), runge_kutta_.state().end(), y_.begin());
  std::copy(runge_kutta_.slope().begin(), runge_kutta_.slope().end(), slope_.begin());
  scale_ = runge_kutta_.scale();
  curve_places_ = motion_.equations().evaluator().curve_places();
  stepped_by_runge_kutta_ = true;
  remember_ratio();
  ++crossing_steps_;
  if (runge_kutta_.pivot_ratio() > dependence::behind_passage && !runge_kutta_.dips()) {
    forget();
    h_ = options_.fixed_step > 0 ? options_.fixed_step : std::min(h_, h);
  }
  return true;
}

IntegratorMemory Radau::memory() const {
  IntegratorMemory memory = scale_.memory();
  memory.step = h_;
  memory.usual_ratio = usual_ratio_;
  return memory;
}

void Radau::remember(const IntegratorMemory& memory) {
  scale_.remember(memory);
  usual_ratio_ = memory.usual_ratio;
}

std::vector<std::string> Radau::remarks() const {
  std::vector<std::string> all;
  if (crossing_steps_ > 0)
    all.push_back(fmt::format("Runge-Kutta took {} steps across nearly singular positions", crossing_steps_));
  runge_kutta_.remark_on_branches(all);
  return all;
}

}  // namespace catena
