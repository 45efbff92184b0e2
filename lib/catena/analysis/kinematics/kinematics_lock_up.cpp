// Where no step can be made any more: dead points, the row there, other singular configurations that end a motion, and
// places of contact that jump.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/motion/runaway.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A step fails where it is longer than about half of the remaining way to a dead point.
constexpr double most_steps_left = 4;
// A zero of a determinant further away than so many times the distance estimated from the rates is a different one.
constexpr double longest_way = 1e3;
// A row whose smallest pivot has fallen to this part of the most that it has been is as near to a dead point as
// positions can tell: they meet the constraints to 1e-12, the square of the distance.
constexpr double locked_part = 1e-5;

}  // namespace

// No step can be made: determines whether the drivers prescribe an impossible motion (w^T nu != 0) or branches meet
// here.
Report Kinematics::stuck(double next, double target) {
  evaluator_.set_time(now_.t);
  trial_ = now_.q;
  std::vector<double> w(at(plan().rows)), nu(at(plan().rows)), z(now_.q.size(), 0.0);
  solver_.factor_at(now_.q);
  const bool found = solver_.null_vectors(w, z);
  evaluator_.nu(nu);
  SingularPoint point;
  point.t = now_.t + (next - now_.t) / 2;
  point.q = now_.q;
  if (found) {
    point.name_bodies(evaluator_, std::span(&z, 1));
    point.find_driver(evaluator_, w, nu);
  }
  if (found && disagreement(evaluator_, w, nu) > clear_disagreement) {
    point.kind = SingularPoint::Kind::lock_up;
    if (!locate_at_infinity(target, w, point)) locate_lock_up(target, point);
    return lock_up(std::move(point));
  }
  std::size_t heaviest = 0;
  const auto weight = [&](std::size_t r) {
    return std::abs(w[r]) * (plan().row_is_angle[r] ? 1 : evaluator_.length_scale());
  };
  for (std::size_t r = 0; r < w.size(); ++r) {
    if (weight(r) > weight(heaviest)) heaviest = r;
  }
  const int element = plan().row_element[heaviest];
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

// Whether a place of contact jumps on the way to (t, trial_); where it goes on as before nothing is looked at.
bool Kinematics::contacts_jump(double t) {
  if (!jumps_.may_jump(curves_.found, evaluator_.curve_places(), t - now_.t)) return false;
  curves_.ends = evaluator_.curve_places();
  curves_.halfway = now_.q;
  for (std::size_t k = 0; k < curves_.halfway.size(); ++k) curves_.halfway[k] += (trial_[k] - now_.q[k]) / 2;
  evaluator_.go_to_curve_places(curves_.found);
  evaluator_.set_configuration(curves_.halfway);
  curves_.jumping = jumps_.jumping(curves_.found, evaluator_.curve_places(), curves_.ends);
  evaluator_.go_to_curve_places(curves_.ends);
  evaluator_.set_configuration(trial_);
  return curves_.jumping >= 0;
}

// The same trouble has the same status in dynamics, whose steps end there as accelerations grow without bound.
Report Kinematics::jumped() const {
  Report report;
  report.status = Status::step_too_small;
  report.message = fmt::format(
      "no step can be made at t = {:.12g} s: the place where {} \"{}\" touches its curve ends there, and the next one "
      "lies elsewhere, so that the motion would jump; likely cause: a curve that is hollow there, or corners of it",
      now_.t, model_->element_type(curves_.jumping), model_->element_name(curves_.jumping));
  return report;
}

// The drivers prescribe a velocity along a vanishing combination of equations.
Report Kinematics::lock_up(SingularPoint point) {
  Report report = point.report_lock_up(*model_);
  singular_points_.push_back(std::move(point));
  return report;
}

// The present configuration, if it is a dead point to rounding; velocities there are meaningless.
std::optional<SingularPoint> Kinematics::dead_point_here() {
  if (!(solver_.factor_at(now_.q) > 0)) return std::nullopt;
  const bool near = margins_.has_fallen(solver_.block_margins(), locked_part);
  std::vector<double> w(at(plan().rows)), nu(w), z(now_.q.size());
  if (!near || !solver_.null_vectors(w, z)) return std::nullopt;
  evaluator_.nu(nu);
  if (!(disagreement(evaluator_, w, nu) > clear_disagreement)) return std::nullopt;
  SingularPoint point;
  point.kind = SingularPoint::Kind::lock_up;
  point.t = now_.t;
  point.q = now_.q;
  point.name_bodies(evaluator_, std::span(&z, 1));
  point.find_driver(evaluator_, w, nu);
  return point;
}

// Towards a dead point q = q* - a sqrt(t* - t), so that  t* - t = |qd|^2 / (2 qd . qdd)  and  q* = q + 2 (t* - t) qd,
// but for terms of t* - t. However large the rounding of the rates, it is no further away than the failed step: point.t
// is in the middle of that step. On this short distance the determinant of the singular block vanishes linearly: its
// zero is q*, off the constraints by the square of the distance; and the instant follows from w^T Phi(q*, t*) = 0,
// which this last distance does not change. False: no velocity leads there.
bool Kinematics::locate_lock_up(double target, SingularPoint& point) {
  std::vector<double> qd(now_.q.size(), 0.0), qdd(now_.q.size(), 0.0);
  if (!solver_.solve_velocity(qd, false)) return false;
  if (!solver_.solve_acceleration(qd, qdd, false)) std::fill(qdd.begin(), qdd.end(), 0.0);
  double product = 0, square = 0;
  for (std::size_t k = 0; k < 3 * at(plan().moving); ++k) {
    const double unit = k % 3 == 2 ? 1 : evaluator_.length_scale();
    product += qd[k] / unit * (qdd[k] / unit);
    square += qd[k] / unit * (qd[k] / unit);
  }
  const double furthest = std::min(2 * most_steps_left * std::abs(point.t - now_.t), std::abs(target - now_.t));
  double rest = square / (2 * product);
  // So near that rounding determines the sign: the distance is taken as the largest possible.
  if (!(rest * (target - now_.t) > 0)) rest = furthest;
  rest = std::copysign(std::min(std::abs(rest), furthest), target - now_.t);
  solver_.factor_at(now_.q);
  std::vector<double> w(at(plan().rows)), nu(w), z(now_.q.size());
  const auto margins = solver_.block_margins();
  const auto smaller = [](const BlockMargin& a, const BlockMargin& b) { return std::abs(a.pivot) < std::abs(b.pivot); };
  const auto block = std::min_element(margins.begin(), margins.end(), smaller) - margins.begin();
  const bool measured = !margins.empty() && solver_.null_vectors(w, z);
  const auto determinant = [&](double part) {
    for (std::size_t k = 0; k < now_.q.size(); ++k) point.q[k] = now_.q[k] + part * 2 * rest * qd[k];
    const bool regular = measured && solver_.factor_at(point.q) > 0;
    return regular ? solver_.block_margins()[static_cast<std::size_t>(block)].determinant : 0.0;
  };
  const double here = determinant(0), there = determinant(1);
  double part = here == there ? 1 : here / (here - there);
  if (const double left = determinant(part); left != here) part *= here / (here - left);
  determinant(part > 0 && part < longest_way ? part : 1);
  point.t = now_.t + rest;
  solver_.residual_at(point.q);
  evaluator_.nu(nu);
  double off = 0, speed = 0;
  for (std::size_t r = 0; r < w.size(); ++r) off += w[r] * solver_.phi()[r], speed += w[r] * nu[r];
  const double time = off / speed;
  if (time * (target - now_.t) >= 0 && std::abs(time) <= std::abs(target - now_.t)) point.t = now_.t + time;
  if (point.driver >= 0) {
    evaluator_.set_time(point.t);
    point.driver_value = evaluator_.element_value(point.driver).f;
  }
  return true;
}

// False: the place that the drivers ask for does not lie at infinity.
bool Kinematics::locate_at_infinity(double target, std::span<const double> w, SingularPoint& point) {
  std::vector<double> qd(now_.q.size(), 0.0), qdd(now_.q.size(), 0.0);
  if (!solver_.solve_velocity(qd, false) || !solver_.solve_acceleration(qd, qdd, false)) return false;
  const std::optional<double> t = instant_at_infinity(evaluator_, now_.t, now_.q, qd, qdd, target);
  if (t) put_at_infinity(point, evaluator_, *t, now_.q, qd, w);
  return t.has_value();
}

// A row at the lock-up: places and times are known, rates and loads grow without bound.
void Kinematics::give_row_at_lock_up(const Needs& needs, RowObserver& observer) {
  const SingularPoint& point = singular_points_.back();
  if (point.at_infinity) return;
  const std::vector<double> none(std::max(now_.q.size(), at(plan().rows)), std::numeric_limits<double>::quiet_NaN());
  const std::span<const double> unknown(none);
  evaluator_.set_time(point.t);
  Snapshot row{.evaluator = evaluator_, .t = point.t, .q = point.q};
  row.residual = solver_.residual_at(point.q) * evaluator_.length_scale();
  if (needs.velocity || needs.acceleration || needs.multipliers) row.qd = unknown.first(now_.q.size());
  if (needs.acceleration || needs.multipliers) row.qdd = unknown.first(now_.q.size());
  if (needs.multipliers) row.lambda = unknown.first(at(plan().rows));
  if (needs.work) work_.show_unknown(row, model_->elements.size());
  observer.observe(row);
}

}  // namespace catena
