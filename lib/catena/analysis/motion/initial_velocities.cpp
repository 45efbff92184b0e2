#include "catena/analysis/motion/initial_velocities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/pose/dead_point.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/analysis/pose/scaling.hpp"
#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/assembly/systems/constraint_solver.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of components with mass that are given, times their mass: a ratio that a few rounds take to rounding.
constexpr double given_weight = 1e4;
// A massless component counts with its small mass, 1e-4 of the constrained mass; a given one thus weighs more than that
// mass.
constexpr double given_massless_weight = 1e8;

}  // namespace

WantedVelocities wanted_velocities(const Evaluator& evaluator, const MassMatrix& masses,
                                   std::span<const double> given) {
  const Plan& plan = evaluator.plan();
  const std::size_t coordinates = at(3 * plan.moving);
  WantedVelocities wanted{std::vector<double>(coordinates, 0.0), std::vector<double>(coordinates, 0.0),
                          std::vector<char>(coordinates, 0), std::vector<char>(coordinates, 0)};
  for (const int c : plan.coordinate) {
    const int k = c % 3;
    const auto& body = evaluator.model().bodies[at(plan.model_body[at(c / 3)])];
    const double mass = masses.mass[at(c)];
    const bool massless = !(mass > 0);
    wanted.weight[at(c)] = massless ? masses.substitute[at(c)] : mass;
    if (!given.empty()) {
      wanted.given[at(c)] = !massless;
      wanted.velocity[at(c)] = given[at(c)];
    } else if (k == 2) {
      wanted.given[at(c)] = body.angular_velocity_given;
      wanted.velocity[at(c)] = body.angular_velocity_given ? body.angular_velocity : 0;
    } else if (body.velocity_given) {
      wanted.given[at(c)] = 1;
      // From the author's origin to the centroid.
      const double omega = body.angular_velocity_given ? body.angular_velocity : 0;
      const Vec2<double> arm = evaluator.frames()[at(c / 3)].axis(body.origin);
      const Vec2<double> v = body.velocity - omega * perpendicular(arm);
      wanted.velocity[at(c)] = k == 0 ? v.x : v.y;
    }
    wanted.follows[at(c)] = massless && !wanted.given[at(c)];
    if (wanted.given[at(c)]) wanted.weight[at(c)] *= massless ? given_massless_weight : given_weight;
    if (wanted.follows[at(c)] && !given.empty()) wanted.weight[at(c)] *= given_weight;
  }
  return wanted;
}

namespace {

// No velocities meet the equations: `worst` of them is missed by `left`, m/s or rad/s.
void report_contradiction(Evaluator& evaluator, std::span<const double> q, int worst, double left,
                          VelocityOutcome& outcome) {
  outcome.dead_point = find_dead_point(evaluator, q);
  if (outcome.dead_point) {
    static_cast<Report&>(outcome) = outcome.dead_point->report_lock_up(evaluator.model());
    return;
  }
  const Plan& plan = evaluator.plan();
  const Model& model = evaluator.model();
  const int element = worst < 0 ? 0 : plan.row_element[at(worst)];
  const std::string against = element_names(model, elements_against(analyse_mobility(evaluator, q), model, element));
  outcome.status = Status::inconsistent;
  outcome.message = fmt::format(
      "no velocities meet all constraints and drivers at t = {:.12g} s: {} \"{}\"{} misses by {:.3g} {}/s; likely "
      "cause: "
      "drivers that contradict each other, or a driver that starts with a jump",
      evaluator.time(), model.element_type(element), model.element_name(element),
      against.empty() ? "" : " contradicts " + against + " and", left,
      worst >= 0 && plan.row_is_angle[at(worst)] ? "rad" : "m");
}

/// The equations of velocities at the evaluator's configuration.
struct VelocityRows {
  const Plan& plan;
  double length;
  Scaling scaling;
  std::vector<double> jacobian, nu;

  explicit VelocityRows(Evaluator& evaluator)
      : plan(evaluator.plan()),
        length(evaluator.length_scale()),
        scaling(plan, length),
        jacobian(at(plan.trash_slot()) + 1),
        nu(at(plan.rows)) {
    evaluator.start_jacobian(jacobian);
    evaluator.jacobian(jacobian);
    evaluator.nu(nu);
  }
  /// rest = nu - Phi_q v; its size.
  double find_rest(std::span<const double> v, std::vector<double>& rest) const {
    rest = nu;
    for (int c = 0; c < plan.columns; ++c) {
      const double rate = v[at(plan.coordinate[at(c)])];
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
        rest[at(plan.jacobian.row_index[at(k)])] -= jacobian[at(k)] * rate;
    }
    return scaling.row_norm(rest);
  }
  double size(std::span<const double> v) const { return scaling.coordinate_norm(plan, v); }
};

// Whether velocities, all of which are known, meet the equations to rounding: as they are, or with the change that the
// factors of the motion give, which have the same metric.
bool meets_constraints(EquationsOfMotion& equations, std::span<const double> q, const VelocityRows& rows,
                       std::vector<double>& velocity) {
  std::vector<double> rest, qd(q.size(), 0.0);
  const auto meets = [&](std::span<const double> v) {
    return rows.find_rest(v, rest) <= thresholds::sum_rounding * rows.size(v);
  };
  if (meets(velocity)) return true;
  if (!equations.factorize(equations.evaluator().time(), Side::after, q)) return false;
  std::copy(velocity.begin(), velocity.end(), qd.begin());
  equations.project_velocity(qd, 0);
  if (!meets(qd)) return false;
  velocity.assign(qd.begin(), qd.begin() + static_cast<std::ptrdiff_t>(velocity.size()));
  return true;
}

// The least changes that keep what is given, round after round; then corrections of what they leave of the equations.
// Returns the size of that.
double change_least(ConstraintSolver& solver, const VelocityRows& rows, const WantedVelocities& wanted,
                    std::vector<double>& velocity, std::vector<double>& rest, Counters& counters) {
  std::vector<double> asked = wanted.velocity, step(velocity.size()), lambda(rest.size());
  for (int round = 0; round < rounds_of_velocities; ++round) {
    rows.find_rest(asked, rest);
    solver.solve(rest, step, lambda, counters);
    double change = 0, size = 0;
    for (std::size_t c = 0; c < step.size(); ++c) {
      const double next = asked[c] + step[c];
      const double unit = c % 3 == 2 ? rows.length : 1;
      change = std::max(change, unit * std::abs(next - velocity[c]));
      size = std::max(size, unit * std::abs(next));
      velocity[c] = next;
      if (wanted.given[c]) asked[c] += wanted.velocity[c] - next;
      // This removes the effect of its small mass.
      if (wanted.follows[c]) asked[c] = next;
    }
    if (round > 0 && change <= 1e-15 * size) break;
  }
  double left = std::numeric_limits<double>::infinity();
  // What is left halves at least from round to round: some fifty end it.
  for (;;) {
    const double now = rows.find_rest(velocity, rest);
    const bool shrinks = now < thresholds::least_gain * left;
    left = now;
    if (!shrinks || now == 0) return left;
    solver.solve(rest, step, lambda, counters);
    for (std::size_t c = 0; c < step.size(); ++c) velocity[c] += step[c];
  }
}

// Changes velocities to those that meet the constraints; `known`: all components were given.
void meet_constraints(EquationsOfMotion& equations, std::span<const double> q, const WantedVelocities& wanted,
                      bool known, std::vector<double>& velocity, VelocityOutcome& outcome) {
  Evaluator& evaluator = equations.evaluator();
  const VelocityRows rows(evaluator);
  std::vector<double> rest;
  outcome.missed = rows.find_rest(wanted.velocity, rest);
  if (known && meets_constraints(equations, q, rows, velocity)) return;
  ConstraintSolver solver(evaluator.shared_plan());
  solver.set_metric(wanted.weight);
  if (!solver.factorize(rows.jacobian, evaluator.counters)) {
    outcome.status = Status::singular;
    outcome.message = "initial velocities are not determined: the constraints' Jacobian is not finite";
    return;
  }
  const double left = change_least(solver, rows, wanted, velocity, rest, evaluator.counters);
  const double asked_size = rows.size(wanted.velocity), driven = rows.scaling.row_norm(rows.nu);
  // Velocities of which constraints leave nothing but rounding are forbidden altogether: no motion whose energy could
  // be watched.
  if (driven == 0 && rows.size(velocity) <= thresholds::carried_rounding * asked_size)
    std::fill(velocity.begin(), velocity.end(), 0.0);
  const double scale = std::max({rows.size(velocity), asked_size, driven});
  if (left <= 1e-9 * scale) return;
  int worst = -1;
  row_norm(rows.plan, rest, evaluator.length_scale(), &worst);
  report_contradiction(evaluator, q, worst, left, outcome);
}

}  // namespace

VelocityOutcome find_initial_velocities(EquationsOfMotion& equations, std::span<const double> q,
                                        std::span<const double> given, std::span<double> qd) {
  VelocityOutcome outcome;
  Evaluator& evaluator = equations.evaluator();
  const Plan& plan = evaluator.plan();
  evaluator.set_configuration(q);
  const WantedVelocities wanted = wanted_velocities(evaluator, equations.masses(), given);
  std::vector<double> velocity = wanted.velocity;
  const bool known = !given.empty() && equations.masses().massless.empty();
  if (plan.rows > 0) meet_constraints(equations, q, wanted, known, velocity, outcome);
  if (!outcome.ok()) return outcome;
  std::fill(qd.begin(), qd.end(), 0.0);
  std::copy(velocity.begin(), velocity.end(), qd.begin());
  const Scaling scaling(plan, evaluator.length_scale());
  const double largest =
      std::max(scaling.coordinate_norm(plan, velocity), scaling.coordinate_norm(plan, wanted.velocity));
  for (const int c : plan.coordinate) {
    const double change = std::abs(velocity[at(c)] - wanted.velocity[at(c)]);
    const double part = change / (c % 3 == 2 ? 1 : evaluator.length_scale()) / largest;
    if (wanted.given[at(c)] && part > outcome.changed_part) {
      outcome.changed = change;
      outcome.changed_part = part;
      outcome.changed_turn = c % 3 == 2;
      outcome.changed_body = plan.model_body[at(c / 3)];
    }
  }
  return outcome;
}

}  // namespace catena
