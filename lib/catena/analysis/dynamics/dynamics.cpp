#include "catena/analysis/dynamics/dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catena/analysis/contact/contact_points.hpp"
#include "catena/analysis/contact/unclear_friction.hpp"
#include "catena/analysis/motion/initial_velocities.hpp"
#include "catena/analysis/pose/minimum_norm.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// Where constraints are redundant, at a place that is not singular: the friction of joints needs their reactions.
Report check_joint_friction(Evaluator& evaluator, std::span<const double> q, double t) {
  if (joints_with_friction(evaluator.model()).empty()) return {};
  evaluator.set_configuration(q);
  MinimumNorm reactions(evaluator);
  return reactions.factorize() ? refuse_unclear_friction(evaluator.model(), reactions.find_ambiguous(), t) : Report{};
}

}  // namespace

Dynamics::Dynamics(std::shared_ptr<const Model> model, const PlanOptions& plan_options, const DynamicsOptions& options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), plan_options)),
      options_(options),
      evaluator_(plan_, *model_, evaluation_),
      equations_(evaluator_),
      redundant_(equations_),
      watched_(evaluator_),
      singular_(equations_) {
  q_ = evaluator_.given_configuration();
  qd_.assign(q_.size(), 0.0);
  choose_method(false);
}

void Dynamics::start_from(const SystemState& state) {
  t_ = state.t;
  origin_.prepared = false;
  take_over_places(evaluator_, state, q_);
  origin_.given_qd = velocities_of(evaluator_, state);
}

void Dynamics::attach(ContactLoads* contacts) {
  attached_.contacts = contacts;
  equations_.attach(contacts);
  row_.contact_loads.assign(contacts ? model_->elements.size() : 0, {});
}

SystemState Dynamics::state() const { return state_of(evaluator_, t_, q_, qd_); }

Report Dynamics::check_options() const {
  Report report;
  if (!(options_.tolerance >= DynamicsOptions::least_tolerance) || !(options_.tolerance < 1)) {
    report.status = Status::refused;
    report.message =
        options_.tolerance >= 1
            ? fmt::format("tolerance {:.3g} is no relative error: give one below 1", options_.tolerance)
            : fmt::format("tolerance {:.3g} cannot be met: double precision holds about {:.0e}; give {:.0e} ... 1",
                          options_.tolerance, DynamicsOptions::least_tolerance, DynamicsOptions::least_tolerance);
  } else if (!(options_.step >= 0) || !std::isfinite(options_.step) || options_.max_steps < 1) {
    report.status = Status::refused;
    report.message = fmt::format(
        "a fixed step of {:.3g} s, or max_steps = {}, advances nothing: give numbers above zero, or leave them out",
        options_.step, options_.max_steps);
  }
  return report;
}

// Places and velocities that meet the constraints.
Report Dynamics::prepare(std::vector<std::string>& warnings) {
  if (Report masses = equations_.use_masses(); !masses.ok()) return masses;
  if (Report options = check_options(); !options.ok()) return options;
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
  origin_.singular = singular_start();
  const SingularStart* start = origin_.singular ? &*origin_.singular : nullptr;
  std::optional<RedundantRows::GenericPlace> elsewhere;
  if (start) {
    run_.singular_points.push_back(start->point);
    if (!start->report.ok()) return start->report;
    elsewhere = place_along(*start);
  }
  redundant_.find(q_, elsewhere ? &*elsewhere : nullptr);
  if (redundant_.count() > 0) {
    if (Report unclear = check_joint_friction(evaluator_, elsewhere ? elsewhere->q : q_, t_); !unclear.ok())
      return unclear;
    evaluator_.set_configuration(q_);
  }
  if (Report massless = equations_.check_massless(q_); !massless.ok()) return massless;
  const VelocityOutcome velocities = find_initial_velocities(equations_, q_, origin_.given_qd, qd_);
  if (velocities.dead_point) run_.singular_points.push_back(*velocities.dead_point);
  if (!velocities.ok()) return velocities;
  // Contacts close and stick at speeds that cannot be told from rest; where rows nearly depend on each other these are
  // met by larger ones of the bodies.
  const double at_rest = attached_.contacts ? 2 * no_speed * attached_.contacts->speed() : 0;
  if (velocities.changed_part > thresholds::contradiction && velocities.missed > at_rest) {
    warnings.push_back(fmt::format("{} did not meet the constraints: changed by up to {:.3g} {} (body \"{}\")",
                                   origin_.given_qd.empty() ? std::string("the given velocities")
                                                            : fmt::format("the velocities at t = {:.12g} s", t_),
                                   velocities.changed, velocities.changed_turn ? "rad/s" : "m/s",
                                   model_->body_name(velocities.changed_body)));
  }
  if (start) {
    // Of all velocities that the constraints allow there the motion has this one.
    const std::vector<double>& tangent = start->point.tangents[static_cast<std::size_t>(start->branch - 1)];
    const double speed = start->point.kind == SingularPoint::Kind::rest ? 0 : 1;
    for (std::size_t k = 0; k < qd_.size(); ++k) qd_[k] = speed * tangent[k];
  }
  take_note_of_start();
  origin_.prepared = true;
  return {};
}

// Where an event engaged constraints, velocities that these change are a blow to the mechanism.
void Dynamics::take_note_of_start() {
  const std::string event = std::exchange(origin_.jolting_event, {});
  if (event.empty() || origin_.given_qd.size() != qd_.size() || !equations_.factorize(t_, Side::after, q_)) return;
  run_.jolts.push_back(
      {t_, event, {}, impulses_of(equations_, q_, qd_, impulse_of_change(equations_, origin_.given_qd, qd_))});
}

double Dynamics::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const auto& function : model_->functions) next = std::min(next, function.next_breakpoint(t));
  return next;
}

}  // namespace catena
