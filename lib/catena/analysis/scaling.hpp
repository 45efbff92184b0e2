// Norms in which metres and radians can be compared, so that a machine in millimetres and one in kilometres converge
// alike: lengths are divided by the scene's length scale, angles are taken as they are.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "catena/assembly/plan.hpp"

namespace catena {

class Scaling {
 public:
  Scaling(const Plan& plan, double length) : columns_(plan.coordinate.size()), rows_(plan.row_is_angle.size()) {
    for (std::size_t c = 0; c < columns_.size(); ++c) columns_[c] = plan.coordinate[c] % 3 == 2 ? 1.0 : 1.0 / length;
    for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r] = plan.row_is_angle[r] ? 1.0 : 1.0 / length;
  }

  /// Largest entry of a vector over the columns of Phi_q; NaN if any entry is not finite.
  double column_norm(std::span<const double> x) const { return largest(x, columns_); }
  /// Largest difference of two vectors over the columns.
  double column_distance(std::span<const double> a, std::span<const double> b) const {
    double most = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double size = std::abs(a[k] - b[k]) * columns_[k];
      most = size > most ? size : most;
    }
    return most;
  }
  /// Largest residual; NaN if any is not finite.
  double row_norm(std::span<const double> r) const { return largest(r, rows_); }
  /// Largest angle of a vector over the columns, rad.
  double largest_angle(std::span<const double> x, const Plan& plan) const {
    double most = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double size = plan.coordinate[k] % 3 == 2 ? std::abs(x[k]) : 0;
      most = size > most ? size : most;
    }
    return most;
  }
  double row_unit(int row) const { return rows_[static_cast<std::size_t>(row)]; }

 private:
  // Independent lanes let the compiler vectorise a maximum, whose order of evaluation it may not change itself.
  static double largest(std::span<const double> x, const std::vector<double>& scale) {
    constexpr std::size_t lanes = 8;
    double most[lanes] = {}, sum[lanes] = {};
    std::size_t k = 0;
    for (; k + lanes <= x.size(); k += lanes) {
      for (std::size_t l = 0; l < lanes; ++l) {
        const double size = std::abs(x[k + l]) * scale[k + l];
        most[l] = size > most[l] ? size : most[l];
        sum[l] += size;
      }
    }
    for (; k < x.size(); ++k) {
      const double size = std::abs(x[k]) * scale[k];
      most[0] = size > most[0] ? size : most[0];
      sum[0] += size;
    }
    double result = 0, total = 0;
    for (std::size_t l = 0; l < lanes; ++l) {
      result = most[l] > result ? most[l] : result;
      total += sum[l];
    }
    return std::isfinite(total) ? result : total - total;  // infinite - infinite is NaN
  }

  std::vector<double> columns_, rows_;
};

/// The same norms for a single use.
inline double column_norm(const Plan& plan, std::span<const double> x, double length) {
  return Scaling(plan, length).column_norm(x);
}
/// `worst`: the row of the largest residual.
inline double row_norm(const Plan& plan, std::span<const double> r, double length, int* worst = nullptr) {
  const Scaling scaling(plan, length);
  if (worst) {
    *worst = 0;
    const auto size = [&](int k) { return std::abs(r[static_cast<std::size_t>(k)]) * scaling.row_unit(k); };
    for (int k = 0; k < static_cast<int>(r.size()); ++k) {
      if (!(size(k) <= size(*worst))) *worst = k;
    }
  }
  return scaling.row_norm(r);
}

}  // namespace catena
