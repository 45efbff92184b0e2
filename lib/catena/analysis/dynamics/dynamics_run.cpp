// A run of Dynamics from its first row to its last, in one go or in parts; where it pauses and is taken up again.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/motion/way_of_motion.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/assembly/length_scale.hpp"
#include "catena/base/flush_denormals.hpp"
#include "catena/columns/energy.hpp"

namespace catena {
namespace {

// Energies cost as much as a hundredth of a step's evaluations; less often, that is not to be seen. Of the first steps
// the 1st, 2nd, 4th, 8th and 16th are looked at, too: a swing takes thirty, and at its ends nothing is in motion.
constexpr std::int64_t steps_between_checks = 32;

}  // namespace

AnalysisReport Dynamics::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  choose_method(observer.stage_watcher() != nullptr);
  begin(grid, needs);
  go_on(grid.size(), observer);
  return end();
}

void Dynamics::begin(const TimeGrid& grid, const Needs& needs) {
  const FlushDenormals flush;
  run_ = {};
  run_.grid = grid;
  run_.needs = needs;
  if (attached_.events) run_.needs |= attached_.events->needs();
  run_.smooth_since = t_;
  singular_.begin_run();
  run_.report.bodies = static_cast<int>(model_->bodies.size());
  run_.report.rows = plan_->rows;
  run_.report.islands = plan_->islands;
  under_way_.integrator.reset();
  begin_looking_for_stiffness();
  run_.outcome = run_.grid.size() > 0 ? start() : Report{};
}

// What a method needs of the mechanism and of the options.
Report Dynamics::check_method() const {
  if (methods_.present == IntegrationMethod::partitioning) {
    if (const Report freedoms = check_freedoms(); !freedoms.ok()) return freedoms;
  }
  if (!(options_.rho >= 0 && options_.rho <= 1))
    return {
        Status::refused, fmt::format("\"rho\" of method alpha is a part, 0 ... 1, and not {:.6g}", options_.rho), {}};
  if (methods_.present == IntegrationMethod::rattle && !(options_.step > 0)) {
    return {Status::refused,
            "method rattle makes steps of one length, which its accuracy follows from: give \"step\", s",
            {}};
  }
  return {};
}

// Everything up to the first row.
Report Dynamics::start() {
  if (const Report order = check_order(); !order.ok()) return order;
  const TimeRange run{t_, run_.grid.last()};
  if (Report functions = check_time_functions(*model_, run); !functions.ok()) return functions;
  under_way_.limit.emplace(evaluator_, run);
  if (!origin_.prepared) {
    if (const Report prepared = prepare(run_.report.warnings); !prepared.ok()) return prepared;
  }
  if (const Report method = check_method(); !method.ok()) return method;
  work_.account.reset();
  // Where constraints are redundant, parts massless or contacts rub the work is summed up for the check alone.
  const bool rubs = attached_.contacts && attached_.contacts->dissipates();
  const bool conserves = BalanceWatch::conserves(evaluator_) && !rubs;
  const bool delicate = redundant_.count() > 0 || !equations_.masses().massless.empty() || rubs;
  if (run_.needs.work || (!conserves && delicate)) work_.account.emplace(evaluator_);
  work_.balance.reset();
  if ((work_.account || conserves) && options_.step == 0) work_.balance.emplace();
  row_.driver_work.assign(work_.account ? model_->elements.size() : 0, 0.0);
  under_way_.motion.emplace(equations_, work_.account ? &*work_.account : nullptr);
  under_way_.all_is_driven = freedoms() == 0;
  if (plan_->rows == 0 && lacks_length(evaluator_)) {
    const double way = origin_.resumed ? memory_.length : way_of_motion(equations_, t_, q_, qd_, run_.grid.last());
    if (way > 0) under_way_.motion->set_length_scale(way);
  }
  under_way_.integrator = make_integrator(*under_way_.motion, run_.grid.last());
  row_.y.assign(under_way_.motion->size(), 0.0);
  row_.slope.assign(under_way_.motion->size(), 0.0);
  if (const Report out = set_out(); !out.ok()) {
    evaluator_.forget_turns();
    under_way_.integrator.reset();
    return out;
  }
  if (attached_.events) {
    const std::span<const double> qd = std::span<const double>(row_.y).subspan(q_.size(), q_.size());
    attached_.events->know_sizes(
        sizes_of_motion(evaluator_.length_scale(), qd, equations_.applied_forces(), equations_.masses().mass));
  }
  look_ahead_at_laws();
  pace_.step = evaluator_.counters.steps + evaluator_.counters.rejected;
  pace_.taken = pace_.of_all ? pace_.of_all : std::make_shared<std::int64_t>(0);
  if (origin_.resumed) *pace_.taken = memory_.steps;
  pace_.counted = pace_.step;
  pace_.t = t_;
  describe_mobility(run_.report);
  if (work_.balance) {
    evaluator_.set_time(t_);
    evaluator_.set_configuration(std::span<const double>(row_.y).first(q_.size()));
    work_.balance->know_energy(work_.earlier_motion);
    work_.balance->begin(snapshot(t_, row_.y, {}), equations_.masses(), options_.tolerance, work_.account.has_value(),
                         !under_way_.integrator->meets_constraints());
  }
  if (!watched_.may_end()) return {};
  evaluator_.set_configuration(std::span<const double>(row_.y).first(q_.size()));
  return check_ends_at(row_.y);
}

// What laws do for a short time, a mechanism at rest does not announce.
void Dynamics::look_ahead_at_laws() {
  const std::span<const double> y(row_.y);
  if (options_.step > 0 || !LawStretches::any(evaluator_)) return;
  if (law_stretches_ && law_stretches_->covers(t_, run_.grid.last())) return;
  evaluator_.set_configuration(y.first(q_.size()));
  law_stretches_ =
      std::make_shared<const LawStretches>(evaluator_, y.subspan(q_.size(), q_.size()), t_, run_.grid.last());
  evaluator_.set_time(t_);
}

// The energy now and then, and at the end. Without events the last evaluation was at the integrator's state.
Report Dynamics::check_balance() {
  if (!work_.balance) return {};
  const std::int64_t steps = evaluator_.counters.steps;
  const bool judges = steps % steps_between_checks == 0 || t_ >= run_.grid.last();
  const bool looks = judges || (steps < steps_between_checks && (steps & (steps - 1)) == 0);
  if (!looks) return {};
  if (attached_.events) {
    evaluator_.set_time(t_);
    evaluator_.set_configuration(under_way_.integrator->state().first(q_.size()));
  }
  work_.balance->observe(snapshot(t_, under_way_.integrator->state(), {}));
  return judges ? judge_balance(t_) : Report{};
}

// Right before a dead point energies grow without bound, and with them what rounding leaves of their balance.
Report Dynamics::judge_balance(double t) {
  Report balance = work_.balance->check(t, equations_.applied_forces(), under_way_.integrator->accelerations());
  if (balance.ok()) return balance;
  if (std::optional<Report> locked = lock_up_ahead()) return *locked;
  return balance;
}

// Puts the integrator where the motion begins, or where it paused.
Report Dynamics::set_out() {
  if (origin_.resumed) {
    if (memory_.y.size() != row_.y.size() || memory_.turns.size() != static_cast<std::size_t>(plan_->moving)) {
      Report report;
      report.status = Status::refused;
      report.message = "the motion cannot be taken up: what was saved is of another mechanism, or of other columns";
      return report;
    }
    std::copy(memory_.y.begin(), memory_.y.end(), row_.y.begin());
    std::vector<double> turned(q_.size(), 0.0);
    for (std::size_t b = 0; b < memory_.turns.size(); ++b) turned[3 * b + 2] = memory_.turns[b] * 2 * std::numbers::pi;
    evaluator_.take_turns(turned);
    under_way_.integrator->remember(memory_.integrator);
    equations_.weigh_massless(std::span(row_.y).first(q_.size()));
    redundant_.take_up(memory_.left_out, std::span(row_.y).first(q_.size()));
  } else {
    std::copy(q_.begin(), q_.end(), row_.y.begin());
    std::copy(qd_.begin(), qd_.end(), row_.y.begin() + static_cast<std::ptrdiff_t>(q_.size()));
    evaluator_.take_turns(std::span(row_.y).first(q_.size()));
  }
  if (!under_way_.integrator->start(t_, row_.y)) return stuck();
  if (!origin_.resumed && (know_start_from_rest() || know_singular_start())) {
    // An integrator keeps a copy of the motion, and the step that the first slope suggested.
    under_way_.integrator = make_integrator(*under_way_.motion, run_.grid.last());
    if (!under_way_.integrator->start(t_, row_.y)) return stuck();
  }
  if (attached_.follower) attached_.follower->begin(*under_way_.integrator, equations_);
  if (!work_.account) return {};
  if (origin_.resumed) {
    work_.initial_energy = memory_.initial_energy;
    return {};
  }
  work_.initial_energy = total_energy(snapshot(t_, row_.y, {}));
  if (work_.earlier.summed_up) {
    work_.earlier.dissipated += work_.earlier.energy - work_.initial_energy;
    work_.initial_energy = work_.earlier.initial_energy;
  }
  return {};
}

bool Dynamics::go_on(std::int64_t rows, RowObserver& observer) {
  const FlushDenormals flush;
  if (under_way_.integrator) under_way_.integrator->show_stages_to(observer.stage_watcher());
  rows = std::min(rows, run_.grid.size());
  while (run_.outcome.ok() && run_.next_row < rows && !run_.stopped()) run_.outcome = next(observer);
  if (run_.outcome.status == Status::lock_up && !std::exchange(run_.locked, true)) give_row_at_lock_up(observer);
  return run_.outcome.ok() && run_.next_row >= rows;
}

// Gives the next row, or does what comes before it.
Report Dynamics::next(RowObserver& observer) {
  const double row = run_.grid[run_.next_row];
  if (row < t_ || (row == t_ && !run_.at_jump)) return give_row(run_.grid[run_.next_row++], observer);
  if (run_.at_jump) return start_anew();
  if (t_ < pause_after_ || !under_way_.integrator->may_pause()) return step(observer);
  remember();
  return {};
}

Report Dynamics::step(RowObserver& observer) {
  const double limit = std::min(next_breakpoint(t_), run_.grid.last());
  double reach = law_stretches_ ? std::min(limit, law_stretches_->limit(t_)) : limit;
  // Where drivers move all, a law or a cable says nothing of itself in the errors of the motion: its work alone does,
  // at the stages.
  if (work_.account && options_.step == 0 && under_way_.all_is_driven && under_way_.integrator->rate() > 0 &&
      (!evaluator_.laws().empty() || under_way_.motion->switches().has_cables()))
    reach = std::min(reach, t_ + thresholds::driven_stretch / under_way_.integrator->rate());
  // The speed at the beginning of the step: its end may lie beyond an event after which other forces act.
  if (attached_.contacts) {
    const std::span<const double> qd = under_way_.integrator->state().subspan(q_.size(), q_.size());
    attached_.contacts->know_speed(fastest(evaluator_, qd));
  }
  if (!under_way_.integrator->advance(reach)) return stuck();
  const double before = t_;
  t_ = under_way_.integrator->time();
  if (attached_.follower) {
    if (under_way_.integrator->straight_passages() > 0) attached_.follower->jump();
    attached_.follower->step(*under_way_.integrator, equations_);
  }
  singular_.follow_step();
  redundant_.follow(under_way_.integrator->state().first(q_.size()));
  if (!observer.proceed(t_)) return cancelled(t_);
  if (const Report pace = check_pace(run_.grid.last()); !pace.ok()) return pace;
  if (const Report rows = check_redundant_rows(); !rows.ok()) return rows;
  if (!attached_.events) {
    if (const Report balance = check_balance(); !balance.ok()) return balance;
  }
  if (watched_.may_end()) {
    if (const Report left = check_curve_ends(before, observer); !left.ok() || run_.stopped_by >= 0) return left;
  }
  if (attached_.events) {
    const Report found = find_events(before, observer);
    if (!found.ok() || run_.stopped_by >= 0) return found;
    // Not before: beyond an instant at which another force begins the motion is none, and its energy says nothing.
    if (const Report balance = check_balance(); !balance.ok()) return balance;
  } else if (const Report shown = show(before, t_, observer); !shown.ok()) {
    return shown;
  }
  run_.at_jump = t_ == limit && limit < run_.grid.last();
  return look_for_stiffness(limit) ? Report{} : stuck();
}

// A function of time jumps here: the next step starts with what holds afterwards.
Report Dynamics::start_anew() {
  run_.at_jump = false;
  std::copy(under_way_.integrator->state().begin(), under_way_.integrator->state().end(), row_.y.begin());
  const std::span<double> q = std::span(row_.y).first(q_.size()), qd = std::span(row_.y).subspan(q_.size(), q_.size());
  const std::span<const double> before = under_way_.integrator->state().subspan(q_.size(), q_.size());
  if (!equations_.factorize(t_, Side::after, q)) return stuck();
  const double jump = equations_.project_velocity(qd, 0) * evaluator_.length_scale();
  run_.jumping.clear();
  if (jump > thresholds::no_jump * fastest(evaluator_, before)) {
    run_.jumping = drivers_that_jump(evaluator_, run_.smooth_since, t_);
    if (attached_.follower) attached_.follower->jump();
  }
  run_.smooth_since = t_;
  if (attached_.contacts) attached_.contacts->know_speed(fastest(evaluator_, before));
  if (attached_.contacts && attached_.contacts->holds() && jump > no_speed * attached_.contacts->speed()) {
    std::copy(before.begin(), before.end(), qd.begin());
    run_.jumped = true;
    return {};
  }
  if (!run_.jumping.empty()) take_note_of_jump(before);
  return under_way_.integrator->start(t_, row_.y) ? Report{} : stuck();
}

// Velocities of drivers jump, and those of the mechanism have from `before` to what row_.y has.
void Dynamics::take_note_of_jump(std::span<const double> before) {
  const std::size_t n = q_.size();
  const std::span<double> y(row_.y);
  const std::vector<double> p = impulse_of_change(equations_, before, y.subspan(n, n));
  if (work_.account) {
    std::vector<double> nu_before(p.size()), nu_after(p.size());
    evaluator_.set_time(t_, Side::before);
    evaluator_.nu(nu_before);
    evaluator_.set_time(t_, Side::after);
    evaluator_.nu(nu_after);
    work_.account->add_jolt(p, nu_before, nu_after, y.subspan(2 * n));
  }
  run_.jolts.push_back({t_, {}, run_.jumping, impulses_of(equations_, y.first(n), y.subspan(n, n), p)});
}

void Dynamics::remember() {
  run_.paused = true;
  memory_.t = t_;
  memory_.y.assign(under_way_.integrator->state().begin(), under_way_.integrator->state().end());
  std::vector<double> turned(q_.size(), 0.0);
  evaluator_.add_turns(turned);
  memory_.turns.resize(static_cast<std::size_t>(plan_->moving));
  for (std::size_t b = 0; b < memory_.turns.size(); ++b) {
    memory_.turns[b] = std::round(turned[3 * b + 2] / (2 * std::numbers::pi));
  }
  memory_.initial_energy = work_.initial_energy;
  memory_.energy = energy_in_motion();
  memory_.length = under_way_.motion->length_scale();
  memory_.next_row = run_.next_row;
  memory_.steps = *pace_.taken;
  memory_.integrator = under_way_.integrator->memory();
  memory_.left_out = equations_.left_out();
  memory_.earlier = work_.earlier;
  memory_.curves = evaluator_.curve_places();
}

void Dynamics::resume(const MotionMemory& memory) {
  memory_ = memory;
  work_.earlier = memory.earlier;
  work_.earlier_motion = memory.energy;
  t_ = memory.t;
  origin_.resumed = origin_.prepared = true;
  evaluator_.go_to_curve_places(memory.curves);
  equations_.use_masses();
}

AnalysisReport Dynamics::end() {
  const FlushDenormals flush;
  AnalysisReport report = std::move(run_.report);
  report.status = run_.outcome.status;
  report.message = run_.outcome.message;
  if (under_way_.integrator) {
    const std::span<const double> y =
        run_.stopped_by < 0 ? under_way_.integrator->state() : std::span<const double>(row_.y);
    std::copy_n(y.begin(), q_.size(), q_.begin());
    std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(q_.size()), q_.size(), qd_.begin());
    if (run_.stopped_by < 0) evaluator_.add_turns(q_);
    evaluator_.forget_turns();
    evaluator_.set_time(t_);
    evaluator_.set_configuration(q_);
    for (std::string& remark : under_way_.integrator->remarks()) report.warnings.push_back(std::move(remark));
  }
  under_way_.limit.reset();
  singular_.remark(report.warnings);
  if (!reactions_.ambiguity.empty()) report.warnings.push_back(reactions_.ambiguity);
  origin_.resumed = false;
  origin_.singular.reset();
  report.counters = evaluator_.counters;
  report.seconds = run_.timer.seconds();
  return report;
}

}  // namespace catena
