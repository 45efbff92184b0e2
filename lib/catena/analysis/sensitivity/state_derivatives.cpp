#include "catena/analysis/sensitivity/state_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "catena/analysis/run/breakpoints.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/saddle_system.hpp"
#include "catena/columns/state_laws.hpp"

namespace catena {
namespace {

// Values and derivatives of a column on both sides of an instant that differ by less than this part are the same:
// motions keep to their tolerance, 1e-8 unless it is asked for less.
constexpr double same_on_both_sides = thresholds::same_value;

bool differ(double a, double b, double rounding) {
  return !(std::abs(a - b) <= same_on_both_sides * std::max(std::abs(a), std::abs(b)) + rounding);
}

}  // namespace

StateDerivatives::~StateDerivatives() = default;

StateDerivatives::StateDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters)
    : evaluator_(evaluator, evaluation_), parameters_(parameters) {
  evaluator_.forget_turns();
  make_groups(models);
}

StateDerivatives::StateDerivatives(std::shared_ptr<const Plan> plan, const Model& model, const DesignModels& models,
                                   int parameters)
    : evaluator_(std::move(plan), model, evaluation_), parameters_(parameters) {
  make_groups(models);
}

void StateDerivatives::make_groups(const DesignModels& models) {
  if (static_cast<int>(models.size()) != (parameters_ + parameters_at_once - 1) / parameters_at_once)
    throw std::invalid_argument("derivatives: there must be a model for every four parameters");
  const auto coordinates = static_cast<std::size_t>(plan().coordinates()), rows = static_cast<std::size_t>(plan().rows);
  groups_.reserve(models.size());
  for (const auto& model : models) {
    Group& group = groups_.emplace_back(DesignMechanism(evaluator_, model));
    group.count = std::min(parameters_ - static_cast<int>(groups_.size() - 1) * parameters_at_once, parameters_at_once);
    for (auto* values : {&group.q, &group.qd, &group.qdd, &group.loads}) values->resize(coordinates);
    group.lambda.resize(rows);
    group.rows.resize(rows);
  }
  jacobian_.resize(static_cast<std::size_t>(plan().trash_slot()) + 1);
  evaluator_.start_jacobian(jacobian_);
  f_.resize(coordinates);
  b_.resize(rows);
}

std::span<const double> StateDerivatives::jacobian(const Evaluator& there) {
  there.Equations::jacobian(there.pose(), jacobian_);
  return std::span<const double>(jacobian_).first(static_cast<std::size_t>(plan().trash_slot()));
}

void StateDerivatives::lift(std::span<const double> values, std::vector<DesignScalar>& out) {
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = k < values.size() ? values[k] : 0.0;
}

void StateDerivatives::leave_out_reactions(Group& group) {
  if (lack_.empty())
    lack_ = "reactions of constraints that depend on each other are not unique, and have no derivative";
  for (DesignScalar& multiplier : group.lambda) multiplier.d.fill(std::numeric_limits<double>::quiet_NaN());
}

void StateDerivatives::leave_out_shares(Group& group, std::span<const char> rows) {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r]) group.lambda[r].d.fill(std::numeric_limits<double>::quiet_NaN());
  }
  if (!rows.empty() && lack_.empty())
    lack_ = "reactions and friction have no derivative while joints share friction that is not unique";
}

void StateDerivatives::leave_out_parameter(Group& group, std::size_t p, int row) {
  lack_ = describe_contradiction(evaluator_.model(), plan(), row);
  for (DesignScalar& place : group.q) place.d[p] = std::numeric_limits<double>::quiet_NaN();
}

void StateDerivatives::lift_state(Group& group, const Snapshot& snapshot) {
  if (plan().in_pose.contacts > 0) {
    const std::vector<CurvePlace> places = snapshot.evaluator.curve_places();
    evaluator_.go_to_curve_places(places);
    group.mechanism.go_to_curve_places(places);
  }
  group.mechanism.lift_configuration(snapshot.q, group.q);
  if (!snapshot.qd.empty()) lift(snapshot.qd, group.qd);
  if (!snapshot.qdd.empty()) lift(snapshot.qdd, group.qdd);
  if (!snapshot.lambda.empty()) lift(snapshot.lambda, group.lambda);
}

void StateDerivatives::differentiate(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out,
                                     std::span<double> values) {
  complete_state();
  values_.resize(columns.size());
  const auto parameters = static_cast<std::size_t>(parameters_);
  std::size_t first = 0;
  for (Group& group : groups_) {
    columns.differentiate(DesignState(group.mechanism, snapshot, group.qdd, group.lambda, &group.contacts), values_);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (first == 0 && !values.empty()) values[k] = values_[k].v;
      for (std::size_t p = 0; p < static_cast<std::size_t>(group.count); ++p)
        out[k * parameters + first + p] = values_[k].d[p];
    }
    first += static_cast<std::size_t>(group.count);
  }
}

const MovingInstant& StateDerivatives::instant_at(double t) {
  if (t == instant_) return at_instant_;
  instant_ = t;
  at_instant_.order = 0;
  at_instant_.rate.assign(static_cast<std::size_t>(parameters_), 0.0);
  std::size_t first = 0;
  for (const Group& group : groups_) {
    const auto count = static_cast<std::size_t>(group.count);
    bool any = false;  // a function that may jump: at most instants there is none
    for (const auto& function : group.mechanism.model().functions) {
      if (!is_breakpoint(function, t)) continue;
      if (!std::exchange(any, true)) {
        of_group_.order = 0;
        of_group_.rate.assign(count, 0.0);
      }
      const FunctionJump jump = jump_of(function, t);
      if (jump.order <= seen_order()) of_group_.add(jump, 0);
    }
    if (any) {
      at_instant_.order = of_group_.order;  // the same in all groups
      std::copy(of_group_.rate.begin(), of_group_.rate.end(),
                at_instant_.rate.begin() + static_cast<std::ptrdiff_t>(first));
    }
    first += count;
  }
  return at_instant_;
}

bool StateDerivatives::derive(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out,
                              std::span<double> change) {
  std::fill(change.begin(), change.end(), 0.0);
  jump_.clear();
  if (!instant_at(snapshot.t).moves()) {
    if (!find(snapshot)) return false;
    differentiate(columns, snapshot, out);
    // A law of state that has a value and no derivative takes those of all that it acts on: it is named.
    const bool lacks = std::any_of(out.begin(), out.end(), [](double d) { return std::isnan(d); });
    for (std::size_t k = 0; lacks && lack_.empty() && k < evaluator_.model().laws.size(); ++k) {
      for (const Group& group : groups_) {
        const DesignScalar force = group.mechanism.law_value(static_cast<int>(k));
        const bool has = std::all_of(force.d.begin(), force.d.end(), [](double d) { return std::isfinite(d); });
        if (has || !std::isfinite(force.v)) continue;
        lack_ = fmt::format("the expression of {} has no derivative at t = {:.9g} s, where its value is {:.9g}",
                            describe_law(evaluator_.model(), static_cast<int>(k)), snapshot.t, force.v);
      }
    }
    return true;
  }
  const std::vector<double> rate = instant_at(snapshot.t).rate;
  before_.assign(out.size(), std::numeric_limits<double>::quiet_NaN());
  column_before_.assign(columns.size(), std::numeric_limits<double>::quiet_NaN());
  column_after_ = column_before_;
  if (find_before(snapshot)) differentiate(columns, snapshot, before_, column_before_);
  if (!find(snapshot)) return false;
  differentiate(columns, snapshot, out, column_after_);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    // What the columns change by as fast as with the parameters, which move the instant at their rates: in what is none
    // of an instant that is rounding of zero.
    double rounding = 0;
    const double moment = thresholds::same_instant * std::max(std::abs(snapshot.t), 1e-3);
    for (std::size_t p = 0; p < rate.size(); ++p) {
      const double steepest = std::max(std::abs(before_[k * rate.size() + p]), std::abs(out[k * rate.size() + p]));
      if (rate[p] != 0 && std::isfinite(steepest / rate[p]))
        rounding = std::max(rounding, moment * steepest / std::abs(rate[p]));
    }
    const bool jumps = differ(column_before_[k], column_after_[k], rounding);
    const double size = std::max(std::abs(column_before_[k]), std::abs(column_after_[k]));
    if (!change.empty() && jumps) change[k] = column_before_[k] - column_after_[k];
    for (std::size_t p = 0; p < rate.size(); ++p) {
      double& derivative = out[k * rate.size() + p];
      if (rate[p] == 0 || std::isnan(derivative)) continue;
      const double small = thresholds::same_instant * size * std::abs(rate[p]) / std::max(std::abs(snapshot.t), 1e-3);
      if (!jumps && !differ(before_[k * rate.size() + p], derivative, std::isfinite(small) ? small : 0)) continue;
      derivative = std::numeric_limits<double>::quiet_NaN();
      jump_ = fmt::format(
          "at t = {:.9g} s a function of time jumps, at an instant that moves with the parameters: columns that jump "
          "or bend there have no derivative at it",
          snapshot.t);
    }
  }
  return true;
}

}  // namespace catena
