#include "catena/analysis/sensitivity/state_derivatives.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "catena/columns/design_state.hpp"

namespace catena {

StateDerivatives::~StateDerivatives() = default;

StateDerivatives::StateDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters)
    : evaluator_(evaluator), parameters_(parameters) {
  evaluator_.forget_turns();
  if (static_cast<int>(models.size()) != (parameters + parameters_at_once - 1) / parameters_at_once)
    throw std::invalid_argument("derivatives: there must be a model for every four parameters");
  const auto coordinates = static_cast<std::size_t>(plan().coordinates()), rows = static_cast<std::size_t>(plan().rows);
  groups_.reserve(models.size());
  for (const auto& model : models) {
    Group& group = groups_.emplace_back(DesignMechanism(evaluator_, model));
    group.count = std::min(parameters - static_cast<int>(groups_.size() - 1) * parameters_at_once, parameters_at_once);
    for (auto* values : {&group.q, &group.qd, &group.qdd, &group.loads}) values->resize(coordinates);
    group.lambda.resize(rows);
    group.rows.resize(rows);
  }
  jacobian_.resize(static_cast<std::size_t>(plan().trash_slot()) + 1);
  evaluator_.start_jacobian(jacobian_);
  f_.resize(coordinates);
  b_.resize(rows);
}

std::span<const double> StateDerivatives::jacobian() {
  evaluator_.jacobian(jacobian_);
  return std::span<const double>(jacobian_).first(static_cast<std::size_t>(plan().trash_slot()));
}

void StateDerivatives::lift(std::span<const double> values, std::vector<DesignScalar>& out) {
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = k < values.size() ? values[k] : 0.0;
}

void StateDerivatives::leave_out_reactions(Group& group) {
  lack_ = "reactions of constraints that depend on each other are not unique, and have no derivative";
  for (DesignScalar& multiplier : group.lambda) multiplier.d.fill(std::numeric_limits<double>::quiet_NaN());
}

void StateDerivatives::lift_state(Group& group, const Snapshot& snapshot) {
  group.mechanism.lift_configuration(snapshot.q, group.q);
  lift(snapshot.qd, group.qd);
  lift(snapshot.qdd, group.qdd);
  lift(snapshot.lambda, group.lambda);
}

void StateDerivatives::differentiate(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out) {
  values_.resize(columns.size());
  const auto parameters = static_cast<std::size_t>(parameters_);
  std::size_t first = 0;
  for (Group& group : groups_) {
    columns.differentiate(DesignState(group.mechanism, snapshot, group.qdd, group.lambda), values_);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      for (std::size_t p = 0; p < static_cast<std::size_t>(group.count); ++p)
        out[k * parameters + first + p] = values_[k].d[p];
    }
    first += static_cast<std::size_t>(group.count);
  }
}

}  // namespace catena
