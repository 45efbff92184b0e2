#include "catena/analysis/stability/modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/analysis/motion/mass_matrix.hpp"
#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/analysis/run/watched_elements.hpp"
#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/modes_dense.hpp"
#include "catena/analysis/spectrum/modes_search.hpp"
#include "catena/analysis/statics/active_set_at.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The option of a scene that does not say how many.
constexpr int default_count = 10;
// Degrees of freedom up to which all modes are computed at once where a third of them or more are wanted: some ten
// seconds.
constexpr int most_complete_freedoms = 1500;
// Of the floor, a bound of rounding: of all of it 300 random oscillators had 0.0089 at most and 0.0012 at the median.
constexpr double usual_part = 0.03;

// A mode is zero where its stiffness is within the floor.
void find_errors(const StiffnessFloor& floor, std::vector<Mode>& modes) {
  for (Mode& mode : modes) mode.error = mode.omega2 != 0 ? usual_part * floor(mode.shape) : 0;
}

// What these modes leave out.
void warn_of_motion(Evaluator& evaluator, bool moving, ModesReport& report) {
  if (is_damped(evaluator)) {
    report.warnings.emplace_back(evaluator.conservative()
                                     ? "damping is left out: these are the undamped modes"
                                     : "damping is left out: these are the undamped modes; under forces without "
                                       "an energy a little damping may bring flutter on earlier");
  }
  if (moving) report.warnings.emplace_back("velocities are left out: these are the modes of the mechanism at rest");
}

// The lowest modes, no more than `wanted`, to the report; what is free or unstable counts all.
void list_modes(std::vector<Mode>& modes, int wanted, const Plan& plan, ModesReport& report) {
  for (const Mode& mode : modes) {
    report.unstable += mode.omega2 < 0;
    report.free_motions += mode.omega2 == 0;
  }
  modes.resize(std::min(modes.size(), at(wanted)));
  for (Mode& mode : modes) {
    report.omega2.push_back(mode.omega2);
    report.omega.push_back(std::sqrt(std::abs(mode.omega2)));
    report.errors.push_back(mode.error);
    const double sense = std::copysign(1.0, decisive_component(plan, mode.shape));
    for (double& x : mode.shape) x *= sense;
    report.shapes.push_back(std::move(mode.shape));
  }
}

void remark_on_modes(const Report& outcome, int asked, const Evaluator& evaluator, std::span<const double> radius,
                     ModesReport& report) {
  const int found = static_cast<int>(report.omega2.size());
  if (outcome.ok() && found == 0) {
    report.warnings.emplace_back("nothing can move: there are no modes");
  } else if (outcome.ok() && found < asked) {
    report.warnings.push_back(fmt::format("{} degree{} of freedom: {} mode{} instead of {}", found,
                                          found > 1 ? "s" : "", found, found > 1 ? "s" : "", asked));
  }
  if (report.free_motions > 0) {
    report.warnings.push_back(fmt::format("free to second order, with omega2 = 0: {}",
                                          describe_free_motions(report.free_motions, report.free_bodies)));
  }
  if (report.unstable > 0) {
    report.warnings.push_back(fmt::format("unstable: {} mode{} with a negative omega2, the lowest: {}", report.unstable,
                                          report.unstable > 1 ? "s" : "",
                                          describe_mode(evaluator, report.shapes.front(), radius)));
  }
}

}  // namespace

Modes::Modes(std::shared_ptr<const Model> model, const PlanOptions& plan_options, const ModesOptions& options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), with_gaps(plan_options))),
      options_(options),
      evaluator_(plan_, *model_, evaluation_),
      system_(evaluator_),
      q_(evaluator_.given_configuration()) {}

void Modes::start_from(const SystemState& state) {
  t_ = state.t;
  q_ = configuration_of(evaluator_, state);
  moving_ = std::any_of(state.qd.begin(), state.qd.end(), [](double v) { return v != 0; });
}

SystemState Modes::state() const { return state_of(evaluator_, t_, q_); }

Report Modes::undetermined(int column) const {
  const int coordinate = plan_->coordinate[at(column)];
  return {
      Status::refused,
      fmt::format("the motion of body \"{}\" is not determined: its {} is zero and no constraint ties it to a body "
                  "with mass",
                  model_->body_name(plan_->model_body[at(coordinate / 3)]), coordinate % 3 == 2 ? "inertia" : "mass"),
      {}};
}

// The `count` lowest modes and all that are zero or negative, where dense algebra is affordable; of a larger mechanism
// the `count` lowest.
Report Modes::find_modes(const MassMatrix& masses, std::span<const double> mass, std::span<const double> lambda,
                         double residual, int count, std::vector<Mode>& modes, const std::function<bool()>& go_on) {
  system_.fill(lambda, Curvature::exact, 0);
  MotionGroups groups(system_, added_.empty());
  const StiffnessFloor floor(system_, lambda, residual, &groups);
  // For nearly all modes of a larger mechanism dense algebra is faster as well.
  const bool most_of_all = 3 * static_cast<std::int64_t>(count) >= groups.freedoms();
  if (groups.are_small(most_of_all ? most_complete_freedoms : MotionGroups::usual_freedoms)) {
    const DenseModes dense(system_, groups, mass, go_on, added_);
    if (dense.cancelled()) return {Status::cancelled, "stopped while modes were looked for", {}};
    if (dense.massless_column()) return undetermined(*dense.massless_column());
    if (!dense.ok()) {
      return {
          Status::not_converged, "the eigenvalues of the stiffness did not settle: is a number in it infinite?", {}};
    }
    modes = dense.lowest(count, floor);
    find_errors(floor, modes);
    return {};
  }
  if (!added_.empty()) {
    return {Status::refused,
            fmt::format("compliant contacts that are closed in mechanisms of more than {} degrees of freedom: modes do "
                        "not treat these; leave out k",
                        MotionGroups::usual_freedoms),
            {}};
  }
  if (!masses.massless.empty()) {
    EquationsOfMotion equations(evaluator_);
    Report report = equations.use_masses();
    if (report.ok()) report = equations.check_massless(q_);
    if (!report.ok()) return report;
    system_.move_to(q_);
  }
  ModeSearch search(system_, lambda, {mass.begin(), mass.end()}, floor, go_on);
  Report report = search.find(std::min(count, plan_->columns), modes);
  hidden_unstable_ = search.unstable();
  find_errors(floor, modes);
  return report;
}

void Modes::soften(ActiveSet& set, std::span<const double> lambda) {
  added_.clear();
  for (std::size_t g = 0; g < set.closed.size(); ++g) {
    const int row = plan_->gap_rows[g];
    const Compliance law = compliance_of(*model_, plan_->row_element[at(row)]);
    if (!set.closed[g] || !law.compliant()) continue;
    AddedSpring spring{law.stiffness_beside(-lambda[at(row)]), std::vector<double>(at(plan_->columns), 0.0)};
    for (int c = 0; c < plan_->columns; ++c) {
      for (int k = plan_->jacobian.column_start[at(c)]; k < plan_->jacobian.column_start[at(c) + 1]; ++k) {
        if (plan_->jacobian.row_index[at(k)] == row) spring.g[at(c)] = system_.jacobian()[at(k)];
      }
    }
    added_.push_back(std::move(spring));
    set.closed[g] = 0;
  }
  if (added_.empty()) return;
  system_.close_gaps(set.closed);
  system_.move_to(q_);
}

Report Modes::take_place(std::span<double> lambda, Imbalance& left, ModesReport& report) {
  if (!system_.has_gaps()) {
    if (Report assembly = assemble_for_statics(system_, q_); !assembly.ok()) return assembly;
    left = balance_loads(system_, lambda);
    return {};
  }
  ActiveSet set;
  if (Report closed = close_gaps_at(system_, q_, lambda, set, left); !closed.ok()) return closed;
  report.active = names_of_closed(evaluator_, set);
  if (!evaluator_.conservative()) {
    for (std::string& remark : remarks_on(evaluator_, set)) report.warnings.push_back(std::move(remark));
    return {};
  }
  if (const std::string weak = names_of_weak(evaluator_, set); !weak.empty())
    report.warnings.push_back(taken_as_open(weak));
  soften(set, lambda);
  return {};
}

ModesReport Modes::run(const std::function<bool()>& go_on) {
  const ProcessTimer timer;
  ModesReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan_->rows;
  report.islands = plan_->islands;
  const auto end = [&](Report outcome) {
    report.status = outcome.status;
    report.message = std::move(outcome.message);
    report.counters = evaluator_.counters;
    report.seconds = timer.seconds();
    return report;
  };
  const bool circulatory = !evaluator_.conservative();
  if (Report functions = check_time_functions(*model_, {t_, t_}); !functions.ok()) return end(std::move(functions));
  evaluator_.set_time(t_);
  std::vector<double> mass(at(plan_->columns)), lambda(at(plan_->rows));
  Imbalance left;
  if (Report placed = take_place(lambda, left, report); !placed.ok()) return end(std::move(placed));
  if (Report ends = WatchedElements(evaluator_).check_ends(); !ends.ok()) return end(std::move(ends));
  MassMatrix masses;
  if (Report missing = masses.load(evaluator_); !missing.ok()) return end(std::move(missing));
  for (int c = 0; c < plan_->columns; ++c) mass[at(c)] = masses.mass[at(plan_->coordinate[at(c)])];
  warn_of_motion(evaluator_, moving_, report);
  const int wanted = options_.count > 0 ? options_.count : default_count;
  std::vector<Mode> modes;
  const double residual = left.negligible() ? left.force : 0;
  Report outcome = circulatory ? find_circulatory(mass, lambda, residual, wanted, report)
                               : find_modes(masses, mass, lambda, residual, wanted, modes, go_on);
  if (!left.negligible()) {
    const int body = plan_->model_body[at(plan_->coordinate[at(left.column)] / 3)];
    report.warnings.push_back(fmt::format(
        "the configuration is no equilibrium: {:.3g} N would set body \"{}\" in motion; an equilibrium analysis before "
        "this one finds the place about which it oscillates",
        left.force, model_->body_name(body)));
  }
  if (!circulatory) {
    std::vector<std::vector<double>> free;
    for (const Mode& mode : modes) {
      if (mode.omega2 == 0) free.push_back(mode.shape);
    }
    report.free_bodies = names_of_moving(system_, lambda, free);
    list_modes(modes, wanted, *plan_, report);
    report.unstable = std::max(report.unstable, hidden_unstable_);
    remark_on_modes(outcome, options_.count, evaluator_, system_.radius(), report);
  }
  return end(std::move(outcome));
}

}  // namespace catena
