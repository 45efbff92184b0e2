// A mechanism of few bodies computed apart from the library: constraints and forces are a line of jets each (value,
// first and second derivative along a motion), matrices dense, numbers long double, the integrator an extrapolation.
//
//   [M  Phi_q^T; Phi_q  0] [a; lambda] = [Q; -Phi'' at a = 0]        Q = sum over loads of f ds/dq
//
// A row Phi and the coordinate s along which a load f acts are functions of the places of two bodies, each with its
// jet, and of time. Jacobians are their first derivatives along one coordinate, Phi'' the second one along v. Redundant
// rows are left out: those that a QR factorization with pivots finds dependent at the start. Symbols: q = (x, y, phi)
// of every body, m and rad. Integrated without projection: drift is of the order of long double's rounding. Singular
// where the rows that were kept become dependent. Method of integration: as KnownPath in oracles/known_motion.hpp.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "oracles/known_motion.hpp"
#include "references/dense.hpp"

namespace catena::testing {

using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

inline Jet atan2(Jet y, Jet x) {
  const Real r2 = x.f * x.f + y.f * y.f, d = (x.f * y.d - y.f * x.d) / r2;
  return {std::atan2(y.f, x.f), d, (x.f * y.dd - y.f * x.dd - 2 * d * (x.f * x.d + y.f * y.d)) / r2};
}

class DenseMechanism {
 public:
  /// Places of bodies i and j (the ground's is zero) and the time.
  using Function = std::function<Jet(const JetPlace& i, const JetPlace& j, Jet t)>;
  struct Body {
    Real mass, inertia;
  };
  struct Row {
    int i, j;
    Function phi;
    Real period = 0;  ///< by which phi may change although the row is met: of angles around a circle; 0: none
  };
  struct Load {
    int i, j;
    Function along;
    std::function<Real(Jet along, Real t, const JetPlace& i)> force;
    std::function<Jet(Jet along)> potential;  ///< empty: none
  };
  std::vector<Body> bodies;
  std::vector<Row> rows;
  std::vector<Load> loads;
  Vec2<double> gravity{};
  Real length = 1;  ///< by which angles are made comparable with places

  Eigen::Index size() const { return 3 * static_cast<Eigen::Index>(bodies.size()); }

  static JetPlace place(int body, const Vector& q, const Vector& v, const Vector& a) {
    if (body < 0) return {};
    const Eigen::Index k = 3 * body;
    return {{{q[k], v[k], a[k]}, {q[k + 1], v[k + 1], a[k + 1]}}, {q[k + 2], v[k + 2], a[k + 2]}};
  }
  template <class Part>
  Jet along(const Part& part, const Function& f, Jet t, const Vector& q, const Vector& v, const Vector& a) const {
    return f(place(part.i, q, v, a), place(part.j, q, v, a), t);
  }
  /// df/dq at a frozen time.
  template <class Part>
  Vector gradient(const Part& part, const Function& f, Real t, const Vector& q) const {
    const Vector zero = Vector::Zero(size());
    Vector g = zero, one = zero;
    for (const int body : {part.i, part.j}) {
      for (Eigen::Index k = 3 * body; body >= 0 && k < 3 * body + 3; ++k) {
        one[k] = 1;
        g[k] = along(part, f, {t}, q, one, zero).d;
        one[k] = 0;
      }
    }
    return g;
  }
  Matrix jacobian(Real t, const Vector& q) const {
    Matrix m(static_cast<Eigen::Index>(rows.size()), size());
    for (std::size_t k = 0; k < rows.size(); ++k)
      m.row(static_cast<Eigen::Index>(k)) = gradient(rows[k], rows[k].phi, t, q).transpose();
    return m;
  }
  /// Phi, Phi' and Phi'' of every row, along v and a.
  std::vector<Jet> residuals(Real t, const Vector& q, const Vector& v, const Vector& a) const {
    std::vector<Jet> all;
    for (const Row& row : rows) all.push_back(along(row, row.phi, {t, 1, 0}, q, v, a));
    return all;
  }
  Vector masses() const {
    Vector m(size());
    for (std::size_t b = 0; b < bodies.size(); ++b)
      m.segment<3>(3 * static_cast<Eigen::Index>(b)) << bodies[b].mass, bodies[b].mass, bodies[b].inertia;
    return m;
  }
  /// Applied loads and weights.
  Vector forces(Real t, const Vector& q, const Vector& v) const {
    const Vector zero = Vector::Zero(size());
    Vector f = zero;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Eigen::Index k = 3 * static_cast<Eigen::Index>(b);
      f[k] = bodies[b].mass * gravity.x;
      f[k + 1] = bodies[b].mass * gravity.y;
    }
    for (const Load& load : loads) {
      const Jet s = along(load, load.along, {t, 1, 0}, q, v, zero);
      f += load.force(s, t, place(load.i, q, v, zero)) * gradient(load, load.along, t, q);
    }
    return f;
  }
  /// Potential energy along a motion.
  Jet potential(const Vector& q, const Vector& v, const Vector& a) const {
    Jet sum;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const JetPlace p = place(static_cast<int>(b), q, v, a);
      sum = sum - bodies[b].mass * (Real(gravity.x) * p.r.x + Real(gravity.y) * p.r.y);
    }
    for (const Load& load : loads) {
      if (load.potential) sum = sum + load.potential(along(load, load.along, {}, q, v, a));
    }
    return sum;
  }

  /// By how much the rows at q differ from those of the start, at most, in lengths and rad.
  Real missed(const Vector& start, const Vector& q) const {
    const Vector zero = Vector::Zero(size());
    const std::vector<Jet> first = residuals(0, start, zero, zero), now = residuals(0, q, zero, zero);
    Real most = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Real change = now[k].f - first[k].f;
      // Angles and lengths are told apart by their period, gears by theirs.
      const bool angle = rows[k].period == turn || rows[k].period == turn / 2;
      const Real left = rows[k].period > 0 ? std::remainder(change, rows[k].period) : change;
      most = std::max(most, std::abs(left) / (angle ? 1 : length));
    }
    return most;
  }

  static inline const Real turn = 2 * std::acos(Real(-1));

  /// Which rows are independent at q, by a factorization with pivots of the scaled Jacobian.
  std::vector<Eigen::Index> independent_rows(Real t, const Vector& q) const {
    Matrix scaled = jacobian(t, q);
    for (Eigen::Index k = 2; k < size(); k += 3) scaled.col(k) /= length;
    for (Eigen::Index k = 0; k < scaled.rows(); ++k) scaled.row(k).normalize();
    if (scaled.rows() == 0) return {};
    return DenseRows<Real>(scaled, 1e-9L).independent();
  }
};

/// y' = f(t, y) by Gragg's rule and extrapolation, to `tolerance` of `scale` a step.
template <class Slope>
class Extrapolation {
 public:
  Extrapolation(Slope slope, Vector y, Vector scale, Real first_step, Real tolerance)
      : slope_(std::move(slope)), y_(std::move(y)), scale_(std::move(scale)), h_(first_step), tolerance_(tolerance) {}

  const Vector& y() const { return y_; }
  /// False where more than `most` steps would be needed.
  bool go_to(Real end, int most = 2000) {
    while (t_ < end) {
      if (--most < 0) return false;
      const Real h = std::min(h_, end - t_);
      const Real error = step(h);
      if (error <= 1) {
        y_ = next_;
        t_ = h == end - t_ ? end : t_ + h;
      }
      const Real factor = 0.8L * std::pow(1 / (error + 1e-12L), 1 / Real(2 * columns - 1));
      if (error > 1 || h == h_) h_ = h * std::min(Real(3), std::max(Real(0.1), std::isfinite(error) ? factor : 0));
    }
    return y_.allFinite();
  }

 private:
  static constexpr int columns = 7;

  Real step(Real h) {
    std::array<Vector, columns> row, before;
    const Vector first = slope_(t_, y_);
    Real error = 0;
    for (int m = 0; m < columns; ++m) {
      const int parts = 2 * (m + 1);
      const Real part = h / parts;
      Vector a = y_, b = y_ + part * first;
      for (int k = 1; k < parts; ++k) {
        Vector c = a + 2 * part * slope_(t_ + k * part, b);
        a = std::move(b);
        b = std::move(c);
      }
      row[0] = (b + a + part * slope_(t_ + h, b)) / 2;
      for (int j = 1; j <= m; ++j) {
        const Real ratio = Real(m + 1) / Real(m + 1 - j);
        const Vector change = (row[j - 1] - before[j - 1]) / (ratio * ratio - 1);
        row[j] = row[j - 1] + change;
        error = change.cwiseAbs().cwiseQuotient(scale_).maxCoeff() / tolerance_;
      }
      before = row;
    }
    next_ = row[columns - 1];
    return next_.allFinite() ? error : std::numeric_limits<Real>::infinity();
  }

  Slope slope_;
  Vector y_, next_, scale_;
  Real t_ = 0, h_, tolerance_;
};

/// a from the equations at the head, with the rows that are independent.
inline Vector acceleration(const DenseMechanism& m, const std::vector<Eigen::Index>& kept, Real t, const Vector& q,
                           const Vector& v) {
  const Eigen::Index n = m.size(), r = static_cast<Eigen::Index>(kept.size());
  const Matrix full = m.jacobian(t, q);
  const std::vector<Jet> phi = m.residuals(t, q, v, Vector::Zero(n));
  Matrix kkt = Matrix::Zero(n + r, n + r);
  Vector right(n + r);
  kkt.diagonal().head(n) = m.masses();
  right.head(n) = m.forces(t, q, v);
  for (Eigen::Index k = 0; k < r; ++k) {
    const Eigen::Index row = kept[static_cast<std::size_t>(k)];
    kkt.block(n + k, 0, 1, n) = full.row(row);
    kkt.block(0, n + k, n, 1) = full.row(row).transpose();
    right[n + k] = -phi[static_cast<std::size_t>(row)].dd;
  }
  return solve<Real>(kkt, right).head(n);
}

}  // namespace catena::testing
