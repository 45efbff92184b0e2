// Following the motion of a driven mechanism between two instants: steps, branches, causes that stop it.
//
// A step is made if its prediction was close, if Newton contracted well, if no body turned far, and if no diagonal
// block of Phi_q came near to a singular one or changed the sign of its determinant: branches that meet differ by that
// sign, so a change means a jump, or a passage; with an even nullity the sign stays, but the blocks' smallest pivots
// dip. Steps are halved until the suspected instant is enclosed; then kinematics_passage.cpp looks at it.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "catena/analysis/kinematics/course/step_rules.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/motion/step_growth.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Passages are tried over stretches of this much motion (rad, length scales), one after the other.
constexpr std::array<double, 6> reaches = {0.2, 0.1, 0.05, 0.015, 0.004, 0.001};
// They are tried again once steps have become this part of their length at the first trial.
constexpr double try_again = 1.0 / 32;
// Steps made after one that failed before their length may grow again.
constexpr int patience = 2;
// Least number of steps between rows where the ends of curves are watched.
constexpr double steps_to_a_row = 32;
// Curvature of the place on such a curve over a step, in parts of the curve: above the first the step is too long,
// below the second no closer check is needed.
constexpr double largest_bend = 0.05, smallest_bend = 1e-9;

}  // namespace

void Kinematics::remember_margins() { margins_.take(solver_.block_margins(), now_.t); }

Kinematics::StepOutcome Kinematics::try_step(double t, bool ignore_dips) {
  if (!ignore_dips && margins_.heads_for_singularity(std::abs(t - now_.t))) return StepOutcome::dipped;
  // A trial that was rejected may have found contacts far from here.
  evaluator_.go_to_curve_places(curves_.found);
  evaluator_.set_time(t);
  trial_ = now_.q;
  // Positions and rates in one pass over the history.
  predicted_.t = predict(t, trial_, predicted_.qd, predicted_.qdd) ? std::optional(t) : std::nullopt;
  newton_ = solver_.solve_position(trial_);
  if (!newton_.converged || newton_.first_turn > step_rules::largest_turn ||
      newton_.contraction > step_rules::largest_contraction) {
    return StepOutcome::too_long;
  }
  if (watched_.has_ends() && leaves_curve(t)) return StepOutcome::left_curve;
  if (!curves_.found.empty() && contacts_jump(t)) return StepOutcome::jumped;
  if (plan().constant_jacobian) return StepOutcome::made;
  double turn = 0;
  solver_.distance(trial_, now_.q, &turn);
  if (turn > step_rules::longest_step) return StepOutcome::too_long;
  // Without a correction the factors are those of the step before.
  if (newton_.iterations == 0) solver_.factor_at(trial_);
  const MarginHistory::Change change = margins_.change_to(solver_.block_margins());
  if (change.crossed) return StepOutcome::crossed;
  return change.dipped && !ignore_dips ? StepOutcome::dipped : StepOutcome::made;
}

// Whether a curve or table is left at (t, trial_) or on the way there, or might be: judged by the parabola through the
// places at the step's ends and halfway, within a part of its curvature.
bool Kinematics::leaves_curve(double t) {
  evaluator_.set_configuration(trial_);
  if (!watched_.check().ok()) return true;
  watched_.find_places(curves_.places[2]);
  curves_.halfway = now_.q;
  for (std::size_t k = 0; k < curves_.halfway.size(); ++k) curves_.halfway[k] += (trial_[k] - now_.q[k]) / 2;
  evaluator_.set_time(now_.t + (t - now_.t) / 2);
  const bool found = solver_.solve_position(curves_.halfway).converged;
  watched_.find_places(curves_.places[1]);
  evaluator_.set_time(now_.t);
  evaluator_.set_configuration(now_.q);
  watched_.find_places(curves_.places[0]);
  evaluator_.set_time(t);
  evaluator_.set_configuration(trial_);
  bool leaves = !found;
  for (std::size_t k = 0; k < curves_.places[0].size(); ++k) {
    const double a = curves_.places[0][k], m = curves_.places[1][k], b = curves_.places[2][k], bend = a - 2 * m + b;
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

bool Kinematics::predict(double t, std::span<double> q, std::span<double> qd, std::span<double> qdd) const {
  const bool known = predictor_.predict(t, q, qd, qdd);
  fixed_.restore(now_.q, q, qd, qdd);
  return known;
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
  const double span = std::abs(t - now_.t);
  Pace pace{
      .direction = t > now_.t ? 1.0 : -1.0, .shortest = shortest_step * std::max(span, std::abs(t)), .step = span};
  // Within a run its own limits hold.
  std::optional<Evaluator::TimeLimit> limit;
  if (!run_.observer) {
    const TimeRange way{std::min(t, now_.t), std::max(t, now_.t)};
    if (report = check_time_functions(*model_, way); !report.ok()) return report;
    limit.emplace(evaluator_, way);
  }
  if (margins_.empty() && stretch_.empty()) {
    solver_.factor_at(now_.q);
    remember_margins();
  }
  now_.on_bridge = false;
  if (curves_.found.empty()) curves_.found = evaluator_.curve_places();
  while (now_.t != t) {
    // A curve that ends must not be left and reached again within a step.
    if (watched_.has_ends()) pace.step = std::min(pace.step, span / steps_to_a_row);
    Report ended;
    if (!stretch_.empty()) {
      ended = go_along_bridge(t, pace);
    } else {
      const bool last = std::abs(t - now_.t) <= pace.step * (1 + 1e-9);
      const double next = last ? t : now_.t + pace.direction * pace.step;
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
  if (stretch_.choice && pace.direction * (t - stretch_.choice->t) > 0) {
    const SingularPoint point = *stretch_.choice;
    if (const Report taken = take_branch(point, options_.branch, pace.direction); !taken.ok()) return taken;
  }
  if (t >= stretch_.from && t <= stretch_.to) {
    place_on_bridge(t);
    return {};
  }
  leave_bridge(pace.direction > 0 ? stretch_.to : stretch_.from);
  pace.step = std::max(std::abs(t - now_.t), pace.shortest);
  return {};
}

// The step to `next`, which was solved for, is made; the next one may be longer.
Report Kinematics::take_step(double next, double target, Pace& pace) {
  now_.q.swap(trial_);
  if (!curves_.found.empty()) jumps_.accept(curves_.found, evaluator_.curve_places(), next - now_.t);
  now_.t = next;
  now_.has_velocity = now_.has_acceleration = pace.ignore_dips = false;
  ++evaluator_.counters.steps;
  ++pace.made_since_failure;
  curves_.found = evaluator_.curve_places();
  remember_margins();
  if (rows_.has_redundant_rows()) {
    if (Report consistent = rows_.check_places(here()); !consistent.ok()) return consistent;
    if (rows_.has_drifted()) choose_better_rows();
  }
  if (now_.t == target) return {};
  if (run_.observer && !run_.observer->proceed(now_.t)) return cancelled();
  bool can_grow = true;
  // Between rows the velocity is worth its solve: it makes the next prediction cubic.
  if (solver_.solve_velocity(now_.qd, false)) {
    now_.has_velocity = true;
    predictor_.push(now_.t, now_.q, now_.qd, {});
    double turning = 0;
    if (pace.step * solver_.rate_size(now_.qd, &turning) > reaches.front()) pace.attempt = 0;
    can_grow = 2 * pace.step * turning < step_rules::longest_step;
  }
  if (can_grow && pace.made_since_failure > patience && newton_.first_turn < step_rules::largest_turn / 8)
    pace.step *= 2;
  return {};
}

// The step to `next` failed: a singular configuration on the way is passed, or the step is halved. Not ok where neither
// leads on; `passed` takes the warnings of passages.
Report Kinematics::shorten_step(StepOutcome outcome, double next, double target, Pace& pace, Report& passed) {
  ++evaluator_.counters.rejected;
  pace.made_since_failure = 0;
  if (!now_.has_velocity) find_velocity();
  const double length = std::abs(next - now_.t);
  if (outcome == StepOutcome::jumped) {
    pace.step = length / 2;
    return pace.is_exhausted(now_.t) ? jumped() : Report{};
  }
  if (outcome == StepOutcome::left_curve) {
    pace.step = length / 2;
    if (!pace.is_exhausted(now_.t)) return {};
    evaluator_.set_configuration(trial_);
    Report left = watched_.check();
    return left.ok() ? stuck(next, target) : left;
  }
  const bool dipped = outcome == StepOutcome::dipped;
  if (length < try_again * pace.first_trial) pace.attempt = 0;
  if (pace.attempt < reaches.size() && now_.has_velocity &&
      length <= bridge_length((now_.t + next) / 2, reaches[pace.attempt]) / 2) {
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
  return pace.is_exhausted(now_.t) ? stuck(next, target) : Report{};
}

}  // namespace catena
