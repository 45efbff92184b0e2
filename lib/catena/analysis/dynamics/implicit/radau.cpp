#include "catena/analysis/dynamics/implicit/radau.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/dynamics/implicit/implicit_step.hpp"
#include "catena/analysis/motion/step_growth.hpp"

namespace catena {
namespace {

// Tolerances x of a step are factor x^power of its estimate: see the header. With a factor of ten, elastic cables that
// became taut within a step were off by 35 tolerances; with this one 1500 random motions with contacts, stops and
// cables kept within ten but for one that was off by eleven beside such a kink, and two of blocks whose bounces
// accumulate.
constexpr double estimate_factor = 1.5, estimate_power = 0.8;
// Beside kinks, where errors are as large as their estimates, a step has this many parts of those of Runge-Kutta.
constexpr double rough_part = 5;
// By how much corrections should become smaller at least, with steps that grow: a matrix of a stiff spring that turns
// by an angle within a step is off by so much that this ratio grows with the square of the step.
constexpr double slowest_convergence = 0.3;
constexpr double first_step = 0.05;  // parts of the time scale, times the fourth root of the tolerance
constexpr double most_ratio = 8;     // of steps that follow each other
// Steps that could be this much longer keep their length, and the factors with it (Hairer and Wanner).
constexpr double not_worth_it = 1.2;
// Stages are of two orders less than the ends of a step, and lie beside the motion by some of the errors that are
// allowed; what has died away within a step is farther off. By the polynomial of the stages alone, instants of impacts
// were wrong by up to 20 tolerances in random motions, by that of the ends by at most one.
constexpr double of_stages = 10;

}  // namespace

Radau::Radau(Motion motion, const RungeKuttaOptions& options)
    : CrossingIntegrator(motion, options), options_(options), matrix_(motion) {
  for (std::vector<double>* y : {&y_, &y_before_, &y_new_, &y_stage_, &slope_, &slope_before_, &error_})
    y->assign(motion_.size(), 0.0);
  for (auto* stages : {&z_, &last_z_, &f_, &residual_}) {
    for (std::vector<double>& stage : *stages) stage.assign(motion_.size(), 0.0);
  }
  scale_.step_tolerance = options.tolerance;
  scale_.loosen(estimate_factor, estimate_power);
  scale_.horizon = options.horizon;
  scale_.length = motion_.length_scale();
  scale_.set_masses(motion_.equations().masses().mass);
}

bool Radau::start(double t, std::span<const double> y) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  if (!motion_.derivative(t_, Side::after, y_, slope_)) return false;
  curve_places_ = motion_.equations().evaluator().curve_places();
  forget_passages();
  observe(0);
  forget();
  return true;
}

// The next step knows of none before it.
void Radau::forget() {
  is_.linearized = is_.has_stages = is_.rejected = crossing_ = false;
  is_.first = true;
  factored_h_ = last_error_ = 0;
  h_ = scale_.rate() > 0 ? first_step * std::pow(scale_.tolerance(), 0.25) / scale_.rate()
                         : std::numeric_limits<double>::max();
}

void Radau::observe(double h) {
  implicit_step::observe(motion_, scale_, t_, h, y_, slope_);
  observe_ratio();
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
    if ((h < scale_.smallest_step(t_) && !lands) || failures > most_rejections) return false;
    t_new_ = lands ? limit : t_ + h;
    predict(h);
    motion_.switches().begin_step(t_);
    if (!prepare(h)) return false;
    const Newton outcome = solve_stages(h);
    if (dips()) {
      crossing_ = true;
      break;
    }
    if (outcome != Newton::converged) {
      if (fixed && is_.fresh) return false;
      // A matrix of an earlier state is made anew first.
      ++motion_.equations().evaluator().counters.rejected;
      if (is_.fresh || outcome == Newton::failed) h_ = h / 2;
      is_.linearized = false;
      // The stages before are a good guess of shorter ones, unless there were none or they lead to nowhere.
      if (outcome == Newton::failed) is_.has_stages = false;
      continue;
    }
    sum_up_work(h);
    switches_ = motion_.switches().found();
    const double error = fixed ? 0 : std::max(error_of_step(h), error_of_work(h));
    const double allowed = is_.rejected || switches_.cables ? rough_part * scale_.strict_part() : 1;
    if (!(error < allowed)) {
      reject(h, error / allowed);
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
  if (!implicit_step::project_end(motion_, t_new_, scale_.rate(), y_new_, position_residual_)) return false;
  tell_work(t_new_, t_, y_, y_new_);
  return motion_.derivative(t_new_, Side::before, y_new_, error_);
}

void Radau::accept(double h, double error) {
  y_before_.swap(y_);
  y_.swap(y_new_);
  slope_before_.swap(slope_);
  slope_.swap(error_);
  last_z_.swap(z_);
  smooth_ = Smooth::unknown;
  t_before_ = t_;
  t_ = t_new_;
  curve_places_ = motion_.equations().evaluator().curve_places();
  ++motion_.equations().evaluator().counters.steps;
  observe(h);
  // The step that the error asks for, and that which the course of errors foresees.
  const double factor = step_safety * (1 + 2.0 * most_corrections) / (corrections_ + 2.0 * most_corrections);
  double ratio = factor / std::pow(std::max(error, 1e-8), 0.25);
  if (last_error_ > 0) {
    const double course = factor * h / last_h_ * std::pow(last_error_ / std::pow(std::max(error, 1e-8), 2), 0.25);
    ratio = std::min(ratio, course);
  }
  last_error_ = std::max(error, 1e-2);
  // The matrix changes with the step, and corrections become smaller by as much less.
  if (convergence_ > 0) ratio = std::min(ratio, std::sqrt(slowest_convergence / convergence_));
  ratio = std::clamp(ratio, largest_cut, is_.rejected ? 1.0 : most_ratio);
  const bool keeps = convergence_ < keeps_matrix;
  h_ = keeps && ratio >= 1 && ratio <= not_worth_it ? h : h * ratio;
  is_.linearized = keeps;
  is_.fresh = is_.first = is_.rejected = false;
  is_.has_stages = true;
  last_h_ = h;
}

void Radau::reject(double h, double error) {
  ++motion_.equations().evaluator().counters.rejected;
  h_ = is_.first ? h / 10 : h * std::clamp(step_safety / std::pow(error, 0.25), largest_cut, 0.9);
  if (!std::isfinite(error)) h_ = h / 10;
  is_.rejected = true;
  if (!is_.fresh) is_.linearized = false;
}

void Radau::interpolate(double t, std::span<double> y) {
  if (stepped_by_runge_kutta_) return runge_kutta_.interpolate(t, y);
  if (smooth_ == Smooth::unknown) smooth_ = is_smooth() ? Smooth::yes : Smooth::no;
  if (smooth_ == Smooth::yes) {
    implicit_step::interpolate_quintic(ends(), t, motion_.coordinates(), scale_, y);
    return tell_work_between(t, y);
  }
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
  tell_work_between(t, y);
}

// Whether the polynomial of both ends goes through the stages of the last step, as far as these are known.
bool Radau::is_smooth() {
  const std::size_t n = motion_.coordinates();
  for (std::size_t i = 0; i < 2; ++i) {
    implicit_step::interpolate_quintic(ends(), t_before_ + radau_tableau().c[i] * last_h_, n, scale_, y_stage_);
    for (std::size_t k = 0; k < 2 * n; ++k) y_stage_[k] -= y_before_[k] + last_z_[i][k];
    if (!(size_of(std::span(y_stage_).first(2 * n), last_h_, 1) <= of_stages)) return false;
  }
  return true;
}

// A step across a singular position.
bool Radau::advance_by_runge_kutta(double limit) {
  return step_across(limit, options_.fixed_step, h_, scale_, slope_, [this] { forget(); });
}

void Radau::remember(const IntegratorMemory& memory) {
  scale_.remember(memory);
  usual_ratio_ = memory.usual_ratio;
}

}  // namespace catena
