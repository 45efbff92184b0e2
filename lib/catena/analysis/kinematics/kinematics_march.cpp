// Following the motion of a driven mechanism between two instants: steps, branches, causes that stop it.
//
// A step is made if its prediction was close, if Newton contracted well, if no body turned far, and if no diagonal
// block of Phi_q came near to a singular one or changed the sign of its determinant: branches that meet differ by that
// sign, so a change means a jump, or a passage; with an even nullity the sign stays, but the blocks' smallest pivots
// dip. Steps are halved until the suspected instant is enclosed; then kinematics_passage.cpp looks at it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A prediction may be off by this angle (the constraints are linear in positions), a correction may be this part of the
// one before: Newton's iteration then stays where it contracts.
constexpr double largest_turn = 0.1;
constexpr double largest_contraction = 0.25;
// No body may turn further than this in a step: a singular configuration in between could be missed.
constexpr double longest_step = 0.5;
// Steps below this part of the span, or of the time itself, are rounding.
constexpr double smallest_step = 1e-13;
// A block whose determinant falls below the first part of its value one step before may pass through a singular matrix:
// this holds if it vanishes linearly, for any position of steps of equal length about that instant. (Its smallest pivot
// may be another one than that which vanishes.) Where there is no determinant the pivot is used, and must also fall
// below the second part of its largest value so far.
constexpr double sudden_part = 0.6, small_part = 0.3;
// The same by extrapolation from the step before: at least this part must be left of it.
constexpr double remaining_part = 0.3;
// Passages are tried over stretches of this much motion (rad, length scales), one after the other.
constexpr std::array<double, 6> reaches = {0.2, 0.1, 0.05, 0.015, 0.004, 0.001};
// They are tried again once steps have become this part of their length at the first trial.
constexpr double try_again = 1.0 / 32;
// Equations are chosen again where their reciprocal condition number has fallen to this part of its value.
constexpr double drifted = 0.01;
// Steps made after one that failed before their length may grow again.
constexpr int patience = 2;
// Least number of steps between rows where the ends of curves are watched.
constexpr double steps_to_a_row = 32;
// Curvature of the place on such a curve over a step, in parts of the curve: above the first the step is too long,
// below the second no closer check is needed.
constexpr double largest_bend = 0.05, smallest_bend = 1e-9;

}  // namespace

void Kinematics::remember_margins() {
  const auto margins = solver_.block_margins();
  const bool continued = margins_.size() == margins.size() && t_ != margins_t_;
  const double per_time = continued ? 1 / std::abs(t_ - margins_t_) : 0;
  margin_rates_.assign(margins.size(), 0.0);
  for (std::size_t k = 0; k < margins.size() && continued; ++k) {
    margin_rates_[k] = (std::abs(margins[k].determinant) - std::abs(margins_[k].determinant)) * per_time;
  }
  margins_.assign(margins.begin(), margins.end());
  margins_t_ = t_;
  if (largest_margins_.size() != margins_.size()) largest_margins_.assign(margins_.size(), 0.0);
  for (std::size_t k = 0; k < margins_.size(); ++k) {
    largest_margins_[k] = std::max(largest_margins_[k], std::abs(margins_[k].pivot));
  }
}

// Whether a block, extrapolated from the step before, is nearly singular at t, or was so before.
bool Kinematics::heads_for_singularity(double t) const {
  const double h = std::abs(t - t_);
  bool heads = false;
  for (std::size_t k = 0; k < margins_.size(); ++k) {
    const double pivot = std::abs(margins_[k].pivot), determinant = std::abs(margins_[k].determinant);
    const bool small = margins_[k].pivot != margins_[k].determinant || pivot < small_part * largest_margins_[k];
    heads |= small && determinant + h * margin_rates_[k] < remaining_part * determinant;
  }
  return heads;
}

Kinematics::StepOutcome Kinematics::try_step(double t, bool ignore_dips) {
  if (!ignore_dips && heads_for_singularity(t)) return StepOutcome::dipped;
  // A trial that was rejected may have found contacts far from here.
  evaluator_.go_to_curve_places(curve_places_);
  evaluator_.set_time(t);
  trial_ = q_;
  // Positions and rates in one pass over the history.
  predicted_ = predict(t, trial_, predicted_qd_, predicted_qdd_) ? std::optional(t) : std::nullopt;
  newton_ = solver_.solve_position(trial_);
  if (!newton_.converged || newton_.first_turn > largest_turn || newton_.contraction > largest_contraction) {
    return StepOutcome::too_long;
  }
  if (watched_.has_ends() && leaves_curve(t)) return StepOutcome::left_curve;
  if (plan_->constant_jacobian) return StepOutcome::made;
  double turn = 0;
  solver_.distance(trial_, q_, &turn);
  if (turn > longest_step) return StepOutcome::too_long;
  // Without a correction the factors are those of the step before.
  if (newton_.iterations == 0) solver_.factor_at(trial_);
  const auto margins = solver_.block_margins();
  if (margins.size() != margins_.size()) return StepOutcome::made;
  bool crossed = false, dipped = false;
  for (std::size_t k = 0; k < margins.size(); ++k) {
    crossed |= (margins[k].pivot < 0) != (margins_[k].pivot < 0);
    const double size = std::abs(margins[k].pivot);
    const bool small = margins[k].pivot != margins[k].determinant || size < small_part * largest_margins_[k];
    dipped |= small && std::abs(margins[k].determinant) < sudden_part * std::abs(margins_[k].determinant);
  }
  if (crossed) return StepOutcome::crossed;
  return dipped && !ignore_dips ? StepOutcome::dipped : StepOutcome::made;
}

// Whether a curve or table is left at (t, trial_) or on the way there, or might be: judged by the parabola through the
// places at the step's ends and halfway, within a part of its curvature.
bool Kinematics::leaves_curve(double t) {
  evaluator_.set_configuration(trial_);
  if (!watched_.check().ok()) return true;
  watched_.find_places(places_[2]);
  halfway_ = q_;
  for (std::size_t k = 0; k < halfway_.size(); ++k) halfway_[k] += (trial_[k] - q_[k]) / 2;
  evaluator_.set_time(t_ + (t - t_) / 2);
  const bool found = solver_.solve_position(halfway_).converged;
  watched_.find_places(places_[1]);
  evaluator_.set_time(t_);
  evaluator_.set_configuration(q_);
  watched_.find_places(places_[0]);
  evaluator_.set_time(t);
  evaluator_.set_configuration(trial_);
  bool leaves = !found;
  for (std::size_t k = 0; k < places_[0].size(); ++k) {
    const double a = places_[0][k], m = places_[1][k], b = places_[2][k], bend = a - 2 * m + b;
    const double turn = (b - a) / (2 * bend);  // half steps before the middle
    leaves |= std::abs(bend) > largest_bend;
    if (!(std::abs(turn) < 1)) continue;
    const double top = m - bend * turn * turn / 2, beyond = std::max(-top, top - 1);
    leaves |= beyond > WatchedElements::allowed_excess;
    leaves |= std::abs(bend) > smallest_bend && beyond > -std::abs(bend);
  }
  // The factors are to be those of the step's end.
  solver_.factor_at(trial_);
  return leaves;
}

// Extrapolation is exact for constants but for rounding, which nothing corrects where there is no unknown.
void Kinematics::restore_fixed(std::span<double> q, std::span<double> qd, std::span<double> qdd) const {
  for (int k : fixed_) {
    if (!q.empty()) q[at(k)] = q_[at(k)];
    if (!qd.empty()) qd[at(k)] = 0;
    if (!qdd.empty()) qdd[at(k)] = 0;
  }
}

bool Kinematics::predict(double t, std::span<double> q, std::span<double> qd, std::span<double> qdd) const {
  const bool known = predictor_.predict(t, q, qd, qdd);
  restore_fixed(q, qd, qdd);
  return known;
}

// The velocity at the present point makes the first prediction where none is known yet.
bool Kinematics::find_velocity() {
  evaluator_.set_time(t_);
  trial_ = q_;
  if (!solver_.solve_position(trial_).converged || !solver_.solve_velocity(qd_, false)) return false;
  has_velocity_ = true;
  predictor_.push(t_, q_, qd_, {});
  return true;
}

double Kinematics::largest_rate() const { return solver_.distance(qd_, nothing_, nullptr); }

Report Kinematics::cancelled() const {
  Report report;
  report.status = Status::cancelled;
  report.message = fmt::format("stopped at t = {:.12g} s; the rows so far are kept", t_);
  return report;
}

// How long steps are on the way to one instant, and what was tried since the last one that was made.
struct Kinematics::Pace {
  double direction;  // +1 or -1
  double shortest;   // s: below it steps are rounding
  double step;       // s
  int made_since_failure = patience;
  std::size_t attempt = 0;   // number of the reach over which a passage is tried next
  double first_trial = 0;    // s: length of the step at which the first one was tried
  bool ignore_dips = false;  // all were tried in vain: the determinants only look like vanishing

  bool is_exhausted(double t) const { return step < shortest || t + direction * step == t; }
};

Report Kinematics::follow_to(double t) {
  Report report;
  const double span = std::abs(t - t_);
  Pace pace{.direction = t > t_ ? 1.0 : -1.0, .shortest = smallest_step * std::max(span, std::abs(t)), .step = span};
  // Within a run its own limits hold.
  std::optional<Evaluator::TimeLimit> limit;
  if (!observer_) {
    const TimeRange way{std::min(t, t_), std::max(t, t_)};
    if (report = check_time_functions(*model_, way); !report.ok()) return report;
    limit.emplace(evaluator_, way);
  }
  if (margins_.empty() && bridge_.empty()) {
    solver_.factor_at(q_);
    remember_margins();
  }
  on_bridge_ = false;
  if (curve_places_.empty()) evaluator_.curve_places(curve_places_);
  while (t_ != t) {
    // A curve that ends must not be left and reached again within a step.
    if (watched_.has_ends()) pace.step = std::min(pace.step, span / steps_to_a_row);
    Report ended;
    if (!bridge_.empty()) {
      ended = go_along_bridge(t, pace);
    } else {
      const bool last = std::abs(t - t_) <= pace.step * (1 + 1e-9);
      const double next = last ? t : t_ + pace.direction * pace.step;
      const StepOutcome outcome = try_step(next, pace.ignore_dips);
      ended = outcome == StepOutcome::made ? take_step(next, t, pace) : shorten_step(outcome, next, t, pace, report);
    }
    if (ended.ok()) continue;
    ended.warnings.insert(ended.warnings.begin(), report.warnings.begin(), report.warnings.end());
    return ended;
  }
  return report;
}

// On a stretch that a bridge spans: the instant on it, or its end.
Report Kinematics::go_along_bridge(double t, Pace& pace) {
  if (choice_ && pace.direction * (t - choice_->t) > 0) {
    const SingularPoint point = *choice_;
    if (const Report taken = take_branch(point, options_.branch, pace.direction); !taken.ok()) return taken;
  }
  if (t >= bridge_from_ && t <= bridge_to_) {
    place_on_bridge(t);
    return {};
  }
  leave_bridge(pace.direction > 0 ? bridge_to_ : bridge_from_);
  pace.step = std::max(std::abs(t - t_), pace.shortest);
  return {};
}

// The step to `next`, which was solved for, is made; the next one may be longer.
Report Kinematics::take_step(double next, double target, Pace& pace) {
  q_.swap(trial_);
  t_ = next;
  has_velocity_ = has_acceleration_ = pace.ignore_dips = false;
  ++evaluator_.counters.steps;
  ++pace.made_since_failure;
  evaluator_.curve_places(curve_places_);
  remember_margins();
  if (Report consistent = check_redundant_rows(); !consistent.ok()) return consistent;
  if (chosen_rcond_ > 0 && solver_.rcond() < drifted * chosen_rcond_) choose_better_rows();
  if (t_ == target) return {};
  if (observer_ && !observer_->proceed(t_)) return cancelled();
  bool can_grow = true;
  // Between rows the velocity is worth its solve: it makes the next prediction cubic.
  if (solver_.solve_velocity(qd_, false)) {
    has_velocity_ = true;
    predictor_.push(t_, q_, qd_, {});
    double turning = 0;
    if (pace.step * solver_.distance(qd_, nothing_, &turning) > reaches.front()) pace.attempt = 0;
    can_grow = 2 * pace.step * turning < longest_step;
  }
  if (can_grow && pace.made_since_failure > patience && newton_.first_turn < largest_turn / 8) pace.step *= 2;
  return {};
}

// The step to `next` failed: a singular configuration on the way is passed, or the step is halved. Not ok where neither
// leads on; `passed` takes the warnings of passages.
Report Kinematics::shorten_step(StepOutcome outcome, double next, double target, Pace& pace, Report& passed) {
  ++evaluator_.counters.rejected;
  pace.made_since_failure = 0;
  if (!has_velocity_) find_velocity();
  const double length = std::abs(next - t_);
  if (outcome == StepOutcome::left_curve) {
    pace.step = length / 2;
    if (!pace.is_exhausted(t_)) return {};
    evaluator_.set_configuration(trial_);
    Report left = watched_.check();
    return left.ok() ? stuck(next, target) : left;
  }
  const bool dipped = outcome == StepOutcome::dipped;
  if (length < try_again * pace.first_trial) pace.attempt = 0;
  if (pace.attempt < reaches.size() && has_velocity_ &&
      length <= bridge_length((t_ + next) / 2, reaches[pace.attempt]) / 2) {
    if (pace.attempt == 0) {
      pace.first_trial = length;
      if (choose_better_rows()) return {};
    }
    const Passage passage = pass_singular(next, target, reaches[pace.attempt], passed);
    if (passage == Passage::failed) return std::exchange(passed, {});
    if (passage != Passage::none) {
      pace.attempt = 0;
      return {};
    }
    ++pace.attempt;
    pace.ignore_dips = dipped && pace.attempt == reaches.size();
    if (pace.ignore_dips) return {};
  } else if (dipped && pace.attempt == reaches.size()) {
    pace.ignore_dips = true;
    return {};
  }
  pace.step = std::min(pace.step, length) / 2;
  return pace.is_exhausted(t_) ? stuck(next, target) : Report{};
}

}  // namespace catena
