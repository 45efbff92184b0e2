// Following the motion of a driven mechanism between two instants: steps, branches, singular configurations.
//
// A step is made if its prediction was close, if Newton contracted well, and if no block determinant of Phi_q changed
// its sign: branches that meet at a singular configuration differ by that sign, so a change means a jump, or a passage.
// A passage is enclosed by halving; then the motion is extrapolated from where it was still regular to the other side,
// and only the branch that continues the velocity is accepted there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/kinematics.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// A prediction may be off by this angle (the constraints are linear in positions), a correction may be this part of the
// one before: Newton's iteration then stays where it contracts.
constexpr double largest_turn = 0.1;
constexpr double largest_contraction = 0.25;
// Steps below this part of the span, or of the time itself, cannot be told from none.
constexpr double smallest_step = 1e-13;
// Steps shorter than this part of the span are a sign of a singular configuration ahead.
constexpr double suspicious_step = 1e-4;
// A singular passage is enclosed to this part of the span before it is crossed.
constexpr double enclosure = 1e-10;
// The anchor lies about this motion (rad, length scales) before the passage.
constexpr double anchor_distance = 0.05;
// Mean of the velocities before and after a passage against the motion between them: other branches miss by far more.
constexpr double largest_kink = 0.05;

}  // namespace

void Kinematics::remember_signs() {
  const auto signs = solver_.determinant_signs();
  signs_.assign(signs.begin(), signs.end());
}

Kinematics::StepOutcome Kinematics::try_step(double t) {
  evaluator_.set_time(t);
  trial_ = q_;
  predictor_.predict(t, trial_, {}, {});
  newton_ = solver_.solve_position(trial_);
  if (!newton_.converged || newton_.first_turn > largest_turn || newton_.contraction > largest_contraction) {
    return StepOutcome::too_long;
  }
  const auto signs = solver_.determinant_signs();
  if (!signs_.empty() && signs.size() == signs_.size() && !std::equal(signs.begin(), signs.end(), signs_.begin())) {
    return StepOutcome::crossed;
  }
  return StepOutcome::made;
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

double Kinematics::largest_rate() const {
  double largest = 0;
  for (int c = 0; c < plan_->columns; ++c) {
    const auto k = at(plan_->coordinate[at(c)]);
    largest = std::max(largest, std::abs(qd_[k]) / (k % 3 == 2 ? 1 : evaluator_.length_scale()));
  }
  return largest;
}

// The acceleration bends the extrapolation; where it cannot be had the step across is shorter.
void Kinematics::set_anchor() {
  if (!has_velocity_) find_velocity();
  anchor_t_ = t_;
  anchor_q_ = q_;
  anchor_qd_ = qd_;
  anchor_qdd_.assign(qd_.size(), 0.0);
  evaluator_.set_time(t_);
  trial_ = q_;
  if (solver_.solve_position(trial_).converged) solver_.solve_acceleration(qd_, anchor_qdd_, false);
}

Report Kinematics::cancelled() const {
  Report report;
  report.status = Status::cancelled;
  report.message = fmt::format("stopped at t = {:.12g} s; the rows so far are kept", t_);
  return report;
}

Report Kinematics::move_to(double t) {
  Report report;
  const double span = std::abs(t - t_), direction = t > t_ ? 1 : -1;
  const double tiny = smallest_step * std::max(span, std::abs(t));
  double step = span;
  bool enclosing = false;
  if (signs_.empty()) {
    solver_.factor_at(q_);
    remember_signs();
  }
  while (t_ != t) {
    const bool last = std::abs(t - t_) <= step * (1 + 1e-9);
    const double next = last ? t : t_ + direction * step;
    const StepOutcome outcome = try_step(next);
    if (outcome == StepOutcome::made) {
      q_.swap(trial_);
      t_ = next;
      has_velocity_ = has_acceleration_ = false;
      ++evaluator_.counters.steps;
      if (signs_.empty()) remember_signs();
      if (t_ != t) {
        if (observer_ && !observer_->proceed(t_)) return cancelled();
        // Between rows the velocity is worth its solve: it makes the next prediction cubic.
        if (solver_.solve_velocity(qd_, false)) {
          has_velocity_ = true;
          predictor_.push(t_, q_, qd_, {});
        }
        if (!enclosing && newton_.first_turn < largest_turn / 8) step *= 2;
        // Nearer to the passage, but not so near that velocities lose their digits.
        if (enclosing && has_velocity_ && step * largest_rate() > anchor_distance) set_anchor();
      }
      continue;
    }
    ++evaluator_.counters.rejected;
    // Branches that meet show by a changed sign, or by a Newton iteration that contracts badly however short the step.
    if (!enclosing && (outcome == StepOutcome::crossed || step < suspicious_step * span)) {
      enclosing = true;
      set_anchor();
    }
    if (enclosing && step <= std::max(enclosure * span, 4 * tiny)) {
      if (!pass_singular(t_, next, t)) return stuck(next);
      report.warnings.push_back(fmt::format(
          "at t = {:.9g} s the mechanism passes a singular configuration where branches meet; it stays on the one that "
          "continues its velocity",
          next));
      enclosing = false;
      step = std::max(std::abs(t - t_), tiny);
      continue;
    }
    step /= 2;
    if (step < tiny || t_ + direction * step == t_) return stuck(next);
    if (!has_velocity_) find_velocity();
  }
  return report;
}

// Extrapolates from the anchor across the enclosed singular instant and accepts the point only if the motion between is
// what the velocities at both ends say.
bool Kinematics::pass_singular(double before, double after, double target) {
  const double distance = std::abs(after - anchor_t_), direction = target > before ? 1 : -1;
  std::vector<double> rates(q_.size());
  for (double part : {1.0, 0.5, 0.25, 0.1, 0.03, 0.01, 1e-3, 1e-4}) {
    double t = after + direction * part * std::max(distance, 1e-6 * std::abs(target - before));
    if ((target - t) * direction < 0) t = target;
    if (t == after) continue;
    const double h = t - anchor_t_;
    for (std::size_t k = 0; k < q_.size(); ++k) {
      trial_[k] = anchor_q_[k] + h * (anchor_qd_[k] + h / 2 * anchor_qdd_[k]);
    }
    evaluator_.set_time(t);
    newton_ = solver_.solve_position(trial_);
    if (!newton_.converged || newton_.first_turn > largest_turn) continue;
    if (!solver_.solve_velocity(rates, false)) continue;
    double motion = 0, kink = 0;
    for (int c = 0; c < plan_->columns; ++c) {
      const auto k = at(plan_->coordinate[at(c)]);
      const double moved = trial_[k] - anchor_q_[k];
      const double scale = k % 3 == 2 ? 1 : 1 / evaluator_.length_scale();
      motion = std::max(motion, std::abs(moved) * scale);
      kink = std::max(kink, std::abs(moved - h / 2 * (anchor_qd_[k] + rates[k])) * scale);
    }
    if (kink > largest_kink * motion) continue;
    q_.swap(trial_);
    t_ = t;
    qd_.swap(rates);
    has_velocity_ = true;
    has_acceleration_ = false;
    predictor_.clear();
    predictor_.push(t_, q_, qd_, {});
    remember_signs();
    ++evaluator_.counters.steps;
    return true;
  }
  return false;
}

// No step can be made: says whether the drivers ask for the impossible (w^T nu != 0) or branches meet here.
Report Kinematics::stuck(double t) {
  Report report;
  evaluator_.set_time(t_);
  trial_ = q_;
  std::vector<double> w(at(plan_->rows)), nu(at(plan_->rows));
  solver_.factor_at(q_);
  const bool found = solver_.left_null_vector(w);
  evaluator_.nu(nu);
  double product = 0, square = 0;
  int heaviest = 0;
  for (std::size_t r = 0; r < w.size(); ++r) {
    product += w[r] * nu[r];
    square += nu[r] * nu[r];
    if (std::abs(w[r]) > std::abs(w[at(heaviest)])) heaviest = static_cast<int>(r);
  }
  const std::string where =
      found ? fmt::format("; most concerned: {} \"{}\"", model_->element_type(plan_->row_element[at(heaviest)]),
                          model_->element_name(plan_->row_element[at(heaviest)]))
            : "";
  const double singular = t_ + (t - t_) / 2;
  if (found && std::abs(product) > 1e-6 * std::sqrt(square)) {
    report.status = Status::lock_up;
    report.message = fmt::format(
        "lock-up at t = {:.12g} s: the drivers ask for a motion that the mechanism cannot make (a dead point){}",
        singular, where);
  } else {
    report.status = found && square > 0 ? Status::bifurcation : Status::singular;
    report.message = fmt::format("the motion cannot be continued beyond the singular configuration at t = {:.12g} s{}",
                                 singular, where);
  }
  return report;
}

}  // namespace catena
