// The choice of the method of integration, the accuracy of its steps, and the end of runs that would take too long.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/dynamics/implicit/alpha.hpp"
#include "catena/analysis/dynamics/implicit/radau.hpp"
#include "catena/analysis/dynamics/implicit/rattle.hpp"
#include "catena/analysis/dynamics/integrators/adams.hpp"
#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"
#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Part of the tolerance that a step may contribute; see the calibration in tests/oracles.
constexpr double step_part = 0.002;
// The same for methods whose errors of steps add up more: those that do not project, and multistep methods; but not
// below rounding.
constexpr double finer_part = 0.2, least_step_tolerance = 2e-14;
// The same of an implicit step, the error of which is of two orders more than its estimate.
constexpr double implicit_part = 0.3;
// Of steps of order 2 the errors h^3 of T / h steps add up to tolerance^(2/3): with steps allowed tolerance^(3/2) times
// this, motions of springs and pendulums were off by 2 to 4 tolerances at 1e-3 ... 1e-7.
constexpr double second_order_part = 0.5;
constexpr double least_multistep_tolerance = 1e-11;
constexpr int least_multistep_bodies = 10;
// Steps over which the pace of a run is measured.
constexpr std::int64_t steps_of_a_pace = 20'000;

// Whether bodies are tied to each other, or to the ground, in more than one way.
bool has_closed_loops(const Plan& plan) {
  std::vector<int> leader(at(plan.moving) + 1);
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int node) {
    while (leader[at(node)] != node) node = leader[at(node)] = leader[at(leader[at(node)])];
    return node;
  };
  bool closed = false;
  for_each_list(plan.blocks, [&](const auto& block, int) {
    for (int e = 0; e < block.size(); ++e) {
      // Bodies that do not move count as the ground.
      const int i = find(std::min(block.body_i[at(e)], plan.moving)),
                j = find(std::min(block.body_j[at(e)], plan.moving));
      closed = closed || i == j;
      leader[at(i)] = j;
    }
  });
  return closed;
}

}  // namespace

std::string names_of(std::span<const IntegrationMethod> used) {
  std::string names;
  for (const IntegrationMethod method : used) {
    const std::string_view name = to_string(method);
    if (names.find(name) == std::string::npos) names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

// A motion is integrated forwards: rows in another order, or before its start, cannot be had.
Report Dynamics::check_order() const {
  Report report;
  double before = origin_.resumed ? run_.grid[0] : t_;
  for (std::int64_t k = 0; k < run_.grid.size(); ++k) {
    if (run_.grid[k] >= before) {
      before = run_.grid[k];
      continue;
    }
    report.status = Status::refused;
    report.message = k == 0
                         ? fmt::format(
                               "a row is asked for at t = {:.12g} s, but the motion starts at {:.12g} s and is not "
                               "integrated backwards",
                               run_.grid[0], t_)
                         : fmt::format(
                               "\"at\" must list its instants in the order of time, since a motion is not integrated "
                               "backwards: {:.12g} s comes after {:.12g} s",
                               run_.grid[k], before);
    return report;
  }
  return report;
}

int Dynamics::freedoms() const { return plan_->columns - acting_rows(*plan_) + redundant_.count(); }

Report Dynamics::check_freedoms() const {
  Report report;
  if (freedoms() > CoordinatePartition::most_freedoms) {
    report.status = Status::refused;
    report.message = fmt::format(
        "partitioning serves up to {} degrees of freedom, and this mechanism has {} degrees of freedom; other methods "
        "have no limit",
        CoordinatePartition::most_freedoms, freedoms());
  }
  return report;
}

// Multistep methods save evaluations in smooth motions of many bodies; in closed loops, which may come to singular
// positions, and at tolerances near rounding, Runge-Kutta is the safer choice.
void Dynamics::choose_method(bool stages_are_watched) {
  methods_.present = options_.method;
  stiffness_.wanted = methods_.present == IntegrationMethod::automatic && options_.may_turn_implicit &&
                      options_.step == 0 && !stages_are_watched;
  if (methods_.present == IntegrationMethod::automatic) {
    // Derivatives that are carried along the stages of order 8 cost no evaluations; beside steps of Adams all are
    // theirs.
    const bool multistep = !stages_are_watched && options_.step == 0 &&
                           options_.tolerance >= least_multistep_tolerance && plan_->moving >= least_multistep_bodies &&
                           !has_closed_loops(*plan_);
    methods_.present = multistep ? IntegrationMethod::adams : IntegrationMethod::rk8;
  }
  methods_.used = {methods_.present};
}

std::unique_ptr<Integrator> Dynamics::make_integrator(const Motion& motion, double horizon) const {
  // A motion that drivers alone decide follows them from a flat start; where something moves freely, steps near that
  // start are known by the pivots of other places.
  RungeKuttaOptions options{.tolerance = step_part * options_.tolerance,
                            .fixed_step = options_.step,
                            .horizon = horizon,
                            .may_lower_order = options_.method != IntegrationMethod::rk8,
                            .usual_ratio = freedoms() > 0 ? redundant_.generic_ratio() : 0};
  const double finer = std::min(options.tolerance, std::max(finer_part * options.tolerance, least_step_tolerance));
  switch (methods_.present) {
    case IntegrationMethod::automatic:
    case IntegrationMethod::rk8:
      break;
    case IntegrationMethod::rk5:
      options.order = 5;
      break;
    case IntegrationMethod::baumgarte:
      options.keeping = ConstraintKeeping::stabilisation;
      options.tolerance = finer;
      break;
    case IntegrationMethod::partitioning:
      options.keeping = ConstraintKeeping::partition;
      // Of two to forty four-bars that pass flat positions motions were off by up to 13 tolerances at 1e-3 with steps
      // twice as coarse, by up to 4 with these.
      options.tolerance = std::max(finer / 2, std::min(finer, least_step_tolerance));
      break;
    case IntegrationMethod::adams:
      options.tolerance = finer;
      return std::make_unique<Adams>(motion, options);
    case IntegrationMethod::radau:
      return std::make_unique<Radau>(motion, options);
    case IntegrationMethod::alpha:
      return std::make_unique<Alpha>(
          motion,
          AlphaOptions{.rho = options_.rho,
                       .tolerance = options_.step > 0 ? implicit_part * options_.tolerance
                                                      : second_order_part * std::pow(options_.tolerance, 1.5),
                       .fixed_step = options_.step,
                       .horizon = horizon},
          options);
    case IntegrationMethod::rattle:
      return std::make_unique<Rattle>(motion, options_.step, horizon);
  }
  return std::make_unique<RungeKutta>(motion, options);
}

// Ends a run that has used up its steps, and at once one that would take hours at its present pace. Fixed steps are as
// they were asked for.
Report Dynamics::check_pace(double last) {
  Report report;
  const bool fixed = options_.step > 0;
  const std::int64_t steps = evaluator_.counters.steps + evaluator_.counters.rejected;
  const std::int64_t taken = *pace_.taken += steps - std::exchange(pace_.counted, steps);
  const bool used_up = taken >= options_.max_steps && t_ < last;
  bool hopeless = false;
  if (!fixed && steps - pace_.step >= steps_of_a_pace) {
    const double pace = (t_ - pace_.t) / static_cast<double>(steps - pace_.step);
    hopeless = last - t_ > 10 * pace * static_cast<double>(options_.max_steps);
    pace_.step = steps;
    pace_.t = t_;
  }
  if (!used_up && !hopeless) return report;
  if (fixed) {
    report.status = Status::not_converged;
    report.message = fmt::format(
        "{} steps of {:.3g} s led to t = {:.12g} s, more than max_steps = {} are needed; give a larger step or "
        "max_steps",
        taken, options_.step, t_, options_.max_steps);
    return report;
  }
  if (std::optional<Report> locked = lock_up_ahead()) return *locked;
  // At a hopeless pace the steps are too small; otherwise the bound was reached.
  report.status = hopeless ? Status::step_too_small : Status::not_converged;
  std::string culprit;
  if (under_way_.integrator->culprit() >= 0) {
    culprit = fmt::format(" the error of body \"{}\" asks for short ones;",
                          model_->body_name(plan_->model_body[at(under_way_.integrator->culprit() / 3)]));
  }
  std::string cause = near_branches();
  if (cause.empty()) {
    cause =
        "masses, stiffnesses or damping of very different sizes, or a tolerance near rounding; give a larger tolerance "
        "or max_steps";
  }
  report.message =
      fmt::format("{} steps led to t = {:.12g} s, {} than max_steps = {} are needed at this pace;{} likely cause: {}",
                  taken, t_, hopeless ? "many more" : "more", options_.max_steps, culprit, cause);
  return report;
}

}  // namespace catena
