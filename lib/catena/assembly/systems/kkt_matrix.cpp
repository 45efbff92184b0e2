#include "catena/assembly/systems/kkt_matrix.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// rho in units of the stiffness of the bodies that a row touches.
constexpr double augmentation = 4;
// eps rho: small enough that two refinements remove its effect, large enough to stand out from rounding.
constexpr double row_regularisation = 1e-10;
// Bodies much softer than the stiffest one count as this part of it, so that pivots stay away from zero.
constexpr double softest_part = 1e-9;

}  // namespace

KktMatrix::KktMatrix(std::shared_ptr<const Plan> plan, std::span<const double> radius)
    : plan_(std::move(plan)), structure_(*plan_), moving_(plan_->moving) {
  set_radius(radius);
  values_.assign(at(structure_.values()), 0.0);
  rho_.resize(at(structure_.rows));
  eps_.resize(at(structure_.rows));
  stiffness_.resize(at(moving_));
  residual_work_.resize(at(structure_.columns + structure_.rows));
  correction_work_.resize(residual_work_.size());
}

void KktMatrix::set_radius(std::span<const double> radius) {
  radius_.assign(radius.begin(), radius.end());
  inverse_arms_.assign(at(structure_.columns), 1.0);
  for (int c = 0; c < structure_.columns; ++c) {
    const int coordinate = plan_->coordinate[at(c)];
    if (coordinate % 3 == 2) inverse_arms_[at(c)] = 1 / radius_[at(coordinate / 3)];
  }
}

void KktMatrix::clear() {
  std::fill_n(values_.begin(), structure_.entries(), 0.0);
  std::fill(values_.begin() + structure_.turning(0), values_.end(), 0.0);
}

void KktMatrix::set_hessian(const Evaluator& evaluator, std::span<const double> lambda, Curvature curvature,
                            const ForeseenSprings* springs) {
  clear();
  if (springs && springs->active()) {
    evaluator.add_hessians(lambda, curvature, springs->others(), values_);
    springs->add(evaluator, curvature, values_);
    return;
  }
  evaluator.add_hessians(lambda, curvature, structure_.hessian, values_);
}

// Constraints alone, without the stiffness of forces, beside which a curvature in 1/m may be rounding. Multipliers of
// neighbouring rows differ, so that the curvatures of one element's rows do not cancel.
bool KktMatrix::constraints_are_linear(const Evaluator& evaluator) {
  std::vector<double> lambda(at(structure_.rows));
  for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] = 1 + 0.37 * static_cast<double>(r % 3);
  bool linear = true;
  evaluator.visit_constraint_hessians(lambda, [&](int i, int j, const ElementMatrix& matrix) {
    for (std::size_t k = 0; linear && k < matrix.size(); ++k) {
      const int row = plan_->column_of(i, j, static_cast<int>(k / 6));
      const int column = plan_->column_of(i, j, static_cast<int>(k % 6));
      linear = matrix[k] == 0 || row < 0 || column < 0;
    }
  });
  return linear;
}

void KktMatrix::write_jacobian(std::span<const double> jacobian) {
  for (std::size_t k = 0; k < structure_.jacobian.size(); ++k) values_[at(structure_.jacobian[k])] = jacobian[k];
}

void KktMatrix::complete(std::span<const double> jacobian, double shift) {
  const double* against_turning = values_.data() + structure_.turning(0);
  for (int c = 0; c < structure_.columns; ++c) {
    const int coordinate = plan_->coordinate[at(c)], body = coordinate / 3;
    double& value = values_[at(structure_.diagonal[at(c)])];
    if (coordinate % 3 == 2) {
      value += against_turning[body] + shift * radius_[at(body)] * radius_[at(body)];
    } else {
      value += shift;
    }
  }
  softness_ = compliance_;
  write_jacobian(jacobian);
}

void KktMatrix::add_diagonal(std::span<const double> weights, double factor) {
  for (int c = 0; c < structure_.columns; ++c) values_[at(structure_.diagonal[at(c)])] += factor * weights[at(c)];
}

void KktMatrix::set_weights(std::span<const double> jacobian, double stiffness) {
  clear();
  complete(jacobian, stiffness);
}

void KktMatrix::choose_augmentation(double least_stiffness) {
  std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
  for (int c = 0; c < structure_.columns; ++c) {
    double& stiffness = stiffness_[at(plan_->coordinate[at(c)] / 3)];
    const double k = std::abs(values_[at(structure_.diagonal[at(c)])]) * inverse_arms_[at(c)] * inverse_arms_[at(c)];
    stiffness = std::max(stiffness, k);
  }
  largest_stiffness_ = 0;
  for (double k : stiffness_) largest_stiffness_ = std::max(largest_stiffness_, k);
  const double least = std::max(least_stiffness, softest_part * largest_stiffness_);
  const SparsePattern& phi_q = plan_->jacobian;
  std::fill(rho_.begin(), rho_.end(), 0.0);
  for (int c = 0; c < structure_.columns; ++c) {
    const std::size_t body = at(plan_->coordinate[at(c)] / 3);
    for (int k = phi_q.column_start[at(c)]; k < phi_q.column_start[at(c) + 1]; ++k) {
      const std::size_t row = at(phi_q.row_index[at(k)]);
      // A row in radians holds torques: its stiffness is in N m.
      const double scale = plan_->row_is_angle[row] ? radius_[body] * radius_[body] : 1;
      rho_[row] = std::max(rho_[row], scale * std::max(least, augmentation * stiffness_[body]));
    }
  }
  for (std::size_t r = 0; r < rho_.size(); ++r) {
    if (!(rho_[r] > 0)) rho_[r] = least > 0 ? least : 1.0;
    eps_[r] = row_regularisation / rho_[r];
  }
}

FactorResult KktMatrix::factorize(double least_stiffness, Counters& counters) {
  if (!analyzed_) {
    factorization_.analyze(structure_.factored_places(), structure_.order, structure_.node_start, counters);
    analyzed_ = true;
  }
  // A quadratic energy under linear constraints has a constant matrix: its factors are kept, with their augmentation.
  if (keep_equal_factors_) {
    if (is_factorized() && !last_.empty() && std::equal(last_.begin(), last_.end(), values_.begin()) &&
        last_softness_ == softness_)
      return {};
    last_.assign(values_.begin(), values_.begin() + structure_.entries());
    last_softness_ = softness_;
  }
  choose_augmentation(least_stiffness);
  double* product = values_.data() + structure_.products();
  double* const minus_eps = values_.data() + structure_.regularisation();
  for (int r = 0; r < structure_.rows; ++r) {
    const int begin = structure_.row_start[at(r)], end = structure_.row_start[at(r) + 1];
    const double d = softness_.empty() ? 0.0 : softness_[at(r)], softening = 1 + rho_[at(r)] * d;
    for (int a = begin; a < end; ++a) {
      const double weighted =
          rho_[at(r)] / softening * values_[at(structure_.jacobian[at(structure_.row_entry[at(a)])])];
      for (int b = begin; b <= a; ++b) {
        *product++ = weighted * values_[at(structure_.jacobian[at(structure_.row_entry[at(b)])])];
      }
    }
    minus_eps[r] = -(eps_[at(r)] + d * softening);
  }
  return factorization_.factorize(std::span<const double>(values_).first(at(structure_.factored())), counters);
}

// Every coordinate's column begins with its diagonal entry; those of constraint rows are empty.
void KktMatrix::multiply(std::span<const double> x, std::span<double> y) const {
  std::fill(y.begin(), y.end(), 0.0);
  const SparsePattern& a = structure_.pattern;
  for (int c = 0; c < structure_.columns; ++c) {
    const double xc = x[at(c)];
    const int begin = a.column_start[at(c)], end = a.column_start[at(c) + 1];
    double sum = values_[at(begin)] * xc;
    for (int k = begin + 1; k < end; ++k) {
      const int r = a.row_index[at(k)];
      const double value = values_[at(k)];
      sum += value * x[at(r)];
      y[at(r)] += value * xc;
    }
    y[at(c)] += sum;
  }
  for (std::size_t r = 0; r < softness_.size(); ++r)
    y[at(structure_.columns) + r] -= softness_[r] * x[at(structure_.columns) + r];
}

void KktMatrix::multiply_stiffness(std::span<const double> x, std::span<double> y) const {
  std::fill(y.begin(), y.end(), 0.0);
  const SparsePattern& a = structure_.pattern;
  for (int c = 0; c < structure_.columns; ++c) {
    for (int k = a.column_start[at(c)]; k < a.column_start[at(c) + 1]; ++k) {
      const int r = a.row_index[at(k)];
      if (r >= structure_.columns) break;
      y[at(r)] += values_[at(k)] * x[at(c)];
      if (r != c) y[at(c)] += values_[at(k)] * x[at(r)];
    }
  }
}

double KktMatrix::absolute_quadratic(std::span<const double> x) const {
  const SparsePattern& a = structure_.pattern;
  double sum = 0;
  for (int c = 0; c < structure_.columns; ++c) {
    for (int k = a.column_start[at(c)]; k < a.column_start[at(c) + 1]; ++k) {
      const int r = a.row_index[at(k)];
      if (r >= structure_.columns) break;
      sum += (r == c ? 1 : 2) * std::abs(values_[at(k)] * x[at(c)] * x[at(r)]);
    }
  }
  return sum;
}

Refinement KktMatrix::solve(std::span<double> x, double force, double length, double tolerance, Counters& counters) {
  right_hand_side_.assign(x.begin(), x.end());
  const std::vector<double>& b = right_hand_side_;
  const auto residual = [&](std::span<const double> solution, std::span<double> r) {
    multiply(solution, r);
    double largest = 0;
    for (int c = 0; c < structure_.columns; ++c) {
      r[at(c)] = b[at(c)] - r[at(c)];
      largest = std::max(largest, std::abs(r[at(c)]) * inverse_arms_[at(c)]);
    }
    largest /= force;
    for (int k = 0; k < structure_.rows; ++k) {
      const std::size_t row = at(structure_.columns + k);
      r[row] = b[row] - r[row];
      largest = std::max(largest, std::abs(r[row]) / (plan_->row_is_angle[at(k)] ? 1.0 : length));
    }
    return largest;
  };
  solve_unrefined(x, counters);
  return refine([&](std::span<double> correction) { solve_unrefined(correction, counters); }, residual, x,
                residual_work_, correction_work_, {.tolerance = tolerance, .max_steps = 4, .least_progress = 1});
}

void KktMatrix::solve_unrefined(std::span<double> x, Counters& counters) {
  const bool soft = !softness_.empty();
  const auto softening = [&](std::size_t r) { return 1 + rho_[r] * softness_[r]; };
  // Phi_q^T R times the second equation was added to the first one on the left, and is added on the right as well.
  const SparsePattern& phi_q = plan_->jacobian;
  const std::span<const double> second = x.subspan(at(structure_.columns));
  const bool nothing = std::all_of(second.begin(), second.end(), [](double v) { return v == 0; });
  for (int c = 0; c < structure_.columns && !nothing; ++c) {
    double sum = 0;
    for (int k = phi_q.column_start[at(c)]; k < phi_q.column_start[at(c) + 1]; ++k) {
      const std::size_t row = at(phi_q.row_index[at(k)]);
      const double weight = soft ? rho_[row] / softening(row) : rho_[row];
      sum += values_[at(structure_.jacobian[at(k)])] * weight * x[at(structure_.columns) + row];
    }
    x[at(c)] += sum;
  }
  factorization_.solve(x, counters);
  for (std::size_t r = 0; r < softness_.size(); ++r) x[at(structure_.columns) + r] *= softening(r);
}

int KktMatrix::negative_modes() const { return factorization_.negative_pivots() - structure_.rows; }

std::vector<int> KktMatrix::dependent_rows() const {
  std::vector<int> dependent;
  for (int r = 0; r < structure_.rows; ++r) {
    if (!softness_.empty() && softness_[at(r)] > 0) continue;
    if (std::abs(factorization_.pivot(structure_.columns + r)) < 1e3 * eps_[at(r)]) dependent.push_back(r);
  }
  return dependent;
}

}  // namespace catena
