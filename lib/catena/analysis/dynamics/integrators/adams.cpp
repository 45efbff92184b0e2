#include "catena/analysis/dynamics/integrators/adams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

// Errors of the method with steps of one length: order k of the predictor, for a change of f by one.
constexpr double steady_error[] = {0,      0.5,     0.0833,  0.0417,  0.0264,  0.0188,  0.0143,
                                   0.0114, 0.00936, 0.00789, 0.00679, 0.00592, 0.00524, 0.00468};
constexpr double first_step = 0.25;   // parts of the time scale, times the root of the tolerance
constexpr double removed_part = 0.1;  // that counts of an error which the projection removes
constexpr std::size_t block = 256;    // entries that stay in the first cache while all differences are added

}  // namespace

Adams::Adams(Motion motion, const RungeKuttaOptions& options) : CrossingIntegrator(motion, options), options_(options) {
  const std::size_t size = motion_.size();
  for (std::vector<double>* y : {&y_, &y_new_, &slope_}) y->assign(size, 0.0);
  difference_.assign(most + 3, std::vector<double>(size - motion_.coordinates(), 0.0));
  predicted_.assign(size - motion_.coordinates(), 0.0);
  change_.assign(size - motion_.coordinates(), 0.0);
  scale_.step_tolerance = options.tolerance;
  scale_.horizon = options.horizon;
  scale_.length = motion_.length_scale();
  scale_.set_masses(motion_.equations().masses().mass);
}

bool Adams::start(double t, std::span<const double> y) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  if (!motion_.derivative(t_, Side::after, y_, slope_)) return false;
  curve_places_ = motion_.equations().evaluator().curve_places();
  const std::span<const double> state(y_), k(slope_);
  scale_.observe(t_, 0, motion_.q(state).first(motion_.moving()), motion_.qd(state).first(motion_.moving()),
                 motion_.qd(k).first(motion_.moving()), motion_.equations().applied_forces(),
                 motion_.equations().smallest_pivot_ratio());
  forget_passages();
  observe_ratio();
  forget();
  return true;
}

// A history of one point, the present one, whose derivative is slope_.
void Adams::forget() {
  std::copy(slope_.begin() + static_cast<std::ptrdiff_t>(motion_.coordinates()), slope_.end(), difference_[1].begin());
  history_.restart();
  k_ = 1;
  k_before_ = 0;
  starting_ = true;
  crossing_ = false;
  h_ = scale_.rate() > 0 ? first_step * std::sqrt(scale_.tolerance()) / scale_.rate()
                         : std::numeric_limits<double>::max();
}

// Positions, velocities and derivatives that the polynomial through the last k points gives for t_new_.
void Adams::predict(double h) {
  history_.find_weights(h, k_ + 1, weights_);
  const std::size_t n = motion_.coordinates(), size = change_.size();
  for (std::size_t begin = 0; begin < size; begin += block) {
    const std::size_t end = std::min(begin + block, size);
    double once[block] = {}, twice[block] = {};
    for (std::size_t c = begin; c < end; ++c) predicted_[c] = 0;
    for (std::size_t i = k_; i >= 1; --i) {
      const double* d = difference_[i].data() + begin;
      const double v = weights_.value[i], w = weights_.integral[i], w2 = weights_.twice[i];
      for (std::size_t c = 0; c < end - begin; ++c) {
        predicted_[begin + c] += v * d[c];
        once[c] += w * d[c];
        twice[c] += w2 * d[c];
      }
    }
    for (std::size_t c = begin; c < end; ++c) {
      y_new_[n + c] = y_[n + c] + h * once[c - begin];
      if (c < n) y_new_[c] = y_[c] + h * (y_[n + c] + h * twice[c - begin]);
    }
  }
}

// Weight of a change of the derivative by one at coordinate c.
inline double Adams::weight(std::size_t c, double h) const {
  const double v_unit = scale_.velocity_unit(c, h, y_[motion_.coordinates() + c]);
  return h * std::max(v_unit > 0 ? 1 / v_unit : 0, h / scale_.position_unit(c, h));
}

// The same of the power of loads and of what dampers take: see RungeKutta::error_of_work.
double Adams::weight_of_work(std::size_t place, double h) const {
  const std::size_t work = 2 * motion_.coordinates() + place;
  return h * scale_.size_of_work(1, {h, y_[work], y_[work] + h * slope_[work]}, motion_.equations().applied_forces(),
                                 accelerations());
}

// Errors at orders k, k-1 and k-2, as if steps had one length.
Adams::Errors Adams::estimate(double h) {
  Errors errors;
  const bool one = k_ >= 2, two = k_ >= 3;
  const auto compare = [&](std::size_t c, double unit) {
    const double df = change_[c], now = unit * std::abs(df);
    const bool larger = !(now <= errors.now);
    if (larger) errors.now = now;
    if (!one) return larger;
    const double last = weights_.value[k_] * difference_[k_][c];
    errors.below = std::max(errors.below, unit * std::abs(last + df));
    if (!two) return larger;
    const double both = last + weights_.value[k_ - 1] * difference_[k_ - 1][c];
    errors.far_below = std::max(errors.far_below, unit * std::abs(both + df));
    return larger;
  };
  for (std::size_t c = 0; c < motion_.moving(); ++c) {
    if (compare(c, weight(c, h))) culprit_ = static_cast<int>(c);
  }
  for (std::size_t place = 0; place < judged_works(); ++place)
    compare(motion_.coordinates() + place, weight_of_work(place, h));
  errors.now *= history_.sigma(k_ + 1, h) * steady_error[k_];
  if (one) errors.below *= history_.sigma(k_, h) * steady_error[k_ - 1];
  if (two) errors.far_below *= history_.sigma(k_ - 1, h) * steady_error[k_ - 2];
  return errors;
}

// The same at order k + 1, from the last two changes; only where steps have one length.
double Adams::estimate_above(double h) const {
  const std::size_t n = motion_.coordinates();
  double largest = 0;
  const auto compare = [&](std::size_t c, double unit) {
    largest = std::max(largest, unit * std::abs(slope_[n + c] - predicted_[c] - difference_[k_ + 1][c]));
  };
  for (std::size_t c = 0; c < motion_.moving(); ++c) compare(c, weight(c, h));
  for (std::size_t place = 0; place < judged_works(); ++place) compare(n + place, weight_of_work(place, h));
  return largest * steady_error[k_ + 1];
}

// The error that the step makes without its corrector's last difference, which is the larger one.
double Adams::error_of_step(double h) {
  const std::size_t n = motion_.coordinates();
  const double once = weights_.integral[k_] / weights_.value[k_] - weights_.integral[k_ + 1] / weights_.value[k_ + 1];
  const double twice = weights_.twice[k_] / weights_.value[k_] - weights_.twice[k_ + 1] / weights_.value[k_ + 1];
  double largest = 0;
  for (std::size_t c = 0; c < motion_.moving(); ++c) {
    const double v_unit = scale_.velocity_unit(c, h, y_[n + c]);
    const double v = v_unit > 0 ? h * once * change_[c] / v_unit : 0;
    const double q = h * h * twice * change_[c] / scale_.position_unit(c, h);
    const double size = v * v + q * q;
    if (!(size <= largest)) {
      largest = size;
      culprit_ = static_cast<int>(c);
    }
  }
  return std::sqrt(largest);
}

// Of a first step what its two ends do not show; the evaluator is at its end again. Infinite where forces have no
// values.
double Adams::error_within(double h) {
  const std::size_t n = motion_.coordinates();
  unseen_.resize(n);
  find_unseen(h, std::span(difference_[1]).first(n), std::span(slope_).subspan(n, n), unseen_);
  double largest = 0;
  for (std::size_t c = 0; c < motion_.moving(); ++c) largest = std::max(largest, weight(c, h) * unseen_[c] / 2);
  if (!motion_.derivative(t_new_, Side::before, y_new_, slope_)) return std::numeric_limits<double>::infinity();
  return largest;
}

// What the corrector's last difference takes off error_of_step() is not known: with all of it claims of digits were
// pessimistic by 1e6 in half of the columns of random mechanisms.
void Adams::add_error(std::span<double> error) const {
  std::fill(error.begin(), error.end(), std::numeric_limits<double>::quiet_NaN());
}

double Adams::error_of_work(double h) const {
  const std::size_t n = motion_.coordinates();
  const double once = weights_.integral[k_] / weights_.value[k_] - weights_.integral[k_ + 1] / weights_.value[k_ + 1];
  const std::size_t usual = ErrorScale::judged(motion_.works()).size();
  if (usual == 0) return 0;
  // Of drivers as RungeKutta::error_of_work asks. What the past foretells of a step in which a power bends is wrong by
  // no more than it differs from the trapezoid rule.
  const StepSwitches::Found switches = motion_.switches().found();
  double largest = 0;
  for (std::size_t place = 0; place < judged_works(); ++place) {
    const std::size_t k = 2 * n + place;
    double error = std::abs(once * (slope_[k] - predicted_[n + place]));
    if (place < usual ? switches.laws : switches.any()) {
      const double work = y_new_[k] - y_[k];
      error = std::max(error, 2 / h * ErrorScale::error_of_switch(h, difference_[1][n + place], slope_[k], work));
    }
    largest = std::max(largest, weight_of_work(place, h) * error);
  }
  return largest;
}

// The error without most of the part that the projection at the step's end will remove.
double Adams::filtered(double h, double raw) {
  motion_.equations().remove_forbidden(std::span(change_).first(motion_.moving()));
  return std::min(raw, std::max(error_of_step(h), removed_part * raw));
}

// Corrects, projects with the factors of the predicted point, and evaluates.
bool Adams::finish(double h) {
  const std::size_t n = motion_.coordinates();
  EquationsOfMotion& equations = motion_.equations();
  const double once = h * weights_.integral[k_ + 1] / weights_.value[k_ + 1];
  const double twice = h * h * weights_.twice[k_ + 1] / weights_.value[k_ + 1];
  for (std::size_t c = 0; c < change_.size(); ++c) {
    const double change = slope_[n + c] - predicted_[c];
    y_new_[n + c] += once * change;
    if (c < n) y_new_[c] += twice * change;
  }
  position_residual_ = equations.project_position(motion_.q(std::span(y_new_)), 4);
  if (!(position_residual_ < RungeKutta::largest_residual)) return false;
  equations.project_velocity(motion_.qd(std::span(y_new_)), scale_.rate());
  tell_work(t_new_, t_, y_, y_new_);
  return motion_.derivative(t_new_, Side::before, y_new_, slope_);
}

// Adds slope_ at t_ + h as the newest value: differences of k + 1 points.
void Adams::update(double h) {
  const std::size_t n = motion_.coordinates(), size = change_.size();
  for (std::size_t begin = 0; begin < size; begin += block) {
    const std::size_t length = std::min(block, size - begin);
    double sum[block] = {}, change[block];
    for (std::size_t c = 0; c < length; ++c) change[c] = slope_[n + begin + c] - predicted_[begin + c];
    for (std::size_t i = k_; i >= 1; --i) {
      double* d = difference_[i].data() + begin;
      const double value = weights_.value[i];
      for (std::size_t c = 0; c < length; ++c) {
        sum[c] += value * d[c];
        d[c] = sum[c] + change[c];
      }
    }
    for (std::size_t c = 0; c < length; ++c) difference_[k_ + 1][begin + c] = change[c];
  }
  history_.push(h);
  k_before_ = k_;
}

void Adams::interpolate(double t, std::span<double> y) {
  if (stepped_by_runge_kutta_) return runge_kutta_.interpolate(t, y);
  const std::size_t n = motion_.coordinates(), size = change_.size(), k = k_before_ + 1;
  const double s = t - t_;
  history_.find_weights(s, k, inside_);
  for (std::size_t begin = 0; begin < size; begin += block) {
    const std::size_t length = std::min(block, size - begin);
    double once[block] = {}, twice[block] = {};
    for (std::size_t i = k; i >= 1; --i) {
      const double* d = difference_[i].data() + begin;
      for (std::size_t c = 0; c < length; ++c) {
        once[c] += inside_.integral[i] * d[c];
        twice[c] += inside_.twice[i] * d[c];
      }
    }
    for (std::size_t c = begin; c < begin + length; ++c) {
      y[n + c] = y_[n + c] + s * once[c - begin];
      if (c < n) y[c] = y_[c] + s * (y_[n + c] + s * twice[c - begin]);
    }
  }
  tell_work_between(t, y);
}

IntegratorMemory Adams::memory() const { return memory_of(scale_, h_); }

void Adams::remember(const IntegratorMemory& memory) {
  scale_.remember(memory);
  usual_ratio_ = memory.usual_ratio;
}

}  // namespace catena
