// Scenes with laws of state, and what their tests are held against: cubic splines by a dense solve for the slopes at
// the knots, and motions by the classical Runge-Kutta method with many small steps. No code of the library.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "references/dense.hpp"

namespace catena::testing {

/// A scene of bodies and forces.
inline std::string law_scene(const std::string& parts, const std::string& outputs, const std::string& analyses) {
  return R"--({"catena": 1, )--" + parts + R"--(, "outputs": [)--" + outputs + R"--(], "analyses": [)--" + analyses +
         "]}";
}

/// A cubic spline in Hermite form: its slopes follow from continuous second derivatives.
class ReferenceSpline {
 public:
  ReferenceSpline(std::vector<double> x, std::vector<double> y, const std::string& end)
      : x_(std::move(x)), y_(std::move(y)), periodic_(end == "periodic") {
    const auto n = static_cast<Eigen::Index>(x_.size());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    const auto width = [&](Eigen::Index k) { return x_[at(k + 1)] - x_[at(k)]; };
    const auto slope = [&](Eigen::Index k) { return (y_[at(k + 1)] - y_[at(k)]) / width(k); };
    // s''(right end of piece k) = (2 m_k + 4 m_k+1 - 6 d_k) / h_k, s''(left end) = (6 d_k - 4 m_k - 2 m_k+1) / h_k.
    for (Eigen::Index k = 1; k + 1 < n; ++k) {
      a(k, k - 1) += 2 / width(k - 1);
      a(k, k) += 4 / width(k - 1) + 4 / width(k);
      a(k, k + 1) += 2 / width(k);
      b(k) = 6 * slope(k - 1) / width(k - 1) + 6 * slope(k) / width(k);
    }
    if (end == "clamped") {
      a(0, 0) = a(n - 1, n - 1) = 1;
    } else if (end == "natural") {
      a(0, 0) = 4;
      a(0, 1) = 2;
      b(0) = 6 * slope(0);
      a(n - 1, n - 2) = 2;
      a(n - 1, n - 1) = 4;
      b(n - 1) = 6 * slope(n - 2);
    } else {
      a(0, 0) = 1;
      a(0, n - 1) = -1;
      a(n - 1, 0) += 4 / width(0);
      a(n - 1, 1) += 2 / width(0);
      a(n - 1, n - 2) += 2 / width(n - 2);
      a(n - 1, n - 1) += 4 / width(n - 2);
      b(n - 1) = 6 * slope(0) / width(0) + 6 * slope(n - 2) / width(n - 2);
    }
    const Eigen::VectorXd m = solve<double>(a, b);
    slope_.assign(m.data(), m.data() + n);
  }

  /// Beyond the ends of one that is not periodic: along straight lines.
  double operator()(double x) const {
    const double period = x_.back() - x_.front();
    if (periodic_) x -= std::floor((x - x_.front()) / period) * period;
    if (x <= x_.front()) return y_.front() + slope_.front() * (x - x_.front());
    if (x >= x_.back()) return y_.back() + slope_.back() * (x - x_.back());
    std::size_t k = 0;
    while (x > x_[k + 1]) ++k;
    const double h = x_[k + 1] - x_[k], u = (x - x_[k]) / h, v = 1 - u;
    return y_[k] * v * v * (1 + 2 * u) + y_[k + 1] * u * u * (3 - 2 * u) +
           h * u * v * (slope_[k] * v - slope_[k + 1] * u);
  }

 private:
  static std::size_t at(Eigen::Index k) { return static_cast<std::size_t>(k); }
  std::vector<double> x_, y_, slope_;
  bool periodic_;
};

using ReferenceState = std::vector<double>;
using ReferenceSlope = std::function<ReferenceState(double t, const ReferenceState&)>;

/// The state at `until`, from t = 0, in `steps` steps of order 4.
inline ReferenceState integrate(const ReferenceSlope& slope, ReferenceState y, double until, int steps) {
  const double h = until / steps;
  const auto moved = [](const ReferenceState& from, double by, const ReferenceState& along) {
    ReferenceState to = from;
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += by * along[k];
    return to;
  };
  for (int n = 0; n < steps; ++n) {
    const double t = n * h;
    const ReferenceState a = slope(t, y), b = slope(t + h / 2, moved(y, h / 2, a)),
                         c = slope(t + h / 2, moved(y, h / 2, b)), d = slope(t + h, moved(y, h, c));
    for (std::size_t k = 0; k < y.size(); ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
  }
  return y;
}

}  // namespace catena::testing
