// cable: an inextensible cable of length L between a point of body i and a point of body j: it pulls, and is slack
// otherwise. With a stiffness k it is an elastic_cable.hpp instead.
//
//   h = r_Pj - r_Pi       Psi = (L^2 - h^T h) / (2 L) >= 0       gap L - |h|
//   Psi_qi = h^T [I, R A_i s'Pi] / L       Psi_qj = -h^T [I, R A_j s'Pj] / L
//
// Symbols: s'Pi, s'Pj and L > 0 in m. At |h| = L the gradient of Psi is that of L - |h|, so that p is the tension, N,
// while Psi stays smooth where the ends meet: never singular. Source: gap_element.hpp; Haug, section 3.3.
#pragma once

#include "catena/elements/gap_element.hpp"
#include "catena/elements/squared_distance.hpp"

namespace catena {

template <class S = double>
struct Cable {
  static constexpr std::string_view type = "cable";
  static constexpr std::string_view summary =
      "A cable between two points that pulls only: inextensible, or elastic where k is given.";
  static constexpr std::string_view equation = "L - |h| >= 0,  tension >= 0,  one of them zero;  h = r_Pj - r_Pi";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr bool one_sided = true;
  static constexpr auto hessian_pattern = squared_distance_hessian_pattern;

  Vec2<S> s_i{}, s_j{};
  S length{-1.0};                     // negative: not given, taken from the given configuration
  S k{};                              // only the scene reader's: zero is inextensible
  S restitution{}, rest_speed{-1.0};  // negative: not given

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Cable::s_i, 0, "the end P_i on body i"},
                           PointField{"j", &Cable::s_j, 1, "the end P_j on body j"},
                           NumberField{"length", &Cable::length, UnitKind::length, Domain::positive, false,
                                       "its length L without tension (default: the given distance)"},
                           NumberField{"k", &Cable::k, UnitKind::stiffness, Domain::positive, false,
                                       "stiffness when taut (default: inextensible)"},
                           NumberField{"restitution", &Cable::restitution, UnitKind::none, Domain::not_negative, false,
                                       "of the jerk when it becomes taut in motion, 0 ... 1 (default 0)"},
                           NumberField{"rest_speed", &Cable::rest_speed, UnitKind::velocity, Domain::not_negative,
                                       false, "a slower rebound is none (default: 1e-4 of the speed of the motion)"});
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    if (value_of(length) < 0) length = norm(separation(i, j, s_i, s_j));
  }
  const char* check() const {
    if (!(value_of(length) > 0)) return "a cable needs a length above zero";
    return check_impact_and_friction(value_of(restitution), 0, -1);
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    const Vec2<T> h = separation(i, j, s_i, s_j);
    // Where the ends meet the distance has no derivative.
    return value_of(squared_norm(h)) > 0 ? T(length) - norm(h) : T(length);
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = (T(length) * T(length) - squared_norm(separation(a.i, a.j, s_i, s_j))) / (T(2.0) * T(length));
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    squared_distance_jacobian(PairGeometry(a, s_i, s_j), entries);
    for (std::size_t n = 0; n < jacobian_size<Cable>; ++n) entries[n] *= -0.5 / length;
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    squared_distance_hessian(PairGeometry(a, s_i, s_j), -0.5 / length * lambda[0], entries);
  }
};

}  // namespace catena
