#include "catena/analysis/dynamics/implicit/alpha.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/dynamics/implicit/implicit_step.hpp"
#include "catena/analysis/motion/step_growth.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

constexpr int usual_repetitions = 10;   // of Newton's method; a step that needs more is shortened, if it may be
constexpr double longest = 4;           // of steps that follow each other
constexpr double starting_step = 0.02;  // parts of the time scale, times the cube root of the tolerance

}  // namespace

Alpha::Alpha(Motion motion, const AlphaOptions& options, const RungeKuttaOptions& across)
    : CrossingIntegrator(motion, across), options_(options), matrix_(motion) {
  for (auto* y : {&y_, &y_before_, &y_new_, &slope_, &slope_new_, &slope_before_}) y->assign(motion_.size(), 0.0);
  own_.assign(motion_.coordinates(), 0.0);
  own_new_ = shifted_ = own_;
  residual_.assign(2 * motion_.coordinates(), 0.0);
  am_ = (2 * options.rho - 1) / (options.rho + 1);
  af_ = options.rho / (options.rho + 1);
  g_ = 0.5 + af_ - am_;
  b_ = (g_ + 0.5) * (g_ + 0.5) / 4;
  scale_.step_tolerance = options.tolerance;
  scale_.horizon = options.horizon;
  scale_.length = motion_.length_scale();
  scale_.set_masses(motion_.equations().masses().mass);
}

bool Alpha::start(double t, std::span<const double> y) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  if (!motion_.derivative(t_, Side::after, y_, slope_)) return false;
  curve_places_ = motion_.equations().evaluator().curve_places();
  forget_passages();
  begin_anew();
  observe(0);
  h_ = scale_.rate() > 0 ? starting_step * std::cbrt(scale_.tolerance()) / scale_.rate()
                         : std::numeric_limits<double>::max();
  return true;
}

// The next step knows of none before it.
void Alpha::begin_anew() {
  std::copy(accelerations().begin(), accelerations().end(), own_.begin());
  linearized_ = crossing_ = false;
  last_h_ = factored_h_ = 0;
}

void Alpha::observe(double h) {
  implicit_step::observe(motion_, scale_, t_, h, y_, slope_);
  observe_ratio();
}

bool Alpha::advance(double limit) {
  const bool fixed = options_.fixed_step > 0;
  Evaluator& evaluator = motion_.equations().evaluator();
  if (fixed) h_ = options_.fixed_step;
  if (!crossing_) {
    evaluator.take_turns(motion_.q(std::span(y_)));
    stepped_by_runge_kutta_ = false;
  }
  for (int trial = 0; trial < most_rejections && !crossing_; ++trial) {
    evaluator.go_to_curve_places(curve_places_);
    const double remaining = limit - t_;
    const bool lands = h_ * (fixed ? 1 + 1e-9 : 1.01) >= remaining;
    double h = lands ? remaining : h_;
    // Two equal steps in place of a long one and a tiny one.
    if (!lands && !fixed && 2 * h > remaining) h = remaining / 2;
    if (h < scale_.smallest_step(t_) && !lands) return false;
    t_new_ = lands ? limit : t_ + h;
    const bool solved = solve(h);
    if (dips()) {
      crossing_ = true;
      break;
    }
    if (!solved) {
      ++evaluator.counters.rejected;
      if (fixed) return false;
      h_ = h / 2;
      linearized_ = false;
      continue;
    }
    double error = fixed ? 0 : error_of_step(h);
    if (!fixed && last_h_ == 0 && error < 1 && is_long_start(scale_.rate(), remaining))
      error = std::max(error, error_within(h));
    if (!(error < 1)) {
      ++evaluator.counters.rejected;
      h_ = h * std::clamp(step_safety / std::cbrt(error), largest_cut, step_safety);
      continue;
    }
    if (finish()) {
      accept(h, error);
      return true;
    }
    ++evaluator.counters.rejected;
    culprit_ = -1;
    if (fixed) return false;
    h_ = h / 2;
  }
  return crossing_ && advance_by_runge_kutta(limit);
}

// A step across a singular position.
bool Alpha::advance_by_runge_kutta(double limit) {
  return step_across(limit, options_.fixed_step, h_, scale_, slope_, [this] { begin_anew(); });
}

// q1 and v1 from A1.
void Alpha::place(double h) {
  const std::size_t n = motion_.coordinates();
  for (std::size_t c = 0; c < n; ++c) {
    y_new_[c] = y_[c] + h * (y_[n + c] + h * ((0.5 - b_) * shifted_[c] + b_ * own_new_[c]));
    y_new_[n + c] = y_[n + c] + h * ((1 - g_) * shifted_[c] + g_ * own_new_[c]);
  }
}

bool Alpha::solve(double h) {
  const std::size_t n = motion_.coordinates();
  if (!linearized_) {
    if (!motion_.derivative(t_, Side::after, y_, slope_new_) || !matrix_.linearize(t_, Side::after, y_)) return false;
    linearized_ = true;
    factored_h_ = 0;
  }
  if (factored_h_ != h && !matrix_.factorize(std::sqrt((1 - am_) / ((1 - af_) * b_)) / h)) return false;
  factored_h_ = h;
  // A follows a by a part of the step: of another length, by the same part of that (Bruels and Arnold 2008).
  const double ratio = last_h_ > 0 ? h / last_h_ : 1;
  for (std::size_t c = 0; c < n; ++c) shifted_[c] = slope_[n + c] + ratio * (own_[c] - slope_[n + c]);
  std::copy(shifted_.begin(), shifted_.end(), own_new_.begin());
  double before = std::numeric_limits<double>::infinity();
  const int most = options_.fixed_step > 0 ? thresholds::most_bisections : usual_repetitions;
  for (int k = 0; k < most; ++k) {
    place(h);
    if (!motion_.derivative(t_new_, Side::before, y_new_, slope_new_)) return false;
    for (std::size_t c = 0; c < n; ++c) {
      residual_[c] = 0;
      residual_[n + c] =
          slope_new_[n + c] + (af_ * slope_[n + c] - (1 - am_) * own_new_[c] - am_ * shifted_[c]) / (1 - af_);
    }
    matrix_.solve(residual_);
    double largest = 0, largest_change = 0;
    for (std::size_t c = 0; c < n; ++c) {
      residual_[c] /= b_ * h * h;
      own_new_[c] += residual_[c];
      const double unit = c % 3 == 2 ? 1 : scale_.length;
      largest = std::max(largest, std::abs(own_new_[c]) / unit);
      largest_change = std::max(largest_change, std::abs(residual_[c]) / unit);
    }
    const double change = size_of(std::span(residual_).first(n), h, b_ * h * h, g_ * h, implicit_step::left_part);
    if (!std::isfinite(change)) return false;
    // Of vibrations that have died away rounding is left: of places, and corrections that no longer become smaller.
    const bool stalls = change > thresholds::least_gain * before;
    const bool is_rounding = b_ * h * h * largest_change <= thresholds::position_rounding ||
                             (stalls && largest_change <= thresholds::same_value * largest);
    if (change <= 1 || is_rounding) {
      place(h);
      return true;
    }
    if (change >= before) return false;
    before = change;
  }
  return false;
}

// The largest change of an acceleration by what it makes of places and velocities, in units of `part` of the allowed
// error and of what rounding makes of it.
double Alpha::size_of(std::span<const double> change, double h, double of_place, double of_velocity, double part) {
  const std::size_t n = motion_.coordinates();
  double largest = 0;
  for (std::size_t c = 0; c < motion_.moving(); ++c) {
    const auto unit = implicit_step::units(scale_, c, h, y_[n + c], part);
    const double of_v = unit.velocity > 0 ? of_velocity / unit.velocity : 0;
    const double size = std::abs(change[c]) * std::max(of_v, of_place / unit.place);
    if (!(size <= largest)) {
      largest = size;
      culprit_ = static_cast<int>(c);
    }
  }
  return largest;
}

double Alpha::error_of_step(double h) {
  const std::size_t n = motion_.coordinates();
  const std::span<double> change = std::span(residual_).first(n);
  for (std::size_t c = 0; c < n; ++c) change[c] = own_new_[c] - shifted_[c];
  const double of_place = size_of(change, h, h * h * std::abs(b_ - 1.0 / 6), 0, 1);
  const double ratio = last_h_ > 0 ? h / last_h_ : 0;
  for (std::size_t c = 0; c < n; ++c)
    change[c] = slope_new_[n + c] - slope_[n + c] - ratio * (slope_[n + c] - slope_before_[n + c]);
  return std::max({of_place, size_of(change, h, 0, h / 12, 1), error_of_work(h, ratio)});
}

// Of a first step what its two ends do not show.
double Alpha::error_within(double h) {
  const std::size_t n = motion_.coordinates();
  const std::span<double> unseen = std::span(residual_).first(n);
  find_unseen(h, accelerations(), std::span(slope_new_).subspan(n, n), unseen);
  if (!motion_.derivative(t_new_, Side::before, y_new_, slope_new_)) return std::numeric_limits<double>::infinity();
  return size_of(unseen, h, h * h / 2, h / 2, 1);
}

// Of the work of loads, of what dampers take and of drivers, by the second difference of their powers: the trapezoid
// rule.
double Alpha::error_of_work(double h, double ratio) const {
  const std::span<const double> end(slope_new_);
  double largest = 0;
  for (std::size_t place = 0; place < judged_works(); ++place) {
    const std::size_t k = 2 * motion_.coordinates() + place;
    const double change = slope_new_[k] - slope_[k];
    const double error = h / 12 * std::abs(change - ratio * (slope_[k] - slope_before_[k]));
    if (error == 0) continue;
    largest = std::max(largest, scale_.size_of_work(error, {h, y_[k], y_[k] + h / 2 * (slope_[k] + slope_new_[k])},
                                                    motion_.equations().applied_forces(), motion_.qd(end)));
  }
  return largest;
}

// Takes the end of the step to the constraints and evaluates there.
bool Alpha::finish() {
  return implicit_step::project_end(motion_, t_new_, scale_.rate(), y_new_, position_residual_) &&
         motion_.derivative(t_new_, Side::before, y_new_, slope_new_);
}

void Alpha::accept(double h, double error) {
  const std::size_t n = motion_.coordinates();
  for (std::size_t k = 2 * n; k < y_.size(); ++k) y_new_[k] = y_[k] + h / 2 * (slope_[k] + slope_new_[k]);
  tell_work(t_new_, t_, y_, y_new_);
  y_before_.swap(y_);
  y_.swap(y_new_);
  slope_before_.swap(slope_);
  slope_.swap(slope_new_);
  own_.swap(own_new_);
  t_before_ = t_;
  t_ = t_new_;
  last_h_ = h;
  curve_places_ = motion_.equations().evaluator().curve_places();
  ++motion_.equations().evaluator().counters.steps;
  observe(h);
  linearized_ = false;
  const double ratio = std::clamp(step_safety / std::cbrt(std::max(error, 1e-6)), largest_cut, longest);
  // Factors are made anew at every step; a length that stays keeps the second difference of accelerations exact.
  if (ratio < 1 || ratio > 1.2)
    h_ = h * ratio;
  else
    h_ = h;
}

void Alpha::interpolate(double t, std::span<double> y) {
  if (stepped_by_runge_kutta_) return runge_kutta_.interpolate(t, y);
  implicit_step::interpolate({t_before_, t_, y_before_, y_, slope_before_, slope_}, t, motion_.coordinates(), y);
  tell_work_between(t, y);
}

}  // namespace catena
