// A run of Dynamics from its first row to its last, in one go or in parts; where it pauses and is taken up again.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/base/flush_denormals.hpp"
#include "catena/columns/energy.hpp"

namespace catena {
namespace {

// Energies cost as much as a hundredth of a step's evaluations; less often, that is not to be seen.
constexpr std::int64_t steps_between_checks = 32;
// Velocities that are projected by less than this part of the largest are those of a smooth motion: steps keep them to
// 1e-12.
constexpr double no_jump = 1e-10;

}  // namespace

AnalysisReport Dynamics::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  begin(grid, needs);
  go_on(grid.size(), observer);
  return end();
}

void Dynamics::begin(const TimeGrid& grid, const Needs& needs) {
  timer_ = {};
  const FlushDenormals flush;
  grid_ = grid;
  needs_ = needs;
  if (events_) needs_ |= events_->needs();
  stopped_by_ = -1;
  acting_.clear();
  jolts_.clear();
  smooth_since_ = t_;
  next_row_ = 0;
  at_jump_ = paused_ = jumped_ = dependent_ = always_dependent_ = unbounded_ = false;
  singular_rows_ = formal_rows_ = 0;
  locked_ = false;
  singular_points_.clear();
  report_ = {};
  report_.bodies = static_cast<int>(model_->bodies.size());
  report_.rows = plan_->rows;
  report_.islands = plan_->islands;
  integrator_.reset();
  outcome_ = grid_.size() > 0 ? start() : Report{};
}

// Everything up to the first row.
Report Dynamics::start() {
  if (const Report order = check_order(); !order.ok()) return order;
  const TimeRange run{t_, grid_.last()};
  if (Report functions = check_time_functions(*model_, run); !functions.ok()) return functions;
  time_limit_.emplace(evaluator_, run);
  if (!prepared_) {
    if (const Report prepared = prepare(report_.warnings); !prepared.ok()) return prepared;
  }
  if (method_ == IntegrationMethod::partitioning) {
    if (const Report freedoms = check_freedoms(); !freedoms.ok()) return freedoms;
  }
  account_.reset();
  // Where constraints are redundant, parts massless or contacts rub the work is summed up for the check alone.
  const bool rubs = contacts_ && contacts_->dissipates();
  const bool conserves = BalanceWatch::conserves(evaluator_) && !rubs;
  const bool delicate = redundant_.count() > 0 || !equations_.masses().massless.empty() || rubs;
  if (needs_.work || (!conserves && delicate)) account_.emplace(evaluator_);
  balance_.reset();
  if ((account_ || conserves) && options_.step == 0) balance_.emplace();
  driver_work_.assign(account_ ? model_->elements.size() : 0, 0.0);
  motion_.emplace(equations_, account_ ? &*account_ : nullptr);
  integrator_ = make_integrator(*motion_, grid_.last());
  y_row_.assign(motion_->size(), 0.0);
  slope_row_.assign(motion_->size(), 0.0);
  if (const Report out = set_out(); !out.ok()) {
    evaluator_.forget_turns();
    integrator_.reset();
    return out;
  }
  pace_step_ = evaluator_.counters.steps + evaluator_.counters.rejected;
  first_step_ = pace_step_ - (resumed_ ? memory_.steps : 0);
  pace_time_ = t_;
  describe_mobility(report_);
  if (balance_) {
    evaluator_.set_time(t_);
    evaluator_.set_configuration(std::span<const double>(y_row_).first(q_.size()));
    balance_->know_energy(earlier_motion_);
    balance_->begin(snapshot(t_, y_row_, {}), options_.tolerance, account_.has_value(),
                    !integrator_->meets_constraints());
  }
  if (!watched_.may_end()) return {};
  evaluator_.set_configuration(std::span<const double>(y_row_).first(q_.size()));
  return check_ends_at(y_row_);
}

// The energy now and then, and at the end: the last evaluation was at the integrator's state.
Report Dynamics::check_balance() {
  if (!balance_ || (evaluator_.counters.steps % steps_between_checks != 0 && t_ < grid_.last())) return {};
  balance_->observe(snapshot(t_, integrator_->state(), {}));
  return balance_->check(t_, equations_.applied_forces());
}

// Puts the integrator where the motion begins, or where it paused.
Report Dynamics::set_out() {
  if (resumed_) {
    if (memory_.y.size() != y_row_.size() || memory_.turns.size() != static_cast<std::size_t>(plan_->moving)) {
      Report report;
      report.status = Status::refused;
      report.message = "the motion cannot be taken up: what was saved is of another mechanism, or of other columns";
      return report;
    }
    std::copy(memory_.y.begin(), memory_.y.end(), y_row_.begin());
    std::vector<double> turned(q_.size(), 0.0);
    for (std::size_t b = 0; b < memory_.turns.size(); ++b) turned[3 * b + 2] = memory_.turns[b] * 2 * std::numbers::pi;
    evaluator_.take_turns(turned);
    integrator_->remember(memory_.integrator);
    equations_.weigh_massless(std::span(y_row_).first(q_.size()));
    redundant_.take_up(memory_.left_out, std::span(y_row_).first(q_.size()));
  } else {
    std::copy(q_.begin(), q_.end(), y_row_.begin());
    std::copy(qd_.begin(), qd_.end(), y_row_.begin() + static_cast<std::ptrdiff_t>(q_.size()));
    evaluator_.take_turns(std::span(y_row_).first(q_.size()));
  }
  if (!integrator_->start(t_, y_row_)) return stuck();
  if (!resumed_ && (know_start_from_rest() || know_singular_start())) {
    // An integrator keeps a copy of the motion, and the step that the first slope suggested.
    integrator_ = make_integrator(*motion_, grid_.last());
    if (!integrator_->start(t_, y_row_)) return stuck();
  }
  if (follower_) follower_->begin(*integrator_, equations_);
  if (!account_) return {};
  if (resumed_) {
    initial_energy_ = memory_.initial_energy;
    return {};
  }
  initial_energy_ = total_energy(snapshot(t_, y_row_, {}));
  if (!earlier_.by_driver.empty()) {
    earlier_.dissipated += earlier_.energy - initial_energy_;
    initial_energy_ = earlier_.initial_energy;
  }
  return {};
}

bool Dynamics::go_on(std::int64_t rows, RowObserver& observer) {
  const FlushDenormals flush;
  rows = std::min(rows, grid_.size());
  while (outcome_.ok() && next_row_ < rows && stopped_by_ < 0 && !paused_ && !jumped_) outcome_ = next(observer);
  if (outcome_.status == Status::lock_up && !std::exchange(locked_, true)) give_row_at_lock_up(observer);
  return outcome_.ok() && next_row_ >= rows;
}

// Gives the next row, or does what comes before it.
Report Dynamics::next(RowObserver& observer) {
  const double row = grid_[next_row_];
  if (row < t_ || (row == t_ && !at_jump_)) return give_row(grid_[next_row_++], observer);
  if (at_jump_) return start_anew();
  if (t_ < pause_after_ || !integrator_->may_pause()) return step(observer);
  remember();
  return {};
}

Report Dynamics::step(RowObserver& observer) {
  const double limit = std::min(next_breakpoint(t_), grid_.last());
  if (!integrator_->advance(limit)) return stuck();
  const double before = t_;
  t_ = integrator_->time();
  if (follower_) follower_->step(*integrator_, equations_);
  always_dependent_ = std::exchange(dependent_, equations_.is_singular()) && dependent_;
  redundant_.follow(integrator_->state().first(q_.size()));
  if (!observer.proceed(t_)) return cancelled(t_);
  if (const Report pace = check_pace(grid_.last()); !pace.ok()) return pace;
  if (const Report rows = check_redundant_rows(); !rows.ok()) return rows;
  if (const Report balance = check_balance(); !balance.ok()) return balance;
  if (watched_.may_end()) {
    if (const Report left = check_curve_ends(before, observer); !left.ok() || stopped_by_ >= 0) return left;
  }
  if (events_) {
    const Report found = find_events(before, observer);
    if (!found.ok() || stopped_by_ >= 0) return found;
  } else if (const Report shown = show(before, t_, observer); !shown.ok()) {
    return shown;
  }
  at_jump_ = t_ == limit && limit < grid_.last();
  return {};
}

// A function of time jumps here: the next step starts with what holds afterwards.
Report Dynamics::start_anew() {
  at_jump_ = false;
  std::copy(integrator_->state().begin(), integrator_->state().end(), y_row_.begin());
  const std::span<double> q = std::span(y_row_).first(q_.size()), qd = std::span(y_row_).subspan(q_.size(), q_.size());
  const std::span<const double> before = integrator_->state().subspan(q_.size(), q_.size());
  if (!equations_.factorize(t_, Side::after, q)) return stuck();
  const double jump = equations_.project_velocity(qd, 0) * evaluator_.length_scale();
  jumping_.clear();
  if (jump > no_jump * fastest(evaluator_, before)) {
    jumping_ = drivers_that_jump(evaluator_, smooth_since_, t_);
    if (follower_) follower_->jump();
  }
  smooth_since_ = t_;
  if (contacts_ && contacts_->holds() && jump > no_speed * contacts_->speed()) {
    std::copy(before.begin(), before.end(), qd.begin());
    jumped_ = true;
    return {};
  }
  if (!jumping_.empty()) take_note_of_jump(before);
  return integrator_->start(t_, y_row_) ? Report{} : stuck();
}

// Velocities of drivers jump, and those of the mechanism have from `before` to what y_row_ has.
void Dynamics::take_note_of_jump(std::span<const double> before) {
  const std::size_t n = q_.size();
  const std::span<double> y(y_row_);
  const std::vector<double> p = impulse_of_change(equations_, before, y.subspan(n, n));
  if (account_) {
    std::vector<double> nu_before(p.size()), nu_after(p.size());
    evaluator_.set_time(t_, Side::before);
    evaluator_.nu(nu_before);
    evaluator_.set_time(t_, Side::after);
    evaluator_.nu(nu_after);
    account_->add_jolt(p, nu_before, nu_after, y.subspan(2 * n));
  }
  jolts_.push_back({t_, {}, jumping_, impulses_of(equations_, y.first(n), y.subspan(n, n), p)});
}

void Dynamics::remember() {
  paused_ = true;
  memory_.t = t_;
  memory_.y.assign(integrator_->state().begin(), integrator_->state().end());
  std::vector<double> turned(q_.size(), 0.0);
  evaluator_.add_turns(turned);
  memory_.turns.resize(static_cast<std::size_t>(plan_->moving));
  for (std::size_t b = 0; b < memory_.turns.size(); ++b) {
    memory_.turns[b] = std::round(turned[3 * b + 2] / (2 * std::numbers::pi));
  }
  memory_.initial_energy = initial_energy_;
  memory_.next_row = next_row_;
  memory_.steps = evaluator_.counters.steps + evaluator_.counters.rejected - first_step_;
  memory_.integrator = integrator_->memory();
  memory_.left_out = equations_.left_out();
  memory_.earlier = earlier_;
  evaluator_.curve_places(memory_.curves);
}

void Dynamics::resume(const MotionMemory& memory) {
  memory_ = memory;
  earlier_ = memory.earlier;
  t_ = memory.t;
  resumed_ = prepared_ = true;
  evaluator_.go_to_curve_places(memory.curves);
  equations_.use_masses();
}

AnalysisReport Dynamics::end() {
  const FlushDenormals flush;
  AnalysisReport report = std::move(report_);
  report.status = outcome_.status;
  report.message = outcome_.message;
  if (integrator_) {
    const std::span<const double> y = stopped_by_ < 0 ? integrator_->state() : std::span<const double>(y_row_);
    std::copy_n(y.begin(), q_.size(), q_.begin());
    std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(q_.size()), q_.size(), qd_.begin());
    if (stopped_by_ < 0) evaluator_.add_turns(q_);
    evaluator_.forget_turns();
    evaluator_.set_time(t_);
    evaluator_.set_configuration(q_);
    for (std::string& remark : integrator_->remarks()) report.warnings.push_back(std::move(remark));
  }
  time_limit_.reset();
  remark_on_singularities(report.warnings);
  if (!ambiguity_.empty()) report.warnings.push_back(ambiguity_);
  resumed_ = false;
  start_.reset();
  report.counters = evaluator_.counters;
  report.seconds = timer_.seconds();
  return report;
}

}  // namespace catena
