#include "catena/analysis/accuracy/carried_error.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/accuracy/row_terms.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The next evaluation is due where another step would go beyond this many radians since the last ...
constexpr double reach = 1;
// ... and beyond this many the method is not stable.
constexpr double farthest = 1.9;
// Part of the stiffness that is remembered from one evaluation to the next: an error turns away from stiff directions
// while steps are short, and into them as soon as they are long.
constexpr double remembered = 0.9;
// An error, in length scales or rad, whose effect is not in proportion any more: it is followed no further, and taken
// for one of which no column has a right digit.
constexpr double doubtful = 0.03, all_wrong = 1e6;
// An error that turns so many times faster than the motion, and grows beyond that, has met a stiffness for which the
// way it is followed by is not made: of a pendulum on a pivot of 1e6 N/m, 2000 times, it said that no digit was right
// where twelve were. It is lost.
constexpr double stiff = 100;
// Evaluations times columns that are made whatever the run costs, and the part of the run's that are made beyond.
constexpr double allowance = 10'000, part_of_run = 0.02;
// Of an evaluation with the projections behind it, in evaluations.
constexpr double cost_of_carrying = 1.5;
// Of a second set of equations, with the analysis of their structure, in evaluations: some 35 of a chain of 400 rods.
constexpr double setup = 30;

double unit_of(std::size_t c, double length) { return c % 3 == 2 ? 1 : length; }

}  // namespace

void CarriedError::begin(const Integrator& integrator, const EquationsOfMotion& equations) {
  if (begun_) return;  // forces jump, errors do not
  const Plan& plan = motion_.plan();
  begun_ = true;
  solved_ = &equations;
  lost_ = plan.moving == 0 || equations.state_loads() != nullptr || !integrator.meets_constraints();
  n_ = at(plan.coordinates());
  moving_ = 3 * at(plan.moving);
  for (std::vector<double>* v : {&error_, &added_, &y_}) v->assign(2 * n_, 0.0);
  for (std::vector<double>* v : {&da_, &now_}) v->assign(n_, 0.0);
  t_ = integrator.time();
  rate_ = integrator.rate();
  first_evaluation_ = motion_.counters.forces;
  add_rounding(integrator.state(), 1);
  error_.swap(added_);
}

bool CarriedError::affordable(double cost) const {
  if (cost == 0) return true;
  const double columns = std::max(1.0, static_cast<double>(motion_.plan().columns));
  const auto of_run = static_cast<double>(motion_.counters.forces - first_evaluation_);
  return spent_ + cost <= allowance / columns + part_of_run * of_run;
}

// Nothing once they are there.
double CarriedError::cost_of_setup() const { return equations_ ? 0 : setup; }

bool CarriedError::spend(double cost) {
  cost += cost_of_setup();
  if (!affordable(cost)) return false;
  spent_ += cost;
  return true;
}

void CarriedError::step(const Integrator& integrator, const EquationsOfMotion& equations) {
  if (lost_ || drowned_) return;
  if (!integrator.may_pause() || equations.is_singular()) {
    lost_ = true;
    return;
  }
  integrator.add_error(added_);
  if (std::isnan(added_.front())) {  // then all of them are
    lost_ = true;
    return;
  }
  ++steps_;
  const double t = integrator.time(), h = t - integrator.previous_time(), since = t - t_;
  rate_ = integrator.rate();
  const double speed = std::max(rate_, sharpest_);
  if (speed * (since + h) <= reach) return;
  const bool can = affordable(cost_of_carrying + cost_of_setup());
  // One long step is as far as it goes by its rate; by its stiffness it must be stable.
  if ((can ? stiffness_ : speed) * since > farthest) lost_ = true;
  if (lost_ || !can) return;
  spent_ += cost_of_setup();
  get_ready();
  carry(integrator);
}

void CarriedError::get_ready() {
  if (!equations_) {
    evaluator_.emplace(motion_, evaluation_);
    evaluator_->trace = nullptr;
    evaluator_->forget_turns();
    equations_.emplace(*evaluator_);
    static_cast<void>(equations_->use_masses());
  }
  if (solved_->left_out().count() > 0) equations_->leave_out(solved_->left_out());
  evaluator_->go_to_curve_places(motion_.curve_places());
}

EquationsOfMotion& CarriedError::equations() {
  get_ready();
  return *equations_;
}

// Evaluates a little beside the place that was reached, and goes on to it.
void CarriedError::carry(const Integrator& integrator) {
  const double t = integrator.time(), since = t - t_, length = motion_.length_scale();
  std::copy_n(integrator.state().begin(), 2 * n_, y_.begin());
  motion_.add_turns(std::span(y_).first(n_));
  add_rounding(y_, steps_);
  steps_ = 0;
  const std::span<double> dq = std::span(error_).first(n_), dv = std::span(error_).subspan(n_);
  for (std::size_t c = 0; c < moving_; ++c) {
    dq[c] += since * (dv[c] + 0.5 * since * da_[c]) + added_[c];
    dv[c] += since * da_[c] + added_[n_ + c];  // as far as it is known before the evaluation
  }
  t_ = t;
  const double size = norm(error_);
  if (!std::isfinite(size)) lost_ = true;
  drowned_ = size > doubtful;
  if (drowned_ && sharpest_ > stiff * rate_) lost_ = true;
  if (drowned_) std::fill(error_.begin(), error_.end(), all_wrong);
  if (lost_ || drowned_ || !(size > 0)) return;
  const double s = Disturbance::shift / size;
  std::vector<double> beside(y_);
  for (std::size_t c = 0; c < moving_; ++c) {
    beside[c] += s * dq[c];
    beside[n_ + c] += s * dv[c];
  }
  spent_ += cost_of_carrying;
  const std::span<const double> q = std::span(beside).first(n_), v = std::span(beside).subspan(n_);
  if (!equations_->accelerations(t, Side::before, q, v, now_)) {
    lost_ = true;
    return;
  }
  const std::span<const double> a = integrator.accelerations();
  double largest_a = 0, largest_v = 0, largest_q = 0;
  for (std::size_t c = 0; c < moving_; ++c) {
    const double da = (now_[c] - a[c]) / s, unit = unit_of(c, length);
    dv[c] += 0.5 * since * (da - da_[c]);
    da_[c] = da;
    largest_a = std::max(largest_a, std::abs(da) / unit);
    largest_v = std::max(largest_v, std::abs(dv[c]) / unit);
    largest_q = std::max(largest_q, std::abs(dq[c]) / unit);
  }
  const double sum = largest_v + std::sqrt(largest_a * largest_q);
  stiffness_ = sum > 0 ? largest_a / sum : 0;
  sharpest_ = std::max(stiffness_, remembered * sharpest_);
  project(q, std::span(y_).subspan(n_), s);
  std::fill(added_.begin(), added_.end(), 0.0);
}

// Onto what the constraints allow at q, the place of the last evaluation, s dq from that of the motion, whose
// velocities are v.
void CarriedError::project(std::span<const double> q, std::span<const double> v, double s) {
  if (motion_.plan().rows == 0) return;
  const std::span<double> dq = std::span(error_).first(n_), dv = std::span(error_).subspan(n_);
  equations_->remove_forbidden(dq.first(moving_));
  std::vector<double> beside(v.begin(), v.end());
  for (std::size_t c = 0; c < moving_; ++c) beside[c] += s * dv[c];
  evaluator_->set_configuration(q);
  equations_->project_velocity(beside, 0);
  for (std::size_t c = 0; c < moving_; ++c) dv[c] = (beside[c] - v[c]) / s;
}

// Of places and rates, which every step rounds once.
void CarriedError::add_rounding(std::span<const double> y, double steps) {
  const double size = 0.5 * Disturbance::epsilon * std::sqrt(steps), length = motion_.length_scale();
  for (std::size_t c = 0; c < moving_; ++c) {
    const double unit = unit_of(c, length);
    added_[c] += size * random_.next() * (unit + std::abs(y[c]));
    added_[n_ + c] += size * random_.next() * (rate_ * unit + std::abs(y[n_ + c]));
  }
}

bool CarriedError::at_instant(double t, std::span<double> error) const {
  if (lost_) return false;
  const double since = drowned_ ? 0 : t - t_;
  for (std::size_t c = 0; c < n_; ++c) {
    error[c] = error_[c] + added_[c] + since * (error_[n_ + c] + 0.5 * since * da_[c]);
    error[n_ + c] = error_[n_ + c] + added_[n_ + c] + since * da_[c];
  }
  return true;
}

double CarriedError::norm_of_places(std::span<const double> error) const {
  const double length = motion_.length_scale();
  double largest = 0;
  for (std::size_t c = 0; c < moving_; ++c) {
    const double size = std::abs(error[c]) / unit_of(c, length);
    if (!std::isfinite(size)) return size;
    largest = std::max(largest, size);
  }
  return largest;
}

double CarriedError::norm(std::span<const double> error) const {
  const double length = motion_.length_scale(), rate = rate_ > 0 ? 1 / rate_ : 0;
  double largest = 0;
  for (std::size_t c = 0; c < moving_; ++c) {
    const double size = std::max(std::abs(error[c]), rate * std::abs(error[n_ + c])) / unit_of(c, length);
    if (!std::isfinite(size)) return size;
    largest = std::max(largest, size);
  }
  return largest;
}

}  // namespace catena
