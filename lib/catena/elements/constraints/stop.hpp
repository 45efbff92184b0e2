// stop: bounds of a joint's angle or slide, of a distance, or of a body's coordinate.
//
//   min <= u <= max       u = phi_j - phi_i,  v^T h,  or |h|       h = r_Pj - r_Pi, v: unit axis on i
//   Psi = u - min,  max - u,  or with both bounds (u - min) (max - u) / (max - min)
//
// Symbols: u, min, max in rad or m. With both bounds Psi is smooth, and at either of them its slope is that of the
// distance to it: p is then the torque, N m, or the force, N, of the bound that is reached; the reported gap is the
// distance to the nearer one. In motion it is rigid, with impacts, or compliant where k is given; equilibrium takes the
// inequality itself. Singular: a distance |h| = 0, which has no direction. Source: gap_element.hpp.
#pragma once

#include <limits>

#include "catena/elements/gap_element.hpp"
#include "catena/elements/pair_motion.hpp"

namespace catena {

/// The quantity that a stop bounds.
enum class StopQuantity : unsigned char { angle, slide, distance };

template <class S = double>
struct Stop {
  static constexpr std::string_view type = "stop";
  static constexpr std::string_view summary = "Bounds of a joint's angle or slide, of a distance, or of a coordinate.";
  static constexpr std::string_view equation = "min <= u <= max,  u: the column";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr bool one_sided = true;

  Vec2<S> s_i{}, s_j{}, axis_i{1.0, 0.0};
  StopQuantity quantity = StopQuantity::angle;
  S min{-std::numeric_limits<double>::infinity()}, max{std::numeric_limits<double>::infinity()};
  S k{}, c{}, exponent{1.0};
  S restitution{}, rest_speed{-1.0};  // negative: not given

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Stop::s_i, 0, "the point P_i of body i"},
                           PointField{"j", &Stop::s_j, 1, "the point P_j of body j"},
                           AxisField{"axis_i", &Stop::axis_i, 0, false, "direction of a slide on body i"});
  }
  /// The keys of a scene in their place: the column determines where the stop acts.
  static constexpr auto keys() {
    return std::make_tuple(
        ColumnField{"column",
                    "what is bounded: the angle or slide of a joint, the length of a spring or cable, x, y or angle of "
                    "a body"},
        BoundField{"min", &Stop::min, UnitKind::length, UnitKind::angle, Domain::any,
                   "its least value (default: none)"},
        BoundField{"max", &Stop::max, UnitKind::length, UnitKind::angle, Domain::any,
                   "its largest value (default: none)"},
        BoundField{"k", &Stop::k, UnitKind::stiffness, UnitKind::torsion_stiffness, Domain::positive,
                   "stiffness in motion: k d^exponent + c d' at a depth d (default: rigid, with impacts)"},
        BoundField{"c", &Stop::c, UnitKind::damping, UnitKind::torsion_damping, Domain::not_negative,
                   "damping beside k (default 0)"},
        NumberField{"exponent", &Stop::exponent, UnitKind::none, Domain::positive, false, "of the depth (default 1)"},
        NumberField{"restitution", &Stop::restitution, UnitKind::none, Domain::not_negative, false,
                    "of rigid impacts, 0 ... 1 (default 0): the part of the closing speed that comes back"},
        BoundField{"rest_speed", &Stop::rest_speed, UnitKind::velocity, UnitKind::angular_velocity,
                   Domain::not_negative, "a slower rebound is none (default: 1e-4 of the speed of the motion)"});
  }

  bool in_angle() const { return quantity == StopQuantity::angle; }
  void complete(const Frame<S>&, const Frame<S>&) { normalise(axis_i); }
  const char* check() const {
    if (!has_low() && !has_high()) return "a stop needs \"min\" or \"max\"";
    if (has_low() && has_high() && value_of(min) >= value_of(max)) return "\"min\" must be below \"max\"";
    if (quantity == StopQuantity::distance && has_high() && value_of(max) <= 0)
      return "a distance cannot be below zero: \"max\" must be positive";
    if (!has_direction(axis_i)) return "the axis has no direction";
    return check_impact_and_friction(value_of(restitution), 0, -1);
  }
  const char* trouble(const Arguments<double>& a) const {
    const bool lost = quantity == StopQuantity::distance && squared_norm(separation(a.i, a.j, s_i, s_j)) == 0;
    return lost ? "the points coincide" : nullptr;
  }

  /// u.
  template <class T>
  T value(const Frame<T>& i, const Frame<T>& j) const {
    if (quantity == StopQuantity::angle) return j.phi - i.phi;
    const Vec2<T> h = separation(i, j, s_i, s_j);
    if (quantity == StopQuantity::slide) return dot(i.axis(axis_i), h);
    return value_of(squared_norm(h)) > 0 ? norm(h) : T(0.0);
  }
  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    const T u = value(i, j), low = u - T(min), high = T(max) - u;
    return value_of(low) < value_of(high) ? low : high;
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const T u = value(a.i, a.j);
    if (has_low() && has_high()) {
      out[0] = (u - T(min)) * (T(max) - u) / (T(max) - T(min));
    } else {
      out[0] = has_low() ? u - T(min) : T(max) - u;
    }
  }

 private:
  // A bound that could not be read is NaN and was reported: it counts as given.
  bool has_low() const { return value_of(min) != -std::numeric_limits<double>::infinity(); }
  bool has_high() const { return value_of(max) != std::numeric_limits<double>::infinity(); }
};

}  // namespace catena
