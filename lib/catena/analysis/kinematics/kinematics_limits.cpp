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

#include "catena/analysis/kinematics/kinematics.hpp"
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
// The same for least reactions a little away from t*.
constexpr double balanced_beside = 1e-9;
constexpr std::size_t most_joints = 6;

}  // namespace

// Multipliers at an instant of the bridge; loads_ are the loads that they balance.
bool Kinematics::multipliers_on_bridge(double t, std::span<double> lambda) {
  std::vector<double> q(q_.size()), qd(q_.size()), qdd(q_.size());
  evaluator_.set_time(t);
  bridge_.evaluate(t, q, qd, qdd);
  restore_fixed(q, qd, qdd);
  const bool factored = solver_.factor_at(q) > 0;
  scatter_applied_forces(qd, qdd);
  if (plan_->rows == plan_->columns) return factored && solver_.solve_multipliers(loads_, lambda);
  if (!minimum_norm_) minimum_norm_.emplace(evaluator_);
  if (!minimum_norm_->factorize()) return false;
  for (int c = 0; c < plan_->columns; ++c) applied_[at(plan_->coordinate[at(c)])] = loads_[at(c)];
  return minimum_norm_->solve(applied_, lambda) <= balanced_beside;
}

void Kinematics::find_limit_of_multipliers() {
  const std::size_t rows = at(plan_->rows);
  const double step = step_of_bridge * (bridge_to_ - bridge_from_);
  const Stencil* stencil = nullptr;
  for (const Stencil* s : {&around, &before, &after}) {
    const double first = t_ + s->place.front() * step, last = t_ + s->place.back() * step;
    const bool fits =
        first >= bridge_.first() && last <= bridge_.last() && functions_go_on(first) && functions_go_on(last);
    if (fits && !stencil) stencil = s;
  }
  std::vector<double> pole(rows, 0.0), lambda(rows);
  lambda_.assign(rows, 0.0);
  double scale = 0;
  bool known = stencil != nullptr;
  for (std::size_t k = 0; known && k < stencil->place.size(); ++k) {
    known = multipliers_on_bridge(t_ + stencil->place[k] * step, lambda);
    for (std::size_t r = 0; r < rows; ++r) {
      lambda_[r] += stencil->weight[k] * lambda[r];
      pole[r] += stencil->weight[k] * stencil->place[k] * lambda[r];
      scale = std::max(
          scale, std::abs(stencil->place[k] * lambda[r]) * (plan_->row_is_angle[r] ? 1 : evaluator_.length_scale()));
    }
  }
  // Back to where the motion is, with the loads there.
  evaluator_.set_time(t_);
  solver_.residual_at(q_);
  scatter_applied_forces(qd_, qdd_);
  std::vector<int> without;
  for (std::size_t r = 0; r < rows; ++r) {
    const double size = std::abs(pole[r]) * (plan_->row_is_angle[r] ? 1 : evaluator_.length_scale());
    if (known && size <= unbounded * scale) continue;
    lambda_[r] = std::numeric_limits<double>::quiet_NaN();
    if (without.empty() || without.back() != plan_->row_element[r]) without.push_back(plan_->row_element[r]);
  }
  if (without.empty()) {
    std::vector<double> rest(loads_);
    std::vector<double> opposite(lambda_);
    for (double& value : opposite) value = -value;
    multiply_transposed_add(plan_->jacobian, solver_.jacobian(), opposite, rest);
    double left = 0, size = 0;
    for (std::size_t c = 0; c < rest.size(); ++c) {
      const double arm = plan_->coordinate[c] % 3 == 2 ? evaluator_.length_scale() : 1;
      left = std::max(left, std::abs(rest[c]) / arm);
      size = std::max(size, std::abs(loads_[c]) / arm);
    }
    if (left > unbalanced * std::max(size, scale / evaluator_.length_scale())) {
      std::fill(lambda_.begin(), lambda_.end(), std::numeric_limits<double>::quiet_NaN());
      for (std::size_t r = 0; r < rows; ++r) {
        if (without.empty() || without.back() != plan_->row_element[r]) without.push_back(plan_->row_element[r]);
      }
    }
  }
  if (limit_rows_++ == 0) limit_t_ = t_;
  if (!without_limit_.empty()) return;
  for (std::size_t k = 0; k < without.size() && k < most_joints; ++k) {
    without_limit_ += fmt::format("{}\"{}\"", k > 0 ? ", " : "", model_->element_name(without[k]));
  }
  if (without.size() > most_joints) without_limit_ += fmt::format(" and {} more", without.size() - most_joints);
}

void Kinematics::remark_on_limits(std::vector<std::string>& warnings) const {
  if (limit_rows_ == 0) return;
  std::string remark = fmt::format(
      "at t = {:.12g} s{} the mechanism is in a singular configuration: loads and reactions there are the limit of the "
      "motion",
      limit_t_, limit_rows_ > 1 ? fmt::format(" and in {} more rows", limit_rows_ - 1) : "");
  if (!without_limit_.empty()) {
    remark += fmt::format("; those of {} grow without bound towards it and are left empty", without_limit_);
  }
  warnings.push_back(std::move(remark));
}

}  // namespace catena
