// Inverse dynamics at singular configurations: multipliers there are the limit of those on both sides.
//
//   Phi_q^T lambda = Q - M qdd =: f,   at t*  Phi_q z = 0:   lambda = A / (t - t*) + B + C (t - t*) + ...
//
// A vanishes where z^T f does. The motion is known on the bridge (kinematics_bridge.hpp), and a little away from t* the
// equations determine lambda: B and A are the values at t* of the polynomials through lambda and (t - t*) lambda at
// instants around, or on one side only where the run or a table ends. Rows with A != 0 have no limit: NaN. Where
// equations are redundant the least multipliers are taken, as elsewhere. Multipliers that all have a limit must balance
// f.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "catena/analysis/kinematics/driven_reactions.hpp"
#include "catena/analysis/pose/departure.hpp"
#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {

namespace {

/// Instants in steps from t*, and the weights by which values there make the one at t*, exact for polynomials of
/// degree 5.
struct Stencil {
  std::array<double, 6> place, weight;
};
constexpr Stencil around{{-3, -2, -1, 1, 2, 3}, {0.05, -0.3, 0.75, 0.75, -0.3, 0.05}};
constexpr Stencil before{{-6, -5, -4, -3, -2, -1}, {-1, 6, -15, 20, -15, 6}};
constexpr Stencil after{{1, 2, 3, 4, 5, 6}, {6, -15, 20, -15, 6, -1}};
// A step in parts of the bridge, which is at most 0.4 rad long: around, the polynomial is off by (1/40)^6 / 20. Shorter
// ones lose more to the condition of the equations near t*.
constexpr double step_of_bridge = 1.0 / 16;
// Of the largest (t - t*) lambda: more than the errors of the polynomial and of the bridge can make.
constexpr double unbounded = 1e-7;
// Part of the loads that limits may leave unbalanced.
constexpr double unbalanced = 1e-6;

// The first that lies where the motion and the functions of time are known; nullptr: none does.
const Stencil* choose_stencil(const Evaluator& evaluator, double t, double step, const BridgedStretch& stretch) {
  for (const Stencil* stencil : {&around, &before, &after}) {
    const double first = t + stencil->place.front() * step, last = t + stencil->place.back() * step;
    if (first >= stretch.bridge.first() && last <= stretch.bridge.last() && functions_exist_at(evaluator, first) &&
        functions_exist_at(evaluator, last)) {
      return stencil;
    }
  }
  return nullptr;
}

}  // namespace

// Multipliers at an instant of the bridge; loads_ are the loads that they balance.
bool DrivenReactions::solve_on_bridge(const MotionBridge& bridge, double t, std::span<const double> known,
                                      std::span<double> lambda) {
  std::vector<double> q(known.size()), qd(known.size()), qdd(known.size());
  evaluator_.set_time(t);
  bridge.evaluate(t, q, qd, qdd);
  fixed_.restore(known, q, qd, qdd);
  const bool factored = solver_.factor_at(q) > 0;
  find_loads(qd, qdd);
  if (plan_.rows == plan_.columns) return factored && solver_.solve_multipliers(loads_, lambda);
  if (!minimum_norm_) minimum_norm_.emplace(evaluator_);
  return minimum_norm_->factorize() && solve_least(lambda) <= thresholds::no_force;
}

// lambda_ becomes B.
DrivenReactions::Limit DrivenReactions::extrapolate(const DrivenInstant& now, const BridgedStretch& stretch) {
  const std::size_t rows = at(plan_.rows);
  const double step = step_of_bridge * (stretch.to - stretch.from);
  const Stencil* const stencil = choose_stencil(evaluator_, now.t, step, stretch);
  std::vector<double> lambda(rows);
  Limit limit;
  limit.known = stencil != nullptr;
  limit.pole.assign(rows, 0.0);
  lambda_.assign(rows, 0.0);
  for (std::size_t k = 0; limit.known && k < stencil->place.size(); ++k) {
    limit.known = solve_on_bridge(stretch.bridge, now.t + stencil->place[k] * step, now.q, lambda);
    for (std::size_t r = 0; r < rows; ++r) {
      lambda_[r] += stencil->weight[k] * lambda[r];
      limit.pole[r] += stencil->weight[k] * stencil->place[k] * lambda[r];
      limit.scale = std::max(limit.scale, std::abs(stencil->place[k] * lambda[r]) * row_unit(r));
    }
  }
  return limit;
}

// Whether lambda_ balances loads_; `scale`: of multipliers, as Limit has it.
bool DrivenReactions::balances_loads(double scale) const {
  std::vector<double> rest(loads_);
  std::vector<double> opposite(lambda_);
  for (double& value : opposite) value = -value;
  multiply_transposed_add(plan_.jacobian, solver_.jacobian(), opposite, rest);
  double left = 0, size = 0;
  for (std::size_t c = 0; c < rest.size(); ++c) {
    const double arm = plan_.coordinate[c] % 3 == 2 ? evaluator_.length_scale() : 1;
    left = std::max(left, std::abs(rest[c]) / arm);
    size = std::max(size, std::abs(loads_[c]) / arm);
  }
  return !(left > unbalanced * std::max(size, scale / evaluator_.length_scale()));
}

void DrivenReactions::take_limit(const DrivenInstant& now, const BridgedStretch& stretch) {
  const Limit limit = extrapolate(now, stretch);
  // Back to where the motion is, with the loads there.
  evaluator_.set_time(now.t);
  solver_.residual_at(now.q);
  find_loads(now.qd, now.qdd);
  std::vector<int> without;
  const auto leave_empty = [&](std::size_t r) {
    lambda_[r] = std::numeric_limits<double>::quiet_NaN();
    if (without.empty() || without.back() != plan_.row_element[r]) without.push_back(plan_.row_element[r]);
  };
  // Friction of joints has no limit of this kind: its slips turn there.
  if (friction_.any()) friction_.forget();
  for (std::size_t r = 0; r < lambda_.size(); ++r) {
    if (!limit.known || friction_.any() || !(std::abs(limit.pole[r]) * row_unit(r) <= unbounded * limit.scale))
      leave_empty(r);
  }
  if (without.empty() && !balances_loads(limit.scale)) {
    for (std::size_t r = 0; r < lambda_.size(); ++r) leave_empty(r);
  }
  note_limit(now.t, without);
}

void DrivenReactions::note_limit(double t, const std::vector<int>& without) {
  if (limit_rows_++ == 0) limit_t_ = t;
  if (!without_limit_.empty()) return;
  without_limit_ = element_names(evaluator_.model(), without);
}

}  // namespace catena
