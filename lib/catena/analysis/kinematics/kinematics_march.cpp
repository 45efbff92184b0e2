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
#include <stdexcept>

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
// A step fails where it is longer than about half of the remaining way to a dead point.
constexpr double most_steps_left = 4;
// A zero of a determinant further away than so many times the distance estimated from the rates is a different one.
constexpr double longest_way = 1e3;
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

Report Kinematics::follow_to(double t) {
  Report report;
  const double span = std::abs(t - t_), direction = t > t_ ? 1 : -1;
  const double tiny = smallest_step * std::max(span, std::abs(t));
  double step = span;
  std::size_t attempt = 0;
  int made_since_failure = patience;
  bool ignore_dips = false;
  double first_trial = 0;
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
  while (t_ != t) {
    // A curve that ends must not be left and reached again within a step.
    if (watched_.has_ends()) step = std::min(step, span / steps_to_a_row);
    if (!bridge_.empty()) {
      if (choice_ && direction * (t - choice_->t) > 0) {
        const SingularPoint point = *choice_;
        if (const Report taken = take_branch(point, options_.branch, direction); !taken.ok()) return taken;
      }
      if (t >= bridge_from_ && t <= bridge_to_) {
        place_on_bridge(t);
        break;
      }
      leave_bridge(direction > 0 ? bridge_to_ : bridge_from_);
      step = std::max(std::abs(t - t_), tiny);
      continue;
    }
    const bool last = std::abs(t - t_) <= step * (1 + 1e-9);
    const double next = last ? t : t_ + direction * step;
    const StepOutcome outcome = try_step(next, ignore_dips);
    if (outcome == StepOutcome::made) {
      q_.swap(trial_);
      t_ = next;
      has_velocity_ = has_acceleration_ = ignore_dips = false;
      ++evaluator_.counters.steps;
      ++made_since_failure;
      remember_margins();
      if (const Report consistent = check_redundant_rows(); !consistent.ok()) return consistent;
      if (chosen_rcond_ > 0 && solver_.rcond() < drifted * chosen_rcond_) choose_better_rows();
      if (t_ != t) {
        if (observer_ && !observer_->proceed(t_)) return cancelled();
        bool can_grow = true;
        // Between rows the velocity is worth its solve: it makes the next prediction cubic.
        if (solver_.solve_velocity(qd_, false)) {
          has_velocity_ = true;
          predictor_.push(t_, q_, qd_, {});
          double turning = 0;
          if (step * solver_.distance(qd_, nothing_, &turning) > reaches.front()) attempt = 0;
          can_grow = 2 * step * turning < longest_step;
        }
        if (can_grow && made_since_failure > patience && newton_.first_turn < largest_turn / 8) step *= 2;
      }
      continue;
    }
    ++evaluator_.counters.rejected;
    made_since_failure = 0;
    if (!has_velocity_) find_velocity();
    if (outcome == StepOutcome::left_curve) {
      step = std::abs(next - t_) / 2;
      if (!(step < tiny || t_ + direction * step == t_)) continue;
      evaluator_.set_configuration(trial_);
      Report left = watched_.check();
      if (left.ok()) return stuck(next, t);
      left.warnings = std::move(report.warnings);
      return left;
    }
    const double length = std::abs(next - t_);
    if (length < try_again * first_trial) attempt = 0;
    if (attempt < reaches.size() && has_velocity_ && length <= bridge_length((t_ + next) / 2, reaches[attempt]) / 2) {
      if (attempt == 0) {
        first_trial = length;
        if (choose_better_rows()) continue;
      }
      const Passage passage = pass_singular(next, t, reaches[attempt], report);
      if (passage == Passage::failed) return report;
      if (passage != Passage::none) {
        attempt = 0;
        continue;
      }
      ++attempt;
      ignore_dips = outcome == StepOutcome::dipped && attempt == reaches.size();
      if (ignore_dips) continue;
    } else if (outcome == StepOutcome::dipped && attempt == reaches.size()) {
      ignore_dips = true;
      continue;
    }
    step = std::min(step, std::abs(next - t_)) / 2;
    if (step < tiny || t_ + direction * step == t_) return stuck(next, t);
  }
  return report;
}

// No step can be made: determines whether the drivers prescribe an impossible motion (w^T nu != 0) or branches meet
// here.
Report Kinematics::stuck(double next, double target) {
  evaluator_.set_time(t_);
  trial_ = q_;
  std::vector<double> w(at(plan_->rows)), nu(at(plan_->rows)), z(q_.size(), 0.0);
  solver_.factor_at(q_);
  const bool found = solver_.null_vectors(w, z);
  evaluator_.nu(nu);
  SingularPoint point;
  point.t = t_ + (next - t_) / 2;
  point.q = q_;
  if (found) {
    point.name_bodies(evaluator_, std::span(&z, 1));
    point.find_driver(evaluator_, w, nu);
  }
  if (found && disagreement(evaluator_, w, nu) > clear_disagreement) {
    point.kind = SingularPoint::Kind::lock_up;
    locate_lock_up(target, point);
    return lock_up(std::move(point));
  }
  std::size_t heaviest = 0;
  const auto weight = [&](std::size_t r) {
    return std::abs(w[r]) * (plan_->row_is_angle[r] ? 1 : evaluator_.length_scale());
  };
  for (std::size_t r = 0; r < w.size(); ++r) {
    if (weight(r) > weight(heaviest)) heaviest = r;
  }
  const int element = plan_->row_element[heaviest];
  const bool moving = std::any_of(nu.begin(), nu.end(), [](double rate) { return rate != 0; });
  Report report;
  report.status = found && moving ? Status::bifurcation : Status::singular;
  report.message = fmt::format(
      "the motion cannot be continued beyond the singular configuration at t = {:.12g} s{}", point.t,
      found ? fmt::format("; most concerned: {} \"{}\"", model_->element_type(element), model_->element_name(element))
            : "");
  singular_points_.push_back(std::move(point));
  return report;
}

// Towards a dead point q = q* - a sqrt(t* - t), so that  t* - t = |qd|^2 / (2 qd . qdd)  and  q* = q + 2 (t* - t) qd,
// but for terms of t* - t. However large the rounding of the rates, it is no further away than the failed step: point.t
// is in the middle of that step. On this short distance the determinant of the singular block vanishes linearly: its
// zero is q*, off the constraints by the square of the distance; and the instant follows from w^T Phi(q*, t*) = 0,
// which this last distance does not change. False: no velocity leads there.
bool Kinematics::locate_lock_up(double target, SingularPoint& point) {
  std::vector<double> qd(q_.size(), 0.0), qdd(q_.size(), 0.0);
  if (!solver_.solve_velocity(qd, false)) return false;
  if (!solver_.solve_acceleration(qd, qdd, false)) std::fill(qdd.begin(), qdd.end(), 0.0);
  double product = 0, square = 0;
  for (std::size_t k = 0; k < 3 * at(plan_->moving); ++k) {
    const double unit = k % 3 == 2 ? 1 : evaluator_.length_scale();
    product += qd[k] / unit * (qdd[k] / unit);
    square += qd[k] / unit * (qd[k] / unit);
  }
  const double furthest = std::min(2 * most_steps_left * std::abs(point.t - t_), std::abs(target - t_));
  double rest = square / (2 * product);
  // So near that rounding determines the sign: the distance is taken as the largest possible.
  if (!(rest * (target - t_) > 0)) rest = furthest;
  rest = std::copysign(std::min(std::abs(rest), furthest), target - t_);
  solver_.factor_at(q_);
  std::vector<double> w(at(plan_->rows)), nu(w), z(q_.size());
  const auto margins = solver_.block_margins();
  const auto smaller = [](const BlockMargin& a, const BlockMargin& b) { return std::abs(a.pivot) < std::abs(b.pivot); };
  const auto block = std::min_element(margins.begin(), margins.end(), smaller) - margins.begin();
  const bool measured = !margins.empty() && solver_.null_vectors(w, z);
  const auto determinant = [&](double part) {
    for (std::size_t k = 0; k < q_.size(); ++k) point.q[k] = q_[k] + part * 2 * rest * qd[k];
    const bool regular = measured && solver_.factor_at(point.q) > 0;
    return regular ? solver_.block_margins()[static_cast<std::size_t>(block)].determinant : 0.0;
  };
  const double here = determinant(0), there = determinant(1);
  double part = here == there ? 1 : here / (here - there);
  if (const double left = determinant(part); left != here) part *= here / (here - left);
  determinant(part > 0 && part < longest_way ? part : 1);
  point.t = t_ + rest;
  solver_.residual_at(point.q);
  evaluator_.nu(nu);
  double off = 0, speed = 0;
  for (std::size_t r = 0; r < w.size(); ++r) off += w[r] * solver_.phi()[r], speed += w[r] * nu[r];
  const double time = off / speed;
  if (time * (target - t_) >= 0 && std::abs(time) <= std::abs(target - t_)) point.t = t_ + time;
  if (point.driver >= 0) {
    evaluator_.set_time(point.t);
    point.driver_value = evaluator_.element_value(point.driver).f;
  }
  return true;
}

// A row at the lock-up: places and times are known, rates and loads grow without bound.
void Kinematics::give_row_at_lock_up(const Needs& needs, RowObserver& observer) {
  const SingularPoint& point = singular_points_.back();
  const std::vector<double> none(std::max(q_.size(), at(plan_->rows)), std::numeric_limits<double>::quiet_NaN());
  const std::span<const double> unknown(none);
  evaluator_.set_time(point.t);
  Snapshot row{.evaluator = evaluator_, .t = point.t, .q = point.q};
  row.residual = solver_.residual_at(point.q) * evaluator_.length_scale();
  if (needs.velocity || needs.acceleration || needs.multipliers) row.qd = unknown.first(q_.size());
  if (needs.acceleration || needs.multipliers) row.qdd = unknown.first(q_.size());
  if (needs.multipliers) row.lambda = unknown.first(at(plan_->rows));
  if (needs.work) {
    row.work = row.dissipated = none.front();
    driver_work_.assign(model_->elements.size(), none.front());
    row.driver_work = driver_work_;
    row.initial_energy = initial_energy_;
  }
  observer.observe(row);
}

}  // namespace catena
