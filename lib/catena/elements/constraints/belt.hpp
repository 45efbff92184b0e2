// belt: a belt over two pulleys without slip, open or crossed, their centres held at a fixed distance by other joints.
//
//   open      Phi = R_i phi_i - R_j phi_j - (R_i - R_j) theta - c
//   crossed   Phi = R_i phi_i + R_j phi_j - (R_i + R_j) theta - c
//   theta = atan2(h) + 2 pi k, h = r_Pj - r_Pi        Phi_q, gamma: rolling_pair.hpp        nu = 0
//
// Symbols: radii in m; c, m, follows from the given configuration. The line of centres may turn (a carrier). Singular
// where the centres coincide. Multiplier: minus the difference of the two strands' tensions, N: their mean, the
// pretension, is not determined by the motion. The part on the centres is what that difference, along the inclined
// strands, exerts on the bearings. Source: rolling_pair.hpp.
#pragma once

#include "catena/elements/rolling_pair.hpp"

namespace catena {

template <class S = double>
struct Belt {
  static constexpr std::string_view type = "belt";
  static constexpr std::string_view summary =
      "A belt, open or crossed, over two pulleys; other joints hold their centres.";
  static constexpr std::string_view equation =
      "R_i phi_i - R_j phi_j - (R_i - R_j) theta - c = 0,  crossed: -R_j for R_j,  theta along the line of centres";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;

  Vec2<S> s_i{}, s_j{};
  S radius_i{}, radius_j{};
  bool crossed = false;
  S constant{};  // c

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &Belt::s_i, 0, "the centre of pulley i"},
        PointField{"j", &Belt::s_j, 1, "the centre of pulley j"},
        NumberField{"radius_i", &Belt::radius_i, UnitKind::length, Domain::positive, true, "radius R_i"},
        NumberField{"radius_j", &Belt::radius_j, UnitKind::length, Domain::positive, true, "radius R_j"},
        FlagField{"crossed", &Belt::crossed,
                  "whether the belt is crossed: the pulleys then turn against each other (default false)"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.belt(s_i, radius_i, s_j, radius_j, crossed);
  }

  void complete(const Frame<S>& i, const Frame<S>& j) { constant = pair().constant(i, j, separation(i, j, s_i, s_j)); }
  const char* check() const {
    if (!(value_of(radius_i) > 0)) return "radius_i is not above zero";
    if (!(value_of(radius_j) > 0)) return "radius_j is not above zero";

    return std::isnan(value_of(constant)) ? "its centres coincide in the given configuration" : nullptr;
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
  RollingPair<S> pair() const { return {radius_i, crossed ? radius_j : -radius_j}; }
};

}  // namespace catena
