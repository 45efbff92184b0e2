// The motion of a mechanism of few freedoms, computed apart from the library: minimal coordinates z, Jourdain's
// principle and extrapolation in long double.
//
//   body k at (r_k, phi_k)(z):   H z'' = f,   H = sum m r_z^T r_z + J phi_z^T phi_z,
//   f = sum r_z^T (F - m r_0'') + phi_z^T (n - J phi_0''),   r_0'', phi_0'': accelerations for z'' = 0
//
// A kind of mechanism says only where its bodies are for given z; derivatives in time follow from jets (value, first,
// second). Symbols: r m, phi rad, F N, n N m, z of any unit. Singular where H is: no body moves with a coordinate.
// Method: Gragg's midpoint rule with Bulirsch and Stoer's extrapolation (Hairer, Norsett, Wanner, section II.9).
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "catena/model/model.hpp"

namespace catena::testing {

using Real = long double;

/// A quantity that moves, to second order in time.
struct Jet {
  Real f = 0, d = 0, dd = 0;
};
inline Jet operator+(Jet a, Jet b) { return {a.f + b.f, a.d + b.d, a.dd + b.dd}; }
inline Jet operator-(Jet a, Jet b) { return {a.f - b.f, a.d - b.d, a.dd - b.dd}; }
inline Jet operator*(Real s, Jet a) { return {s * a.f, s * a.d, s * a.dd}; }
inline Jet operator*(Jet a, Jet b) {
  return {a.f * b.f, a.d * b.f + a.f * b.d, a.dd * b.f + 2 * a.d * b.d + a.f * b.dd};
}
inline Jet sin(Jet a) {
  const Real s = std::sin(a.f), c = std::cos(a.f);
  return {s, c * a.d, c * a.dd - s * a.d * a.d};
}
inline Jet cos(Jet a) {
  const Real s = std::sin(a.f), c = std::cos(a.f);
  return {c, -s * a.d, -s * a.dd - c * a.d * a.d};
}
inline Jet sqrt(Jet a) {
  const Real s = std::sqrt(a.f), d = a.d / (2 * s);
  return {s, d, (a.dd / 2 - d * d) / s};
}

struct JetPoint {
  Jet x, y;
};
inline JetPoint operator+(JetPoint a, JetPoint b) { return {a.x + b.x, a.y + b.y}; }
inline JetPoint operator-(JetPoint a, JetPoint b) { return {a.x - b.x, a.y - b.y}; }
inline JetPoint fixed_point(Vec2<double> p) { return {{p.x}, {p.y}}; }
/// A vector given in axes turned by an angle.
inline JetPoint turned(Jet angle, Vec2<double> s) {
  const Jet c_ = cos(angle), s_ = sin(angle);
  return {Real(s.x) * c_ - Real(s.y) * s_, Real(s.x) * s_ + Real(s.y) * c_};
}

/// Where a body is: its centroid and its angle.
struct JetPlace {
  JetPoint r;
  Jet phi;
  JetPoint point(Vec2<double> s) const { return r + turned(phi, s); }
};

inline constexpr int most_freedoms = 3;
using Coordinates = std::array<Real, most_freedoms>;
using JetCoordinates = std::array<Jet, most_freedoms>;

/// A spring and damper between two points; i = -1: the ground. length < 0 is not used.
struct KnownSpring {
  int i, j;
  Vec2<double> s_i, s_j;
  double k, c, length;
};
/// A torsion spring from the ground to body j; `torque`, N m, is added to what it does.
struct KnownTorsion {
  int j;
  double k, c, angle, torque;
};

struct KnownMotion {
  std::string kind;
  std::shared_ptr<Model> model = std::make_shared<Model>();
  int freedoms = 1;
  std::function<std::vector<JetPlace>(const JetCoordinates&)> places;
  std::vector<KnownSpring> springs;
  std::vector<KnownTorsion> torsions;
  Coordinates z{}, rate{};  // at t = 0
  double until = 1;
  double length = 1;  ///< scale of places, m
  double pace = 1;    ///< scale of rates, 1/s
  /// Zero where the mechanism lies flat; empty if it never does.
  std::function<Real(const Coordinates&)> flat;

  std::vector<JetPlace> places_of(const Coordinates& at, const Coordinates& rates) const {
    JetCoordinates jets{};
    for (std::size_t k = 0; k < most_freedoms; ++k) jets[k] = {at[k], rates[k], 0};
    return places(jets);
  }
  Coordinates acceleration(const Coordinates& at, const Coordinates& rates) const;
  /// det H at z.
  Real constrained_mass(const Coordinates& at) const;

 private:
  using Matrix = std::array<std::array<Real, most_freedoms + 1>, most_freedoms>;
  std::array<std::vector<JetPlace>, most_freedoms> directions(const Coordinates& at) const;
  Matrix mass_matrix(const std::array<std::vector<JetPlace>, most_freedoms>& along) const;
};

inline std::array<std::vector<JetPlace>, most_freedoms> KnownMotion::directions(const Coordinates& at) const {
  std::array<std::vector<JetPlace>, most_freedoms> along;
  for (std::size_t k = 0; k < static_cast<std::size_t>(freedoms); ++k) {
    Coordinates one{};
    one[k] = 1;
    along[k] = places_of(at, one);
  }
  return along;
}

inline KnownMotion::Matrix KnownMotion::mass_matrix(
    const std::array<std::vector<JetPlace>, most_freedoms>& along) const {
  const std::size_t n = static_cast<std::size_t>(freedoms);
  Matrix h{};
  for (std::size_t b = 0; b < model->bodies.size(); ++b) {
    const Real mass = model->bodies[b].mass, inertia = model->bodies[b].inertia;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const JetPlace &p = along[i][b], &o = along[j][b];
        h[i][j] += mass * (p.r.x.d * o.r.x.d + p.r.y.d * o.r.y.d) + inertia * p.phi.d * o.phi.d;
      }
    }
  }
  return h;
}

inline Real KnownMotion::constrained_mass(const Coordinates& at) const {
  const std::size_t n = static_cast<std::size_t>(freedoms);
  Matrix h = mass_matrix(directions(at));
  Real determinant = 1;
  for (std::size_t i = 0; i < n; ++i) {
    determinant *= h[i][i];
    for (std::size_t j = i + 1; j < n; ++j) {
      const Real factor = h[j][i] / h[i][i];
      for (std::size_t k = i; k < n; ++k) h[j][k] -= factor * h[i][k];
    }
  }
  return determinant;
}

inline Coordinates KnownMotion::acceleration(const Coordinates& at, const Coordinates& rates) const {
  const std::size_t n = static_cast<std::size_t>(freedoms), bodies = model->bodies.size();
  const std::vector<JetPlace> now = places_of(at, rates);
  const std::array<std::vector<JetPlace>, most_freedoms> along = directions(at);
  struct Load {
    Real x = 0, y = 0, n = 0;
  };
  std::vector<Load> loads(bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    const Real mass = model->bodies[b].mass, inertia = model->bodies[b].inertia;
    loads[b] = {mass * (model->gravity.x - now[b].r.x.dd), mass * (model->gravity.y - now[b].r.y.dd),
                -inertia * now[b].phi.dd};
  }
  const auto end_of = [&](int body, Vec2<double> s) {
    return body < 0 ? fixed_point(s) : now[static_cast<std::size_t>(body)].point(s);
  };
  const auto push = [&](int body, Vec2<double> s, Real x, Real y) {
    if (body < 0) return;
    const std::size_t b = static_cast<std::size_t>(body);
    const JetPoint arm = turned(now[b].phi, s);
    loads[b].x += x;
    loads[b].y += y;
    loads[b].n += arm.x.f * y - arm.y.f * x;
  };
  for (const KnownSpring& spring : springs) {
    const JetPoint h = end_of(spring.j, spring.s_j) - end_of(spring.i, spring.s_i);
    const Real l = std::hypot(h.x.f, h.y.f), ld = (h.x.f * h.x.d + h.y.f * h.y.d) / l;
    const Real tension = (spring.k * (l - spring.length) + spring.c * ld) / l;
    push(spring.i, spring.s_i, tension * h.x.f, tension * h.y.f);
    push(spring.j, spring.s_j, -tension * h.x.f, -tension * h.y.f);
  }
  for (const KnownTorsion& spring : torsions) {
    const Jet phi = now[static_cast<std::size_t>(spring.j)].phi;
    loads[static_cast<std::size_t>(spring.j)].n += spring.torque - spring.k * (phi.f - spring.angle) - spring.c * phi.d;
  }
  Matrix a = mass_matrix(along);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t b = 0; b < bodies; ++b) {
      const JetPlace& p = along[i][b];
      a[i][most_freedoms] += p.r.x.d * loads[b].x + p.r.y.d * loads[b].y + p.phi.d * loads[b].n;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Real factor = a[j][i] / a[i][i];
      for (std::size_t k = i; k <= most_freedoms; ++k) a[j][k] -= factor * a[i][k];
    }
  }
  Coordinates out{};
  for (std::size_t i = n; i-- > 0;) {
    Real sum = a[i][most_freedoms];
    for (std::size_t j = i + 1; j < n; ++j) sum -= a[i][j] * out[j];
    out[i] = sum / a[i][i];
  }
  return out;
}

/// Carries z and z' of a known motion through time, to about 1e-15 of their sizes a unit of pace.
class KnownPath {
 public:
  explicit KnownPath(const KnownMotion& motion) : KnownPath(motion, motion.z, motion.rate) {}
  KnownPath(const KnownMotion& motion, const Coordinates& z, const Coordinates& rate)
      : motion_(motion), y_{z, rate}, h_(0.1L / motion.pace) {}

  const Coordinates& z() const { return y_.z; }
  const Coordinates& rate() const { return y_.rate; }

  void go_to(Real t) {
    while (t_ < t) {
      const bool last = t_ + h_ >= t;
      const Real h = last ? t - t_ : h_;
      const Real error = step(h);
      const Real factor = std::min(Real(4), std::max(Real(0.2), 0.8L * std::pow(1 / (error + 1e-9L), 1 / 15.0L)));
      if (error <= 1) {
        y_ = next_;
        t_ = last ? t : t_ + h;
        if (!last || factor < 1) h_ = h * factor;
      } else {
        h_ = h * std::min(factor, Real(0.7));
      }
    }
  }

 private:
  struct State {
    Coordinates z, rate;
  };
  static constexpr int columns = 8;

  State slope(const State& y) const { return {y.rate, motion_.acceleration(y.z, y.rate)}; }
  State moved(const State& y, const State& by, Real h) const {
    State out = y;
    for (std::size_t k = 0; k < most_freedoms; ++k) {
      out.z[k] += h * by.z[k];
      out.rate[k] += h * by.rate[k];
    }
    return out;
  }

  /// Fills next_; the error in units of what is allowed.
  Real step(Real h) {
    std::array<State, columns> row{}, before{};
    const State first = slope(y_);
    Real error = 0;
    for (int m = 0; m < columns; ++m) {
      const int parts = 2 * (m + 1);
      State a = y_, b = moved(y_, first, h / parts);
      for (int k = 1; k < parts; ++k) {
        const State c = moved(a, slope(b), 2 * h / parts);
        a = b;
        b = c;
      }
      // Gragg's smoothing: the mean of the last midpoint value and of an Euler step back to it.
      const State end = moved(a, slope(b), h / parts);
      for (std::size_t k = 0; k < most_freedoms; ++k) {
        row[0].z[k] = (b.z[k] + end.z[k]) / 2;
        row[0].rate[k] = (b.rate[k] + end.rate[k]) / 2;
      }
      error = 0;
      for (int j = 1; j <= m; ++j) {
        const Real ratio = Real(m + 1) / Real(m + 1 - j), weight = 1 / (ratio * ratio - 1);
        for (std::size_t k = 0; k < most_freedoms; ++k) {
          const auto extrapolate = [&](auto member) {
            const Real low = (before[static_cast<std::size_t>(j) - 1].*member)[k];
            const Real high = (row[static_cast<std::size_t>(j) - 1].*member)[k];
            (row[static_cast<std::size_t>(j)].*member)[k] = high + weight * (high - low);
            return std::abs(weight * (high - low));
          };
          const Real dz = extrapolate(&State::z), dr = extrapolate(&State::rate);
          if (j == m && m == columns - 1) {
            error = std::max({error, dz / (1e-16L * (1 + std::abs(y_.z[k]))),
                              dr / (1e-16L * (motion_.pace + std::abs(y_.rate[k])))});
          }
        }
      }
      before = row;
    }
    next_ = row[columns - 1];
    return error;
  }

  const KnownMotion& motion_;
  State y_{}, next_{};
  Real t_ = 0, h_;
};

}  // namespace catena::testing
