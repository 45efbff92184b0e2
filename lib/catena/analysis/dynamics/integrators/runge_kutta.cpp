#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

constexpr double largest_drift = 1e-2;  // of positions that are not projected

}  // namespace

RungeKutta::RungeKutta(Motion motion, const RungeKuttaOptions& options)
    : motion_(motion),
      options_(options),
      stage_(motion_.size()),
      dense_(motion_.size()),
      order_(options.order, options.may_lower_order),
      ratios_(stage_.size(), options.usual_ratio),
      trials_(options.tolerance),
      energy_(motion_, stage_.size(), motion_.equations().evaluator().length_scale(),
              is_fixed() ? StepEnergy::Tells::nothing : StepEnergy::of(motion_)) {
  for (std::vector<double>* y : {&y_, &y_before_, &y_new_, &y_stage_, &slope_, &slope_new_}) {
    y->assign(motion_.size(), 0.0);
  }
  error_.high.resize(motion_.size());
  error_.low.resize(2 * motion_.coordinates());
  scale_.step_tolerance = options.tolerance;
  scale_.horizon = options.horizon;
  scale_.length = motion_.length_scale();
  scale_.set_masses(motion_.equations().masses().mass);
  if (options.keeping == ConstraintKeeping::partition) {
    partition_ = std::make_unique<CoordinatePartition>(motion_.equations());
  }
  if (BranchKeeping::judges(motion_.equations())) branches_ = std::make_unique<BranchKeeping>(motion_.equations());
}

bool RungeKutta::start(double t, std::span<const double> y) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  if (!derivative(t_, Side::after, y_, slope_)) return false;
  curve_places_ = motion_.equations().evaluator().curve_places();
  observe_ratio();
  observe_rates();
  if (h_ == 0) {
    const double part = 0.2 * std::pow(scale_.tolerance(), 1.0 / options_.order);
    h_ = scale_.rate() > 0 ? part / scale_.rate() : std::numeric_limits<double>::max();
  }
  return follow_motion();
}

// Lets the choice of independent coordinates, or the stabilisation, follow the motion; accelerations of the point where
// the latter changes are evaluated anew.
bool RungeKutta::follow_motion() {
  if (partitions()) {
    motion_.equations().evaluator().set_time(t_);
    return partition_->keeps_up() || partition_->choose(motion_.q(std::span<const double>(y_)));
  }
  if (projects()) return true;
  double wanted = scale_.rate();
  if (is_fixed()) wanted = std::min(wanted, 1 / options_.fixed_step);
  if (stabilisation_ > 0.5 * wanted && stabilisation_ < 2 * wanted) return true;
  stabilisation_ = wanted;
  return derivative(t_, Side::after, y_, slope_);
}

// With stabilisation alone the motion could take any of the branches that meet at a singular position: steps across it
// are projected, from a point on the constraints.
bool RungeKutta::begin_projection() {
  EquationsOfMotion& equations = motion_.equations();
  const std::span<double> y(y_);
  stabilisation_ = 0;
  crossing_ = true;
  if (!equations.factorize(t_, Side::after, motion_.q(y))) return false;
  equations.project_position(motion_.q(y), 4);
  equations.project_velocity(motion_.qd(y), scale_.rate());
  if (!derivative(t_, Side::after, y_, slope_)) return false;
  std::copy(slope_.begin(), slope_.end(), stage_[0].begin());
  return true;
}

IntegratorMemory RungeKutta::memory() const {
  IntegratorMemory memory = scale_.memory();
  memory.step = h_;
  memory.usual_ratio = ratios_.usual();
  return memory;
}

void RungeKutta::remember(const IntegratorMemory& memory) {
  scale_.remember(memory);
  h_ = memory.step;
  ratios_.set_usual(memory.usual_ratio);
}

bool RungeKutta::take_over(double t, std::span<const double> y, double h, const ErrorScale& scale, double usual_ratio) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  scale_.take_over(scale);
  h_ = h;
  ratios_.set_usual(usual_ratio);
  if (!derivative(t_, Side::after, y_, slope_)) return false;
  curve_places_ = motion_.equations().evaluator().curve_places();
  observe_ratio();
  return true;
}

double RungeKutta::pivot_ratio() const { return ratios_.compared(motion_.equations().smallest_pivot_ratio()); }

bool RungeKutta::dips() const { return !turn_.is_under_way() && ratios_.dip(); }

void RungeKutta::observe_ratio() { ratios_.start(motion_.equations().smallest_pivot_ratio()); }

void RungeKutta::observe_rates() {
  const std::span<const double> y(y_), k(slope_);
  scale_.observe(t_, t_ - t_before_, motion_.q(y).first(motion_.moving()), motion_.qd(y).first(motion_.moving()),
                 motion_.qd(k).first(motion_.moving()), motion_.equations().applied_forces(),
                 motion_.equations().smallest_pivot_ratio());
}

bool RungeKutta::begin_showing() {
  return watcher_ && tableau().order == 8 && projects() && !trials_.project_stages() &&
         watcher_->begin_stages(t_, t_new_, y_);
}

bool RungeKutta::evaluate_stages(double h) {
  const Tableau& table = tableau();
  const bool watching = watches_energy();
  if (watching) {
    motion_.equations().evaluator().set_time(t_, h > 0 ? Side::after : Side::before);
    motion_.equations().evaluator().set_configuration(motion_.q(std::span<const double>(y_)));
    energy_.note_power(motion_, 0, y_);
  }
  ratios_.begin();
  const bool shows = begin_showing();
  for (std::size_t s = 1; s < static_cast<std::size_t>(table.stages); ++s) {
    stage_.combine(table.a[s], h, y_, y_stage_);
    // The last stages lie at the end exactly: a function of time may jump there.
    const bool at_end = table.c[s] == 1;
    const double t = at_end ? t_new_ : t_ + table.c[s] * h;
    const Side side = at_end ? Side::before : Side::after;
    if (trials_.project_stages() && !project_stage(t, side)) return false;
    if (partitions() && !solve_dependent(t, side, y_stage_)) return false;
    if (!derivative(t, side, y_stage_, stage_[s])) return false;
    if (shows) watcher_->watch_stage(static_cast<int>(s), t, side, y_stage_, stage_[s], motion_.equations());
    ratios_.note(s, motion_.equations().smallest_pivot_ratio());
    if (watching) energy_.note_power(motion_, s, y_stage_);
  }
  if (trials_.project_stages() || watching) ratios_.find_roughness(table.b);
  stage_.combine(table.b, h, y_, y_new_);
  stage_.combine(table.error, 1, {}, error_.high);
  if (table.order == 8) stage_.combine(table.error_low, 1, {}, error_.low);
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
  return !projects() || tableau().order == 5 || pivot_ratio() > dependence::singular_passage ||
         motion_.equations().factorize(t_new_, Side::before, motion_.q(std::span<const double>(y_new_)));
}

// Projects the new point and evaluates it; the stages stay as they are for the interpolant.
bool RungeKutta::finish_step() {
  EquationsOfMotion& equations = motion_.equations();
  if (partitions()) {
    if (!solve_dependent(t_new_, Side::before, y_new_)) return false;
    position_residual_ = partition_->position_residual();
    return derivative(t_new_, Side::before, y_new_, slope_new_);
  }
  if (!projects()) {
    position_residual_ = equations.position_residual(motion_.q(std::span(y_new_)));
    return position_residual_ < largest_drift && derivative(t_new_, Side::before, y_new_, slope_new_);
  }
  position_residual_ = equations.project_position(motion_.q(std::span(y_new_)), 4);
  if (!(position_residual_ < largest_residual)) return false;
  equations.project_velocity(motion_.qd(std::span(y_new_)), scale_.rate());
  work_told_ = tells_work();
  if (!balance(t_new_ - t_)) return false;
  return derivative(t_new_, Side::before, y_new_, slope_new_);
}

bool RungeKutta::watches_energy() const {
  return projects() && energy_.watches(ratios_.at_start(), trials_.project_stages());
}

bool RungeKutta::tells_work() const { return projects() && energy_.tells_work(motion_); }

BalancedEnds RungeKutta::balanced_ends(double t, double h, std::span<const double> before, std::span<double> y) const {
  return {.t = t, .h = h, .y_before = before, .y = y, .error = error_.high};
}

// Balances the step from y_ to y_new_, of size h, which was projected. False: it has lost its way.
bool RungeKutta::balance(double h) {
  const BalancedEnds ends = balanced_ends(t_new_, h, y_, y_new_);
  if (watches_energy()) {
    return energy_.restore(
        motion_,
        {.ends = ends, .errors = error_.of_step + rounding_of_velocity(h), .scale = scale_, .weights = tableau().b});
  }
  if (work_told_) energy_.restore_work(motion_, ends);
  return true;
}

}  // namespace catena
