#include "catena/analysis/spectrum/static_balance.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/analysis/spectrum/motion_groups.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Residual forces below this part of the largest force count as none.
constexpr double balance_rounding = thresholds::carried_rounding;

}  // namespace

Report assemble_for_statics(StaticSystem& system, std::vector<double>& q) {
  system.move_to(q);
  if (system.phi_norm() <= std::max(thresholds::assembled, 10 * system.rounding_change())) return {};
  Assembler assembler(system.evaluator());
  const Report report = assembler.assemble(q);
  system.move_to(q);
  return report;
}

bool Imbalance::negligible() const { return relative <= negligible_part || force <= rounding; }

Imbalance balance_loads(StaticSystem& system, std::span<double> lambda) {
  const Plan& plan = system.plan();
  const std::size_t columns = at(plan.columns);
  std::fill(lambda.begin(), lambda.end(), 0.0);
  std::vector<double> residual(columns);
  if (plan.rows > 0) {
    system.fill_weights();
    if (system.factorize().ok()) {
      // Refined until the multipliers no longer change: in a long chain the load passes through every joint.
      std::vector<double> weight(columns, 0.0), given(columns + lambda.size(), 0.0), x(given.size()),
          correction(given.size());
      for (char angle : plan.row_is_angle) weight.push_back(angle ? 1 / (system.length() * system.length()) : 1);
      for (std::size_t c = 0; c < columns; ++c) given[c] = -system.gradient()[c];
      solve_to_rounding(system, weight, given, x, correction);
      std::copy(x.begin() + plan.columns, x.end(), lambda.begin());
    }
  }
  system.residual(lambda, residual);
  system.fill(lambda, Curvature::exact, 0);
  // Forces and moments over the arms at which the body is held, whatever the units.
  const std::vector<double> arms = body_arms(system, lambda);
  const auto arm = [&](int c) { return plan.coordinate[at(c)] % 3 == 2 ? arms[at(plan.coordinate[at(c)] / 3)] : 1.0; };
  // K applied to places that are off by one extent each, without a pattern.
  std::vector<double> places(columns), forces(columns);
  for (int c = 0; c < plan.columns; ++c) places[at(c)] = (c % 2 ? 1.0 : -1.0) / arm(c);
  system.matrix().multiply_stiffness(places, forces);
  Imbalance left;
  double largest = 0;
  for (int c = 0; c < plan.columns; ++c) {
    const double force = std::abs(residual[at(c)]) / arm(c);
    if (force > left.force || left.column < 0) {
      left.force = force;
      left.column = c;
    }
    left.rounding = std::max(left.rounding, balance_rounding * std::abs(forces[at(c)]) / arm(c) * system.extent());
    double own = std::abs(system.gradient()[at(c)]);
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      own = std::max(own, std::abs(system.jacobian()[at(k)] * lambda[at(plan.jacobian.row_index[at(k)])]));
    }
    largest = std::max(largest, own / arm(c));
  }
  left.relative = largest > 0 ? left.force / largest : 0;
  return left;
}

}  // namespace catena
