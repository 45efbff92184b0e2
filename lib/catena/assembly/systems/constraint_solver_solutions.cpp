// ConstraintSolver: solutions with the factors at hand.
#include <algorithm>
#include <cmath>

#include "catena/assembly/systems/constraint_solver.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/factorization/refinement.hpp"
#include "catena/linalg/kernels/packs.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Five rounds gain what is regularised at the least pivots that are not.
constexpr RefinementLimits rounding_of_change{.tolerance = 1e-14, .max_steps = 5};

// The largest of numbers of rows, lengths beside angles: each in the root of its diagonal entry of S. Rows that move
// nothing count for nothing.
double largest(std::span<const double> numbers, std::span<const double> diagonal) {
  double most = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (diagonal[k] > 0) most = std::max(most, numbers[k] * numbers[k] / diagonal[k]);
  }
  return std::sqrt(most);
}

}  // namespace

template <class V>
void ConstraintSolver::add_compliance(std::span<const V> lambda, std::span<V> out) const {
  for (int k = 0; k < left_out_.count(); ++k) {
    const std::span<const int> rows = left_out_.indices(k);
    const std::span<const double> c = left_out_.values(k);
    V sum{};
    for (std::size_t a = 0; a < c.size(); ++a) sum += c[a] * lambda[at(rows[a])];
    for (std::size_t a = 0; a < c.size(); ++a) out[at(rows[a])] += c[a] * sum;
  }
  for (std::size_t k = 0; compliance_ && k < out.size(); ++k) out[k] += compliance_[k] * lambda[k];
}

template <class V>
void ConstraintSolver::add_product(std::span<const V> x, std::span<V> out) const {
  const double* jacobian = jacobian_;
  const int* row = plan_->jacobian.row_index.data();
  for (std::size_t c = 0; c + 1 < column_start_.size(); ++c) {
    const V factor = x[c];
    for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) out[at(row[k])] += jacobian[k] * factor;
  }
}

void ConstraintSolver::multiply_add(std::span<const double> x, std::span<double> out) const { add_product(x, out); }

template <class V>
void ConstraintSolver::spread(std::span<const V> lambda, std::span<V> x) const {
  const double* jacobian = jacobian_;
  const int* row = plan_->jacobian.row_index.data();
  for (std::size_t c = 0; c + 1 < column_start_.size(); ++c) {
    V sum{};
    for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) sum += jacobian[k] * lambda[at(row[k])];
    x[c] = masses_.inverse[c] * sum;
  }
}

template <class V>
void ConstraintSolver::find_residual(std::span<const V> b, std::span<const V> lambda, std::span<V> x,
                                     std::span<V> r) const {
  spread<V>(lambda, x);
  std::fill(r.begin(), r.end(), V{});
  add_product<V>(x, r);
  add_compliance<V>(lambda, r);
  for (std::size_t k = 0; k < r.size(); ++k) r[k] = b[k] - r[k];
}

template <class V, class S>
void ConstraintSolver::solve_refined(std::span<V> lambda, std::span<const V> b, S& scratch, Counters& counters) {
  eliminate(lambda, scratch, counters);
  if (smallest_ratio_ >= dependence::refined) return;
  const std::span<V> correction = scratch.correction;
  find_residual<V>(b, lambda, scratch.change, correction);
  eliminate(correction, scratch, counters);
  for (std::size_t k = 0; k < correction.size(); ++k) lambda[k] += correction[k];
}

void ConstraintSolver::solve(std::span<const double> b, std::span<double> x, std::span<double> lambda,
                             Counters& counters) {
  const double size = largest(b, diagonal_values_);
  const auto eliminate_in = [&](std::span<double> r) { factors_.solve(r, counters); };
  const auto residual = [&](std::span<const double> multipliers, std::span<double> r) {
    find_residual<double>(b, multipliers, x, r);
    const double left = largest(r, diagonal_values_);
    return size > 0 ? left / size : left;
  };
  std::copy(b.begin(), b.end(), lambda.begin());
  if (plan_->rows > 0) eliminate_in(lambda);
  refine(eliminate_in, residual, lambda, scratch_.right_hand_side, scratch_.correction, rounding_of_change);
  spread<double>(lambda, x);
}

void ConstraintSolver::least_change(std::span<const double> b, std::span<double> x, std::span<double> lambda,
                                    Counters& counters) {
  std::copy(b.begin(), b.end(), lambda.begin());
  solve_rows(lambda, counters);
  spread<double>(lambda, x);
}

void ConstraintSolver::least_change_rough(std::span<const double> b, std::span<double> x, std::span<double> lambda,
                                          Counters& counters) {
  std::copy(b.begin(), b.end(), lambda.begin());
  factors_.solve(lambda, counters);
  spread<double>(lambda, x);
}

void ConstraintSolver::solve_rows(std::span<double> x, Counters& counters) {
  std::copy(x.begin(), x.end(), scratch_.right_hand_side.begin());
  solve_refined<double>(x, scratch_.right_hand_side, scratch_, counters);
}

template <class V, class S>
void ConstraintSolver::solve_with_masses(std::span<const V> Q, std::span<const V> gamma, std::span<V> qdd,
                                         std::span<V> lambda, S& scratch, Counters& counters) {
  const std::size_t coordinates = masses_.inverse.size();
  for (std::size_t c = 0; c < coordinates; ++c) qdd[c] = masses_.inverse[c] * Q[c];
  if (plan_->rows == 0) return;
  const std::span<V> right_hand_side = scratch.right_hand_side;
  for (std::size_t k = 0; k < right_hand_side.size(); ++k) right_hand_side[k] = -gamma[k];
  add_product<V>(qdd, right_hand_side);
  std::copy(right_hand_side.begin(), right_hand_side.end(), lambda.begin());
  solve_refined<V>(lambda, right_hand_side, scratch, counters);
  const double* jacobian = jacobian_;
  const int* row = plan_->jacobian.row_index.data();
  for (std::size_t c = 0; c < coordinates; ++c) {
    V sum{};
    for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) sum += jacobian[k] * lambda[at(row[k])];
    qdd[c] -= masses_.inverse[c] * sum;
  }
}

template void ConstraintSolver::add_compliance<double>(std::span<const double>, std::span<double>) const;
template void ConstraintSolver::solve_with_masses<double, SchurScratch<double>>(std::span<const double>,
                                                                                std::span<const double>,
                                                                                std::span<double>, std::span<double>,
                                                                                SchurScratch<double>&, Counters&);

bool ConstraintSolver::refines_each() const {
  return !rest_.Q.empty() && (!masses_.massless.empty() || unequal_ || smallest_ratio_ < dependence::refined_if_light);
}

void ConstraintSolver::solve_motion(std::span<const double> Q, std::span<const double> gamma, std::span<double> qdd,
                                    std::span<double> lambda, Counters& counters) {
  solve_with_masses(Q, gamma, qdd, lambda, scratch_, counters);
  if (refines_each()) refine_motion(Q, gamma, qdd, lambda, counters);
}

void ConstraintSolver::solve_motion(std::span<const Lanes> Q, std::span<const Lanes> gamma, std::span<Lanes> qdd,
                                    std::span<Lanes> lambda, SchurLanes& scratch, Counters& counters) {
  if (!refines_each()) {
    scratch.right_hand_side.resize(scratch_.right_hand_side.size());
    scratch.correction.resize(scratch_.correction.size());
    scratch.change.resize(scratch_.change.size());
    return solve_with_masses(Q, gamma, qdd, lambda, scratch, counters);
  }
  SchurAlone& own = scratch.own;
  own.Q.resize(Q.size());
  own.gamma.resize(gamma.size());
  own.qdd.resize(qdd.size());
  own.lambda.resize(lambda.size());
  const auto take = [](std::span<const Lanes> all, int lane, std::vector<double>& one) {
    for (std::size_t k = 0; k < one.size(); ++k) one[k] = all[k][lane];
  };
  const auto give = [](const std::vector<double>& one, int lane, std::span<Lanes> all) {
    for (std::size_t k = 0; k < one.size(); ++k) all[k].set(lane, one[k]);
  };
  for (int lane = 0; lane < Lanes::count; ++lane) {
    take(Q, lane, own.Q);
    take(gamma, lane, own.gamma);
    solve_motion(own.Q, own.gamma, own.qdd, own.lambda, counters);
    give(own.qdd, lane, qdd);
    give(own.lambda, lane, lambda);
  }
}

/// x = M^-1 Q, and what it leaves of the equations: rows = Phi_q M^-1 Q - gamma.
struct ConstraintSolver::EliminationKernel {
  const ConstraintSolver& solver;
  double *x, *rows;
  std::size_t width;

  template <class P>
  void run(std::size_t first) const {
    const int *const start = solver.column_start_.data(), *const row = solver.plan_->jacobian.row_index.data();
    const double *const inverse = solver.masses_.inverse.data(), *const jacobian = solver.jacobian_;
    const std::size_t coordinates = solver.masses_.inverse.size();
    for (std::size_t c = 0; c < coordinates; ++c) {
      P value;
      packs::load(value, x + c * width + first);
      value *= inverse[c];
      packs::store(value, x + c * width + first);
      for (int k = start[c]; k < start[c + 1]; ++k)
        packs::add(rows + static_cast<std::size_t>(row[k]) * width + first, jacobian[k], value);
    }
  }
};

/// x -= M^-1 Phi_q^T lambda.
struct ConstraintSolver::SpreadKernel {
  const ConstraintSolver& solver;
  double* x;
  const double* lambda;
  std::size_t width;

  template <class P>
  void run(std::size_t first) const {
    const int *const start = solver.column_start_.data(), *const row = solver.plan_->jacobian.row_index.data();
    const double *const inverse = solver.masses_.inverse.data(), *const jacobian = solver.jacobian_;
    const std::size_t coordinates = solver.masses_.inverse.size();
    for (std::size_t c = 0; c < coordinates; ++c) {
      P sum{}, multiplier;
      for (int k = start[c]; k < start[c + 1]; ++k) {
        packs::load(multiplier, lambda + static_cast<std::size_t>(row[k]) * width + first);
        sum += jacobian[k] * multiplier;
      }
      packs::add(x + c * width + first, -inverse[c], sum);
    }
  }
};

void ConstraintSolver::solve_motion_rows(std::span<double> x, std::span<double> rows, std::size_t width,
                                         SchurRows& scratch, Counters& counters) {
  if (refines_each() || smallest_ratio_ < dependence::refined)
    return solve_each_of(x, rows, width, scratch.own, counters);
  packs::with_packs(EliminationKernel{*this, x.data(), rows.data(), width}, width);
  if (plan_->rows == 0) return;
  factors_.solve_rows(rows.data(), width, scratch.work, counters);
  packs::with_packs(SpreadKernel{*this, x.data(), rows.data(), width}, width);
}

void ConstraintSolver::solve_each_of(std::span<double> x, std::span<double> rows, std::size_t width, SchurAlone& own,
                                     Counters& counters) {
  own.Q.resize(masses_.inverse.size());
  own.qdd.resize(masses_.inverse.size());
  own.gamma.resize(rows.size() / width);
  own.lambda.resize(rows.size() / width);
  for (std::size_t p = 0; p < width; ++p) {
    for (std::size_t c = 0; c < own.Q.size(); ++c) own.Q[c] = x[c * width + p];
    for (std::size_t k = 0; k < own.gamma.size(); ++k) own.gamma[k] = -rows[k * width + p];
    solve_motion(own.Q, own.gamma, own.qdd, own.lambda, counters);
    for (std::size_t c = 0; c < own.Q.size(); ++c) x[c * width + p] = own.qdd[c];
    for (std::size_t k = 0; k < own.gamma.size(); ++k) rows[k * width + p] = own.lambda[k];
  }
}

}  // namespace catena
