// The rows of a driven motion: the mechanism is taken to every instant of the grid and checked there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/columns/energy.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Redundant rows that velocities and accelerations miss by more than the first part of them are a reason to look for
// better rows, by more than the second a contradiction.
constexpr double doubtful_rates = 1e-11, contradictory_rates = 1e-6;
// Rates of redundant equations, if not needed for output, are checked at one in so many rows: they cost as much as the
// positions, whose residual is checked at every step.
constexpr std::int64_t rows_between_checks = 16;

bool has_rates(const Needs& needs) { return needs.velocity || needs.acceleration || needs.multipliers; }

}  // namespace

AnalysisReport Kinematics::run(const TimeGrid& grid, const Needs& asked, RowObserver& observer) {
  const ProcessTimer timer;
  AnalysisReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan().rows;
  report.islands = plan().islands;
  run_ = {.observer = &observer};
  solver_.forget_left();
  Needs needs = asked;
  if (needs.work) needs.velocity = needs.acceleration = needs.multipliers = true;
  work_.end();
  TimeRange whole{now_.t, now_.t};
  if (grid.size() > 0) {
    run_.earliest = grid.earliest();
    run_.latest = grid.latest();
    whole = {std::min(now_.t, run_.earliest), std::max(now_.t, run_.latest)};
  }
  const Evaluator::TimeLimit limit(evaluator_, whole);
  Report outcome = begin_run(grid, needs, whole, report);
  for (std::int64_t k = 0; outcome.ok() && k < grid.size(); ++k) {
    outcome = go_to_row(grid[k], report.warnings);
    if (outcome.ok()) outcome = give_row(needs, k % rows_between_checks == 0);
  }
  end_run(outcome, needs, report);
  report.seconds = timer.seconds();
  return report;
}

// What the rows need is there, and constraints and drivers determine the motion.
Report Kinematics::begin_run(const TimeGrid& grid, const Needs& needs, const TimeRange& whole, AnalysisReport& report) {
  if (needs.multipliers) {
    if (const int body = body_without_mass(*model_, plan()); body >= 0) {
      Report refused;
      refused.status = Status::refused;
      refused.message =
          fmt::format("loads and reactions need the mass and the inertia of body \"{}\"", model_->body_name(body));
      return refused;
    }
  }
  if (Report functions = check_time_functions(*model_, whole); !functions.ok()) return functions;
  if (!assembled_ || !assembled_->ok()) {
    if (const AssemblyOutcome outcome = assemble(); !outcome.ok()) return outcome;
  }
  predicted_.qd.resize(has_rates(needs) ? now_.q.size() : 0);
  predicted_.qdd.resize(needs.acceleration || needs.multipliers ? now_.q.size() : 0);
  predicted_.t.reset();
  Report prepared = prepare(grid.size() > 1 && grid[1] < grid[0] ? -1 : 1);
  placed_ = true;  // by the first row
  if (!prepared.ok()) return prepared;
  report.warnings = std::move(prepared.warnings);
  report.redundant = rows_.names();
  report.rank = plan().columns;
  report.dof = 0;
  report.mobility = rows_.mobility();
  return needs.work ? start_work() : Report{};
}

// The mechanism at the instant of a row; `warnings` takes those of the way there.
Report Kinematics::go_to_row(double t, std::vector<std::string>& warnings) {
  if (t != now_.t) {
    Report moved = work_.is_on() ? move_and_sum_up(t) : follow_to(t);
    if (!moved.ok()) return moved;
    warnings.insert(warnings.end(), moved.warnings.begin(), moved.warnings.end());
  } else if (now_.on_bridge || stretch_.covers(t)) {
    place_on_bridge(t);
  } else {
    solve_here();
  }
  run_.interpolated = run_.interpolated || now_.on_bridge;
  return {};
}

// Checks the present instant and gives its row. Redundant equations must agree in velocities and accelerations as well;
// `check_rates`: even where these are not needed.
Report Kinematics::give_row(const Needs& needs, bool check_rates) {
  const bool redundant = rows_.has_redundant_rows();
  if (redundant) {
    if (Report consistent = rows_.check_places(here()); !consistent.ok()) return consistent;
  }
  if (Report sound = watched_.check(); !sound.ok()) return sound;
  Needs checked = needs;
  if (redundant && check_rates) checked.velocity = checked.acceleration = true;
  if (Report solved = find_rates(checked); !solved.ok()) return solved;
  if (has_rates(needs)) {
    if (Report laws = watched_.check_laws(now_.qd); !laws.ok()) return laws;
  }
  if (!now_.on_bridge && solver_.rcond() < dependence::suspicious) {
    if (std::optional<SingularPoint> point = dead_point_here()) return lock_up(std::move(*point));
  }
  if (redundant) {
    if (!check_redundant_rates(doubtful_rates, false).ok() && choose_better_rows()) {
      // The equations in use were badly conditioned; others are well conditioned.
      solver_.solve_position(now_.q);
      if (Report solved = find_rates(checked); !solved.ok()) return solved;
    }
    if (Report consistent = check_redundant_rates(contradictory_rates, true); !consistent.ok()) return consistent;
  }
  const DrivenInstant now = here();
  predictor_.push(now.t, now.q, now.qd, now.qdd);
  if (work_.is_on()) work_.update_driver_work();
  Snapshot row = snapshot();
  if (needs.multipliers) {
    row.lambda = reactions_.multipliers();
    row.contacts = reactions_.friction();
  }
  return run_.observer->observe(row) ? Report{} : cancelled();
}

void Kinematics::end_run(const Report& outcome, const Needs& needs, AnalysisReport& report) {
  const bool locked = outcome.status == Status::lock_up;
  if (locked) give_row_at_lock_up(needs, *run_.observer);
  run_ = {.interpolated = run_.interpolated};
  report.status = outcome.status;
  report.message = outcome.message;
  report.warnings.insert(report.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
  // At a dead point work is not known, and the row there says so.
  if (std::string doubt = work_.doubt(); !doubt.empty() && !locked) report.warnings.push_back(std::move(doubt));
  reactions_.add_remarks(report.warnings);
  report.counters = evaluator_.counters;
}

Report Kinematics::cancelled() const {
  Report report;
  report.status = Status::cancelled;
  report.message = fmt::format("stopped at t = {:.12g} s; the rows so far are kept", now_.t);
  return report;
}

}  // namespace catena
