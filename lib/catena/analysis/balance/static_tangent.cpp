#include "catena/analysis/balance/static_tangent.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr int most_tangent_corrections = 10;

}  // namespace

StaticTangent::StaticTangent(StaticSystem& system) : system_(system) {
  const Plan& plan = system.plan();
  const int size = plan.columns + plan.rows;
  std::vector<MatrixEntry> places;
  for (int k = 0; k < size; ++k) places.push_back({k, k});
  for (int c = 0; c < plan.columns; ++c) {
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      const int row = plan.columns + plan.jacobian.row_index[at(k)];
      places.push_back({row, c});
      places.push_back({c, row});
    }
  }
  const std::size_t first = places.size();
  const std::vector<double> none(at(plan.rows) + 1, 0.0);
  visit(none, [&](int row, int column, double) { places.push_back({row, column}); });
  SlottedPattern built = build_pattern(size, size, places);
  slot_.assign(built.slot.begin(), built.slot.begin() + static_cast<std::ptrdiff_t>(first));
  element_slot_.assign(built.slot.begin() + static_cast<std::ptrdiff_t>(first), built.slot.end());
  values_.resize(built.pattern.row_index.size());
  correction_.resize(at(size));
  usable_ = factorization_.analyze(built.pattern, Kernel::automatic, system.evaluator().counters).ok();
}

// All entries of -dQ/dq and of sum lambda Phi_qq over columns.
template <class F>
void StaticTangent::visit(std::span<const double> lambda, F&& entry) {
  const Plan& plan = system_.plan();
  const auto element = [&](int i, int j, const ElementMatrix& m) {
    for (int a = 0; a < 6; ++a) {
      const int row = plan.column_of(i, j, a);
      for (int b = 0; b < 6 && row >= 0; ++b) {
        const int column = plan.column_of(i, j, b);
        if (column >= 0) entry(row, column, m[at(6 * a + b)]);
      }
    }
  };
  system_.evaluator().visit_stiffness({}, element);
  system_.evaluator().visit_constraint_hessians(lambda, element);
}

void StaticTangent::fill(std::span<const double> lambda, double damping, double compliance) {
  const Plan& plan = system_.plan();
  std::fill(values_.begin(), values_.end(), 0.0);
  std::size_t k = 0;
  for (int c = 0; c < plan.columns; ++c, ++k) {
    const int coordinate = plan.coordinate[at(c)];
    const double arm = coordinate % 3 == 2 ? system_.radius()[at(coordinate / 3)] : 1;
    values_[at(slot_[k])] += damping * arm * arm;
  }
  for (int r = 0; r < plan.rows; ++r, ++k) values_[at(slot_[k])] -= compliance;
  for (double value : system_.jacobian()) {
    values_[at(slot_[k++])] += value;
    values_[at(slot_[k++])] += value;
  }
  k = 0;
  visit(lambda, [&](int, int, double value) { values_[at(element_slot_[k++])] += value; });
}

bool StaticTangent::factorize() {
  return usable_ && factorization_.factorize(values_, system_.evaluator().counters).ok();
}

bool StaticTangent::solve(std::span<double> x) {
  return factorization_.solve_checked(values_, x, system_.evaluator().counters).ok();
}

void StaticTangent::multiply(std::span<const double> x, std::span<double> y, bool transposed) const {
  const SparsePattern& pattern = factorization_.pattern();
  const int columns = system_.plan().columns;
  std::fill(y.begin(), y.end(), 0.0);
  for (int c = 0; c < pattern.columns; ++c) {
    for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
      const int r = pattern.row_index[at(k)];
      if (r >= columns && c >= columns) continue;  // E
      y[at(transposed ? c : r)] += values_[at(k)] * x[at(transposed ? r : c)];
    }
  }
}

void StaticTangent::solve_to_rounding(std::span<const double> given, std::span<double> x, bool transposed) {
  Counters& counters = system_.evaluator().counters;
  const std::span<const double> radius = system_.radius();
  const Plan& plan = system_.plan();
  const auto solve_once = [&](std::span<double> b) {
    if (transposed)
      factorization_.solve_transposed(b, counters);
    else
      static_cast<void>(factorization_.solve_checked(values_, b, counters));
  };
  // Angles over the arms; multipliers follow from places.
  const auto size = [&](std::span<const double> b) {
    double sum = 0;
    for (int c = 0; c < plan.columns; ++c) {
      const int coordinate = plan.coordinate[at(c)];
      const double v = b[at(c)] * (coordinate % 3 == 2 ? radius[at(coordinate / 3)] : 1);
      sum += v * v;
    }
    return std::sqrt(sum);
  };
  std::copy(given.begin(), given.end(), x.begin());
  solve_once(x);
  double before = size(x);
  for (int k = 0; k < most_tangent_corrections; ++k) {
    multiply(x, correction_, transposed);
    for (std::size_t i = 0; i < x.size(); ++i) correction_[i] = given[i] - correction_[i];
    solve_once(correction_);
    const double now = size(correction_);
    if (!(now < thresholds::least_gain * before)) return;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += correction_[i];
    before = now;
  }
}

void StaticTangent::multiply_stiffness(std::span<const double> x, std::span<double> y, bool transposed) const {
  const SparsePattern& pattern = factorization_.pattern();
  const int columns = system_.plan().columns;
  std::fill(y.begin(), y.end(), 0.0);
  for (int c = 0; c < columns; ++c) {
    for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
      const int r = pattern.row_index[at(k)];
      if (r < columns) y[at(transposed ? c : r)] += values_[at(k)] * x[at(transposed ? r : c)];
    }
  }
}

double StaticTangent::largest_stiffness() const {
  const SparsePattern& pattern = factorization_.pattern();
  const std::span<const double> inverse_arms = system_.matrix().inverse_arms();
  double largest = 0;
  for (int c = 0; c < static_cast<int>(inverse_arms.size()); ++c) {
    for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
      const int r = pattern.row_index[at(k)];
      if (r >= static_cast<int>(inverse_arms.size())) continue;
      largest = std::max(largest, std::abs(values_[at(k)]) * inverse_arms[at(c)] * inverse_arms[at(r)]);
    }
  }
  return largest;
}

}  // namespace catena
