#include "catena/analysis/modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/certificate.hpp"
#include "catena/analysis/equations_of_motion.hpp"
#include "catena/analysis/mass_matrix.hpp"
#include "catena/analysis/modes_search.hpp"
#include "catena/analysis/process_time.hpp"
#include "catena/analysis/state_conversion.hpp"
#include "catena/analysis/static_balance.hpp"
#include "catena/analysis/time_coverage.hpp"
#include "catena/analysis/watched_elements.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

constexpr int default_count = 10;

// Whether any motion loses power to damping.
bool is_damped(const Evaluator& evaluator) {
  std::vector<double> qd(at(evaluator.plan().coordinates()), 0.0);
  for (int k = 0; k < 3 * evaluator.plan().moving; ++k) qd[at(k)] = std::sin(1.0 + k) + std::cos(0.7 * k * k);
  return evaluator.dissipation(qd) != 0;
}

}  // namespace

Modes::Modes(std::shared_ptr<const Model> model, const PlanOptions& plan_options, const ModesOptions& options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), plan_options)),
      options_(options),
      evaluator_(plan_, *model_),
      system_(evaluator_),
      q_(evaluator_.given_configuration()) {}

void Modes::start_from(const SystemState& state) {
  t_ = state.t;
  q_ = configuration_of(evaluator_, state);
  moving_ = std::any_of(state.qd.begin(), state.qd.end(), [](double v) { return v != 0; });
}

SystemState Modes::state() const { return state_of(evaluator_, t_, q_); }

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
  if (!evaluator_.conservative()) {
    return end({Status::refused,
                "follower forces have no energy, and the modes of forces without one are not built; give the forces in "
                "ground axes",
                {}});
  }
  if (Report functions = check_time_functions(*model_, {t_, t_}); !functions.ok()) return end(std::move(functions));
  evaluator_.set_time(t_);
  if (Report assembly = assemble_for_statics(system_, q_); !assembly.ok()) return end(std::move(assembly));
  if (Report ends = WatchedElements(evaluator_).check_ends(); !ends.ok()) return end(std::move(ends));
  MassMatrix masses;
  if (Report missing = masses.load(evaluator_); !missing.ok()) return end(std::move(missing));
  if (!masses.massless.empty()) {
    EquationsOfMotion equations(evaluator_);
    Report undetermined = equations.use_masses();
    if (undetermined.ok()) undetermined = equations.check_massless(q_);
    if (!undetermined.ok()) return end(std::move(undetermined));
    system_.move_to(q_);
  }
  std::vector<double> mass(at(plan_->columns)), lambda(at(plan_->rows));
  for (int c = 0; c < plan_->columns; ++c) mass[at(c)] = masses.mass[at(plan_->coordinate[at(c)])];
  const Imbalance left = balance_loads(system_, lambda);
  if (is_damped(evaluator_)) report.warnings.emplace_back("damping is left out: these are the undamped modes");
  if (moving_) report.warnings.emplace_back("velocities are left out: these are the modes of the mechanism at rest");

  ModeSearch search(system_, lambda, std::move(mass), go_on);
  std::vector<Mode> modes;
  const int wanted = options_.count > 0 ? options_.count : default_count;
  Report outcome = search.find(std::min(wanted, plan_->columns), modes);
  if (!left.negligible()) {
    const int body = plan_->model_body[at(plan_->coordinate[at(left.column)] / 3)];
    report.warnings.push_back(fmt::format(
        "the configuration is no equilibrium: {:.3g} N would set body \"{}\" in motion; an equilibrium analysis before "
        "this one finds the place about which it oscillates",
        left.force, model_->body_name(body)));
  }
  report.unstable = search.unstable();
  for (Mode& mode : modes) {
    report.omega2.push_back(mode.omega2);
    report.omega.push_back(std::sqrt(std::abs(mode.omega2)));
    const double sense = std::copysign(1.0, decisive_component(*plan_, mode.shape));
    for (double& x : mode.shape) x *= sense;
    report.shapes.push_back(std::move(mode.shape));
  }
  const int found = static_cast<int>(modes.size());
  if (outcome.ok() && found == 0) {
    report.warnings.emplace_back("nothing can move: there are no modes");
  } else if (outcome.ok() && found < options_.count) {
    report.warnings.push_back(fmt::format("{} degree{} of freedom: {} mode{} instead of {}", found,
                                          found > 1 ? "s" : "", found, found > 1 ? "s" : "", options_.count));
  }
  if (report.unstable > 0) {
    report.warnings.push_back(fmt::format("unstable: {} mode{} with a negative omega2, the lowest: {}", report.unstable,
                                          report.unstable > 1 ? "s" : "",
                                          describe_mode(evaluator_, report.shapes.front(), system_.radius())));
  }
  return end(std::move(outcome));
}

}  // namespace catena
