#include "catena/analysis/dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/initial_velocities.hpp"
#include "catena/analysis/integrators/motion.hpp"
#include "catena/analysis/mobility.hpp"
#include "catena/analysis/process_time.hpp"
#include "catena/analysis/state_conversion.hpp"
#include "catena/base/flush_denormals.hpp"
#include "catena/columns/energy.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

constexpr double least_tolerance = 1e-14;
// Rows whose smallest pivot ratio is above this need no rank analysis.
constexpr double independent_ratio = 1e-8;
constexpr std::size_t most_names = 10;  // in a warning

Report cancelled(double t) {
  Report report;
  report.status = Status::cancelled;
  report.message = fmt::format("stopped at t = {:.12g} s; the rows so far are kept", t);
  return report;
}

}  // namespace

Dynamics::Dynamics(std::shared_ptr<const Model> model, const PlanOptions& plan_options, const DynamicsOptions& options)
    : model_(std::move(model)),
      plan_(Plan::make(*model_, plan_options)),
      options_(options),
      evaluator_(plan_, *model_),
      equations_(evaluator_) {
  q_ = evaluator_.given_configuration();
  qd_.assign(q_.size(), 0.0);
  choose_method();
}

void Dynamics::start_from(const SystemState& state) {
  t_ = state.t;
  prepared_ = false;
  take_over_places(evaluator_, state, q_);
  given_qd_ = velocities_of(evaluator_, state);
}

SystemState Dynamics::state() const { return state_of(evaluator_, t_, q_, qd_); }

Report Dynamics::prepare(std::vector<std::string>& warnings) {
  Report masses = equations_.use_masses();
  if (!masses.ok()) return masses;
  if (!(options_.tolerance >= least_tolerance) || !(options_.tolerance < 1)) {
    masses.status = Status::refused;
    masses.message =
        fmt::format("tolerance {:.3g} cannot be met: double precision holds about {:.0e}; give {:.0e} ... 1",
                    options_.tolerance, least_tolerance, least_tolerance);
    return masses;
  }
  evaluator_.set_time(t_);
  Assembler assembler(evaluator_);
  AssemblyOutcome assembled = assembler.assemble(q_);
  if (!assembled.ok()) return assembled;
  if (assembled.moved > 1e-9 * evaluator_.length_scale()) {
    warnings.push_back(
        fmt::format("the given configuration did not meet the constraints: assembled first, bodies moved "
                    "by {:.3g} m (RMS)",
                    assembled.moved));
  }
  if (Report massless = equations_.check_massless(q_); !massless.ok()) return massless;
  const VelocityOutcome velocities = find_initial_velocities(equations_, q_, given_qd_, qd_);
  if (!velocities.ok()) return velocities;
  if (velocities.changed > 1e-9) {
    warnings.push_back(
        fmt::format("the given velocities did not meet the constraints: changed by up to {:.3g} (body \"{}\")",
                    velocities.changed, model_->body_name(velocities.changed_body)));
  }
  prepared_ = true;
  return {};
}

double Dynamics::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& function : model_->functions) next = std::min(next, function.next_breakpoint(t));
  return next;
}

Report Dynamics::check_functions(double last) const {
  Report report;
  for (const auto& function : model_->functions) {
    const TimeRange domain = function.domain();
    if (domain.first > t_ || domain.last < last) {
      report.status = Status::refused;
      report.message = fmt::format(
          "a table of a function of time covers {:.12g} s ... {:.12g} s, the analysis {:.12g} s ... {:.12g} s",
          domain.first, domain.last, t_, last);
    }
  }
  return report;
}

Snapshot Dynamics::snapshot(double t, std::span<const double> y, const Needs& needs) const {
  const std::size_t n = q_.size();
  Snapshot s{.evaluator = evaluator_, .t = t, .q = y.first(n), .qd = y.subspan(n, n)};
  if (needs.acceleration || needs.multipliers) s.qdd = std::span<const double>(slope_row_).subspan(n, n);
  if (needs.multipliers) s.lambda = lambda_row_;
  s.residual = row_residual_ * evaluator_.length_scale();
  if (account_) {
    const std::span<const double> work = y.subspan(2 * n);
    s.work = earlier_.supplied + EnergyAccount::supplied(work);
    s.dissipated = earlier_.dissipated + EnergyAccount::dissipated(work);
    s.driver_work = driver_work_;
    s.initial_energy = initial_energy_;
  }
  return s;
}

Report Dynamics::give_row(double t, const Needs& needs, RowObserver& observer) {
  const std::optional<Snapshot> state = state_at(t, needs);
  if (!state) return stuck();
  return observer.observe(*state) ? Report{} : cancelled(t);
}

// The mechanism at an instant of the last step, on its constraints if the method keeps to them; nothing where that
// cannot be had.
std::optional<Snapshot> Dynamics::state_at(double t, const Needs& needs) {
  const std::size_t n = q_.size();
  const std::span<double> y(y_row_);
  if (t == integrator_->time()) {
    std::copy(integrator_->state().begin(), integrator_->state().end(), y.begin());
    row_residual_ = integrator_->position_residual();
  } else {
    integrator_->interpolate(t, y);
    if (integrator_->meets_constraints()) {
      if (!equations_.factorize(t, Side::after, y.first(n))) return {};
      row_residual_ = equations_.project_position(y.first(n), 4);
      equations_.project_velocity(y.subspan(n, n), 0);
    } else {
      evaluator_.set_time(t);
      row_residual_ = equations_.position_residual(y.first(n));
    }
  }
  if (needs.acceleration || needs.multipliers) {
    const std::span<double> slope(slope_row_);
    if (!equations_.accelerations(t, Side::after, y.first(n), y.subspan(n, n), slope.subspan(n, n))) return {};
    if (needs.multipliers) find_multipliers();
  } else {
    evaluator_.set_time(t);
    evaluator_.set_configuration(y.first(n));
  }
  if (account_) {
    account_->driver_work(y.subspan(2 * n), driver_work_);
    for (std::size_t e = 0; e < earlier_.by_driver.size(); ++e) driver_work_[e] += earlier_.by_driver[e];
  }
  evaluator_.add_turns(y.first(n));
  return snapshot(t, y, needs);
}

// Multipliers of the row: those of the accelerations, or the least ones where they are not unique.
void Dynamics::find_multipliers() {
  lambda_row_.assign(equations_.multipliers().begin(), equations_.multipliers().end());
  if (!equations_.is_dependent()) return;
  if (!minimum_norm_) minimum_norm_.emplace(evaluator_);
  if (!minimum_norm_->factorize()) return;
  const std::span<const double> Q = equations_.applied_forces(), qdd = std::span(slope_row_).subspan(q_.size());
  const std::vector<double>& mass = equations_.masses().mass;
  loads_row_.resize(mass.size());
  for (std::size_t c = 0; c < mass.size(); ++c) loads_row_[c] = Q[c] - mass[c] * qdd[c];
  minimum_norm_->solve(loads_row_, lambda_row_);
  if (!ambiguity_.empty()) return;
  const std::vector<int> elements = minimum_norm_->find_ambiguous();
  for (std::size_t k = 0; k < elements.size() && k < most_names; ++k) {
    ambiguity_ += (k > 0 ? ", \"" : "\"") + model_->element_name(elements[k]) + "\"";
  }
  if (elements.size() > most_names) ambiguity_ += fmt::format(" and {} more", elements.size() - most_names);
  ambiguity_ = fmt::format(
      "reactions of {} are not unique, since constraints depend on each other: the least are given", ambiguity_);
  minimum_norm_->solve(loads_row_, lambda_row_);
}

// Degrees of freedom: by count where rows are independent, else by rank.
void Dynamics::describe_mobility(AnalysisReport& report) {
  if (equations_.smallest_pivot_ratio() > independent_ratio) {
    report.rank = plan_->rows;
    report.dof = plan_->columns - plan_->rows;
    report.mobility = plan_->mobility();
    return;
  }
  const MobilityReport mobility = analyse_mobility(evaluator_, std::span<const double>(y_row_).first(q_.size()));
  report.rank = mobility.rank;
  report.dof = mobility.dof();
  report.mobility = mobility.mobility();
  for (int element : mobility.redundant_elements) report.redundant.push_back(model_->element_name(element));
}

Report Dynamics::stuck() const {
  Report report;
  report.status = Status::step_too_small;
  const int row = equations_.weakest_row();
  std::string where;
  if (integrator_->culprit() >= 0) {
    where = fmt::format("the error of body \"{}\" cannot be kept small enough",
                        model_->body_name(plan_->model_body[at(integrator_->culprit() / 3)]));
  } else {
    where = "accelerations are not finite or constraints cannot be kept";
  }
  std::string cause = "forces that grow without bound, or a motion that jumps";
  if (plan_->rows > 0 && equations_.smallest_pivot_ratio() < 1e-6 && row >= 0) {
    const int element = plan_->row_element[at(row)];
    cause = fmt::format("a singular configuration: {} \"{}\" depends on other constraints there",
                        model_->element_type(element), model_->element_name(element));
  }
  report.message =
      fmt::format("no step can be made at t = {:.12g} s: {}; likely cause: {}", integrator_->time(), where, cause);
  return report;
}

AnalysisReport Dynamics::run(const TimeGrid& grid, const Needs& asked, RowObserver& observer) {
  const ProcessTimer timer;
  const FlushDenormals flush;
  Needs needs = asked;
  if (events_) needs |= events_->needs();
  stopped_by_ = -1;
  AnalysisReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan_->rows;
  report.islands = plan_->islands;
  const auto end = [&](const Report& outcome) {
    report.status = outcome.status;
    report.message = outcome.message;
    if (integrator_) {
      for (std::string& remark : integrator_->remarks()) report.warnings.push_back(std::move(remark));
    }
    if (!ambiguity_.empty()) report.warnings.push_back(ambiguity_);
    report.counters = evaluator_.counters;
    report.seconds = timer.seconds();
    return report;
  };
  if (grid.size() == 0) return end({});
  if (const Report functions = check_functions(grid.last()); !functions.ok()) return end(functions);
  if (method_ == IntegrationMethod::partitioning) {
    if (const Report freedoms = check_freedoms(); !freedoms.ok()) return end(freedoms);
  }
  if (!prepared_) {
    if (const Report prepared = prepare(report.warnings); !prepared.ok()) return end(prepared);
  }
  account_.reset();
  if (needs.work) account_.emplace(evaluator_);
  driver_work_.assign(account_ ? model_->elements.size() : 0, 0.0);
  const Motion motion(equations_, account_ ? &*account_ : nullptr);
  integrator_ = make_integrator(motion, grid.last());
  y_row_.assign(motion.size(), 0.0);
  slope_row_.assign(motion.size(), 0.0);
  std::copy(q_.begin(), q_.end(), y_row_.begin());
  std::copy(qd_.begin(), qd_.end(), y_row_.begin() + static_cast<std::ptrdiff_t>(q_.size()));
  evaluator_.take_turns(std::span(y_row_).first(q_.size()));
  if (!integrator_->start(t_, y_row_)) {
    evaluator_.forget_turns();
    return end(stuck());
  }
  describe_mobility(report);
  if (account_) {
    initial_energy_ = total_energy(snapshot(t_, y_row_, {}));
    if (!earlier_.by_driver.empty()) {
      earlier_.dissipated += earlier_.energy - initial_energy_;
      initial_energy_ = earlier_.initial_energy;
    }
  }
  first_step_ = pace_step_ = evaluator_.counters.steps + evaluator_.counters.rejected;
  pace_time_ = t_;
  std::int64_t& row = next_row_ = 0;
  Report outcome;
  while (outcome.ok() && row < grid.size() && grid[row] <= t_) outcome = give_row(grid[row++], needs, observer);
  while (outcome.ok() && row < grid.size() && stopped_by_ < 0) {
    const double limit = std::min(next_breakpoint(t_), grid.last());
    outcome = move(limit, grid, row, needs, observer);
  }
  const std::span<const double> y = stopped_by_ < 0 ? integrator_->state() : std::span<const double>(y_row_);
  std::copy_n(y.begin(), q_.size(), q_.begin());
  std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(q_.size()), q_.size(), qd_.begin());
  if (stopped_by_ < 0) evaluator_.add_turns(q_);
  evaluator_.forget_turns();
  evaluator_.set_time(t_);
  evaluator_.set_configuration(q_);
  return end(outcome);
}

// Steps to `limit`, giving the rows on the way.
Report Dynamics::move(double limit, const TimeGrid& grid, std::int64_t& row, const Needs& needs,
                      RowObserver& observer) {
  while (t_ < limit) {
    if (!integrator_->advance(limit)) return stuck();
    const double before = t_;
    t_ = integrator_->time();
    if (!observer.proceed(t_)) return cancelled(t_);
    if (const Report pace = check_pace(grid.last()); !pace.ok()) return pace;
    if (events_) {
      const Report found = find_events(before, grid, row, needs, observer);
      if (!found.ok() || stopped_by_ >= 0) return found;
    }
    if (t_ == limit && limit < grid.last()) {
      // A function of time jumps here: the next step starts with what holds afterwards.
      while (row < grid.size() && grid[row] < t_) {
        if (const Report given = give_row(grid[row++], needs, observer); !given.ok()) return given;
      }
      std::copy(integrator_->state().begin(), integrator_->state().end(), y_row_.begin());
      if (!equations_.factorize(t_, Side::after, std::span(y_row_).first(q_.size()))) return stuck();
      equations_.project_velocity(std::span(y_row_).subspan(q_.size(), q_.size()), 0);
      if (!integrator_->start(t_, y_row_)) return stuck();
    }
    while (row < grid.size() && grid[row] <= t_) {
      if (const Report given = give_row(grid[row++], needs, observer); !given.ok()) return given;
    }
  }
  return {};
}

// Events within the last step, in order: rows before each, then its own.
Report Dynamics::find_events(double from, const TimeGrid& grid, std::int64_t& row, const Needs& needs,
                             RowObserver& observer) {
  const auto state = [&](double t) { return state_at(t, needs); };
  while (const std::optional<FoundEvent> found = events_->find(from, t_, state)) {
    while (row < grid.size() && grid[row] < found->t) {
      if (const Report given = give_row(grid[row++], needs, observer); !given.ok()) return given;
    }
    if (row < grid.size() && grid[row] == found->t) ++row;
    if (const Report given = give_row(found->t, needs, observer); !given.ok()) return given;
    from = found->t;
    if (!events_->take(*found)) continue;
    stopped_by_ = found->event;
    t_ = found->t;
    return {};
  }
  return {};
}

WorkSoFar Dynamics::work_so_far() const {
  if (!account_) return {};
  const Snapshot now = snapshot(t_, y_row_, {});
  return {now.work, now.dissipated, initial_energy_, total_energy(now), driver_work_};
}

}  // namespace catena
