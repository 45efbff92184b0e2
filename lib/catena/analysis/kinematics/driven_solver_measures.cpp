// What the solver tells about a configuration: sizes of motions and residuals, the distance from singular matrices, the
// null vectors near them.
#include <algorithm>
#include <cmath>

#include "catena/analysis/kinematics/driven_solver.hpp"
#include "catena/base/at.hpp"

namespace catena {

// The largest shift in units of motion_unit_, or the largest angle, of what `entry` gives by coordinate.
template <class Entry>
double DrivenSolver::motion_size(Entry&& entry, double* angle) const {
  const double unit = 1 / motion_unit_;
  double shift = 0, turn = 0;
  for (std::size_t k = 0; k + 2 < 3 * at(plan_.moving); k += 3) {
    const double x = std::abs(entry(k)), y = std::abs(entry(k + 1)), phi = std::abs(entry(k + 2));
    shift = x > shift ? x : shift;
    shift = y > shift ? y : shift;
    turn = phi > turn ? phi : turn;
  }
  if (angle) *angle = turn;
  return std::max(shift * unit, turn);
}

double DrivenSolver::distance(std::span<const double> a, std::span<const double> b, double* angle) const {
  return motion_size([&](std::size_t k) { return a[k] - b[k]; }, angle);
}

double DrivenSolver::rate_size(std::span<const double> rate, double* angle) const {
  return motion_size([&](std::size_t k) { return rate[k]; }, angle);
}

double DrivenSolver::rate_norm(std::span<const double> rates) const {
  double largest = 0;
  for (const int k : plan_.coordinate)
    largest = std::max(largest, std::abs(rates[at(k)]) * (k % 3 == 2 ? 1 : 1 / evaluator_.length_scale()));
  return largest;
}

double DrivenSolver::redundant_residual(std::span<const double> residual_of_all, int* worst) const {
  double largest = 0;
  for (int row = 0; row < plan_.rows && !all_rows_; ++row) {
    if (in_use_[at(row)]) continue;
    const double size = std::abs(residual_of_all[at(row)]) * scaling_.row_unit(row);
    if (!(size <= largest)) largest = size, *worst = row;
  }
  return largest;
}

std::span<const BlockMargin> DrivenSolver::block_margins() {
  if (!factorization_.is_factorized()) return {};
  return factorization_.block_margins();
}

// By inverse iteration with the matrix in length scales and rad, R A C: of metres beside radians the smallest singular
// value would be one of units, in a mechanism of nanometres that of every angle.
bool DrivenSolver::null_vectors(std::span<double> w, std::span<double> z) {
  if (!is_square() || !factored_.valid) return false;
  // A start without symmetry: a null vector orthogonal to it would be missed.
  for (std::size_t k = 0; k < step_.size(); ++k) step_[k] = 1 + 0.37 * std::sin(1.0 + static_cast<double>(k));
  const auto row_unit = [&](std::size_t k) { return scaling_.row_unit(rows_[k]); };
  const auto column_unit = [&](std::size_t k) { return plan_.coordinate[k] % 3 == 2 ? 1 : evaluator_.length_scale(); };
  const auto divide = [&](auto&& unit) {
    for (std::size_t k = 0; k < step_.size(); ++k) step_[k] /= unit(k);
  };
  const auto normalise = [&] {
    double square = 0;
    for (double x : step_) square += x * x;
    for (double& x : step_) x /= std::sqrt(square);
    return square > 0 && std::isfinite(square);
  };
  for (int iteration = 0; iteration < 4; ++iteration) {
    divide(column_unit);
    factorization_.solve_transposed(step_, evaluator_.counters);
    divide(row_unit);
    if (!normalise()) return false;
    if (iteration == 3) {
      std::fill(w.begin(), w.end(), 0.0);
      for (std::size_t k = 0; k < rows_.size(); ++k) w[at(rows_[k])] = row_unit(k) * step_[k];
    }
    divide(row_unit);
    factorization_.solve(step_, evaluator_.counters);
    divide(column_unit);
    if (!normalise()) return false;
  }
  for (std::size_t k = 0; k < step_.size(); ++k) step_[k] *= column_unit(k);
  std::fill(z.begin(), z.end(), 0.0);
  to_coordinates(step_, z);
  return true;
}

}  // namespace catena
