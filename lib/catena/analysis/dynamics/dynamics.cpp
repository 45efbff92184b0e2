#include "catena/analysis/dynamics/dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/motion/initial_velocities.hpp"
#include "catena/analysis/run/state_conversion.hpp"

namespace catena {
Dynamics::Dynamics(std::shared_ptr<const Model> model, const PlanOptions& plan_options, const DynamicsOptions& options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), plan_options)),
      options_(options),
      evaluator_(plan_, *model_),
      equations_(evaluator_),
      redundant_(equations_),
      watched_(evaluator_) {
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

void Dynamics::attach(ContactLoads* contacts) {
  contacts_ = contacts;
  equations_.attach(contacts);
  const std::size_t elements = contacts ? model_->elements.size() : 0;
  contact_force_.assign(elements, 0.0);
  contact_friction_.assign(elements, 0.0);
  contact_slip_.assign(elements, 0.0);
}

SystemState Dynamics::state() const { return state_of(evaluator_, t_, q_, qd_); }

Report Dynamics::prepare(std::vector<std::string>& warnings) {
  Report masses = equations_.use_masses();
  if (!masses.ok()) return masses;
  constexpr double least_tolerance = DynamicsOptions::least_tolerance;
  if (!(options_.tolerance >= least_tolerance) || !(options_.tolerance < 1)) {
    masses.status = Status::refused;
    masses.message =
        fmt::format("tolerance {:.3g} cannot be met: double precision holds about {:.0e}; give {:.0e} ... 1",
                    options_.tolerance, least_tolerance, least_tolerance);
    return masses;
  }
  if (!(options_.step >= 0) || !std::isfinite(options_.step) || options_.max_steps < 1) {
    masses.status = Status::refused;
    masses.message = fmt::format(
        "a fixed step of {:.3g} s, or max_steps = {}, advances nothing: give numbers above zero, or leave them out",
        options_.step, options_.max_steps);
    return masses;
  }
  evaluator_.set_time(t_);
  Assembler assembler(evaluator_);
  AssemblyOutcome assembled = assembler.assemble(q_);
  if (!assembled.ok()) return assembled;
  if (assembled.moved > 1e-9 * evaluator_.length_scale()) {
    warnings.push_back(fmt::format(
        "the given configuration did not meet the constraints: assembled first, which shifted bodies by up to {:.3g} m "
        "and turned them by up to {:.3g} rad",
        assembled.shifted, assembled.turned));
  }
  equations_.weigh_massless(q_);
  redundant_.find(q_);
  if (Report massless = equations_.check_massless(q_); !massless.ok()) return massless;
  const VelocityOutcome velocities = find_initial_velocities(equations_, q_, given_qd_, qd_);
  if (!velocities.ok()) return velocities;
  if (velocities.changed > 1e-9) {
    warnings.push_back(fmt::format(
        "{} did not meet the constraints: changed by up to {:.3g} {} (body \"{}\")",
        given_qd_.empty() ? std::string("the given velocities") : fmt::format("the velocities at t = {:.12g} s", t_),
        velocities.changed, velocities.changed_turn ? "rad/s" : "m/s", model_->body_name(velocities.changed_body)));
  }
  prepared_ = true;
  return {};
}

double Dynamics::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& function : model_->functions) next = std::min(next, function.next_breakpoint(t));
  return next;
}

}  // namespace catena
