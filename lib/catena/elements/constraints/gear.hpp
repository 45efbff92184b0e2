// gear: two gears in mesh, their centres held at the sum (internal: difference) of the radii by other joints.
//
//   external   Phi = R_i phi_i + R_j phi_j - (R_i + R_j) theta - c
//   internal   Phi = R_i phi_i - R_j phi_j - (R_i - R_j) theta - c        the larger one is the ring
//   theta = atan2(h) + 2 pi k, h = r_Pj - r_Pi        Phi_q, gamma: rolling_pair.hpp        nu = 0
//
// Symbols: radii in m; c, m, follows from the given configuration: as the teeth mesh there, they go on meshing, over
// any number of turns. Singular where the centres coincide. Multiplier: minus the tangential tooth force, N; the
// reaction is that at the pitch point. Source: rolling_pair.hpp.
#pragma once

#include "catena/elements/rolling_pair.hpp"

namespace catena {

template <class S = double>
struct Gear {
  static constexpr std::string_view type = "gear";
  static constexpr std::string_view summary =
      "Two gears, external or internal, roll on each other; other joints hold their centres.";
  static constexpr std::string_view equation =
      "R_i phi_i + R_j phi_j - (R_i + R_j) theta - c = 0,  internal: -R_j for R_j,  theta along the line of centres";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;

  Vec2<S> s_i{}, s_j{};
  S radius_i{}, radius_j{};
  bool internal = false;
  S constant{};  // c

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &Gear::s_i, 0, "the centre of gear i"}, PointField{"j", &Gear::s_j, 1, "the centre of gear j"},
        NumberField{"radius_i", &Gear::radius_i, UnitKind::length, Domain::positive, true, "pitch radius R_i"},
        NumberField{"radius_j", &Gear::radius_j, UnitKind::length, Domain::positive, true, "pitch radius R_j"},
        FlagField{"internal", &Gear::internal, "whether one gear runs inside the other (default false)"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.gears(s_i, radius_i, s_j, radius_j, internal);
  }

  void complete(const Frame<S>& i, const Frame<S>& j) { constant = pair().constant(i, j, separation(i, j, s_i, s_j)); }
  const char* check() const {
    if (!(value_of(radius_i) > 0)) return "radius_i is not above zero";
    if (!(value_of(radius_j) > 0)) return "radius_j is not above zero";
    if (internal && value_of(radius_i) == value_of(radius_j)) return "an internal gear needs radii that differ";
    return std::isnan(value_of(constant)) ? "its centres coincide in the given configuration" : nullptr;
  }

  /// The pitch point, where the reaction is reported: on the line of centres, R_i from P_i.
  Vec2<S> reaction_point(const Frame<S>& i, const Frame<S>& j) const {
    const Vec2<S> h = separation(i, j, s_i, s_j);
    const bool inside = internal && radius_i < radius_j;  // i in the ring j: they touch beyond P_i
    return i.point(s_i) + ((inside ? -radius_i : radius_i) / norm(h)) * h;
  }
  const char* trouble(const Arguments<double>& a) const { return RollingPair<S>::trouble(PairGeometry(a, s_i, s_j)); }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = pair().row(a.i, a.j, separation(a.i, a.j, s_i, s_j), T(constant));
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    pair().jacobian(PairGeometry(a, s_i, s_j), entries);
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    out[0] = pair().gamma(PairMotion(a, s_i, s_j, u, v));
  }

 private:
  RollingPair<S> pair() const { return {radius_i, internal ? -radius_j : radius_j}; }
};

}  // namespace catena
