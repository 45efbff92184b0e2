#include "catena/analysis/stability/buckling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/balance/force_sizes.hpp"
#include "catena/analysis/balance/static_holding.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/analysis/run/watched_elements.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/analysis/statics/solvers/static_active_set.hpp"
#include "catena/analysis/statics/static_explanation.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Constraints met to this, in length scales or rad, do not depend on the parameter.
constexpr double kept_place = 1e-9;
constexpr const char* moved_by_load =
    "the load moves the equilibrium: these are estimates of linear buckling theory; an analysis of type path finds the "
    "critical points on the way";

ModelAt required(ModelAt model_at) {
  if (!model_at)
    throw std::invalid_argument("buckling: there is nothing that makes models at other values of the parameter");
  return model_at;
}

}  // namespace

Buckling::Buckling(std::shared_ptr<const Model> model, ModelAt model_at, const BucklingOptions& options,
                   const PlanOptions& plan_options)
    : model_(std::move(model)),
      plan_(Plan::make(catena::required(model_), with_gaps(plan_options))),
      options_(options),
      evaluator_(plan_, *model_, evaluation_),
      system_(evaluator_),
      path_(system_, required(std::move(model_at)), options.present, 1) {
  point_ = {evaluator_.given_configuration(), std::vector<double>(at(plan_->rows), 0.0), options.present};
}

void Buckling::start_from(const SystemState& state) {
  t_ = state.t;
  point_.q = configuration_of(evaluator_, state);
}

Report Buckling::not_stable() const {
  return {Status::refused,
          fmt::format("the equilibrium is not stable at the present value {:.6g} of the parameter; begin "
                      "with a smaller load",
                      options_.present),
          {}};
}

Report Buckling::neutral(int count, const std::vector<std::string>& bodies) {
  return {Status::refused,
          fmt::format("the equilibrium is neutral at the present value of the parameter: nothing resists {}; hold them "
                      "first",
                      describe_free_motions(count, bodies)),
          {}};
}

SystemState Buckling::state() const { return state_of(evaluator_, t_, point_.q); }

Report Buckling::place_load(double p) {
  PathPoint loaded = point_;
  loaded.p = p;
  outside_ = !path_.move_to(loaded);
  if (outside_) {
    return {Status::refused, fmt::format("the scene does not allow the value {:.6g} of the parameter", p), {}};
  }
  if (system_.phi_norm() > kept_place) {
    return {Status::refused,
            "the parameter moves constraints, so that the configuration cannot be kept; an analysis of type path "
            "follows it",
            {}};
  }
  // The multipliers are needed even if the load is already known to move the equilibrium.
  const bool moves = !balance_loads(system_, loaded.lambda).negligible();
  moves_ = moves_ || moves;
  loaded_ = std::move(loaded.lambda);
  return {};
}

Report Buckling::stiffness_at(double p, KktMatrix& matrix) {
  if (Report placed = place_load(p); !placed.ok()) return placed;
  matrix.set_hessian(evaluator_, loaded_, Curvature::exact);
  matrix.complete(system_.jacobian(), 0);
  return {};
}

// Multipliers that would be zero are what the solution of linear equations leaves of the loads.
StiffnessFloor Buckling::floor_under_load() {
  const ForceSizes sizes = force_sizes(evaluator_);
  double largest = 0;
  for (std::size_t c = 0; c < sizes.loads.size(); ++c)
    largest = std::max(largest, sizes.loads[c] / (c % 3 == 2 ? evaluator_.length_scale() : 1));
  return {system_, loaded_, thresholds::solved * largest};
}

Report Buckling::take_place(Imbalance& left, BucklingReport& report) {
  if (!system_.has_gaps()) {
    if (Report assembly = assemble_for_statics(system_, point_.q); !assembly.ok()) return assembly;
    left = balance_loads(system_, point_.lambda);
    return {};
  }
  if (Report closed = close_gaps_at(system_, point_.q, point_.lambda, set_, left); !closed.ok()) return closed;
  report.active = names_of_closed(evaluator_, set_);
  for (std::string& remark : remarks_on(evaluator_, set_)) report.warnings.push_back(std::move(remark));
  return {};
}

void Buckling::check_gaps(BucklingReport& report) {
  if (!system_.has_gaps()) return;
  for (const double load : report.loads) {
    PathPoint loaded = point_;
    loaded.p = load;
    if (!path_.move_to(loaded)) continue;
    static_cast<void>(balance_loads(system_, loaded.lambda));
    const std::vector<double> faults = gap_faults(system_, loaded.lambda, set_.closed);
    ActiveSet other{.closed = {}, .weak = std::vector<char>(faults.size())};
    for (std::size_t k = 0; k < faults.size(); ++k) other.weak[k] = faults[k] > thresholds::no_force;
    if (const std::string names = names_of_weak(evaluator_, other); !names.empty()) {
      report.warnings.push_back(fmt::format(
          "at the value {:.6g} one-sided elements would not hold, or not be open, as they are at the present one: {}; "
          "the value is that of a mechanism in which they stay so, and an analysis of type path follows them",
          load, names));
    }
  }
}

Report Buckling::find(BucklingReport& report, const std::function<bool()>& go_on) {
  Imbalance left;
  if (Report placed = take_place(left, report); !placed.ok()) return placed;
  if (std::optional<Report> loose = find_loose_bodies(system_, evaluator_)) return *loose;
  const bool unbalanced = !left.negligible();
  if (unbalanced) {
    report.warnings.emplace_back(
        "the configuration is no equilibrium; an equilibrium analysis before this one finds it");
  }
  if (!path_.move_to(point_)) return {Status::refused, "the scene does not allow the parameter's present value", {}};
  if (!evaluator_.conservative()) {
    Report outcome = find_without_energy(report, go_on);
    if (outcome.ok() && moves_ && !unbalanced) report.warnings.emplace_back(moved_by_load);
    return outcome;
  }
  std::vector<Load> loads;
  groups_.emplace(system_, false);
  const bool dense = groups_->are_small() && plan_->columns > 0;
  Report outcome = dense ? find_by_dense(loads, go_on) : find_by_lanczos(loads, go_on);
  if (!outcome.ok()) return outcome;
  if (loads.empty()) {
    report.warnings.emplace_back("no value of the parameter makes this equilibrium unstable");
    return {};
  }
  for (Load& load : loads) {
    report.loads.push_back(options_.present + load.distance);
    const double largest = decisive_component(*plan_, load.shape);
    for (double& x : load.shape) x /= largest;
    report.shapes.push_back(std::move(load.shape));
  }
  if (moves_ && !unbalanced) {
    report.warnings.emplace_back(moved_by_load);
  }
  check_gaps(report);
  if (options_.errors) find_errors(report);
  if (static_cast<int>(report.loads.size()) < options_.count) {
    report.warnings.push_back(fmt::format("there are only {} such values", report.loads.size()));
  }
  return {};
}

BucklingReport Buckling::run(const std::function<bool()>& go_on) {
  const ProcessTimer timer;
  BucklingReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan_->rows;
  report.islands = plan_->islands;
  Report outcome = check_time_functions(*model_, {t_, t_});
  if (outcome.ok()) {
    evaluator_.set_time(t_);
    path_.set_time(t_);
    const bool treated = evaluator_.conservative() || !system_.has_gaps();
    outcome = treated ? find(report, go_on) : refuse_gaps_without_energy(system_);
    path_.move_to(point_);
    const WatchedElements watched(evaluator_);
    if (outcome.ok()) outcome = watched.check_ends();
    if (outcome.ok()) outcome = watched.check_ropes();
  }
  report.status = outcome.status;
  report.message = std::move(outcome.message);
  report.warnings.insert(report.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
  report.counters = evaluator_.counters;
  report.seconds = timer.seconds();
  return report;
}

}  // namespace catena
