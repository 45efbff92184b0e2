#include "catena/analysis/kinematics/driven_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "catena/analysis/kinematics/body_motion.hpp"
#include "catena/analysis/kinematics/course/step_rules.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Refinement by keep_rate a step, below, brings an error to 1e-14 in 7.
constexpr int max_refinements = 10;
// In length scales or rad: a residual below `rounding` is zero, a correction predicted to be below `not_computed` is
// not computed; one that is solved need not shrink any more.
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double rounding = 1e-16;
constexpr double not_computed = 1e-14;
// Shifts are compared with the length scale, or with this part of the extent of a long structure.
constexpr double part_of_extent = 0.01;
// Factors from further away than this are replaced: a new factorization costs two or three solves.
constexpr double keep_distance = 1e-4;
// Refinement that leaves more than this of an error takes longer than new factors.
constexpr double keep_rate = 1e-2;

}  // namespace

DrivenSolver::DrivenSolver(Evaluator& evaluator)
    : evaluator_(evaluator), plan_(evaluator.plan()), scaling_(plan_, evaluator.length_scale()) {
  values_.resize(at(plan_.trash_slot()) + 1);
  evaluator_.start_jacobian(values_);
  phi_.resize(at(plan_.rows));
  factored_.q.resize(at(plan_.columns));
  q_.resize(at(plan_.columns));
  step_.resize(at(plan_.columns));
  x_.resize(at(plan_.columns));
  rhs_.resize(at(plan_.rows));
  residual_all_.resize(at(plan_.rows));
  // The end of a long structure moves by many of the lengths that its parts are made of while they hardly turn.
  Vec2<double> low{}, high{};
  for (int p = 0; p < plan_.moving; ++p) {
    const Vec2<double> place = evaluator_.origin(p) - evaluator_.origin(0);
    low = {std::min(low.x, place.x), std::min(low.y, place.y)};
    high = {std::max(high.x, place.x), std::max(high.y, place.y)};
  }
  motion_unit_ = std::max(evaluator_.length_scale(), part_of_extent * std::max(high.x - low.x, high.y - low.y));
  if (plan_.rows == plan_.columns) {
    rows_.resize(at(plan_.rows));
    std::iota(rows_.begin(), rows_.end(), 0);
    all_rows_ = true;
  }
}

// Entries of the rows in use; returns their norm over all rows in use.
double DrivenSolver::gather_rows(std::span<const double> all, std::span<double> chosen) const {
  if (all_rows_) return scaling_.scan_rows(all.size(), [&](std::size_t k) { return chosen[k] = all[k]; });
  double largest = 0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    chosen[k] = all[at(rows_[k])];
    const double size = std::abs(chosen[k]) * scaling_.row_unit(rows_[k]);
    if (!(size <= largest)) largest = size;
  }
  return largest;
}

void DrivenSolver::to_columns(std::span<const double> coordinates, std::span<double> columns) const {
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c] = coordinates[at(plan_.coordinate[c])];
}

void DrivenSolver::to_coordinates(std::span<const double> columns, std::span<double> coordinates) const {
  for (std::size_t c = 0; c < columns.size(); ++c) coordinates[at(plan_.coordinate[c])] = columns[c];
}

std::span<const double> DrivenSolver::jacobian() {
  if (!jacobian_valid_) {
    evaluator_.jacobian(values_);
    jacobian_valid_ = true;
  }
  return std::span(values_).first(at(plan_.trash_slot()));
}

bool DrivenSolver::values_never_changed(std::span<const double> values) {
  if (matrix_.values_changed) return false;
  matrix_.values_changed =
      !std::equal(values.begin(), values.end(), matrix_.first_values.begin(), matrix_.first_values.end());
  if (matrix_.values_changed) matrix_.first_values = {};
  return !matrix_.values_changed;
}

bool DrivenSolver::factorize() {
  std::span<const double> values = jacobian();
  if (!all_rows_) {
    for (std::size_t k = 0; k < matrix_.gather.size(); ++k) matrix_.values[k] = values[at(matrix_.gather[k])];
    values = matrix_.values;
  }
  if (!matrix_.analyzed) {
    factored_.result =
        factorization_.analyze(all_rows_ ? plan_.jacobian : matrix_.pattern, Kernel::automatic, evaluator_.counters);
    if (!factored_.result.ok()) return false;
    // Pivots, by which branches are told apart and rows chosen, must not depend on the unit of length.
    std::vector<double> units(at(plan_.columns));
    for (std::size_t c = 0; c < units.size(); ++c) {
      units[c] = plan_.coordinate[c] % 3 == 2 ? 1 : evaluator_.length_scale();
    }
    factorization_.set_column_units(units);
    matrix_.analyzed = true;
    matrix_.values_changed = false;
    matrix_.first_values.assign(values.begin(), values.end());
  }
  // Linear constraints, and joints at the origins of their bodies, give the same values at every configuration: their
  // factors stay. Once the values have changed they are not compared again.
  const bool same = factorization_.is_factorized() && (plan_.constant_jacobian || values_never_changed(values));
  if (!same) factored_.result = factorization_.factorize(values, evaluator_.counters);
  factored_.valid = factored_.result.ok();
  factored_.rcond = factored_.valid ? factorization_.rcond() : 0;
  factored_.q = q_;
  factored_.t = evaluator_.time();
  factored_.gap = 0;
  return factored_.valid;
}

// Evaluates the constraints at q, which it keeps, with its distance from where the factors were made.
void DrivenSolver::evaluate_at(std::span<const double> q) {
  evaluator_.set_configuration(q);
  evaluator_.phi(phi_);
  jacobian_valid_ = jacobian_valid_ && plan_.constant_jacobian;
  const auto keep = [&](auto&& coordinate) {
    const auto sizes = scaling_.scan_columns<2>(q_.size(), [&](std::size_t c) {
      const double value = q_[c] = q[coordinate(c)];
      return std::array{value, value - factored_.q[c]};
    });
    extent_ = sizes[0].all;
    factored_.gap = sizes[1].all;
  };
  if (plan_.contiguous && q_.size() < few_columns) {
    BodyMotion place, gap;
    for (std::size_t c = 0; c < q_.size(); c += 3) {
      const double *there = q.data() + c, *from = factored_.q.data() + c;
      place.add(there[0], there[1], there[2]);
      gap.add(there[0] - from[0], there[1] - from[1], there[2] - from[2]);
    }
    std::copy_n(q.begin(), q_.size(), q_.begin());
    extent_ = place.size(evaluator_.length_scale()).all;
    factored_.gap = gap.size(evaluator_.length_scale()).all;
  } else if (plan_.contiguous) {
    keep([](std::size_t c) { return c; });
  } else {
    keep([&](std::size_t c) { return at(plan_.coordinate[c]); });
  }
}

double DrivenSolver::residual_at(std::span<const double> q) {
  evaluate_at(q);
  return gather_rows(phi_, step_);
}

bool DrivenSolver::factors_serve() const {
  if (!factored_.valid) return false;
  const bool exact = plan_.constant_jacobian || (factored_.gap == 0 && factored_.t == evaluator_.time());
  return exact || (factored_.gap <= keep_distance && factored_.rcond >= dependence::far_from_singular);
}

// The part of an error that one refinement leaves with factors made at a distance.
double DrivenSolver::refinement_rate() const {
  return plan_.constant_jacobian || factored_.gap == 0 ? 0 : factored_.gap / factored_.rcond;
}

// A linear system needs no determinant: factors serve as long as refinement with them converges fast.
bool DrivenSolver::factors_refine() const { return factored_.valid && refinement_rate() <= keep_rate; }

NewtonOutcome DrivenSolver::solve_position(std::span<double> q) {
  NewtonOutcome outcome;
  double size = 0;  // of the last correction
  double rate = 0;  // by which the next correction will be smaller
  double last_residual = std::numeric_limits<double>::infinity();
  // Without a set of equations that determines all coordinates nothing can converge.
  if (!is_square()) return outcome;
  for (;; ++outcome.iterations) {
    evaluate_at(q);
    outcome.residual = gather_rows(phi_, step_);
    if (!std::isfinite(outcome.residual)) return outcome;
    // The far end of a long structure moves by many length scales: its residuals contain the rounding of its
    // coordinates.
    const double attainable = std::max(tolerance, 8 * epsilon * extent_);
    // Corrections are the residual times a condition number: they need not become small, but then the residual stays
    // constant.
    const bool small = outcome.residual <= attainable;
    const bool settled = rate * size <= std::max(not_computed, epsilon * extent_) ||
                         outcome.residual > step_rules::poor_contraction * last_residual;
    if (outcome.residual <= rounding || (outcome.iterations > 0 && small && settled)) {
      outcome.converged = true;
      return outcome;
    }
    last_residual = outcome.residual;
    if (outcome.iterations == step_rules::most_iterations) return outcome;
    if (!factors_serve() && !factorize()) {
      outcome.factor = factored_.result;
      return outcome;
    }
    factorization_.solve(step_, evaluator_.counters);
    ++evaluator_.counters.iterations;
    const double last_size = size;
    const Scaling::Size correction = plan_.contiguous ? subtract_step(q) : scaling_.column_size(step_);
    size = correction.all;
    if (!std::isfinite(size)) return outcome;
    // A correction with factors from a distance g leaves about (g + size) size.
    rate = plan_.constant_jacobian ? 0 : factored_.gap + size;
    if (outcome.iterations == 0) {
      outcome.first_correction = size;
      outcome.first_turn = correction.angle;
    } else if (!small && size > std::max(thresholds::solved, thresholds::sum_rounding * extent_)) {
      const double ratio = size / last_size;
      outcome.contraction = std::max(outcome.contraction, ratio);
      rate = std::max(rate, ratio);
      if (ratio > step_rules::poor_contraction) factored_.valid = false;
    } else if (small && size <= std::max(thresholds::solved, thresholds::sum_rounding * extent_)) {
      rate = 0;  // what is left is rounding
    }
    if (plan_.contiguous) continue;
    for (std::size_t c = 0; c < step_.size(); ++c) q[at(plan_.coordinate[c])] -= step_[c];
  }
}

// q -= step_, measured on the way.
Scaling::Size DrivenSolver::subtract_step(std::span<double> q) {
  if (step_.size() < few_columns) {
    BodyMotion motion;
    for (std::size_t c = 0; c < step_.size(); c += 3) motion.add(step_[c], step_[c + 1], step_[c + 2]);
    for (std::size_t c = 0; c < step_.size(); ++c) q[c] -= step_[c];
    return motion.size(evaluator_.length_scale());
  }
  return scaling_.scan_columns<1>(step_.size(), [&](std::size_t c) {
    q[c] -= step_[c];
    return std::array{step_[c]};
  })[0];
}

void DrivenSolver::subtract_product(std::span<const double> values, std::span<const double> x,
                                    std::span<double> rest) const {
  const int* start = plan_.jacobian.column_start.data();
  const int* row = plan_.jacobian.row_index.data();
  for (int c = 0; c < plan_.columns; ++c) {
    const double factor = x[at(c)];
    for (int k = start[c]; k < start[c + 1]; ++k) rest[at(row[k])] -= values[at(k)] * factor;
  }
}

bool DrivenSolver::solve_refined(std::span<double> x, bool has_start) {
  const std::span<const double> values = jacobian();
  bool factored_here = false;
  if (!factors_refine()) {
    if (!factorize()) return false;
    factored_here = true;
  }
  // At rest the solution is zero: refinement of a start would never end, since no relative accuracy of zero is reached.
  if (std::all_of(rhs_.begin(), rhs_.end(), [](double value) { return value == 0; })) {
    std::fill(x.begin(), x.end(), 0.0);
    return true;
  }
  if (!has_start) std::fill(x.begin(), x.end(), 0.0);
  const std::span<double> rest = all_rows_ ? std::span<double>(step_) : std::span<double>(residual_all_);
  double size = 0, all = 0, rate = refinement_rate();
  for (int k = 0; k < max_refinements; ++k) {
    std::copy(rhs_.begin(), rhs_.end(), rest.begin());
    if (has_start || k > 0) subtract_product(values, x, rest);
    if (!all_rows_) gather_rows(rest, step_);
    factorization_.solve(step_, evaluator_.counters);
    const double last_size = size;
    const auto sizes = scaling_.scan_columns<2>(x.size(), [&](std::size_t c) {
      x[c] += step_[c];
      return std::array{step_[c], x[c]};
    });
    size = sizes[0].all;
    all = sizes[1].all;
    if (!std::isfinite(size)) return false;
    if (k > 0) rate = std::max(rate, size / last_size);
    if (rate * size <= not_computed * all) {
      left_.of_rates = std::max(left_.of_rates, rate * size / all);
      return true;
    }
    if (k > 0 && size > step_rules::poor_contraction * last_size) {
      if (size > thresholds::solved * all && !factored_here) {
        if (!factorize()) return false;
        factored_here = true;
        rate = 0;
      } else if (k > 1 && is_solved_to_rounding(values, x)) {
        left_.of_rates = std::max(left_.of_rates, size / all);
        return true;
      }
    }
  }
  left_.of_rates = std::max(left_.of_rates, size / all);
  return size <= tolerance * all || is_solved_to_rounding(values, x);
}

// In a structure of very many parts corrections end well above the rounding of x: its own condition multiplies it. The
// result is then the exact solution of equations that differ from the given ones by rounding, row by row.
bool DrivenSolver::is_solved_to_rounding(std::span<const double> values, std::span<const double> x) {
  std::copy(rhs_.begin(), rhs_.end(), residual_all_.begin());
  subtract_product(values, x, residual_all_);
  terms_.resize(rhs_.size());
  for (std::size_t r = 0; r < rhs_.size(); ++r) terms_[r] = std::abs(rhs_[r]);
  for (int c = 0; c < plan_.columns; ++c) {
    for (int k = plan_.jacobian.column_start[at(c)]; k < plan_.jacobian.column_start[at(c) + 1]; ++k) {
      terms_[at(plan_.jacobian.row_index[at(k)])] += std::abs(values[at(k)] * x[at(c)]);
    }
  }
  return std::all_of(rows_.begin(), rows_.end(), [&](int row) {
    return std::abs(residual_all_[at(row)]) <= thresholds::sum_rounding * terms_[at(row)];
  });
}

// Solves for the columns of a vector over all coordinates, in place where they are the same.
bool DrivenSolver::solve_rate(std::span<double> rate, bool has_start) {
  if (plan_.contiguous) return solve_refined(rate.first(at(plan_.columns)), has_start);
  if (has_start) to_columns(rate, x_);
  if (!solve_refined(x_, has_start)) return false;
  to_coordinates(x_, rate);
  return true;
}

bool DrivenSolver::solve_velocity(std::span<double> qd, bool has_start) {
  if (!is_square()) return false;
  evaluator_.nu(rhs_);
  return solve_rate(qd, has_start);
}

bool DrivenSolver::solve_acceleration(std::span<const double> qd, std::span<double> qdd, bool has_start) {
  if (!is_square()) return false;
  evaluator_.gamma(qd, rhs_);
  return solve_rate(qdd, has_start);
}

bool DrivenSolver::respond(std::span<const double> rows, std::span<double> change) {
  if (!is_square() || !factored_.valid) return false;
  for (std::size_t k = 0; k < rows_.size(); ++k) step_[k] = rows[at(rows_[k])];
  factorization_.solve(step_, evaluator_.counters);
  std::fill(change.begin(), change.end(), 0.0);
  to_coordinates(step_, change);
  return true;
}

bool DrivenSolver::solve_multipliers(std::span<const double> rhs, std::span<double> lambda) {
  if (!is_square()) return false;
  const std::span<const double> values = jacobian();
  if (!factors_refine() && !factorize()) return false;
  std::fill(lambda.begin(), lambda.end(), 0.0);
  double size = 0;
  for (int k = 0; k < max_refinements; ++k) {
    std::copy(rhs.begin(), rhs.end(), step_.begin());
    if (k > 0) {
      for (double& x : lambda) x = -x;
      multiply_transposed_add(plan_.jacobian, values, lambda, step_);
      for (double& x : lambda) x = -x;
    }
    factorization_.solve_transposed(step_, evaluator_.counters);
    const double last_size = size;
    double all = 0;
    size = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      double& x = lambda[at(rows_[r])];
      x += step_[r];
      size = std::max(size, std::abs(step_[r]));
      all = std::max(all, std::abs(x));
    }
    if (!std::isfinite(all)) return false;
    // The ratio of corrections alone may be that of forces while what is left is moments.
    const double ratio = k > 0 ? size / last_size : 0, rate = std::max(refinement_rate(), ratio);
    if (rate * size <= not_computed * all) {
      if (all > 0) left_.of_multipliers = std::max(left_.of_multipliers, rate * size / all);
      return true;
    }
    if (ratio > step_rules::poor_contraction) {
      left_.of_multipliers = std::max(left_.of_multipliers, size / all);
      return size <= tolerance * all;
    }
  }
  left_.of_multipliers = 1;
  return true;
}

double DrivenSolver::factor_at(std::span<const double> q) {
  if (!is_square()) return 0;
  evaluate_at(q);
  return factorize() ? factored_.rcond : 0;
}

}  // namespace catena
