#include "catena/analysis/sensitivity/kinematic_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace catena {

KinematicDerivatives::KinematicDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters)
    : StateDerivatives(evaluator, models, parameters), system_(evaluator.shared_plan(), SaddleBlock::none) {}

bool KinematicDerivatives::solve_level(Group& group, int level, std::vector<DesignScalar>& target) {
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  group.mechanism.rows(group.rows);
  for (std::size_t p = 0; p < static_cast<std::size_t>(group.count); ++p) {
    std::fill(f.begin(), f.end(), 0.0);
    for (std::size_t r = 0; r < b.size(); ++r) {
      const Taylor<DesignScalar>& row = group.rows[r];
      b[r] = -(level == 0 ? row.f : level == 1 ? row.d : row.dd).d[p];
    }
    if (!system_.solve(f, b)) return false;
    for (const int coordinate : plan().coordinate) {
      const auto c = static_cast<std::size_t>(coordinate);
      target[c].d[p] = f[c];
    }
  }
  return true;
}

bool KinematicDerivatives::solve_multipliers(Group& group) {
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  group.mechanism.applied_forces(group.loads);
  for (DesignScalar& load : group.loads) load = -load;
  for (int c = 0; c < 3 * plan().moving; ++c)
    group.loads[static_cast<std::size_t>(c)] += group.mechanism.mass(c) * group.qdd[static_cast<std::size_t>(c)];
  group.mechanism.add_constraint_loads(group.lambda, group.loads);
  for (std::size_t p = 0; p < static_cast<std::size_t>(group.count); ++p) {
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = -group.loads[c].d[p];
    std::fill(b.begin(), b.end(), 0.0);
    if (!system_.solve(f, b)) return false;
    for (std::size_t r = 0; r < b.size(); ++r) group.lambda[r].d[p] = b[r];
  }
  if (!system_.dependent_rows().empty()) leave_out_reactions(group);
  return true;
}

bool KinematicDerivatives::solve_values(Group& group, const Snapshot& snapshot) {
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  DesignMechanism& mechanism = group.mechanism;
  const auto solve = [&](int level, std::vector<DesignScalar>& target) {
    mechanism.rows(group.rows);
    std::fill(f.begin(), f.end(), 0.0);
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -(level == 1 ? group.rows[r].d : group.rows[r].dd).v;
    if (!system_.solve(f, b)) return false;
    std::fill(target.begin(), target.end(), DesignScalar());
    for (const int c : plan().coordinate) target[static_cast<std::size_t>(c)] = f[static_cast<std::size_t>(c)];
    return true;
  };
  mechanism.set_state(group.q);
  if (snapshot.qd.empty()) return true;
  if (!solve(1, group.qd)) return false;
  mechanism.set_state(group.q, group.qd);
  if (snapshot.qdd.empty()) return true;
  if (!solve(2, group.qdd)) return false;
  if (snapshot.lambda.empty()) return true;
  mechanism.applied_forces(group.loads);
  for (std::size_t c = 0; c < f.size(); ++c) f[c] = group.loads[c].v;
  for (int c = 0; c < 3 * plan().moving; ++c) {
    const auto k = static_cast<std::size_t>(c);
    f[k] -= mechanism.mass(c).v * group.qdd[k].v;
  }
  std::fill(b.begin(), b.end(), 0.0);
  if (!system_.solve(f, b)) return false;
  lift(b, group.lambda);
  return true;
}

bool KinematicDerivatives::find_at(const Snapshot& snapshot, Side side) {
  evaluator().set_time(snapshot.t, side);
  evaluator().set_configuration(snapshot.q);
  const std::span<const double> phi_q = jacobian();
  bool regular = system_.begin(phi_q) && system_.factorize();
  if (!regular) {
    system_.forget_rows();
    regular = system_.begin(phi_q) && system_.factorize();
  }
  const auto singular = [&] {
    return fail(fmt::format("at t = {:.9g} s the mechanism is in a singular configuration, which has no derivative",
                            snapshot.t));
  };
  if (!regular) return singular();
  const bool velocity = !snapshot.qd.empty(), acceleration = velocity && !snapshot.qdd.empty();
  for (Group& group : groups()) {
    DesignMechanism& mechanism = group.mechanism;
    mechanism.set_time(snapshot.t, side);
    lift_state(group, snapshot);
    if (side == Side::before && !solve_values(group, snapshot)) return singular();
    mechanism.set_state(group.q);
    if (!solve_level(group, 0, group.q)) return singular();
    if (velocity) {
      mechanism.set_state(group.q, group.qd);
      if (!solve_level(group, 1, group.qd)) return singular();
    }
    if (acceleration) {
      mechanism.set_state(group.q, group.qd, group.qdd);
      if (!solve_level(group, 2, group.qdd)) return singular();
    }
    // Multipliers of the limit at a singular configuration are missing.
    if (velocity)
      mechanism.set_state(group.q, group.qd);
    else
      mechanism.set_state(group.q);
    if (acceleration && !snapshot.lambda.empty() && !solve_multipliers(group)) return singular();
  }
  return true;
}

}  // namespace catena
