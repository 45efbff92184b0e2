#include "catena/analysis/sensitivity/kinematic_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "catena/base/at.hpp"

namespace catena {

KinematicDerivatives::KinematicDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters)
    : StateDerivatives(evaluator, models, parameters), system_(evaluator.shared_plan(), SaddleBlock::none) {
  if (groups().empty() || !AdjointMechanism::why_not(evaluator.model()).empty()) return;
  tangents_ = std::make_unique<MechanismTangents>(this->evaluator());
  for (Group& group : groups()) reached_.emplace_back(*tangents_, group.mechanism);
  width_ = groups().size() * parameters_at_once;
  for (auto* rows : {&q_, &qd_, &qdd_, &loads_}) rows->assign(at(plan().coordinates()) * width_, 0.0);
  for (auto* rows : {&phi_, &rates_, &bends_}) rows->assign(at(plan().rows) * width_, 0.0);
  side_.resize(at(plan().rows));
  place_.resize(at(plan().coordinates()));
}

bool KinematicDerivatives::solve_rows(const std::vector<double>& rows, std::vector<double>& x, bool places) {
  if (system_.solves_in_lanes()) {
    for (std::size_t first = 0; first < width_; first += parameters_at_once) {
      for (std::size_t r = 0; r < side_.size(); ++r) side_[r] = -Lanes::load(rows.data() + r * width_ + first);
      system_.solve_places(side_, place_);
      for (const int c : plan().coordinate) place_[at(c)].store(x.data() + at(c) * width_ + first);
    }
    return true;
  }
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  for (std::size_t p = 0; p < at(parameters()); ++p) {
    std::fill(f.begin(), f.end(), 0.0);
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -rows[r * width_ + p];
    if (!system_.solve(f, b)) return false;
    for (const int c : plan().coordinate) x[at(c) * width_ + p] = f[at(c)];
    const int row = places ? system_.contradicted_row() : -1;
    if (row < 0) continue;
    leave_out_parameter(groups()[p / parameters_at_once], p % parameters_at_once, row);
    for (const int c : plan().coordinate) x[at(c) * width_ + p] = std::numeric_limits<double>::quiet_NaN();
  }
  return true;
}

bool KinematicDerivatives::find_by_tangents(const Snapshot& snapshot, Side side) {
  const bool velocity = !snapshot.qd.empty(), acceleration = velocity && !snapshot.qdd.empty();
  const bool reacts = acceleration && !snapshot.lambda.empty();
  tangents_->set_motion(evaluator(), snapshot.qd, snapshot.qdd, side);
  const auto cleared = [](std::vector<double>& rows, bool wanted) {
    if (wanted) std::fill(rows.begin(), rows.end(), 0.0);
    return wanted ? std::span<double>(rows) : std::span<double>();
  };
  const TangentSums own{.loads = cleared(loads_, reacts),
                        .phi = cleared(phi_, true),
                        .rates = cleared(rates_, velocity),
                        .bends = cleared(bends_, acceleration)};
  for (std::size_t g = 0; g < groups().size(); ++g) {
    tangents_->add_parameters(groups()[g].mechanism, reached_[g], snapshot.lambda, snapshot.qdd, g * parameters_at_once,
                              width_, own);
  }
  if (!solve_rows(phi_, q_, true)) return false;
  if (velocity) {
    tangents_->add_along(evaluator(), {}, q_, qd_, width_, {.rates = rates_});
    if (!solve_rows(rates_, qd_, false)) return false;
  }
  if (acceleration) {
    TangentSums sums{.bends = bends_};
    if (reacts) sums.loads = loads_;
    tangents_->add_along(evaluator(), snapshot.lambda, q_, qd_, width_, sums);
    if (!solve_rows(bends_, qdd_, false)) return false;
  }
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  for (std::size_t g = 0, first = 0; g < groups().size(); ++g, first += parameters_at_once) {
    Group& group = groups()[g];
    for (const int coordinate : plan().coordinate) {
      const std::size_t c = at(coordinate);
      const auto take = [&](const std::vector<double>& rows, DesignScalar& x) {
        std::copy_n(rows.data() + c * width_ + first, parameters_at_once, x.d.data());
      };
      take(q_, group.q[c]);
      if (velocity) take(qd_, group.qd[c]);
      if (acceleration) take(qdd_, group.qdd[c]);
    }
    for (std::size_t p = 0; reacts && p < at(group.count); ++p) {
      std::fill(b.begin(), b.end(), 0.0);
      for (std::size_t c = 0; c < f.size(); ++c) {
        const bool has_mass = c < at(3 * plan().moving);
        f[c] = loads_[c * width_ + first + p];
        if (has_mass) f[c] -= group.mechanism.mass(static_cast<int>(c)).v * qdd_[c * width_ + first + p];
      }
      if (!system_.solve(f, b)) return false;
      for (std::size_t r = 0; r < b.size(); ++r) group.lambda[r].d[p] = b[r];
    }
    if (reacts && !system_.dependent_rows().empty()) leave_out_reactions(group);
  }
  has_rates_ = velocity;
  found_t_ = snapshot.t;
  is_complete_ = false;
  return true;
}

void KinematicDerivatives::complete_state() {
  if (is_complete_) return;
  is_complete_ = true;
  for (Group& group : groups()) {
    group.mechanism.set_time(found_t_);
    if (has_rates_)
      group.mechanism.set_state(group.q, group.qd);
    else
      group.mechanism.set_state(group.q);
  }
}

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
    if (const int row = level == 0 ? system_.contradicted_row() : -1; row >= 0) leave_out_parameter(group, p, row);
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
  const bool regular = system_.factorize(jacobian(), [] {});
  const auto singular = [&] {
    return fail(fmt::format("at t = {:.9g} s the mechanism is in a singular configuration, which has no derivative",
                            snapshot.t));
  };
  if (!regular) return singular();
  is_complete_ = true;
  if (tangents_ && side == Side::after) {
    for (std::size_t g = 0; g < groups().size(); ++g) {
      if (reached_[g].asks_mechanism()) groups()[g].mechanism.set_time(snapshot.t, side);
      lift_state(groups()[g], snapshot);
    }
    return find_by_tangents(snapshot, side) || singular();
  }
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
