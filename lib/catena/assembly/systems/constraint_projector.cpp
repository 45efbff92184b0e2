#include "catena/assembly/systems/constraint_projector.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// Part of its diagonal added to every row: far below the accuracy of a row's own products, enough for a factorization.
constexpr double regularisation = 1e-12;

}  // namespace

ConstraintProjector::ConstraintProjector(std::shared_ptr<const Plan> plan) : plan_(std::move(plan)) {
  inverse_weights_.assign(at(plan_->columns), 1.0);
  work_.resize(at(std::max(plan_->columns, plan_->rows)));
  make_pattern();
}

void ConstraintProjector::make_pattern() {
  const SparsePattern& a = plan_->jacobian;
  std::vector<MatrixEntry> entries;
  for (int r = 0; r < plan_->rows; ++r) entries.push_back({r, r});
  for (int c = 0; c < a.columns; ++c) {
    for (int x = a.column_start[at(c)]; x < a.column_start[at(c) + 1]; ++x) {
      for (int y = a.column_start[at(c)]; y <= x; ++y) {
        products_.push_back({x, y, c, 0});
        entries.push_back({a.row_index[at(x)], a.row_index[at(y)]});
      }
    }
  }
  SlottedPattern slotted = build_pattern(plan_->rows, plan_->rows, entries);
  pattern_ = std::move(slotted.pattern);
  diagonal_.assign(slotted.slot.begin(), slotted.slot.begin() + plan_->rows);
  for (std::size_t k = 0; k < products_.size(); ++k) products_[k].slot = slotted.slot[at(plan_->rows) + k];
  values_.resize(pattern_.row_index.size());
}

void ConstraintProjector::set_inverse_weights(std::span<const double> inverse_weights) {
  std::copy(inverse_weights.begin(), inverse_weights.end(), inverse_weights_.begin());
}

void ConstraintProjector::multiply(std::span<const double> jacobian) {
  jacobian_ = jacobian.first(plan_->jacobian.row_index.size());  // without the scratch slot
  std::fill(values_.begin(), values_.end(), 0.0);
  for (const Product& p : products_) {
    values_[at(p.slot)] += inverse_weights_[at(p.column)] * jacobian[at(p.first)] * jacobian[at(p.second)];
  }
}

FactorResult ConstraintProjector::factorize_values(Counters& counters) {
  if (!analyzed_) {
    const FactorResult result = schur_.analyze(pattern_, {.form = SymmetricForm::ldl}, counters);
    if (!result.ok()) return result;
    analyzed_ = true;
  }
  return schur_.factorize(values_, 0, counters);
}

FactorResult ConstraintProjector::factorize(std::span<const double> jacobian, Counters& counters, double damping) {
  multiply(jacobian);
  compliance_ = {};
  double largest = 0;
  for (int d : diagonal_) largest = std::max(largest, values_[at(d)]);
  // An equation between bodies that cannot move has an empty diagonal; it must not stop the others.
  for (int d : diagonal_) {
    double& value = values_[at(d)];
    value += (regularisation + damping) * value;
    if (!(value > 0)) value = largest > 0 ? largest : 1;
  }
  return factorize_values(counters);
}

FactorResult ConstraintProjector::factorize_compliant(std::span<const double> jacobian,
                                                      std::span<const double> compliance, Counters& counters) {
  multiply(jacobian);
  compliance_ = compliance;
  for (std::size_t r = 0; r < diagonal_.size(); ++r) values_[at(diagonal_[r])] += compliance[r];
  return factorize_values(counters);
}

double ConstraintProjector::solve(std::span<const double> b, std::span<double> x, std::span<double> lambda,
                                  Counters& counters) {
  if (plan_->rows == 0) {
    std::fill(x.begin(), x.end(), 0.0);
    return 0;
  }
  double size_b = 0;
  for (double value : b) size_b = std::max(size_b, std::abs(value));
  const auto change_of = [&](std::span<const double> multipliers, std::span<double> change) {
    std::fill(change.begin(), change.end(), 0.0);
    multiply_transposed_add(plan_->jacobian, jacobian_, multipliers, change);
    for (std::size_t c = 0; c < change.size(); ++c) change[c] *= inverse_weights_[c];
  };
  const auto residual = [&](std::span<const double> multipliers, std::span<double> r) {
    change_of(multipliers, x);
    for (double& value : x) value = -value;
    std::copy(b.begin(), b.end(), r.begin());
    multiply_add(plan_->jacobian, jacobian_, x, r);
    for (std::size_t k = 0; k < compliance_.size(); ++k) r[k] -= compliance_[k] * multipliers[k];
    double size = 0;
    for (double value : r) size = std::max(size, std::abs(value));
    return size_b > 0 ? size / size_b : size;
  };
  std::copy(b.begin(), b.end(), lambda.begin());
  const Refinement outcome = schur_.solve_refined(lambda, residual, {.tolerance = 1e-14, .max_steps = 5}, counters);
  change_of(lambda, x);
  return outcome.residual;
}

}  // namespace catena
