// Two wheels that roll on each other, or are tied by a belt, at a fixed distance of their centres: gear and belt.
//
//   Phi = a phi_i + b phi_j - d theta - c        d = a + b        theta = atan2(h) + 2 pi k,  h = r_Pj - r_Pi
//   Phi_qi = [g^T, a + (R A_i s'Pi)^T g]         Phi_qj = [-g^T, b - (R A_j s'Pj)^T g]        g = d R h / h^T h
//   gamma = d (h x hdd - 2 thetad h^T hd) / h^T h        thetad = h x hd / h^T h
//
// a = R_i, and b = R_j where the wheels turn against each other (external gear, crossed belt), -R_j where they turn
// alike (internal gear, open belt). The integer k makes |Phi| least, so that Phi is a function of q alone, whatever
// turns were made. The equation acts on both centres, which makes the reactions of their pins right. Units: a, b, c in
// m; hd, hdd as in pair_motion.hpp. Singular where the centres coincide. Source: Shabana, Computational Dynamics,
// section 3.4; the angle of the line of centres as in planetary trains.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "catena/elements/pair_motion.hpp"

namespace catena {

template <class S>
struct RollingPair {
  S a, b;

  /// a phi_i + b phi_j - d atan2(h): the equation without c and without whole turns of the line of centres.
  template <class T>
  T rolled(const Frame<T>& i, const Frame<T>& j, const Vec2<T>& h) const {
    using std::atan2;
    return T(a) * i.phi + T(b) * j.phi - T(a + b) * atan2(h.y, h.x);
  }
  template <class T>
  T row(const Frame<T>& i, const Frame<T>& j, const Vec2<T>& h, const T& c) const {
    const T principal = rolled(i, j, h) - c;
    const double period = 2 * std::numbers::pi * value_of(a + b);
    if (period == 0) return principal;
    const double k = std::round(value_of(principal) / period);
    return principal - T(2 * std::numbers::pi * k) * T(a + b);
  }
  /// The c that the given configuration meets; NaN where the centres coincide.
  S constant(const Frame<S>& i, const Frame<S>& j, const Vec2<S>& h) const {
    if (!(value_of(squared_norm(h)) > 0)) return S(std::numeric_limits<double>::quiet_NaN());
    return rolled(i, j, h);
  }

  static const char* trouble(const PairGeometry& p) { return squared_norm(p.h) > 0 ? nullptr : "its centres coincide"; }

  void jacobian(const PairGeometry& p, double* entries) const {
    const Vec2<double> g = gradient(p);
    entries[0] = g.x;
    entries[1] = g.y;
    entries[2] = a + cross(p.arm_i, g);
    entries[3] = -g.x;
    entries[4] = -g.y;
    entries[5] = b - cross(p.arm_j, g);
  }
  double gamma(const PairMotion& m) const {
    const double square = squared_norm(m.h), turning = cross(m.h, m.hd) / square;
    return (a + b) * (cross(m.h, m.hdd) - 2 * turning * dot(m.h, m.hd)) / square;
  }

 private:
  Vec2<double> gradient(const PairGeometry& p) const { return ((a + b) / squared_norm(p.h)) * perpendicular(p.h); }
};

}  // namespace catena
