// Adams::advance: the choice of order and step, and when Runge-Kutta takes over.
#include <algorithm>
#include <cmath>

#include "catena/analysis/dynamics/integrators/adams.hpp"
#include "catena/analysis/motion/step_growth.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

constexpr double goal = 0.5;  // error a step is chosen for, compared with what is allowed
constexpr double longer = 4;  // steps of Runge-Kutta, compared with those of an Adams method
constexpr std::size_t fixed_order = 8;

}  // namespace

bool Adams::advance(double limit) {
  const bool fixed = options_.fixed_step > 0;
  const double smallest = scale_.smallest_step(t_);
  failures_ = 0;
  if (fixed) h_ = options_.fixed_step;
  const auto by_itself = [&] { return !crossing_ && !(fixed && k_ < fixed_order); };
  // Runge-Kutta continues from its own copy of the state and takes whole turns out of it: they must be taken only once.
  if (by_itself()) {
    motion_.equations().evaluator().take_turns(motion_.q(std::span(y_)));
    stepped_by_runge_kutta_ = false;
  }
  while (by_itself()) {
    motion_.equations().evaluator().go_to_curve_places(curve_places_);
    const double remaining = limit - t_;
    const bool lands = h_ * (fixed ? 1 + 1e-9 : 1.01) >= remaining;
    // Two equal steps instead of a long one and a tiny one.
    double h = lands ? remaining : h_;
    if (!lands && !fixed && 2 * h > remaining) h = remaining / 2;
    if ((h < smallest && !lands) || failures_ > most_rejections) return false;
    t_new_ = lands ? limit : t_ + h;
    if (try_step(h, remaining)) return true;
    if (fixed && !crossing_) return false;
  }
  return advance_by_runge_kutta(limit);
}

// False: too large an error, in which case order and step were reduced, or a singular position nearby.
bool Adams::try_step(double h, double remaining) {
  const bool fixed = options_.fixed_step > 0;
  const std::size_t n = motion_.coordinates();
  predict(h);
  motion_.switches().begin_step(t_);
  if (!motion_.derivative(t_new_, Side::before, y_new_, slope_)) {
    culprit_ = -1;
    fail(h, 1e10, true);
    return false;
  }
  if (dips()) {
    crossing_ = true;
    return false;
  }
  for (std::size_t c = 0; c < change_.size(); ++c) change_[c] = slope_[n + c] - predicted_[c];
  const Errors errors = estimate(h);
  const bool lower = errors.favour_lower(k_);
  double error = fixed ? 0 : error_of_step(h);
  if (!(error <= 1) && std::isfinite(error)) error = compared_with_end(h, error);
  if (!(error <= 1) && std::isfinite(error)) error = filtered(h, error);
  if (!fixed && motion_.works() > 0) error = std::max(error, error_of_work(h));
  const bool unseen = !fixed && k_ == 1 && error <= 1 && is_long_start(scale_.rate(), remaining);
  if (unseen) error = error_within(h);
  if (!(error <= 1)) {
    fail(h, !std::isfinite(error) ? 1e10 : unseen ? error : errors.now, lower);
    return false;
  }
  if (!finish(h)) {
    culprit_ = -1;
    fail(h, 1e10, true);
    return false;
  }
  const bool steady = k_before_ >= k_ && k_ < most && history_.equal_steps(k_, h);
  const double above = steady && !starting_ && !lower ? estimate_above(h) : -1;
  update(h);
  t_before_ = t_;
  t_ = t_new_;
  y_.swap(y_new_);
  curve_places_ = motion_.equations().evaluator().curve_places();
  stepped_by_runge_kutta_ = false;
  ++motion_.equations().evaluator().counters.steps;
  observe_ratio();
  const std::span<const double> y(y_), k(slope_);
  scale_.observe(t_, h, motion_.q(y).first(motion_.moving()), motion_.qd(y).first(motion_.moving()),
                 motion_.qd(k).first(motion_.moving()), motion_.equations().applied_forces(),
                 motion_.equations().smallest_pivot_ratio());
  if (!fixed) choose(h, errors, lower, above);
  return true;
}

// The error compared with the motion at the step's end, where that is faster.
double Adams::compared_with_end(double h, double error) {
  const std::span<const double> y(y_new_), k(slope_);
  return scale_.compare_with_end(motion_.qd(y).first(motion_.moving()), motion_.qd(k).first(motion_.moving()), error,
                                 [&] { return error_of_step(h); });
}

void Adams::fail(double h, double error, bool lower) {
  ++motion_.equations().evaluator().counters.rejected;
  starting_ = false;
  double cut = 0.5;
  if (++failures_ > 3 && goal < 0.25 * error) cut = std::max(std::sqrt(goal / error), 0.01);
  if (failures_ >= 3) {
    k_ = 1;
  } else if (lower && k_ > 1) {
    --k_;
  }
  h_ = cut * h;
  // Differences of many points magnify the rounding of accelerations near a singular position.
  if (failures_ >= 3 && motion_.equations().smallest_pivot_ratio() < dependence::clear_of_passage * usual_ratio_)
    crossing_ = true;
}

// Order and size of the next step. `above`: the error at order k + 1, negative where it is not known.
void Adams::choose(double h, const Errors& errors, bool lower, double above) {
  double error = errors.now;
  const auto change_order = [&](bool up) {
    error = up ? std::max(above, 0.0) : errors.below;
    k_ = up ? k_ + 1 : k_ - 1;
  };
  if (lower || k_ == most) starting_ = false;
  if (starting_) {
    ++k_;
  } else if (lower) {
    change_order(false);
  } else if (above >= 0) {
    if (k_ > 1 && errors.below <= std::min(errors.now, above)) {
      change_order(false);
    } else if (above < (k_ > 1 ? 1 : 0.5) * errors.now) {
      change_order(true);
    }
  }
  const double power = static_cast<double>(k_) + 1;
  if (starting_ || goal >= error * std::pow(2, power)) {
    h_ = 2 * h;
  } else {
    h_ = goal >= error ? h : h * std::clamp(std::pow(goal / error, 1 / power), 0.5, 0.9);
  }
}

// A step of Runge-Kutta: across a singular position, or one of the first of a fixed length.
bool Adams::advance_by_runge_kutta(double limit) {
  const double start = t_;
  if (!step_by_runge_kutta(limit, longer * h_, scale_, slope_)) return false;
  const double h = t_ - start;
  if (!crossing_) {
    predict(h);
    update(h);
    ++k_;
  } else if (has_crossed()) {
    forget();
    h_ = options_.fixed_step > 0 ? options_.fixed_step : std::min(h_, h);
  }
  return true;
}

}  // namespace catena
