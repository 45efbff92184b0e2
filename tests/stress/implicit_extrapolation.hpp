// q'' = a(t, q, q') where it is stiff, apart from the library: implicit Euler and extrapolation, in long double.
//
//   w1 = w0 + g a(t1, q0 + g w1, w1),   q1 = q0 + g w1,   g = h / m, m = 1 ... 10
//   T(m, j) = T(m, j-1) + (T(m, j-1) - T(m-1, j-1)) / (m / (m - j) - 1)
//
// Its steps damp what is faster than they are (A(88 degrees)-stable, and 0 at infinity), so that they are as long as
// the slow motion allows once fast parts have died away. Newton's method keeps a matrix, by differences of a at the
// start of h, for the whole step. Source: P. Deuflhard, E. Hairer, G. Wanner, Solving Ordinary Differential Equations
// II, IV.9.
#pragma once

#include <array>

#include "references/dense.hpp"
#include "stress/dense_mechanism.hpp"

namespace catena::testing {

template <class Acceleration>
class ImplicitExtrapolation {
 public:
  /// To `tolerance` of `scale`, [q, v], a step.
  ImplicitExtrapolation(Acceleration acceleration, Vector q, Vector v, Vector scale, Real first_step, Real tolerance)
      : acceleration_(std::move(acceleration)),
        q_(std::move(q)),
        v_(std::move(v)),
        scale_(std::move(scale)),
        h_(first_step),
        tolerance_(tolerance) {}

  const Vector& q() const { return q_; }
  const Vector& v() const { return v_; }
  /// False where more than `most` steps would be needed.
  bool go_to(Real end, int most) {
    while (t_ < end) {
      if (--most < 0) return false;
      const Real h = std::min(h_, end - t_);
      const Real error = step(h);
      if (error <= 1) {
        q_ = next_.head(q_.size());
        v_ = next_.tail(q_.size());
        t_ = h == end - t_ ? end : t_ + h;
      }
      const Real factor = 0.8L * std::pow(1 / (error + 1e-12L), 1 / Real(columns));
      if (error > 1 || h == h_) h_ = h * std::min(Real(3), std::max(Real(0.1), std::isfinite(error) ? factor : 0));
    }
    return q_.allFinite();
  }

 private:
  static constexpr int columns = 10, most_corrections = 12;

  // da/dq and da/dv at the start of a step.
  void linearize() {
    const Eigen::Index n = q_.size();
    by_place_ = by_velocity_ = Matrix::Zero(n, n);
    const Vector here = acceleration_(t_, q_, v_);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Real dq = 1e-9L * scale_[k], dv = 1e-7L * scale_[n + k];
      Vector moved = q_;
      moved[k] += dq;
      by_place_.col(k) = (acceleration_(t_, moved, v_) - here) / dq;
      moved = v_;
      moved[k] += dv;
      by_velocity_.col(k) = (acceleration_(t_, q_, moved) - here) / dv;
    }
  }

  /// `parts` steps of implicit Euler; false where Newton's method does not converge.
  bool euler(Real h, int parts, Vector& out) {
    const Eigen::Index n = q_.size();
    const Real g = h / parts;
    const ReferenceFactors<Real> lu(Matrix::Identity(n, n) - g * by_velocity_ - g * g * by_place_);
    Vector q = q_, v = v_;
    for (int k = 1; k <= parts; ++k) {
      Vector w = v;
      Real before = std::numeric_limits<Real>::infinity();
      for (int correction = 0;; ++correction) {
        const Vector change = lu.solve(v - w + g * acceleration_(t_ + k * g, q + g * w, w));
        w += change;
        const Real size = (change.cwiseAbs().cwiseQuotient(scale_.tail(n))).maxCoeff();
        if (!std::isfinite(size) || correction > most_corrections) return false;
        // Down to where rounding is left.
        if (size <= 1e-3L * tolerance_ || (size > before / 2 && size <= 0.1L * tolerance_)) break;
        if (size > 2 * before) return false;
        before = size;
      }
      q += g * w;
      v = w;
    }
    out << q, v;
    return true;
  }

  Real step(Real h) {
    std::array<Vector, columns> row, before;
    linearize();
    Real error = 0;
    for (int m = 0; m < columns; ++m) {
      row[0] = Vector(2 * q_.size());
      if (!euler(h, m + 1, row[0])) return 1e30L;
      for (int j = 1; j <= m; ++j) {
        const Real ratio = Real(m + 1) / Real(m + 1 - j);
        const Vector change =
            (row[static_cast<std::size_t>(j - 1)] - before[static_cast<std::size_t>(j - 1)]) / (ratio - 1);
        row[static_cast<std::size_t>(j)] = row[static_cast<std::size_t>(j - 1)] + change;
        error = change.cwiseAbs().cwiseQuotient(scale_).maxCoeff() / tolerance_;
      }
      before = row;
    }
    next_ = row[columns - 1];
    return next_.allFinite() ? error : std::numeric_limits<Real>::infinity();
  }

  Acceleration acceleration_;
  Vector q_, v_, next_, scale_;
  Matrix by_place_, by_velocity_;
  Real t_ = 0, h_, tolerance_;
};

}  // namespace catena::testing
