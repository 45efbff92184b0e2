#include "catena/analysis/kinematics/kinematics.hpp"

#include <cmath>
#include <stdexcept>

#include "catena/analysis/kinematics/course/step_rules.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/analysis/pose/singular_start.hpp"
#include "catena/analysis/pose/whole_turns.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {

Kinematics::Kinematics(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                       const KinematicsOptions& options)
    : model_(std::move(model)),
      evaluator_(Plan::make(required(model_), plan_options), *model_, evaluation_),
      options_(options),
      fixed_(plan()),
      solver_(evaluator_),
      rows_(evaluator_, solver_),
      reactions_(evaluator_, solver_, fixed_),
      watched_(evaluator_),
      predictor_(at(plan().coordinates())),
      jumps_(*model_) {
  if (!(options.tolerance > 0)) throw std::invalid_argument("kinematics: the tolerance must be above zero");
  if (options.branch < 0) throw std::invalid_argument("kinematics: branches are numbered from 1, and 0 chooses none");
  solver_.tolerance = options.tolerance;
  now_.q = evaluator_.given_configuration();
  now_.qd.assign(now_.q.size(), 0.0);
  now_.qdd.assign(now_.q.size(), 0.0);
  trial_ = now_.q;
}

void Kinematics::start_from(const SystemState& state) {
  now_.t = state.t;
  assembled_.reset();
  predictor_.clear();
  stretch_.bridge.clear();
  stretch_.choice.reset();
  margins_.clear();
  curves_.found.clear();
  jumps_.forget();
  rows_.forget_names();
  prepared_ = placed_ = now_.on_bridge = false;
  now_.has_velocity = now_.has_acceleration = false;
  work_.end();
  take_over_places(evaluator_, state, now_.q);
}

SystemState Kinematics::state() const {
  return state_of(evaluator_, now_.t, now_.q,
                  now_.has_velocity ? std::span<const double>(now_.qd) : std::span<const double>{});
}

AssemblyOutcome Kinematics::assemble() {
  evaluator_.set_time(now_.t);
  predictor_.clear();
  stretch_.bridge.clear();
  placed_ = now_.on_bridge = false;
  now_.has_velocity = now_.has_acceleration = false;
  curves_.found.clear();
  AssemblyOutcome outcome;
  if (!assemble_nearby()) outcome = Assembler(evaluator_).assemble(now_.q, options_.tolerance);
  if (outcome.ok() && watched_.has_ends()) {
    evaluator_.set_configuration(now_.q);
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
  trial_ = now_.q;
  move_whole_turns(evaluator_, trial_);
  newton_ = solver_.solve_position(trial_);
  if (!newton_.converged || newton_.first_correction > step_rules::nearby ||
      newton_.contraction > step_rules::largest_contraction) {
    return false;
  }
  now_.q.swap(trial_);
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
  if (!stretch_.empty()) {
    place_on_bridge(now_.t);
  } else {
    solve_here();
  }
  return prepared;
}

// Corrects the present configuration at the present instant.
void Kinematics::solve_here() {
  trial_ = now_.q;
  evaluator_.set_time(now_.t);
  newton_ = solver_.solve_position(trial_);
  if (newton_.converged) now_.q.swap(trial_);
}

Report Kinematics::move_to(double t) {
  if (!std::isfinite(t)) throw std::invalid_argument("kinematics cannot move to an instant that is not finite");
  Report ready = get_ready(t < now_.t ? -1 : 1);
  if (!ready.ok()) return ready;
  Report moved = work_.is_on() ? move_and_sum_up(t) : follow_to(t);
  if (work_.is_on()) work_.update_driver_work();
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
  if (!plan().jacobian.entries() && plan().columns > 0) {
    report.status = Status::under_driven;
    report.message = "nothing is constrained or driven: add drivers, or fix bodies";
    return report;
  }
  // In the usual case, a factorization without a small pivot, no rank analysis is needed.
  if (plan().rows == plan().columns && solver_.factor_at(now_.q) > dependence::clearly_regular) {
    prepared_ = true;
    return report;
  }
  const MobilityReport mobility = analyse_mobility(evaluator_, now_.q);
  if (mobility.rank < plan().columns) {
    SingularPoint point = find_branches(evaluator_, now_.q, {}, dependence::follows_at_start);
    if (plan().rows >= plan().columns && point.held_to_second_order) {
      return start_singular(std::move(point), direction);
    }
    report.status = Status::under_driven;
    report.message = mobility.describe_freedom();
    return report;
  }
  if (plan().rows > plan().columns) {
    rows_.choose(now_.q);
    rows_.note_condition(now_.q);
  }
  rows_.name_redundant(mobility);
  report.warnings = mobility.warnings;
  prepared_ = true;
  return report;
}

Snapshot Kinematics::snapshot() const {
  Snapshot s{.evaluator = evaluator_, .t = now_.t, .q = now_.q};
  if (now_.has_velocity) s.qd = now_.qd;
  if (now_.has_acceleration) s.qdd = now_.qdd;
  s.residual = newton_.residual * evaluator_.length_scale();
  if (work_.is_on()) work_.show(s);
  return s;
}

}  // namespace catena
