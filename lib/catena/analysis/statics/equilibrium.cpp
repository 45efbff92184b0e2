#include "catena/analysis/statics/equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/balance/static_holding.hpp"
#include "catena/analysis/pose/minimum_norm.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/analysis/run/watched_elements.hpp"
#include "catena/analysis/statics/active_set_at.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// What the search says of the stability.
void tell_stability(const StaticResult& result, EquilibriumReport& report) {
  const Certificate& c = result.certificate;
  report.has_energy = result.has_energy;
  report.certified = c.valid && result.has_energy && result.report.status != Status::not_converged;
  report.stable = report.certified && c.stable;
  report.neutral = report.certified && c.neutral;
  report.negative_modes = report.certified ? c.negative_modes : 0;
  report.free_motions = report.certified ? c.neutral_modes : 0;
  if (report.certified) report.free_bodies = c.free_bodies;
  if (result.stability && result.stability->judged) {
    const CirculatoryModes& motions = result.stability->motions;
    report.certified = true;
    report.stable = result.stability->stable;
    report.neutral = motions.neutral > 0;
    report.negative_modes = motions.negative;
    report.flutter = result.stability->in_masses ? motions.pairs : 0;
    report.free_motions = motions.neutral;
    report.free_bodies = result.free_bodies;
  }
  report.softest_stiffness = c.softest_stiffness;
}

void tell_softest_mode(const Evaluator& evaluator, std::span<const double> radius, const Certificate& certificate,
                       EquilibriumReport& report) {
  const Plan& plan = evaluator.plan();
  if (certificate.mode.empty()) return;
  report.softest_mode = describe_mode(evaluator, certificate.mode, radius);
  report.softest_shape.assign(3 * evaluator.model().bodies.size(), 0.0);
  for (int k = 0; k < plan.columns; ++k) {
    const int coordinate = plan.coordinate[at(k)];
    report.softest_shape[3 * at(plan.model_body[at(coordinate / 3)]) + at(coordinate % 3)] = certificate.mode[at(k)];
  }
}

// Refuses a place beyond an end of what an element is defined on.
Report check_ends(Evaluator& evaluator, std::span<const double> q) {
  const WatchedElements watched(evaluator);
  evaluator.set_configuration(q);
  Report left = watched.check_ends();
  if (left.ok()) left = watched.check_laws({});
  if (left.ok()) left = watched.check_ropes();
  return left;
}

// Gaps that are closed, rank and degrees of freedom with them.
void tell_rank(const Evaluator& evaluator, const StaticResult& result, EquilibriumReport& report) {
  const Plan& plan = evaluator.plan();
  const auto& closed = result.gaps.closed;
  int open = 0;
  for (std::size_t k = 0; k < closed.size(); ++k) {
    if (closed[k]) report.active.push_back(evaluator.model().element_name(plan.row_element[at(plan.gap_rows[k])]));
    open += !closed[k] || result.gaps.weak[k];
  }
  report.rank = plan.rows - static_cast<int>(result.dependent_rows.size()) - open;
  report.dof = plan.columns - *report.rank;
}

}  // namespace

Equilibrium::Equilibrium(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                         const EquilibriumOptions& options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), with_gaps(plan_options))),
      options_(options),
      evaluator_(plan_, *model_, evaluation_),
      system_(evaluator_) {
  if (!(options.tolerance > 0)) throw std::invalid_argument("equilibrium: the tolerance must be above zero");
  if (options.find < 1) throw std::invalid_argument("equilibrium: find asks for at least one equilibrium");
  q_ = evaluator_.given_configuration();
  lambda_.assign(at(plan_->rows), 0.0);
}

void Equilibrium::start_from(const SystemState& state) {
  t_ = state.t;
  solved_ = false;
  take_over_places(evaluator_, state, q_);
}

void Equilibrium::set_model(std::shared_ptr<const Model> model) {
  required(model);
  // Origins may move with the parameters: places are kept in the ground frame.
  std::vector<Vec2<double>> before(at(plan_->bodies));
  for (int p = 0; p < plan_->bodies; ++p) before[at(p)] = evaluator_.origin(p);
  evaluator_.set_model(*model);
  model_ = std::move(model);
  system_.take_over_model();
  for (int p = 0; p < plan_->moving; ++p) {
    q_[3 * at(p)] += before[at(p)].x - evaluator_.origin(p).x;
    q_[3 * at(p) + 1] += before[at(p)].y - evaluator_.origin(p).y;
  }
}

SystemState Equilibrium::state() const { return state_of(evaluator_, t_, q_); }

// Where equations depend on each other many multipliers balance the loads: the least of them are given, with a warning.
void Equilibrium::choose_least_reactions(Report& report) {
  MinimumNorm least(evaluator_);
  if (!least.factorize()) return;
  std::vector<double> loads(at(plan_->coordinates())), multipliers(lambda_.size());
  evaluator_.applied_forces(std::vector<double>(loads.size(), 0.0), loads);
  // Least reactions that do not balance the loads are rejected.
  if (!(least.solve(loads, multipliers) <= thresholds::no_force)) return;
  // One-sided elements only push: where the least reactions would pull, those found are kept.
  for (int r : plan_->gap_rows) {
    if (multipliers[at(r)] > 0) return;
  }
  lambda_ = std::move(multipliers);
  const std::string names = least.name_ambiguous();
  if (names.empty()) return;
  report.warnings.push_back(fmt::format(
      "redundant constraints: the reactions of {} are not unique; of all that balance the loads the least are given",
      names));
}

EquilibriumReport Equilibrium::solve() {
  const ProcessTimer timer;
  EquilibriumReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan_->rows;
  report.islands = plan_->islands;
  const auto end = [&](Report outcome) {
    report.status = outcome.status;
    report.message = std::move(outcome.message);
    for (std::string& warning : outcome.warnings) report.warnings.push_back(std::move(warning));
    report.counters = evaluator_.counters;
    report.seconds = timer.seconds();
    solved_ = report.ok();
    neutral_ = report.neutral;
    return report;
  };
  if (Report functions = check_time_functions(*model_, {t_, t_}); !functions.ok()) return end(std::move(functions));
  evaluator_.set_time(t_);
  system_.move_to(q_);
  if (std::optional<Report> loose = find_loose_bodies(system_, evaluator_)) return end(*loose);
  StaticSearch search(system_, {.solver = options_.solver,
                                .tolerance = options_.tolerance,
                                .stationary = options_.accept == Accept::stationary,
                                .warm = solved_,
                                .verbose = options_.verbose});
  StaticResult result = search.find(q_, lambda_);
  report.solver = std::string(result.solver);
  report.iterations = result.iterations;
  report.residual = result.residual;
  report.energy = system_.energy();
  tell_stability(result, report);
  tell_softest_mode(evaluator_, system_.radius(), result.certificate, report);
  for (int r : result.dependent_rows) {
    const std::string name = model_->element_name(plan_->row_element[at(r)]);
    if (report.redundant.empty() || report.redundant.back() != name) report.redundant.push_back(name);
  }
  if (result.report.ok()) {
    if (Report left = check_ends(evaluator_, q_); !left.ok()) result.report = std::move(left);
  }
  if (result.report.ok()) {
    tell_rank(evaluator_, result, report);
    if (std::string rigid = taken_as_rigid(evaluator_, result.gaps); !rigid.empty())
      result.report.warnings.push_back(std::move(rigid));
    if (!result.dependent_rows.empty()) choose_least_reactions(result.report);
  }
  return end(std::move(result.report));
}

bool Equilibrium::send_row(const Needs& needs, RowObserver& observer, Report& report) {
  const Snapshot snapshot{.evaluator = evaluator_,
                          .t = t_,
                          .q = q_,
                          .lambda = needs.multipliers ? std::span<const double>(lambda_) : std::span<const double>{},
                          .residual = system_.phi_norm() * system_.length()};
  if (observer.observe(snapshot)) return true;
  report.status = Status::cancelled;
  report.message = fmt::format("stopped at t = {:.12g} s; the rows so far are kept", t_);
  return false;
}

EquilibriumReport Equilibrium::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  EquilibriumReport report;
  const ProcessTimer timer;
  system_.watch([&] { return observer.proceed(t_); });
  for (std::int64_t k = 0; k < grid.size(); ++k) {
    t_ = grid[k];
    if (options_.find > 1) {
      report = find_several(needs, observer);
      break;
    }
    report = solve();
    if (!report.ok() || !send_row(needs, observer, report)) break;
  }
  system_.watch({});
  report.seconds = timer.seconds();
  return report;
}

}  // namespace catena
