#include "catena/analysis/motion/impulses.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/analysis/pose/minimum_norm.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/reaction.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Impulses below this part of the largest, or of the largest momentum, are rounding: velocities are known to 1e-12 of
// the largest, and a system of a condition of 10^2 leaves this.
constexpr double rounding = 1e-10;
// Instants since the last breakpoint at which the largest rate of a driver is looked for.
constexpr int looks = 8;

/// The least of all that balance the same.
void choose_least(Evaluator& evaluator, std::span<const double> q, std::vector<double>& p) {
  const Plan& plan = evaluator.plan();
  const std::vector<double> jacobian = jacobian_values(evaluator, q);
  std::vector<double> by_column(at(plan.columns), 0.0), loads(at(plan.coordinates()), 0.0), least(p.size(), 0.0);
  multiply_transposed_add(plan.jacobian, jacobian, p, by_column);
  for (int c = 0; c < plan.columns; ++c) loads[at(plan.coordinate[at(c)])] = by_column[at(c)];
  MinimumNorm minimum_norm(evaluator);
  if (!minimum_norm.factorize()) return;
  minimum_norm.solve(loads, least);
  p.swap(least);
}

/// p dPhi/dc: Phi contains -c, or -c^2 where distances are squared.
double load_of(const Evaluator& evaluator, int element, double multiplier) {
  const Model& model = evaluator.model();
  bool squared = false;
  with_list(model.constraints, model.elements[at(element)].type,
            [&](const auto& list) { squared = HasSquaredValue<ElementOf<decltype(list)>>; });
  return squared ? -2 * evaluator.element_value(element).f * multiplier : -multiplier;
}

}  // namespace

std::vector<double> impulse_of_change(EquationsOfMotion& equations, std::span<const double> before,
                                      std::span<const double> after) {
  const Plan& plan = equations.plan();
  const std::vector<double>& mass = equations.masses().mass;
  // [M, Phi_q^T; Phi_q, 0] [0; p] = [-M (qd+ - qd-); 0]
  std::vector<double> loads(at(plan.coordinates()), 0.0), none(loads), gamma(at(plan.rows), 0.0), p(gamma);
  for (std::size_t c = 0; c < mass.size(); ++c) loads[c] = -mass[c] * (after[c] - before[c]);
  equations.solve_motion(loads, gamma, none, p);
  return p;
}

std::vector<ConstraintImpulse> impulses_of(EquationsOfMotion& equations, std::span<const double> q,
                                           std::span<const double> qd, std::vector<double> p) {
  Evaluator& evaluator = equations.evaluator();
  const Plan& plan = evaluator.plan();
  const Model& model = evaluator.model();
  evaluator.set_configuration(q);
  if (equations.is_dependent()) choose_least(evaluator, q, p);
  Snapshot snapshot{.evaluator = evaluator, .q = q};
  snapshot.lambda = p;
  std::vector<ConstraintImpulse> impulses;
  std::vector<double> sizes;
  for (int row = 0; row < plan.rows; ++row) {
    const int element = plan.row_element[at(row)];
    if (plan.element_row[at(element)] != row) continue;
    const ElementReactions reactions = element_reactions(snapshot, element);
    const Reaction& on_j = reactions.on_j;
    ConstraintImpulse impulse{element, on_j.force.x, on_j.force.y, on_j.torque, 0};
    if (model.elements[at(element)].kind == ElementKind::driver)
      impulse.load = load_of(evaluator, element, reactions.multiplier[0]);
    sizes.push_back(
        std::max({std::abs(impulse.x), std::abs(impulse.y),
                  std::max(std::abs(impulse.moment), std::abs(reactions.on_i.torque)) / evaluator.length_scale()}));
    impulses.push_back(impulse);
  }
  double largest = sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
  const std::vector<double>& mass = equations.masses().mass;
  for (std::size_t c = 0; c < mass.size(); ++c)
    largest = std::max(largest, std::abs(mass[c] * qd[c]) / (c % 3 == 2 ? evaluator.length_scale() : 1));
  std::vector<ConstraintImpulse> told;
  for (std::size_t k = 0; k < impulses.size(); ++k) {
    if (sizes[k] > rounding * largest) told.push_back(impulses[k]);
  }
  std::sort(told.begin(), told.end(), [](const auto& a, const auto& b) { return a.element < b.element; });
  return told;
}

std::vector<int> drivers_that_jump(Evaluator& evaluator, double from, double t) {
  const Plan& plan = evaluator.plan();
  std::vector<int> drivers;  // and others, whose value does not change
  std::vector<double> before, after, largest;
  for (int row = 0; row < plan.rows; ++row) {
    const int element = plan.row_element[at(row)];
    if (plan.element_row[at(element)] == row) drivers.push_back(element);
  }
  const auto rates = [&](double instant, Side side) {
    evaluator.set_time(instant, side);
    std::vector<double> found;
    for (const int driver : drivers) found.push_back(evaluator.element_value(driver).d);
    return found;
  };
  largest.assign(drivers.size(), 0.0);
  const auto note = [&](const std::vector<double>& rate) {
    for (std::size_t k = 0; k < rate.size(); ++k) largest[k] = std::max(largest[k], std::abs(rate[k]));
  };
  for (int n = 1; n < looks; ++n) note(rates(from + (t - from) * n / looks, Side::after));
  note(before = rates(t, Side::before));
  note(after = rates(t, Side::after));
  std::vector<int> jump;
  for (std::size_t k = 0; k < drivers.size(); ++k) {
    if (std::abs(after[k] - before[k]) > thresholds::no_jump * largest[k]) jump.push_back(drivers[k]);
  }
  std::sort(jump.begin(), jump.end());
  return jump;
}

std::vector<std::pair<int, double>> work_of_drivers(Evaluator& evaluator, const Jolt& jolt) {
  std::vector<std::pair<int, double>> work;
  for (const ConstraintImpulse& impulse : jolt.impulses) {
    if (evaluator.model().elements[at(impulse.element)].kind != ElementKind::driver) continue;
    evaluator.set_time(jolt.t, Side::before);
    const double before = evaluator.element_value(impulse.element).d;
    evaluator.set_time(jolt.t, Side::after);
    const double after = evaluator.element_value(impulse.element).d;
    work.emplace_back(impulse.element, impulse.load * (before + after) / 2);
  }
  return work;
}

}  // namespace catena
