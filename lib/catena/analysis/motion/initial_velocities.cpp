#include "catena/analysis/motion/initial_velocities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/pose/dead_point.hpp"
#include "catena/analysis/pose/scaling.hpp"
#include "catena/assembly/systems/constraint_projector.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double given_weight = 1e4;
// A massless component counts with its small mass, 1e-4 of the constrained mass; a given one thus weighs more than that
// mass.
constexpr double given_massless_weight = 1e8;
// Velocities are corrected until the constraints' residual no longer shrinks, at most so many times.
constexpr int most_corrections = 4;
// Velocities of which constraints leave no more than this part are forbidden altogether: what is left is rounding, some
// hundred of it, and no motion whose energy could be watched.
constexpr double nothing_left = 1e-13;
// Residuals of this part of the velocities are the rounding of some dozen terms.
constexpr double met = 1e-14;

}  // namespace

WantedVelocities wanted_velocities(const Evaluator& evaluator, const MassMatrix& masses,
                                   std::span<const double> given) {
  const Plan& plan = evaluator.plan();
  WantedVelocities wanted{std::vector<double>(at(plan.columns), 0.0), std::vector<double>(at(plan.columns), 1.0),
                          std::vector<char>(at(plan.columns), 0), std::vector<char>(at(plan.columns), 0)};
  for (int c = 0; c < plan.columns; ++c) {
    const int coordinate = plan.coordinate[at(c)], k = coordinate % 3;
    const auto& body = evaluator.model().bodies[at(plan.model_body[at(coordinate / 3)])];
    const double mass = masses.mass[at(coordinate)];
    const bool massless = !(mass > 0);
    wanted.weight[at(c)] = massless ? masses.substitute[at(coordinate)] : mass;
    if (!given.empty()) {
      wanted.given[at(c)] = !massless;
      wanted.velocity[at(c)] = given[at(coordinate)];
    } else if (k == 2) {
      wanted.given[at(c)] = body.angular_velocity_given;
      wanted.velocity[at(c)] = body.angular_velocity_given ? body.angular_velocity : 0;
    } else if (body.velocity_given) {
      wanted.given[at(c)] = 1;
      // From the author's origin to the centroid.
      const double omega = body.angular_velocity_given ? body.angular_velocity : 0;
      const Vec2<double> arm = evaluator.frames()[at(coordinate / 3)].axis(body.origin);
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
  const int element = worst < 0 ? 0 : evaluator.plan().row_element[at(worst)];
  outcome.status = Status::inconsistent;
  outcome.message = fmt::format(
      "no velocities meet all constraints and drivers at t = {:.12g} s: {} \"{}\" misses by {:.3g}; likely cause: "
      "drivers that contradict each other, or a driver that starts with a jump",
      evaluator.time(), evaluator.model().element_type(element), evaluator.model().element_name(element), left);
}

// Whether velocities, all of which are known, meet the equations to rounding: as they are, or with the change that the
// factors of the motion give, which have the same metric.
bool meets_constraints(EquationsOfMotion& equations, std::span<const double> q, std::span<const double> values,
                       const std::vector<double>& nu, std::vector<double>& velocity) {
  Evaluator& evaluator = equations.evaluator();
  const Plan& plan = evaluator.plan();
  const double length = evaluator.length_scale();
  std::vector<double> rest(nu.size()), back(velocity.size());
  const auto meets = [&](const std::vector<double>& v) {
    for (std::size_t c = 0; c < v.size(); ++c) back[c] = -v[c];
    rest = nu;
    multiply_add(plan.jacobian, values, back, rest);
    return row_norm(plan, rest, length) <= met * column_norm(plan, v, length);
  };
  if (meets(velocity)) return true;
  if (!equations.factorize(evaluator.time(), Side::after, q)) return false;
  std::vector<double> qd(q.size(), 0.0), changed(velocity.size());
  for (int c = 0; c < plan.columns; ++c) qd[at(plan.coordinate[at(c)])] = velocity[at(c)];
  equations.project_velocity(qd, 0);
  for (int c = 0; c < plan.columns; ++c) changed[at(c)] = qd[at(plan.coordinate[at(c)])];
  if (!meets(changed)) return false;
  velocity = changed;
  return true;
}

// Changes velocities to those that meet the constraints; `known`: all components were given.
void meet_constraints(EquationsOfMotion& equations, std::span<const double> q, const WantedVelocities& wanted,
                      bool known, std::vector<double>& velocity, VelocityOutcome& outcome) {
  Evaluator& evaluator = equations.evaluator();
  const Plan& plan = evaluator.plan();
  std::vector<double> jacobian(at(plan.trash_slot()) + 1), nu(at(plan.rows)), rest(nu), lambda(nu);
  std::vector<double> asked = wanted.velocity, step(velocity.size()), inverse(velocity.size());
  for (std::size_t c = 0; c < inverse.size(); ++c) inverse[c] = 1 / wanted.weight[c];
  evaluator.start_jacobian(jacobian);
  evaluator.jacobian(jacobian);
  evaluator.nu(nu);
  const auto values = std::span<const double>(jacobian).first(at(plan.trash_slot()));
  const double length = evaluator.length_scale();
  for (std::size_t c = 0; c < step.size(); ++c) step[c] = -asked[c];
  rest = nu;
  multiply_add(plan.jacobian, values, step, rest);
  outcome.missed = row_norm(plan, rest, length);
  if (known && meets_constraints(equations, q, values, nu, velocity)) return;
  ConstraintProjector projector(evaluator.shared_plan());
  projector.set_inverse_weights(inverse);
  if (!projector.factorize(values, evaluator.counters).ok()) {
    outcome.status = Status::singular;
    outcome.message = "initial velocities are not determined: the constraints' Jacobian is not finite";
    return;
  }
  for (int round = 0; round < rounds_of_velocities; ++round) {
    rest = nu;
    for (std::size_t c = 0; c < step.size(); ++c) step[c] = -asked[c];
    multiply_add(plan.jacobian, values, step, rest);
    projector.solve(rest, step, lambda, evaluator.counters);
    double change = 0, size = 0;
    for (std::size_t c = 0; c < step.size(); ++c) {
      const double next = asked[c] + step[c];
      change = std::max(change, std::abs(next - velocity[c]));
      size = std::max(size, std::abs(next));
      velocity[c] = next;
      if (wanted.given[c]) asked[c] += wanted.velocity[c] - next;
      // This removes the effect of its small mass.
      if (wanted.follows[c]) asked[c] = next;
    }
    if (round > 0 && change <= 1e-15 * size) break;
  }
  int worst = -1;
  double left = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= most_corrections; ++k) {
    rest = nu;
    for (std::size_t c = 0; c < step.size(); ++c) step[c] = -velocity[c];
    multiply_add(plan.jacobian, values, step, rest);
    const double now = row_norm(plan, rest, length, &worst);
    const bool shrinks = now < 0.5 * left;
    left = now;
    if (!shrinks || k == most_corrections || now == 0) break;
    projector.solve(rest, step, lambda, evaluator.counters);
    for (std::size_t c = 0; c < step.size(); ++c) velocity[c] += step[c];
  }
  const double asked_size = column_norm(plan, wanted.velocity, length), driven = row_norm(plan, nu, length);
  if (driven == 0 && column_norm(plan, velocity, length) <= nothing_left * asked_size)
    std::fill(velocity.begin(), velocity.end(), 0.0);
  const double scale = std::max({column_norm(plan, velocity, length), asked_size, driven});
  if (!(left <= 1e-9 * scale)) report_contradiction(evaluator, q, worst, left, outcome);
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
  for (int c = 0; c < plan.columns; ++c) {
    const int coordinate = plan.coordinate[at(c)];
    qd[at(coordinate)] = velocity[at(c)];
    const double change = std::abs(velocity[at(c)] - wanted.velocity[at(c)]);
    if (wanted.given[at(c)] && change > outcome.changed) {
      outcome.changed = change;
      outcome.changed_turn = plan.coordinate[at(c)] % 3 == 2;
      outcome.changed_body = plan.model_body[at(coordinate / 3)];
    }
  }
  return outcome;
}

}  // namespace catena
