// The choice of the equations that are solved with where there are more than needed: exchanges that make their
// determinant larger.
//
// Every equation left over is a combination of those in use, r = sum_k c_k row_k, found by one solve with the
// transposed matrix; putting it in the place of row k multiplies the determinant by c_k. With rows of length one,
// exchanges end in a set of (locally) greatest volume: no combination then has large coefficients, and the condition of
// the matrix is about that of the whole Phi_q. Source: S. Goreinov et al., "How to find a good submatrix" (2010).
#include <algorithm>
#include <cmath>

#include "catena/analysis/kinematics/driven_solver.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// An exchange is worth its factorization above this factor; so many of them, over so many rows left over, are tried.
constexpr double worthwhile = 1.5;
constexpr int most_exchanges = 32;
constexpr int most_candidates = 256;

}  // namespace

void DrivenSolver::use_rows(std::vector<int> rows) {
  rows_ = std::move(rows);
  all_rows_ = static_cast<int>(rows_.size()) == plan_.rows;
  matrix_.analyzed = factored_.valid = false;
  matrix_.gather.clear();
  if (all_rows_) return;
  std::vector<int> place(at(plan_.rows), -1);
  in_use_.assign(at(plan_.rows), 0);
  for (std::size_t k = 0; k < rows_.size(); ++k) place[at(rows_[k])] = static_cast<int>(k), in_use_[at(rows_[k])] = 1;
  matrix_.pattern = {static_cast<int>(rows_.size()), plan_.columns, {0}, {}};
  for (int c = 0; c < plan_.columns; ++c) {
    for (int k = plan_.jacobian.column_start[at(c)]; k < plan_.jacobian.column_start[at(c) + 1]; ++k) {
      const int row = place[at(plan_.jacobian.row_index[at(k)])];
      if (row < 0) continue;
      matrix_.pattern.row_index.push_back(row);
      matrix_.gather.push_back(k);
    }
    matrix_.pattern.column_start.push_back(static_cast<int>(matrix_.gather.size()));
  }
  matrix_.values.resize(matrix_.gather.size());
}

bool DrivenSolver::exchange_rows(std::span<const double> q) {
  if (all_rows_ || !is_square()) return false;
  evaluate_at(q);
  const SlottedPattern by_row = transpose(plan_.jacobian);
  const std::span<const double> values = jacobian();
  std::vector<double> row_values(values.size()), length(at(plan_.rows), 0.0), c(at(plan_.columns));
  for (std::size_t k = 0; k < values.size(); ++k) row_values[at(by_row.slot[k])] = values[k];
  const std::vector<int>& start = by_row.pattern.column_start;
  for (int r = 0; r < plan_.rows; ++r) {
    for (int k = start[at(r)]; k < start[at(r) + 1]; ++k) {
      // By length scales and radians: the choice must not depend on the unit of length.
      const bool angle = plan_.coordinate[at(by_row.pattern.row_index[at(k)])] % 3 == 2;
      const double value = row_values[at(k)] * (angle ? 1 : evaluator_.length_scale());
      length[at(r)] += value * value;
    }
    length[at(r)] = std::sqrt(length[at(r)]);
  }
  bool changed = false;
  for (int exchange = 0; exchange < most_exchanges; ++exchange) {
    if (!factorize()) return changed;
    double most = worthwhile;
    int enters = -1;
    std::size_t leaves = 0;
    int candidates = 0;
    for (int r = 0; r < plan_.rows && candidates < most_candidates; ++r) {
      if (in_use_[at(r)] || !(length[at(r)] > 0)) continue;
      ++candidates;
      std::fill(c.begin(), c.end(), 0.0);
      for (int k = start[at(r)]; k < start[at(r) + 1]; ++k) c[at(by_row.pattern.row_index[at(k)])] = row_values[at(k)];
      factorization_.solve_transposed(c, evaluator_.counters);
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        const double gain = std::abs(c[k]) * length[at(rows_[k])] / length[at(r)];
        if (gain > most) most = gain, enters = r, leaves = k;
      }
    }
    if (enters < 0) break;
    std::vector<int> rows = rows_;
    rows[leaves] = enters;
    std::sort(rows.begin(), rows.end());
    use_rows(std::move(rows));
    changed = true;
  }
  return changed;
}

}  // namespace catena
