#include "catena/analysis/kinematics/kinematics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/pose/mobility.hpp"
#include "catena/analysis/pose/singular_start.hpp"
#include "catena/analysis/pose/whole_turns.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/energy.hpp"

namespace catena {
namespace {

// A given configuration is taken as near to the assembled one if Newton's first correction is at most this large
// (length scales, rad) and every further one at most this part of the one before.
constexpr double nearby = 0.1;
constexpr double nearby_contraction = 0.25;
// A reciprocal condition number above this leaves no doubt that all rows are independent.
constexpr double clearly_regular = 1e-9;
// Below this one reactions are taken from both sides of the singular configuration: a bridge, which meets the
// constraints to 2e-12, gives them there with a relative error of 1e-6.
constexpr double reactions_determined = 1e-6;
// Part of the loads that least reactions may leave unbalanced.
constexpr double balanced = 1e-10;
// How far along a branch (rad, length scales) rows are chosen where it starts.
constexpr double start_distance = 0.02;
// Redundant rows that velocities and accelerations miss by more than the first part of them are a reason to look for
// better rows, by more than the second a contradiction.
constexpr double doubtful_rates = 1e-11, contradictory_rates = 1e-6;
// A row whose smallest pivot has fallen to this part of the most that it has been is as near to a dead point as
// positions can tell: they meet the constraints to 1e-12, the square of the distance.
constexpr double locked_part = 1e-5;
// The present factors may be those of an earlier iterate: below this condition the pivots are checked.
constexpr double suspicious_part = 1e-4;
// Rates of redundant equations, if not needed for output, are checked at one in so many rows: they cost as much as the
// positions, whose residual is checked at every step.
constexpr std::int64_t rows_between_checks = 16;
}  // namespace

Kinematics::Kinematics(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                       const KinematicsOptions& options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), plan_options)),
      evaluator_(plan_, *model_),
      options_(options),
      solver_(evaluator_),
      watched_(evaluator_),
      predictor_(at(plan_->coordinates())) {
  if (!(options.tolerance > 0)) throw std::invalid_argument("kinematics: the tolerance must be above zero");
  if (options.branch < 0) throw std::invalid_argument("kinematics: branches are numbered from 1, and 0 chooses none");
  solver_.tolerance = options.tolerance;
  q_ = evaluator_.given_configuration();
  qd_.assign(q_.size(), 0.0);
  qdd_.assign(q_.size(), 0.0);
  nothing_.assign(q_.size(), 0.0);
  for (int k = 0; k < plan_->coordinates(); ++k) {
    if (k >= 3 * plan_->bodies || plan_->column[at(k)] < 0) fixed_.push_back(k);
  }
  trial_ = q_;
}

void Kinematics::start_from(const SystemState& state) {
  t_ = state.t;
  assembled_.reset();
  predictor_.clear();
  bridge_.clear();
  choice_.reset();
  margins_.clear();
  curve_places_.clear();
  redundant_.clear();
  prepared_ = placed_ = on_bridge_ = false;
  has_velocity_ = has_acceleration_ = false;
  account_.reset();
  take_over_places(evaluator_, state, q_);
}

SystemState Kinematics::state() const {
  return state_of(evaluator_, t_, q_, has_velocity_ ? std::span<const double>(qd_) : std::span<const double>{});
}

AssemblyOutcome Kinematics::assemble() {
  evaluator_.set_time(t_);
  predictor_.clear();
  bridge_.clear();
  placed_ = on_bridge_ = false;
  has_velocity_ = has_acceleration_ = false;
  curve_places_.clear();
  AssemblyOutcome outcome;
  if (!assemble_nearby()) outcome = Assembler(evaluator_).assemble(q_, options_.tolerance);
  if (outcome.ok() && watched_.has_ends()) {
    evaluator_.set_configuration(q_);
    static_cast<Report&>(outcome) = watched_.check_ends();
  }
  assembled_ = outcome;
  return outcome;
}

// A driven mechanism given near its assembled configuration needs only Newton's method: that configuration is isolated,
// and none is nearer.
bool Kinematics::assemble_nearby() {
  for (const auto& body : model_->bodies) {
    if (body.hold_x || body.hold_y || body.hold_angle) return false;
  }
  if (!solver_.is_square()) return false;
  trial_ = q_;
  move_whole_turns(evaluator_, trial_);
  newton_ = solver_.solve_position(trial_);
  if (!newton_.converged || newton_.first_correction > nearby || newton_.contraction > nearby_contraction) {
    return false;
  }
  q_.swap(trial_);
  if (evaluator_.trace) (*evaluator_.trace)("assembly", newton_.iterations, newton_.residual, newton_.first_correction);
  return true;
}

// Assembled and driven, with the solver at the present configuration: the state from which every step and every solve
// starts.
Report Kinematics::get_ready(double direction) {
  if (!assembled_ || !assembled_->ok()) {
    if (const AssemblyOutcome outcome = assemble(); !outcome.ok()) return outcome;
  }
  Report prepared = prepare(direction);
  if (!prepared.ok() || placed_) return prepared;
  placed_ = true;
  if (!bridge_.empty()) {
    place_on_bridge(t_);
    return prepared;
  }
  trial_ = q_;
  evaluator_.set_time(t_);
  newton_ = solver_.solve_position(trial_);
  if (newton_.converged) q_.swap(trial_);
  return prepared;
}

Report Kinematics::move_to(double t) {
  if (!std::isfinite(t)) throw std::invalid_argument("kinematics cannot move to an instant that is not finite");
  Report ready = get_ready(t < t_ ? -1 : 1);
  if (!ready.ok()) return ready;
  Report moved = account_ ? move_and_sum_up(t) : follow_to(t);
  if (account_) account_->driver_work(work_, driver_work_);
  moved.warnings.insert(moved.warnings.begin(), ready.warnings.begin(), ready.warnings.end());
  return moved;
}

Report Kinematics::solve_rates(const Needs& needs) {
  Report ready = get_ready(1);
  return ready.ok() ? find_rates(needs) : ready;
}

Report Kinematics::sum_up_work() {
  Report ready = get_ready(1);
  return ready.ok() ? start_work() : ready;
}

// Makes sure that the constraints drive every coordinate, with a working set of rows if there are more than needed.
Report Kinematics::prepare(double direction) {
  Report report;
  if (prepared_) return report;
  if (!plan_->jacobian.entries() && plan_->columns > 0) {
    report.status = Status::under_driven;
    report.message = "nothing is constrained or driven: add drivers, or fix bodies";
    return report;
  }
  // In the usual case, a factorization without a small pivot, no rank analysis is needed.
  if (plan_->rows == plan_->columns && solver_.factor_at(q_) > clearly_regular) {
    prepared_ = true;
    return report;
  }
  const MobilityReport mobility = analyse_mobility(evaluator_, q_);
  if (mobility.rank < plan_->columns) {
    SingularPoint point = find_branches(evaluator_, q_, {}, start_dependence);
    if (plan_->rows >= plan_->columns && point.held_to_second_order) {
      return start_singular(std::move(point), direction);
    }
    report.status = Status::under_driven;
    report.message = mobility.describe_freedom();
    return report;
  }
  if (plan_->rows > plan_->columns) {
    choose_rows(q_);
    chosen_rcond_ = solver_.factor_at(q_);
  }
  for (int element : mobility.redundant_elements) redundant_.push_back(model_->element_name(element));
  report.warnings = mobility.warnings;
  prepared_ = true;
  return report;
}

// The mechanism is given where branches meet: nothing says on which of them it is.
Report Kinematics::start_singular(SingularPoint found, double direction) {
  SingularStart start = decide_start(evaluator_, std::move(found), options_.branch, direction);
  singular_points_.push_back(start.point);
  if (!start.report.ok()) return start.report;
  const SingularPoint& point = start.point;
  const int branch = start.branch;
  Report report;
  if (plan_->rows > plan_->columns) {
    // Rows are chosen a little way along the branch, where they can be told apart.
    const std::vector<double>& tangent = point.tangents[at(branch - 1)];
    const double h = direction * start_distance / solver_.distance(tangent, nothing_, nullptr);
    trial_ = q_;
    for (std::size_t k = 0; k < trial_.size(); ++k) trial_[k] += h * tangent[k];
    if (!choose_rows(trial_)) {
      report.status = Status::singular;
      report.message = fmt::format("the constraints do not determine the motion near its start at t = {:.12g} s", t_);
      return report;
    }
  }
  report = take_branch(point, branch, direction);
  prepared_ = report.ok();
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
  if (!(solver_.factor_at(q_) > 0)) return std::nullopt;
  const auto margins = solver_.block_margins();
  bool near = false;
  for (std::size_t k = 0; k < margins.size() && k < largest_margins_.size(); ++k) {
    near = near || std::abs(margins[k].pivot) < locked_part * largest_margins_[k];
  }
  std::vector<double> w(at(plan_->rows)), nu(w), z(q_.size());
  if (!near || !solver_.null_vectors(w, z)) return std::nullopt;
  evaluator_.nu(nu);
  if (!(disagreement(evaluator_, w, nu) > clear_disagreement)) return std::nullopt;
  SingularPoint point;
  point.kind = SingularPoint::Kind::lock_up;
  point.t = t_;
  point.q = q_;
  point.name_bodies(evaluator_, std::span(&z, 1));
  point.find_driver(evaluator_, w, nu);
  return point;
}

// Q - M qdd by columns, at the evaluator's configuration.
void Kinematics::scatter_applied_forces(std::span<const double> qd, std::span<const double> qdd) {
  applied_.resize(at(plan_->coordinates()));
  evaluator_.applied_forces(qd, applied_);
  loads_.resize(at(plan_->columns));
  for (int c = 0; c < plan_->columns; ++c) {
    const int coordinate = plan_->coordinate[at(c)];
    const auto& body = model_->bodies[at(plan_->model_body[at(coordinate / 3)])];
    const double inertia = coordinate % 3 == 2 ? body.inertia : body.mass;
    loads_[at(c)] = applied_[at(coordinate)] - inertia * qdd[at(coordinate)];
  }
}

Report Kinematics::find_rates(const Needs& needs) {
  Report report;
  const bool acceleration = needs.acceleration || needs.multipliers;
  if (!needs.velocity && !acceleration) return report;
  if (on_bridge_) {
    // The bridge gives the rates; multipliers need factors of the matrix, which show whether they can be computed.
    if (needs.multipliers && !(solver_.factor_at(q_) > reactions_determined)) {
      find_limit_of_multipliers();
      return report;
    }
    return needs.multipliers ? solve_multipliers() : report;
  }
  // Predictions cover the quantities that run() needs.
  const bool start = predicted_ == t_ && !predicted_qd_.empty();
  const bool acceleration_start = start && !predicted_qdd_.empty();
  predicted_.reset();
  if (start) qd_.swap(predicted_qd_);
  if (!solver_.solve_velocity(qd_, start)) {
    report.status = Status::singular;
    report.message =
        fmt::format("velocities are not determined at t = {:.12g} s: the mechanism is at a singular configuration", t_);
    return report;
  }
  has_velocity_ = true;
  if (!acceleration) return report;
  if (acceleration_start) qdd_.swap(predicted_qdd_);
  if (!solver_.solve_acceleration(qd_, qdd_, acceleration_start)) {
    report.status = Status::singular;
    report.message = fmt::format(
        "accelerations are not determined at t = {:.12g} s: the mechanism is at a singular configuration", t_);
    return report;
  }
  has_acceleration_ = true;
  return needs.multipliers ? solve_multipliers() : report;
}

Report Kinematics::solve_multipliers() {
  Report report;
  lambda_.resize(at(plan_->rows));
  scatter_applied_forces(qd_, qdd_);
  if (!solver_.solve_multipliers(loads_, lambda_)) {
    report.status = Status::singular;
    report.message = fmt::format("reactions are not determined at t = {:.12g} s", t_);
    return report;
  }
  if (plan_->rows > plan_->columns) choose_least_reactions();
  return report;
}

// Where equations depend on each other: the least of all multipliers that give these accelerations, and the elements
// concerned.
void Kinematics::choose_least_reactions() {
  if (!minimum_norm_) minimum_norm_.emplace(evaluator_);
  evaluator_.set_configuration(q_);
  if (!minimum_norm_->factorize()) return;
  for (int c = 0; c < plan_->columns; ++c) applied_[at(plan_->coordinate[at(c)])] = loads_[at(c)];
  least_lambda_.assign(lambda_.size(), 0.0);
  // Multipliers that do not balance the loads are rejected.
  if (!(minimum_norm_->solve(applied_, least_lambda_) <= balanced)) return;
  lambda_.swap(least_lambda_);
  ambiguity_ = minimum_norm_->ambiguity();
}

Snapshot Kinematics::snapshot() const {
  Snapshot s{.evaluator = evaluator_, .t = t_, .q = q_};
  if (has_velocity_) s.qd = qd_;
  if (has_acceleration_) s.qdd = qdd_;
  s.residual = newton_.residual * evaluator_.length_scale();
  if (account_) {
    s.work = EnergyAccount::supplied(work_);
    s.dissipated = EnergyAccount::dissipated(work_);
    s.driver_work = driver_work_;
    s.initial_energy = initial_energy_;
  }
  return s;
}

AnalysisReport Kinematics::run(const TimeGrid& grid, const Needs& asked, RowObserver& observer) {
  const ProcessTimer timer;
  AnalysisReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan_->rows;
  report.islands = plan_->islands;
  observer_ = &observer;
  interpolated_ = false;
  solver_.forget_left();
  Needs needs = asked;
  if (needs.work) needs.velocity = needs.acceleration = needs.multipliers = true;
  account_.reset();
  TimeRange whole{t_, t_};
  if (grid.size() > 0) {
    earliest_ = grid.earliest();
    latest_ = grid.latest();
    whole = {std::min(t_, earliest_), std::max(t_, latest_)};
  }
  const Evaluator::TimeLimit limit(evaluator_, whole);
  const auto end = [&](const Report& outcome) {
    observer_ = nullptr;
    earliest_ = -std::numeric_limits<double>::infinity();
    latest_ = std::numeric_limits<double>::infinity();
    if (outcome.status == Status::lock_up) give_row_at_lock_up(needs, observer);
    report.status = outcome.status;
    report.message = outcome.message;
    report.warnings.insert(report.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
    if (std::string doubt = doubt_of_work(); !doubt.empty()) report.warnings.push_back(std::move(doubt));
    if (!ambiguity_.empty()) report.warnings.push_back(ambiguity_);
    remark_on_limits(report.warnings);
    report.counters = evaluator_.counters;
    report.seconds = timer.seconds();
    return report;
  };
  if (needs.multipliers) {
    if (const int body = body_without_mass(*model_, *plan_); body >= 0) {
      Report refused;
      refused.status = Status::refused;
      refused.message =
          fmt::format("loads and reactions need the mass and the inertia of body \"{}\"", model_->body_name(body));
      return end(refused);
    }
  }
  if (const Report functions = check_time_functions(*model_, whole); !functions.ok()) return end(functions);
  if (!assembled_ || !assembled_->ok()) {
    const AssemblyOutcome outcome = assemble();
    if (!outcome.ok()) return end(outcome);
  }
  predicted_qd_.resize(needs.velocity || needs.acceleration || needs.multipliers ? q_.size() : 0);
  predicted_qdd_.resize(needs.acceleration || needs.multipliers ? q_.size() : 0);
  predicted_.reset();
  const Report prepared = prepare(grid.size() > 1 && grid[1] < grid[0] ? -1 : 1);
  placed_ = true;  // by the first row
  if (!prepared.ok()) return end(prepared);
  report.warnings = prepared.warnings;
  report.redundant = redundant_;
  report.rank = plan_->columns;
  report.dof = 0;
  report.mobility = plan_->driver_rows;
  if (needs.work) {
    if (const Report begun = start_work(); !begun.ok()) return end(begun);
  }
  for (std::int64_t k = 0; k < grid.size(); ++k) {
    if (grid[k] != t_) {
      const Report moved = account_ ? move_and_sum_up(grid[k]) : follow_to(grid[k]);
      if (!moved.ok()) return end(moved);
      report.warnings.insert(report.warnings.end(), moved.warnings.begin(), moved.warnings.end());
    } else if (on_bridge_ || (!bridge_.empty() && t_ >= bridge_from_ && t_ <= bridge_to_)) {
      place_on_bridge(t_);
    } else {
      trial_ = q_;
      evaluator_.set_time(t_);
      newton_ = solver_.solve_position(trial_);
      if (newton_.converged) q_.swap(trial_);
    }
    interpolated_ = interpolated_ || on_bridge_;
    if (const Report consistent = check_redundant_rows(); !consistent.ok()) return end(consistent);
    if (const Report sound = watched_.check(); !sound.ok()) return end(sound);
    // Redundant equations must agree in velocities and accelerations as well, whether or not these are output.
    Needs checked = needs;
    if (plan_->rows > plan_->columns && k % rows_between_checks == 0) checked.velocity = checked.acceleration = true;
    if (const Report solved = find_rates(checked); !solved.ok()) return end(solved);
    if (needs.velocity || needs.acceleration || needs.multipliers) {
      if (const Report laws = watched_.check_laws(qd_); !laws.ok()) return end(laws);
    }
    if (!on_bridge_ && solver_.rcond() < suspicious_part) {
      if (std::optional<SingularPoint> point = dead_point_here()) return end(lock_up(std::move(*point)));
    }
    if (!check_redundant_rates(doubtful_rates, false).ok() && choose_better_rows()) {
      // The equations in use were badly conditioned; others are well conditioned.
      solver_.solve_position(q_);
      if (const Report solved = find_rates(checked); !solved.ok()) return end(solved);
    }
    if (const Report consistent = check_redundant_rates(contradictory_rates, true); !consistent.ok())
      return end(consistent);
    predictor_.push(t_, q_, has_velocity_ ? std::span<const double>(qd_) : std::span<const double>{},
                    has_acceleration_ ? std::span<const double>(qdd_) : std::span<const double>{});
    if (account_) account_->driver_work(work_, driver_work_);
    Snapshot row = snapshot();
    if (needs.multipliers) row.lambda = lambda_;
    if (!observer.observe(row)) return end(cancelled());
  }
  return end({});
}

}  // namespace catena
