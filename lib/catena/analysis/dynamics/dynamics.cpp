#include "catena/analysis/dynamics/dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
  contact_loads_.assign(contacts ? model_->elements.size() : 0, {});
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
  start_ = singular_start();
  std::optional<RedundantRows::GenericPlace> elsewhere;
  if (start_) {
    singular_points_.push_back(start_->point);
    if (!start_->report.ok()) return start_->report;
    elsewhere = place_along(*start_);
  }
  redundant_.find(q_, elsewhere ? &*elsewhere : nullptr);
  if (Report massless = equations_.check_massless(q_); !massless.ok()) return massless;
  const VelocityOutcome velocities = find_initial_velocities(equations_, q_, given_qd_, qd_);
  if (velocities.dead_point) singular_points_.push_back(*velocities.dead_point);
  if (!velocities.ok()) return velocities;
  if (velocities.changed > 1e-9) {
    warnings.push_back(fmt::format(
        "{} did not meet the constraints: changed by up to {:.3g} {} (body \"{}\")",
        given_qd_.empty() ? std::string("the given velocities") : fmt::format("the velocities at t = {:.12g} s", t_),
        velocities.changed, velocities.changed_turn ? "rad/s" : "m/s", model_->body_name(velocities.changed_body)));
  }
  if (start_) {
    // Of all velocities that the constraints allow there the motion has this one.
    const std::vector<double>& tangent = start_->point.tangents[static_cast<std::size_t>(start_->branch - 1)];
    const double speed = start_->point.kind == SingularPoint::Kind::rest ? 0 : 1;
    for (std::size_t k = 0; k < qd_.size(); ++k) qd_[k] = speed * tangent[k];
  }
  take_note_of_start();
  prepared_ = true;
  return {};
}

// Where an event engaged constraints, velocities that these change are a blow to the mechanism.
void Dynamics::take_note_of_start() {
  const std::string event = std::exchange(jolting_event_, {});
  if (event.empty() || given_qd_.size() != qd_.size() || !equations_.factorize(t_, Side::after, q_)) return;
  jolts_.push_back({t_, event, {}, impulses_of(equations_, q_, qd_, impulse_of_change(equations_, given_qd_, qd_))});
}

double Dynamics::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& function : model_->functions) next = std::min(next, function.next_breakpoint(t));
  return next;
}

}  // namespace catena
