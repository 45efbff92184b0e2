// Norms in which metres and radians can be compared, so that a machine in millimetres and one in kilometres converge
// alike: lengths are divided by the scene's length scale, angles are taken as they are.
//
//   |x| = max_k |x_k| u_k        u_k = 1 / length scale for x, y and residuals in metres, 1 for angles
//
// A large scene does not fit into the caches, so that a pass over a vector costs memory traffic, not arithmetic: `scan`
// measures vectors in the same pass that computes or moves them, and skips the units where they repeat. Norms of
// vectors with an entry that is not finite are NaN.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "catena/assembly/plan.hpp"

namespace catena {

class Scaling {
 public:
  /// Largest entry in units, and largest of the angles alone, rad.
  struct Size {
    double all = 0, angle = 0;
  };

  Scaling(const Plan& plan, double length) {
    // Without particles the units of the columns repeat with every body; mostly those of the rows are all the same.
    const std::size_t columns = plan.contiguous ? lanes : plan.coordinate.size();
    columns_.repeat = plan.contiguous;
    for (std::size_t c = 0; c < columns; ++c) {
      columns_.push_back((plan.contiguous ? static_cast<int>(c) : plan.coordinate[c]) % 3 == 2, length);
    }
    bool any = false, all = true;
    for (bool angle : plan.row_is_angle) any = any || angle, all = all && angle;
    rows_.repeat = !any || all;
    for (std::size_t r = 0; r < (rows_.repeat ? lanes : plan.row_is_angle.size()); ++r) {
      rows_.push_back(rows_.repeat ? any : plan.row_is_angle[r], length);
    }
  }

  /// Calls `entry(k)` for k = 0 ... n - 1, which returns N entries of vectors over the columns, and measures them.
  template <int N, class Entry>
  std::array<Size, static_cast<std::size_t>(N)> scan_columns(std::size_t n, Entry&& entry) const {
    return scan<static_cast<std::size_t>(N)>(columns_, n, entry);
  }
  /// The same for one vector over the rows.
  template <class Entry>
  double scan_rows(std::size_t n, Entry&& entry) const {
    return scan<1>(rows_, n, [&](std::size_t k) { return std::array{entry(k)}; })[0].all;
  }

  /// Largest entry of a vector over the columns of Phi_q.
  double column_norm(std::span<const double> x) const { return column_size(x).all; }
  Size column_size(std::span<const double> x) const {
    return scan_columns<1>(x.size(), [&](std::size_t k) { return std::array{x[k]}; })[0];
  }
  /// Largest entry of a vector over the coordinates, where these have columns.
  double coordinate_norm(const Plan& plan, std::span<const double> x) const {
    const std::vector<int>& place = plan.coordinate;
    return scan_columns<1>(place.size(),
                           [&](std::size_t k) { return std::array{x[static_cast<std::size_t>(place[k])]}; })[0]
        .all;
  }
  /// Largest residual.
  double row_norm(std::span<const double> r) const {
    return scan_rows(r.size(), [&](std::size_t k) { return r[k]; });
  }
  double row_unit(int row) const { return rows_.unit[rows_.repeat ? 0 : static_cast<std::size_t>(row)]; }

 private:
  // Independent lanes let the compiler vectorise a maximum, whose order of evaluation it may not change itself; three
  // coordinates a body and vectors of up to eight entries make it 24.
  static constexpr std::size_t lanes = 24;

  struct Units {
    bool repeat = false;
    std::vector<double> unit;
    std::vector<double> angle;  // 1 for angles, else 0
    void push_back(bool is_angle, double length) {
      unit.push_back(is_angle ? 1.0 : 1.0 / length);
      angle.push_back(is_angle ? 1.0 : 0.0);
    }
  };

  template <std::size_t N, class Entry>
  static std::array<Size, N> scan(const Units& units, std::size_t n, Entry&& entry) {
    Sums<N> sums;
    // Setting up the lanes costs more than the few bodies of a small mechanism.
    std::size_t k = 0;
    if (units.repeat && n >= lanes) k = scan_lanes(units, n, entry, sums);
    // Of units that repeat fewer than one pass over the lanes is left.
    const std::size_t first = k;
    for (; k < n; ++k) {
      const std::size_t u = k - first;
      const std::array<double, N> x = entry(k);
      for (std::size_t v = 0; v < N; ++v) {
        const double size = std::abs(x[v]) * units.unit[u], angle = size * units.angle[u];
        sums.size[v].all = size > sums.size[v].all ? size : sums.size[v].all;
        sums.size[v].angle = angle > sums.size[v].angle ? angle : sums.size[v].angle;
        sums.total[v] += size;
      }
    }
    for (std::size_t v = 0; v < N; ++v) {
      const double total = sums.total[v];
      if (!std::isfinite(total)) sums.size[v].all = sums.size[v].angle = total - total;  // infinite - infinite: NaN
    }
    return sums.size;
  }

  template <std::size_t N>
  struct Sums {
    std::array<Size, N> size{};
    std::array<double, N> total{};
  };

  /// Measures all entries but those of the last, incomplete pass over the lanes; returns the number of the first left.
  template <std::size_t N, class Entry>
  static std::size_t scan_lanes(const Units& units, std::size_t n, Entry&& entry, Sums<N>& sums) {
    double most[N][lanes] = {}, sum[N][lanes] = {}, unit[lanes];
    for (std::size_t l = 0; l < lanes; ++l) unit[l] = units.unit[l];
    std::size_t k = 0;
    for (; k + lanes <= n; k += lanes) {
      for (std::size_t l = 0; l < lanes; ++l) {
        const std::array<double, N> x = entry(k + l);
        for (std::size_t v = 0; v < N; ++v) {
          const double size = std::abs(x[v]) * unit[l];
          most[v][l] = size > most[v][l] ? size : most[v][l];
          sum[v][l] += size;
        }
      }
    }
    for (std::size_t v = 0; v < N; ++v) {
      for (std::size_t l = 0; l < lanes; ++l) {
        Size& size = sums.size[v];
        size.all = most[v][l] > size.all ? most[v][l] : size.all;
        if (units.angle[l] != 0 && most[v][l] > size.angle) size.angle = most[v][l];
        sums.total[v] += sum[v][l];
      }
    }
    return k;
  }

  Units columns_, rows_;
};

/// The norm of rows for a single use; `worst`: the row of the largest residual.
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
