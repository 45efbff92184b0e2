#include "catena/analysis/kinematics/minimum_norm_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/kinematics/course/step_rules.hpp"
#include "catena/analysis/motion/runaway.hpp"
#include "catena/analysis/motion/step_growth.hpp"
#include "catena/analysis/motion/tableau.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/pose/dead_point.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/analysis/pose/scaling.hpp"
#include "catena/analysis/pose/singular_start.hpp"
#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

constexpr double tolerance = 1e-13;         // of a step's error, length scales or rad
constexpr double largest_residual = 1e-11;  // of positions after a step
// Steps that would have to be shorter than this (rad, length scales) may be near a place where branches meet: it is
// jumped over by one of `reaches`, with an error that is this many tolerances at most.
constexpr double suspicious_step = 0.03;
constexpr double norm_reaches[] = {0.05, 0.1, 0.03, 0.2, 0.15};
constexpr double rate_allowance = 1e4;

}  // namespace

MinimumNormMotion::MinimumNormMotion(std::shared_ptr<const Model> model, const PlanOptions& plan_options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), plan_options)),
      evaluator_(plan_, *model_, evaluation_),
      least_(evaluator_),
      watched_(evaluator_) {
  q_ = evaluator_.given_configuration();
  qd_.assign(q_.size(), 0.0);
  qdd_ = trial_ = error_ = error_low_ = qd_;
  stage_.assign(at(dormand_prince_8().stages), qd_);
}

void MinimumNormMotion::start_from(const SystemState& state) {
  t_ = state.t;
  has_velocity_ = false;
  step_ = 0;
  take_over_places(evaluator_, state, q_);
}

SystemState MinimumNormMotion::state() const {
  return state_of(evaluator_, t_, q_, has_velocity_ ? std::span<const double>(qd_) : std::span<const double>{});
}

Report MinimumNormMotion::prepare(AnalysisReport& report) {
  evaluator_.set_time(t_);
  const AssemblyOutcome assembled = Assembler(evaluator_).assemble(q_);
  if (!assembled.ok()) return assembled;
  residual_ = assembled.residual;
  const MobilityReport mobility = analyse_mobility(evaluator_, q_);
  report.rank = mobility.rank;
  report.dof = mobility.dof();
  report.mobility = mobility.mobility();
  for (int element : mobility.redundant_elements) report.redundant.push_back(model_->element_name(element));
  report.warnings = mobility.warnings;
  if (mobility.dof() > 0) {
    std::string bodies;
    for (const std::string& body : mobility.free_bodies) bodies += (bodies.empty() ? "\"" : ", \"") + body + "\"";
    report.warnings.push_back(fmt::format(
        "{} of {} coordinates are not driven ({}): of all motions the one with the smallest velocities is given, {}",
        mobility.dof(), mobility.columns, bodies,
        least_.in_mass_metric()
            ? "that of least kinetic energy"
            : "in the metric |v|^2 + rho^2 omega^2 of every body, rho its mean attachment distance"));
  }
  started_ = t_;
  travelled_ = 0;
  return {};
}

// At the start: in a dead point, or with rows that contradict each other.
Report MinimumNormMotion::no_velocity() {
  evaluator_.set_time(t_);
  if (std::optional<SingularPoint> point = find_dead_point(evaluator_, q_)) {
    singular_points_.push_back(std::move(*point));
    return singular_points_.back().report_lock_up(*model_);
  }
  Report report;
  NameList names;
  for (const int element : least_.worst_elements())
    names.add_text(fmt::format("{} \"{}\"", model_->element_type(element), model_->element_name(element)));
  report.status = Status::inconsistent;
  report.message = fmt::format(
      "no velocities meet all constraints and drivers at t = {:.12g} s; most concerned: {}; likely cause: drivers that "
      "contradict each other, or a motion that the mechanism cannot make",
      t_, names.text());
  return report;
}

Report MinimumNormMotion::cancelled() const {
  Report report;
  report.status = Status::cancelled;
  report.message = fmt::format("stopped at t = {:.12g} s; the rows so far are kept", t_);
  return report;
}

// The start lies where no motion goes on, or where several do and nothing chooses; ok: neither.
Report MinimumNormMotion::stuck_at_start(double target) {
  evaluator_.set_time(t_);
  SingularPoint point = find_branches(evaluator_, q_, {}, dependence::follows_at_start);
  if (point.nullity <= plan_->columns - plan_->rows) return {};
  SingularStart start = decide_start(evaluator_, std::move(point), 0, target < t_ ? -1 : 1, "drive what is free");
  if (!start.report.ok()) singular_points_.push_back(std::move(start.point));
  return start.report;
}

// No step can be made: velocities have grown beyond all bounds, or rows have become dependent.
Report MinimumNormMotion::stuck(double target) {
  if (t_ == started_) {
    if (Report start = stuck_at_start(target); !start.ok()) return start;
  }
  Report report;
  const bool met = least_.velocity(t_, Side::after, q_, qd_);
  const int element = met ? plan_->row_element[at(least_.heaviest_row())] : least_.worst_elements().front();
  const std::string where =
      fmt::format("; most concerned: {} \"{}\"", model_->element_type(element), model_->element_name(element));
  SingularPoint point;
  point.t = t_;
  point.q = q_;
  point.name_bodies(evaluator_, std::span(&qd_, 1));
  if (least_.size(qd_) * std::abs(t_ - started_) > far_away * travelled_) {
    const bool rates = met && least_.acceleration(qd_, qdd_);
    if (const auto t = rates ? instant_at_infinity(evaluator_, t_, q_, qd_, qdd_, target) : std::nullopt) {
      put_at_infinity(point, evaluator_, *t, q_, qd_, least_.multipliers());
      return singular_points_.emplace_back(std::move(point)).report_lock_up(*model_);
    }
    point.kind = SingularPoint::Kind::lock_up;
    // q = q* - a sqrt(t* - t): velocities grow with 1 / sqrt(t* - t), their relative growth is 1 / (2 (t* - t)).
    const double growth = rates ? least_.growth(qd_, qdd_) : 0;
    if (const double rest = 1 / (2 * growth);
        growth != 0 && rest * (target - t_) > 0 && std::abs(rest) <= std::abs(target - t_)) {
      point.t += rest;
      for (std::size_t k = 0; k < q_.size(); ++k) point.q[k] += 2 * rest * qd_[k];
    }
    report.status = Status::lock_up;
    report.message = fmt::format(
        "lock-up at t = {:.12g} s: the drivers ask for a motion that the mechanism cannot make, whatever its free "
        "motions do{}",
        point.t, where);
  } else {
    point.kind = SingularPoint::Kind::isolated;
    report.status = Status::singular;
    report.message = fmt::format(
        "the motion of least velocities cannot be continued beyond the singular configuration at t = {:.12g} s{}",
        point.t, where);
  }
  std::vector<double> nu(at(plan_->rows));
  evaluator_.set_time(point.t);
  evaluator_.nu(nu);
  point.find_driver(evaluator_, least_.multipliers(), nu);
  singular_points_.push_back(std::move(point));
  return report;
}

// A row at the lock-up: places and times are known, rates grow without bound.
void MinimumNormMotion::give_row_at_lock_up(const Needs& needs, RowObserver& observer) {
  const SingularPoint& point = singular_points_.back();
  if (point.at_infinity) return;
  const std::vector<double> unknown(q_.size(), std::numeric_limits<double>::quiet_NaN());
  const std::span<const double> none;
  std::vector<double> phi(at(plan_->rows));
  evaluator_.set_time(point.t);
  evaluator_.set_configuration(point.q);
  evaluator_.phi(phi);
  observer.observe({.evaluator = evaluator_,
                    .t = point.t,
                    .q = point.q,
                    .qd = needs.velocity || needs.acceleration ? std::span<const double>(unknown) : none,
                    .qdd = needs.acceleration ? std::span<const double>(unknown) : none,
                    .residual = row_norm(*plan_, phi, evaluator_.length_scale()) * evaluator_.length_scale()});
}

// stage_[0] holds the velocities at (t_, q_); trial_ is where the step ends.
bool MinimumNormMotion::evaluate_stages(double h, double end, bool lands_on_break, bool on_constraints) {
  const Tableau& table = dormand_prince_8();
  const std::size_t moving = 3 * at(plan_->moving);
  // A trial that was rejected may have found contacts far from here.
  evaluator_.go_to_curve_places(curve_places_);
  const auto combine = [&](const StageSum& sum, const double* from, std::span<double> out) {
    for (std::size_t k = 0; k < moving; ++k) {
      double value = 0;
      for (const StageTerm& term : sum) value += term.weight * stage_[at(term.stage)][k];
      out[k] = (from ? from[k] : 0) + h * value;
    }
  };
  for (int s = 1; s < table.stages; ++s) {
    combine(table.a[at(s)], q_.data(), trial_);
    const bool at_end = table.c[at(s)] == 1;
    const double t = at_end ? end : t_ + table.c[at(s)] * h;
    const Side side = at_end && lands_on_break ? Side::before : Side::after;
    if (on_constraints && !(least_.project(t, side, trial_) <= largest_residual)) return false;
    if (!least_.velocity(t, side, trial_, stage_[at(s)])) return false;
  }
  combine(table.b, q_.data(), trial_);
  combine(table.error, nullptr, error_);
  combine(table.error_low, nullptr, error_low_);
  return true;
}

double MinimumNormMotion::error_size(double h) const {
  if (h == 0) return 0;
  const double high = least_.size(error_) / tolerance, low = least_.size(error_low_) / tolerance;
  const double denominator = std::hypot(high, 0.1 * low);
  return denominator == 0 ? 0 : high * high / denominator;
}

// A step to `end`, which it leaves in trial_: its error in tolerances, infinite if there is none.
double MinimumNormMotion::try_step(double end, bool lands_on_break, bool on_constraints) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (!evaluate_stages(end - t_, end, lands_on_break, on_constraints)) return none;
  const double error = error_size(end - t_);
  if (!(error <= (on_constraints ? rate_allowance : 1))) return error;
  const double residual = least_.project(end, Side::before, trial_);
  if (!(residual <= largest_residual)) return none;
  residual_ = residual;
  return error;
}

// Across a place where branches meet. Off the constraints the velocities mean nothing there; those of v(t, P(t, q)), P
// the projection onto the constraints, are the same ones on them and as smooth as the branch.
std::optional<double> MinimumNormMotion::jump(double limit, bool breaks, double rate) {
  for (double reach : norm_reaches) {
    const double h = reach / rate, remaining = std::abs(limit - t_);
    const double end = h < remaining ? t_ + std::copysign(h, limit - t_) : limit;
    if (try_step(end, breaks && end == limit, true) <= rate_allowance) return end;
  }
  return std::nullopt;
}

// The part of the way to one instant within which functions of time are smooth: to the next breakpoint.
struct MinimumNormMotion::Leg {
  double direction;     // 1 or -1, of time
  double limit;         // its end, s
  bool breaks = false;  // a function breaks there
  double rate = 0;      // of the largest velocity at its start, rad/s or length scales a second
};

MinimumNormMotion::Leg MinimumNormMotion::next_leg(double t) const {
  Leg leg{.direction = t > t_ ? 1.0 : -1.0, .limit = t};
  for (const auto& function : model_->functions) {
    for (double instant : function.breakpoints(std::min(t_, leg.limit), std::max(t_, leg.limit))) {
      if (leg.direction * (leg.limit - instant) > 0) leg.limit = instant, leg.breaks = true;
    }
  }
  return leg;
}

Report MinimumNormMotion::move_to(double t, RowObserver& observer) {
  while (t_ != t) {
    if (!observer.proceed(t_)) return cancelled();
    Leg leg = next_leg(t);
    if (!least_.velocity(t_, leg.direction > 0 ? Side::after : Side::before, q_, stage_[0])) {
      return t_ == started_ ? no_velocity() : stuck(t);
    }
    curve_places_ = evaluator_.curve_places();
    leg.rate = least_.size(stage_[0]);
    if (step_ == 0) {
      step_ = leg.rate > 0 ? 0.2 * std::pow(tolerance, 1.0 / 8) / leg.rate : std::abs(leg.limit - t_);
    }
    if (Report made = make_step(leg, t); !made.ok()) return made;
  }
  return {};
}

// One step of the leg, from the velocity in the first stage; `target`: where the motion is to come.
Report MinimumNormMotion::make_step(const Leg& leg, double target) {
  const auto [direction, limit, breaks, rate] = leg;
  const double smallest = shortest_step * std::max(std::abs(t_), rate > 0 ? 1 / rate : 0.0);
  for (bool rejected = false;;) {
    const double remaining = std::abs(limit - t_);
    double h = std::min(step_, rate > 0 ? step_rules::longest_step / rate : step_);
    const bool lands = h >= remaining * (1 - 1e-9);
    if (lands) h = remaining;
    double end = lands ? limit : t_ + direction * h;
    if (!lands && (h < smallest || end == t_)) return stuck(target);
    // Backwards in time a jump lies on the other side.
    const double error = try_step(end, direction > 0 && lands && breaks, false);
    if (error <= 1 && watched_.has_ends()) {
      evaluator_.set_configuration(trial_);
      if (Report left = watched_.check(); !left.ok()) {
        if (h < smallest) return left;
        step_ = h / 2;
        continue;
      }
    }
    const double growth = step_growth(error, 8);
    if (!(error <= 1)) {
      ++evaluator_.counters.rejected;
      const bool first = !rejected;
      rejected = true;
      const std::optional<double> across =
          first && h * rate < suspicious_step ? jump(limit, direction > 0 && breaks, rate) : std::nullopt;
      if (!across) {
        step_ = h * (std::isfinite(error) ? std::min(growth, 0.9) : 0.25);
        continue;
      }
      end = *across;
      h = std::abs(end - t_);
      step_ = h;
    } else if (!lands || growth < 1) {
      step_ = h * (rejected ? std::min(growth, 1.0) : growth);
    }
    take_step(end, rate * h);
    return {};
  }
}

// The step to `end`, which was tried, is made.
void MinimumNormMotion::take_step(double end, double way) {
  ++evaluator_.counters.steps;
  travelled_ += way;
  q_.swap(trial_);
  t_ = end;
  has_velocity_ = false;
}

Report MinimumNormMotion::solve_rates(const Needs& needs) {
  if (!needs.velocity && !needs.acceleration) return {};
  if (!least_.velocity(t_, Side::after, q_, qd_)) return t_ == started_ ? no_velocity() : stuck(t_);
  has_velocity_ = true;
  if (needs.acceleration && !least_.acceleration(qd_, qdd_)) return t_ == started_ ? no_velocity() : stuck(t_);
  return {};
}

AnalysisReport MinimumNormMotion::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  const ProcessTimer timer;
  AnalysisReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan_->rows;
  report.islands = plan_->islands;
  std::int64_t rows = 0;
  double last_row = t_;
  const auto end = [&](const Report& outcome) {
    report.status = outcome.status;
    report.message = outcome.message;
    const bool given = rows > 0 && !singular_points_.empty() && singular_points_.back().t == last_row;
    if (outcome.status == Status::lock_up && !given) give_row_at_lock_up(needs, observer);
    report.counters = evaluator_.counters;
    report.seconds = timer.seconds();
    return report;
  };
  const TimeRange whole{grid.size() > 0 ? std::min(t_, grid.earliest()) : t_,
                        grid.size() > 0 ? std::max(t_, grid.latest()) : t_};
  if (const Report functions = check_time_functions(*model_, whole); !functions.ok()) return end(functions);
  const Evaluator::TimeLimit limit(evaluator_, whole);
  if (const Report prepared = prepare(report); !prepared.ok()) return end(prepared);
  for (std::int64_t k = 0; k < grid.size(); ++k) {
    if (grid[k] != t_) {
      if (const Report moved = move_to(grid[k], observer); !moved.ok()) return end(moved);
    }
    if (const Report solved = solve_rates(needs); !solved.ok()) return end(solved);
    evaluator_.set_time(t_);
    evaluator_.set_configuration(q_);
    if (const Report sound = watched_.check(); !sound.ok()) return end(sound);
    const std::span<const double> none;
    const Snapshot snapshot{.evaluator = evaluator_,
                            .t = t_,
                            .q = q_,
                            .qd = has_velocity_ ? std::span<const double>(qd_) : none,
                            .qdd = needs.acceleration ? std::span<const double>(qdd_) : none,
                            .residual = residual_ * evaluator_.length_scale()};
    if (!observer.observe(snapshot)) return end(cancelled());
    ++rows;
    last_row = t_;
  }
  // A later analysis continues with the velocities, whether or not they are output, since drivers do not determine
  // them.
  if (!has_velocity_) {
    if (const Report solved = solve_rates({.velocity = true}); !solved.ok()) return end(solved);
  }
  return end({});
}

}  // namespace catena
