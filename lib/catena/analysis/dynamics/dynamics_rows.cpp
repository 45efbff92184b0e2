// Rows of Dynamics: the mechanism at an instant of the last step, events, and the report where no step can be made.
#include <fmt/format.h>

#include <algorithm>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/energy.hpp"
#include "catena/columns/state_laws.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Of the length scale: how far before the circle of a pulley steps end that would go into it. A stretch of length l
// there turns by D / l, and l is the square root of the distance.
constexpr double before_circle = 1e-6;

/// Ropes where the motion is about to go. Leaves the evaluator there.
Report check_ropes_ahead(const WatchedElements& watched, Evaluator& evaluator, std::span<const double> y) {
  const std::size_t n = at(evaluator.plan().coordinates());
  std::vector<double> q(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(n));
  const double speed = fastest(evaluator, y.subspan(n, n));
  if (!(speed > 0)) return {};
  for (std::size_t k = 0; k < n; ++k) q[k] += before_circle * evaluator.length_scale() / speed * y[n + k];
  evaluator.set_configuration(q);
  return watched.check_ropes();
}

}  // namespace

Report Dynamics::cancelled(double t) {
  Report report;
  report.status = Status::cancelled;
  report.message = fmt::format("stopped at t = {:.12g} s; the rows so far are kept", t);
  return report;
}

Snapshot Dynamics::snapshot(double t, std::span<const double> y, const Needs& needs) const {
  const std::size_t n = q_.size();
  Snapshot s{.evaluator = evaluator_, .t = t, .q = y.first(n), .qd = y.subspan(n, n)};
  if (needs.acceleration || needs.multipliers) s.qdd = std::span<const double>(row_.slope).subspan(n, n);
  if (needs.multipliers) s.lambda = row_.lambda;
  s.residual = row_.residual * evaluator_.length_scale();
  if (attached_.contacts) {
    s.contacts = row_.contact_loads;
    s.contact_energy = attached_.contacts->energy();
  }
  if (work_.account) {
    const std::span<const double> work = y.subspan(2 * n);
    s.work = work_.earlier.supplied + EnergyAccount::supplied(work);
    s.dissipated = work_.earlier.dissipated + EnergyAccount::dissipated(work);
    s.driver_work = row_.driver_work;
    s.initial_energy = work_.initial_energy;
  }
  return s;
}

Report Dynamics::give_row(double t, RowObserver& observer) {
  const std::optional<Snapshot> state = state_at(t);
  if (!state) return stuck();
  if (work_.balance && t != under_way_.integrator->time() &&
      equations_.smallest_pivot_ratio() < dependence::singular_passage) {
    work_.balance->observe(*state);
    if (Report balance = judge_balance(t); !balance.ok()) return balance;
  }
  return observer.observe(*state) ? Report{} : cancelled(t);
}

// The mechanism at an instant of the last step, on its constraints if the method keeps to them; nothing where that
// cannot be had.
std::optional<Snapshot> Dynamics::state_at(double t) {
  const std::size_t n = q_.size();
  const std::span<double> y(row_.y);
  if (t == under_way_.integrator->time()) {
    std::copy(under_way_.integrator->state().begin(), under_way_.integrator->state().end(), y.begin());
    row_.residual = under_way_.integrator->position_residual();
  } else {
    under_way_.integrator->interpolate(t, y);
    if (under_way_.integrator->meets_constraints()) {
      if (!equations_.factorize(t, Side::after, y.first(n))) return {};
      row_.residual = equations_.project_position(y.first(n), 4);
      equations_.project_velocity(y.subspan(n, n), 0);
    } else {
      evaluator_.set_time(t);
      row_.residual = equations_.position_residual(y.first(n));
    }
  }
  if (run_.needs.acceleration || run_.needs.multipliers) {
    const std::span<double> slope(row_.slope);
    if (!equations_.accelerations(t, Side::after, y.first(n), y.subspan(n, n), slope.subspan(n, n))) return {};
    look_for_singularity(t);
    const bool shares = attached_.contacts && equations_.is_dependent();
    if (run_.needs.multipliers || shares) find_multipliers();
    if (shares) attached_.contacts->take_share(row_.lambda);
    if (attached_.contacts) attached_.contacts->scatter(row_.contact_loads);
  } else {
    evaluator_.set_time(t);
    evaluator_.set_configuration(y.first(n));
  }
  if (work_.account) {
    // Released drivers do no work in the present run, but their earlier work is kept.
    std::fill(row_.driver_work.begin(), row_.driver_work.end(), 0.0);
    work_.account->driver_work(y.subspan(2 * n), row_.driver_work);
    for (std::size_t e = 0; e < work_.earlier.by_driver.size(); ++e) row_.driver_work[e] += work_.earlier.by_driver[e];
  }
  evaluator_.add_turns(y.first(n));
  return snapshot(t, y, run_.needs);
}

// Multipliers of the row: those of the accelerations, or the least ones where they are not unique.
void Dynamics::find_multipliers() {
  row_.lambda.assign(equations_.multipliers().begin(), equations_.multipliers().end());
  if (!equations_.is_dependent() && !singular_.is_here()) return;
  MinimumNorm* least = reactions_.factorize(evaluator_);
  if (!least) return;
  if (singular_.is_here()) {
    least->solve(singular_.loads(), row_.lambda);
    return;
  }
  const std::span<const double> Q = equations_.applied_forces(), qdd = std::span(row_.slope).subspan(q_.size());
  const std::vector<double>& mass = equations_.masses().mass;
  row_.loads.resize(mass.size());
  for (std::size_t c = 0; c < mass.size(); ++c) row_.loads[c] = Q[c] - mass[c] * qdd[c];
  least->solve(row_.loads, row_.lambda);
  reactions_.ambiguity = least->ambiguity();
}

// Degrees of freedom: by count where rows are independent, else by rank.
void Dynamics::describe_mobility(AnalysisReport& report) {
  if (equations_.smallest_pivot_ratio() > dependence::independent && !equations_.is_dependent()) {
    report.rank = plan_->rows;
    report.dof = plan_->columns - plan_->rows;
    report.mobility = plan_->mobility();
    return;
  }
  const MobilityReport mobility = analyse_mobility(evaluator_, std::span<const double>(row_.y).first(q_.size()));
  report.rank = mobility.rank;
  report.dof = mobility.dof();
  report.mobility = mobility.mobility();
  for (int element : mobility.redundant_elements) report.redundant.push_back(model_->element_name(element));
}

Report Dynamics::stuck() {
  Report report;
  // Steps that end beyond the place where a law ceases to have a value fail, however short they are.
  const int lost = evaluator_.law_without_value();
  // So do those that end where friction has no force that fits.
  const std::string trouble = attached_.contacts ? attached_.contacts->trouble() : std::string();
  if (std::optional<Report> locked = lock_up_ahead()) return *locked;
  // An element that is undefined in kinematics is undefined here as well.
  evaluator_.set_time(under_way_.integrator->time());
  evaluator_.set_configuration(under_way_.integrator->state().first(q_.size()));
  if (Report sound = watched_.check(); !sound.ok()) return sound;
  if (Report laws = watched_.check_laws(under_way_.integrator->state().subspan(q_.size(), q_.size())); !laws.ok())
    return laws;
  if (Report ropes = check_ropes_ahead(watched_, evaluator_, under_way_.integrator->state()); !ropes.ok()) return ropes;
  if (lost >= 0) {
    report.status = Status::singular;
    report.message = fmt::format("{} is undefined beyond t = {:.9g} s: its expression has no finite value there",
                                 describe_law(*model_, lost), under_way_.integrator->time());
    return report;
  }
  if (!trouble.empty()) {
    report.status = Status::inconsistent;
    report.message = fmt::format("at t = {:.12g} s: {}", under_way_.integrator->time(), trouble);
    return report;
  }
  report.status = Status::step_too_small;
  std::string where;
  if (under_way_.integrator->culprit() >= 0) {
    where = fmt::format("the error of body \"{}\" cannot be kept small enough",
                        model_->body_name(plan_->model_body[at(under_way_.integrator->culprit() / 3)]));
  } else {
    where = "accelerations are not finite or constraints cannot be kept";
  }
  std::string cause = "forces that grow without bound, or a motion that jumps";
  if (const std::string undetermined = equations_.undetermined(); !undetermined.empty()) cause = undetermined;
  if (std::string branches = near_branches(); !branches.empty()) cause = std::move(branches);
  report.message = fmt::format("no step can be made at t = {:.12g} s: {}; likely cause: {}",
                               under_way_.integrator->time(), where, cause);
  return report;
}

// Gives a part of the last step to observers that look between rows.
Report Dynamics::show(double from, double to, RowObserver& observer, int ended_by) {
  if (!observer.wants_stretches() || !(to > from)) return {};
  MotionStretch stretch{from, to, [this](double t) { return state_at(t); }};
  stretch.ended_by = ended_by;
  stretch.ends_phase = ended_by >= 0 && attached_.events->acts(ended_by);
  return observer.cover(stretch) ? Report{} : cancelled(to);
}

// Events within the last step, in order: rows before each, then its own.
Report Dynamics::find_events(double from, RowObserver& observer) {
  const auto state = [&](double t) { return state_at(t); };
  while (const std::optional<FoundEvent> found = attached_.events->find(from, t_, state)) {
    if (const Report shown = show(from, found->t, observer, found->event); !shown.ok()) return shown;
    while (run_.next_row < run_.grid.size() && run_.grid[run_.next_row] < found->t) {
      if (const Report given = give_row(run_.grid[run_.next_row++], observer); !given.ok()) return given;
    }
    if (attached_.events->is_transition(*found)) {
      const std::optional<Snapshot> end = state_at(found->t);
      if (!end) return stuck();
      if (work_.balance) {
        work_.balance->observe(*end);
        if (Report balance = judge_balance(found->t); !balance.ok()) return balance;
      }
      run_.stopped_by = found->event;
      t_ = found->t;
      return {};
    }
    if (run_.next_row < run_.grid.size() && run_.grid[run_.next_row] == found->t) ++run_.next_row;
    if (const Report given = give_row(found->t, observer); !given.ok()) return given;
    from = found->t;
    if (attached_.events->take(*found)) run_.acting.push_back(found->event);
    // All that happen at the same instant have their rows before one of them acts.
    if (run_.acting.empty() || attached_.events->has_simultaneous()) continue;
    run_.stopped_by = run_.acting.front();
    t_ = found->t;
    return {};
  }
  return show(from, t_, observer);
}

WorkSoFar Dynamics::work_so_far() const {
  if (!work_.account) return {};
  const Snapshot now = snapshot(t_, row_.y, {});
  return {now.work, now.dissipated, work_.initial_energy, total_energy(now), row_.driver_work, true};
}

}  // namespace catena
