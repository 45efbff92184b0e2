#include "catena/analysis/integrators/runge_kutta.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

constexpr double safety = 0.9;
constexpr double largest_growth = 2.5, largest_cut = 0.2;
// The part of an error estimate that the projection will remove counts this much: stages spoil each other by it.
constexpr double forbidden_part = 0.1;
// A step with a stage whose pivot ratio is below this is repeated with all stages projected ...
constexpr double projection_ratio = 1e-2;
// ... if the ratio of other stages is this much larger: light parts make it small without any singularity.
constexpr double ratio_dip = 0.3;
// Where no step across a singular position is good enough, the best is taken if its error is below this.
constexpr double largest_crossing_error = 300;
// Ends of steps are kept away from positions where a pivot ratio is below this; accelerations lose ratio^1.5 there.
constexpr double singular_end = 1e-7, lost_digits = 2e-11;
constexpr double other_steps[] = {0.8, 0.6, 1.15, 0.4, 0.9, 1.3};  // what is tried instead of h
constexpr int rejections_before_low_order = 8, low_order_run = 30;
constexpr int most_rejections = 100;
constexpr double smallest_step = 1e-13;    // part of |t| and of the time scale
constexpr double largest_residual = 1e-6;  // of positions after their projection, in length scales or rad

}  // namespace

RungeKutta::RungeKutta(Motion motion, const RungeKuttaOptions& options) : motion_(motion), options_(options) {
  const std::size_t size = motion_.size();
  for (std::vector<double>* y : {&y_, &y_before_, &y_new_, &y_stage_, &slope_, &slope_new_}) y->assign(size, 0.0);
  stage_.assign(16, std::vector<double>(size, 0.0));
  error_.resize(2 * motion_.coordinates());
  error_low_.resize(2 * motion_.coordinates());
  scale_.step_tolerance = options.tolerance;
  scale_.horizon = options.horizon;
  scale_.length = motion_.equations().evaluator().length_scale();
  scale_.set_masses(motion_.equations().masses().mass);
  singular_ratio_ = std::max(singular_end, std::pow(lost_digits / std::sqrt(options.tolerance), 2.0 / 3));
}

bool RungeKutta::start(double t, std::span<const double> y) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  if (!motion_.derivative(t_, Side::after, y_, slope_)) return false;
  observe_ratio();
  observe_rates();
  if (h_ == 0) {
    const double part = 0.2 * std::pow(scale_.tolerance(), 1.0 / options_.order);
    h_ = scale_.rate() > 0 ? part / scale_.rate() : std::numeric_limits<double>::max();
  }
  return true;
}

double RungeKutta::pivot_ratio() const { return motion_.equations().smallest_pivot_ratio() / usual_ratio_; }

bool RungeKutta::dips() const {
  return smallest_stage_ratio_ < std::min(projection_ratio, ratio_dip * largest_stage_ratio_);
}

void RungeKutta::observe_ratio() {
  usual_ratio_ = std::max(usual_ratio_, motion_.equations().smallest_pivot_ratio());
  start_ratio_ = pivot_ratio();
}

void RungeKutta::observe_rates() {
  const std::span<const double> y(y_), k(slope_);
  scale_.observe(t_, t_ - t_before_, motion_.qd(y).first(motion_.moving()), motion_.qd(k).first(motion_.moving()));
}

void RungeKutta::combine(const StageSum& sum, double h, const double* from, std::span<double> out) const {
  constexpr std::size_t block = 256;  // stays in the first cache while all stages are added
  for (std::size_t begin = 0; begin < out.size(); begin += block) {
    const std::size_t end = std::min(begin + block, out.size());
    for (std::size_t i = begin; i < end; ++i) out[i] = from ? from[i] : 0;
    for (const StageTerm& term : sum) {
      const double weight = h * term.weight;
      const double* k = stage_[static_cast<std::size_t>(term.stage)].data();
      for (std::size_t i = begin; i < end; ++i) out[i] += weight * k[i];
    }
  }
}

bool RungeKutta::evaluate_stages(double h) {
  const Tableau& table = tableau();
  smallest_stage_ratio_ = std::numeric_limits<double>::infinity();
  largest_stage_ratio_ = start_ratio_;
  for (std::size_t s = 1; s < static_cast<std::size_t>(table.stages); ++s) {
    combine(table.a[s], h, y_.data(), y_stage_);
    // The last stages lie at the end exactly: a function of time may jump there.
    const bool at_end = table.c[s] == 1;
    const double t = at_end ? t_new_ : t_ + table.c[s] * h;
    const Side side = at_end ? Side::before : Side::after;
    if (projecting_stages_ && !project_stage(t, side)) return false;
    if (!motion_.derivative(t, side, y_stage_, stage_[s])) return false;
    smallest_stage_ratio_ = std::min(smallest_stage_ratio_, pivot_ratio());
    largest_stage_ratio_ = std::max(largest_stage_ratio_, pivot_ratio());
  }
  combine(table.b, h, y_.data(), y_new_);
  combine(table.error, 1, nullptr, error_);
  if (table.order == 8) combine(table.error_low, 1, nullptr, error_low_);
  return true;
}

// Integrates y' = f(P(y)), P the projection: a smooth extension of the equations whose order is the method's, but in
// which the errors of stages across the constraints do not grow where those are nearly dependent.
bool RungeKutta::project_stage(double t, Side side) {
  EquationsOfMotion& equations = motion_.equations();
  const std::span<double> y(y_stage_);
  if (!equations.factorize(t, side, motion_.q(y))) return false;
  equations.project_position(motion_.q(y), 3);
  equations.project_velocity(motion_.qd(y), scale_.rate());
  return true;
}

// Factors at the new point, before it is projected. Order 5 had its last stage there, order 8 beside it: far from
// singular positions those factors serve.
bool RungeKutta::factorize_new_point() {
  return tableau().order == 5 || pivot_ratio() > projection_ratio ||
         motion_.equations().factorize(t_new_, Side::before, motion_.q(std::span<const double>(y_new_)));
}

double RungeKutta::error_size(double h) {
  const std::size_t moving = motion_.moving(), offset = motion_.coordinates();
  const double* v = motion_.qd(std::span<const double>(y_)).data();
  const bool two = tableau().order == 8;
  double high = 0, low = 0;
  for (std::size_t c = 0; c < moving; ++c) {
    const double v_unit = scale_.velocity_unit(c, v[c]);
    // Where nothing has moved yet velocities have no scale; positions then tell.
    const double q_scale = 1 / scale_.position_unit(c), v_scale = v_unit > 0 ? 1 / v_unit : 0;
    const double q_error = error_[c] * q_scale, v_error = error_[offset + c] * v_scale;
    const double size = q_error * q_error + v_error * v_error;
    if (!(size <= high)) {
      high = size;
      culprit_ = static_cast<int>(c);
    }
    if (!two) continue;
    const double q_low = error_low_[c] * q_scale, v_low = error_low_[offset + c] * v_scale;
    low = std::max(low, q_low * q_low + v_low * v_low);
  }
  if (!two) return std::abs(h) * std::sqrt(high);
  const double denominator = high + 0.01 * low;
  return denominator == 0 ? 0 : std::abs(h) * high / std::sqrt(denominator);
}

// The error without most of what the projection at the step's end will remove.
double RungeKutta::filtered_error(double h, double raw) {
  const std::size_t moving = motion_.moving(), offset = motion_.coordinates();
  EquationsOfMotion& equations = motion_.equations();
  for (std::vector<double>* error : {&error_, &error_low_}) {
    if (error == &error_low_ && tableau().order == 5) break;
    equations.remove_forbidden(std::span(*error).first(moving));
    equations.remove_forbidden(std::span(*error).subspan(offset, moving));
  }
  return std::min(raw, std::max(error_size(h), forbidden_part * raw));
}

// Projects the new point and evaluates it; the stages stay as they are for the interpolant.
bool RungeKutta::finish_step() {
  EquationsOfMotion& equations = motion_.equations();
  position_residual_ = equations.project_position(motion_.q(std::span(y_new_)), 4);
  if (!(position_residual_ < largest_residual)) return false;
  equations.project_velocity(motion_.qd(std::span(y_new_)), scale_.rate());
  return motion_.derivative(t_new_, Side::before, y_new_, slope_new_);
}

// Chooses the next step after a rejection; order 5 gets its turn when order 8 does not get ahead.
void RungeKutta::reject(double h) {
  ++motion_.equations().evaluator().counters.rejected;
  h_ = h;
  if (++rejections_ % rejections_before_low_order == 0 && options_.order == 8 && options_.may_lower_order) {
    low_order_left_ = low_order_run;
  }
}

// Another step size in place of h, so that neither its end nor a stage lies beside a singular position.
bool RungeKutta::detour(double h) {
  if (detours_ == static_cast<int>(std::size(other_steps))) return false;
  if (detours_ == 0) undisturbed_step_ = h;
  ++motion_.equations().evaluator().counters.rejected;
  h_ = undisturbed_step_ * other_steps[detours_++];
  return true;
}

void RungeKutta::repeat_with_projected_stages(double h) {
  projecting_stages_ = true;
  best_error_ = largest_crossing_error;
  best_step_ = 0;
  h_ = h;
}

// What to do about a step of size h that failed near a singular position: project its stages; try other sizes; at last
// take the best of those unless it is bad. False: none of this helps, h_ is as it was.
bool RungeKutta::try_crossing(double h, double error) {
  if (!projecting_stages_) {
    repeat_with_projected_stages(h);
    return true;
  }
  if (error < best_error_) {
    best_error_ = error;
    best_step_ = h;
  }
  if (detour(h)) return true;
  if (best_step_ == 0) return false;
  h_ = best_step_;
  accepted_error_ = 1.1 * best_error_;
  best_step_ = 0;
  return true;
}

bool RungeKutta::advance(double limit) {
  const bool fixed = options_.fixed_step > 0;
  const double smallest = smallest_step * std::max(std::abs(t_), scale_.rate() > 0 ? 1 / scale_.rate() : 0.0);
  double proposed = fixed ? options_.fixed_step : h_;
  detours_ = 0;
  projecting_stages_ = false;
  accepted_error_ = 1;
  rejections_ = 0;
  stage_[0] = slope_;
  motion_.equations().evaluator().take_turns(motion_.q(std::span(y_)));
  interpolant_ready_ = false;
  h_ = proposed;
  while (true) {
    const double remaining = limit - t_;
    const bool lands = h_ * (fixed ? 1 + 1e-9 : 1.01) >= remaining;
    // Two equal steps instead of a long one and a tiny one.
    double h = lands ? remaining : h_;
    if (!lands && !fixed && detours_ == 0 && 2 * h > remaining) h = remaining / 2;
    if ((h < smallest && !lands) || rejections_ > most_rejections) return false;
    t_new_ = lands ? limit : t_ + h;
    if (!evaluate_stages(h)) {
      culprit_ = -1;
      if (fixed) return false;
      reject(h / 4);
      continue;
    }
    double error = fixed ? 0 : error_size(h);
    bool factored = false;
    if (!(error <= 1) && std::isfinite(error)) {
      factored = factorize_new_point();
      if (factored) error = filtered_error(h, error);
    }
    if (!std::isfinite(error)) error = 1e10;
    const double growth =
        std::clamp(safety * std::pow(std::max(error, 1e-10), -1.0 / tableau().order), largest_cut, largest_growth);
    if (error <= accepted_error_ && !fixed && !projecting_stages_ && dips()) {
      // Errors of stages across the constraints spoil each other here, and the estimate does not see all of it.
      repeat_with_projected_stages(h);
      continue;
    }
    if (error > accepted_error_) {
      // Near a singular position a shorter step would only walk into it.
      if (dips() && try_crossing(h, error)) continue;
      reject(h * std::min(growth, 1.0));
      continue;
    }
    if (!factored && !factorize_new_point()) {
      if (fixed) return false;
      reject(h / 4);
      continue;
    }
    const double ratio = pivot_ratio();
    if (ratio > 10 * singular_ratio_) passing_singular_ = false;
    if (ratio < singular_ratio_ && !passing_singular_ && !lands && !fixed) {
      if (detour(h)) continue;
      passing_singular_ = true;
    }
    if (!finish_step()) {
      culprit_ = -1;
      if (fixed) return false;
      reject(h / 4);
      continue;
    }
    accept(growth, std::max(proposed, h));
    return true;
  }
}

void RungeKutta::accept(double growth, double proposed) {
  const double h = t_new_ - t_;
  ++motion_.equations().evaluator().counters.steps;
  step_was_low_order_ = tableau().order == 5;
  if (low_order_left_ > 0) {
    --low_order_left_;
    ++low_order_steps_;
  }
  t_before_ = t_;
  t_ = t_new_;
  y_before_.swap(y_);
  y_.swap(y_new_);
  slope_.swap(slope_new_);
  observe_ratio();
  observe_rates();
  // A step that was cut short by a limit says nothing against the longer one.
  h_ = rejections_ > 0 ? h * std::min(growth, 1.0) : std::max(h * growth, h < proposed ? proposed : 0.0);
}

}  // namespace catena
