#include "catena/analysis/balance/static_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "catena/analysis/balance/force_sizes.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Sums over the terms of the residual, by columns.
std::vector<double> sum_terms(const StaticSystem& system, std::span<const double> sizes,
                              std::span<const double> lambda) {
  const Plan& plan = system.plan();
  const SparsePattern& a = plan.jacobian;
  std::vector<double> sum(at(plan.columns));
  for (int c = 0; c < plan.columns; ++c) {
    sum[at(c)] = sizes[at(plan.coordinate[at(c)])];
    for (int k = a.column_start[at(c)]; k < a.column_start[at(c) + 1]; ++k) {
      sum[at(c)] += std::abs(system.jacobian()[at(k)] * lambda[at(a.row_index[at(k)])]);
    }
  }
  return sum;
}

// Adds, by columns, the change of every element's force (constraints included) for a relative error of one in its
// places.
void add_stiffness_times_places(StaticSystem& system, std::span<const double> lambda, std::span<double> sum) {
  const Plan& plan = system.plan();
  Evaluator& evaluator = system.evaluator();
  const std::span<const Frame<double>> frames = evaluator.frames();
  const auto moves = [&](int b) { return b >= 0 && b < plan.moving; };
  const auto reach = [&](int b) { return moves(b) ? norm(frames[at(b)].origin()) + system.radius()[at(b)] : 0.0; };
  const auto place = [&](int b) { return b >= 0 ? evaluator.ground_frame(b).origin() : Vec2<double>{}; };
  const auto add = [&](int i, int j, const ElementMatrix& m) {
    // The distance of two bodies, or of a body from the ground's origin, to which places in the ground refer.
    const double length = std::max(norm(place(i) - place(j)), system.length()) + reach(i) + reach(j);
    for (int row = 0; row < 6; ++row) {
      const int c = plan.column_of(i, j, row);
      if (c < 0) continue;
      for (int k = 0; k < 6; ++k) {
        const int other = k < 3 ? i : j;
        const double size = k % 3 != 2 ? length : moves(other) ? 1 + std::abs(frames[at(other)].phi) : 1;
        sum[at(c)] += std::abs(m[at(6 * row + k)]) * size;
      }
    }
  };
  evaluator.visit_stiffness({}, add);
  evaluator.visit_constraint_hessians(lambda, add);
}

// Whether all forces are rounding of what transmits them: constraints pass that of one coordinate on to all that they
// tie together, so that among those the largest counts. Where none of these has an applied force, `applied` by
// coordinates, multipliers are left over from elimination and balance nothing.
bool are_rounding(const Plan& plan, std::span<const double> applied, std::span<const double> terms,
                  std::span<const double> floor, std::span<const double> inverse_arms) {
  std::vector<int> leader(terms.size()), first(at(plan.rows), -1), of_body(at(plan.moving), -1);
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int c) {
    while (leader[at(c)] != c) c = leader[at(c)] = leader[at(leader[at(c)])];
    return c;
  };
  const auto tie = [&](int& known, int c) { known < 0 ? known = c : leader[at(find(c))] = find(known); };
  for (int c = 0; c < plan.columns; ++c) {
    tie(of_body[at(plan.coordinate[at(c)] / 3)], c);
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
      tie(first[at(plan.jacobian.row_index[at(k)])], c);
  }
  std::vector<double> force(terms.size(), 0.0), rounding(terms.size(), 0.0), acting(terms.size(), 0.0);
  for (int c = 0; c < plan.columns; ++c) {
    const std::size_t group = at(find(c));
    force[group] = std::max(force[group], terms[at(c)] * inverse_arms[at(c)]);
    rounding[group] = std::max(rounding[group], thresholds::few_roundings * floor[at(c)] * inverse_arms[at(c)]);
    acting[group] = std::max(acting[group], applied[at(plan.coordinate[at(c)])]);
  }
  for (std::size_t group = 0; group < force.size(); ++group) {
    if (acting[group] > 0 && !(force[group] <= rounding[group])) return false;
  }
  return true;
}

}  // namespace

std::vector<double> balance_rounding(StaticSystem& system, std::span<const double> lambda) {
  std::vector<double> rounding = sum_terms(system, force_sizes(system.evaluator()).all, lambda);
  add_stiffness_times_places(system, lambda, rounding);
  for (double& size : rounding) size *= thresholds::few_roundings;
  return rounding;
}

StaticAccuracy judge_balance(StaticSystem& system, std::span<const double> lambda, double tolerance) {
  const Plan& plan = system.plan();
  const std::span<const double> inverse_arms = system.matrix().inverse_arms();
  std::vector<double> residual(at(plan.columns));
  system.residual(lambda, residual);
  const ForceSizes sizes = force_sizes(system.evaluator());
  const std::vector<double> terms = sum_terms(system, sizes.all, lambda);
  StaticAccuracy result;
  bool finite = true;
  for (int c = 0; c < plan.columns; ++c) {
    const double force = std::abs(residual[at(c)]) * inverse_arms[at(c)];
    finite = finite && std::isfinite(force);
    if (result.column < 0 || force > result.residual) {
      result.residual = force;
      result.column = c;
    }
    result.forces = std::max(result.forces, terms[at(c)] * inverse_arms[at(c)]);
    result.loads = std::max(result.loads, sizes.loads[at(plan.coordinate[at(c)])] * inverse_arms[at(c)]);
  }
  const bool loaded = result.loads > 0;
  if (!loaded) result.loads = result.forces;
  const bool shows = result.residual > std::max(StaticAccuracy::shown, tolerance) * result.loads;
  result.balanced = finite && !shows && result.residual <= tolerance * result.forces;
  if (result.balanced || !finite) return result;
  std::vector<double> floor = terms;
  add_stiffness_times_places(system, lambda, floor);
  // Without loads, with springs at their free lengths, all forces are rounding.
  const bool nothing = !loaded && are_rounding(plan, sizes.all, terms, floor, inverse_arms);
  bool rounded = true;
  double worst = -1;
  for (int c = 0; c < plan.columns; ++c) {
    const double force = std::abs(residual[at(c)]), rounding = thresholds::few_roundings * floor[at(c)];
    // What is balanced there needs no rounding: a body without loads may have none.
    if (force * inverse_arms[at(c)] <= tolerance * result.forces) continue;
    rounded = rounded && force <= rounding;
    if (force > worst * rounding) {
      worst = rounding > 0 ? force / rounding : std::numeric_limits<double>::infinity();
      result.rounding = rounding * inverse_arms[at(c)];
    }
  }
  result.rounded = nothing || (rounded && !shows);
  return result;
}

}  // namespace catena
