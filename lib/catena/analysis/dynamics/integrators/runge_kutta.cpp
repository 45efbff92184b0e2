#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/pose/jacobian_rank.hpp"

namespace catena {
namespace {

// A step with a stage whose pivot ratio is below this is repeated with all stages projected ...
constexpr double projection_ratio = 1e-2;
// ... if the ratio of other stages is this much larger: light parts make it small without any singularity.
constexpr double ratio_dip = 0.3;
// Steps must not end at positions where a pivot ratio is below this; accelerations lose ratio^1.5 there.
constexpr double singular_end = 1e-7, lost_digits = 2e-11;
constexpr double largest_residual = 1e-6;  // of positions after their projection, in length scales or rad
constexpr double largest_drift = 1e-2;     // of positions that are not projected

// What drivers do follows from multipliers, which a singular position leaves open.
bool is_driven(EquationsOfMotion& equations) {
  const auto& elements = equations.evaluator().model().elements;
  return std::any_of(elements.begin(), elements.end(), [](const auto& e) { return e.kind == ElementKind::driver; });
}

}  // namespace

RungeKutta::RungeKutta(Motion motion, const RungeKuttaOptions& options) : motion_(motion), options_(options) {
  const std::size_t size = motion_.size();
  for (std::vector<double>* y : {&y_, &y_before_, &y_new_, &y_stage_, &slope_, &slope_new_}) y->assign(size, 0.0);
  stage_.assign(16, std::vector<double>(size, 0.0));
  interpolant_.assign(7, std::vector<double>(size, 0.0));
  error_.resize(2 * motion_.coordinates());
  error_low_.resize(2 * motion_.coordinates());
  stage_ratio_.assign(stage_.size(), 1.0);
  stage_power_.assign(stage_.size(), 0.0);
  direction_.resize(motion_.moving());
  detour_steps_.reserve(most_detours);
  acting_rows_ = acting_rows(motion_.equations().plan());
  usual_ratio_ = std::max(usual_ratio_, options.usual_ratio);
  scale_.step_tolerance = options.tolerance;
  scale_.horizon = options.horizon;
  scale_.length = motion_.equations().evaluator().length_scale();
  scale_.set_masses(motion_.equations().masses().mass);
  if (options.keeping == ConstraintKeeping::partition) {
    partition_ = std::make_unique<CoordinatePartition>(motion_.equations());
  }
  for (std::size_t c = 0; c < direction_.size(); c += 3) weight_ += motion_.equations().masses().mass[c];
  const Vec2<double> gravity = motion_.equations().evaluator().model().gravity;
  weight_ *= std::hypot(gravity.x, gravity.y) * scale_.length;
  const bool driven = is_driven(motion_.equations());
  if (!driven && options.fixed_step == 0 && BranchKeeping::judges(motion_.equations()))
    branches_ = std::make_unique<BranchKeeping>(motion_.equations());
  keeps_energy_ = options.fixed_step == 0 && !motion_.equations().state_loads() && !driven;
  singular_ratio_ = std::max(singular_end, std::pow(lost_digits / std::sqrt(options.tolerance), 2.0 / 3));
}

bool RungeKutta::start(double t, std::span<const double> y) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  if (!derivative(t_, Side::after, y_, slope_)) return false;
  motion_.equations().evaluator().curve_places(curve_places_);
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
    return (partition_->choices() > 0 && !partition_->has_worsened()) ||
           partition_->choose(motion_.q(std::span<const double>(y_)));
  }
  if (projects()) return true;
  double wanted = scale_.rate();
  if (options_.fixed_step > 0) wanted = std::min(wanted, 1 / options_.fixed_step);
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

std::vector<std::string> RungeKutta::remarks() const {
  std::vector<std::string> all;
  if (low_order_steps_ > 0)
    all.push_back(fmt::format("order 5 took over for {} steps where order 8 failed repeatedly", low_order_steps_));
  if (projected_steps_ > 0)
    all.push_back(fmt::format("{} steps across nearly singular positions were projected", projected_steps_));
  if (turns_ > 0)
    all.push_back(
        fmt::format("{} times the motion turned where branches pass each other, the last time at a distance "
                    "of {:.2g} rad or length scales: steps there were shortened to it",
                    turns_, branches_->gap()));
  if (turns_given_up_ > 0)
    all.push_back(
        fmt::format("{} times the motion went straight on where branches pass each other, the last time at a distance "
                    "of {:.2g} rad or length scales: rounding does not let steps turn there",
                    turns_given_up_, branches_->gap()));
  if (partition_ && partition_->choices() > 1)
    all.push_back(fmt::format("independent coordinates were chosen {} times", partition_->choices()));
  return all;
}

IntegratorMemory RungeKutta::memory() const {
  IntegratorMemory memory = scale_.memory();
  memory.step = h_;
  memory.usual_ratio = usual_ratio_;
  return memory;
}

void RungeKutta::remember(const IntegratorMemory& memory) {
  scale_.remember(memory);
  h_ = memory.step;
  usual_ratio_ = memory.usual_ratio;
}

bool RungeKutta::take_over(double t, std::span<const double> y, double h, const ErrorScale& scale, double usual_ratio) {
  t_ = t_before_ = t;
  std::copy(y.begin(), y.end(), y_.begin());
  scale_ = scale;
  h_ = h;
  usual_ratio_ = usual_ratio;
  if (!derivative(t_, Side::after, y_, slope_)) return false;
  motion_.equations().evaluator().curve_places(curve_places_);
  observe_ratio();
  return true;
}

double RungeKutta::pivot_ratio() const { return motion_.equations().smallest_pivot_ratio() / usual_ratio_; }

bool RungeKutta::dips() const {
  return !turning_ && smallest_stage_ratio_ < std::min(projection_ratio, ratio_dip * largest_stage_ratio_);
}

void RungeKutta::observe_ratio() {
  usual_ratio_ = std::max(usual_ratio_, motion_.equations().smallest_pivot_ratio());
  start_ratio_ = pivot_ratio();
}

void RungeKutta::observe_rates() {
  const std::span<const double> y(y_), k(slope_);
  scale_.observe(t_, t_ - t_before_, motion_.qd(y).first(motion_.moving()), motion_.qd(k).first(motion_.moving()),
                 motion_.equations().applied_forces(), motion_.equations().smallest_pivot_ratio());
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
  const bool watching = watches_energy();
  if (watching) {
    motion_.equations().evaluator().set_time(t_, h > 0 ? Side::after : Side::before);
    motion_.equations().evaluator().set_configuration(motion_.q(std::span<const double>(y_)));
    note_power(0, y_);
  }
  smallest_stage_ratio_ = std::numeric_limits<double>::infinity();
  largest_stage_ratio_ = start_ratio_;
  for (std::size_t s = 1; s < static_cast<std::size_t>(table.stages); ++s) {
    combine(table.a[s], h, y_.data(), y_stage_);
    // The last stages lie at the end exactly: a function of time may jump there.
    const bool at_end = table.c[s] == 1;
    const double t = at_end ? t_new_ : t_ + table.c[s] * h;
    const Side side = at_end ? Side::before : Side::after;
    if (projecting_stages_ && !project_stage(t, side)) return false;
    if (partitions() && !solve_dependent(t, side, y_stage_)) return false;
    if (!derivative(t, side, y_stage_, stage_[s])) return false;
    smallest_stage_ratio_ = std::min(smallest_stage_ratio_, pivot_ratio());
    largest_stage_ratio_ = std::max(largest_stage_ratio_, pivot_ratio());
    stage_ratio_[s] = pivot_ratio();
    if (watching) note_power(s, y_stage_);
  }
  if (projecting_stages_ || watching) find_roughness();
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
  return !projects() || tableau().order == 5 || pivot_ratio() > projection_ratio ||
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
  if (watches_energy() && !restore_energy(t_new_ - t_)) return false;
  return derivative(t_new_, Side::before, y_new_, slope_new_);
}

}  // namespace catena
