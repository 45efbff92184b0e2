// friction: dry friction of a joint: the pin of a revolute joint in its hole, or a slider in its guide.
//
//   revolute        u = phi_j - phi_i     |torque| <= mu N radius      N = |force of the joint|
//   translational   u = v^T h             |force| <= mu N              N = |force across| + |moment| / (length / 2)
//   sticks          Phi = u - c = 0       slides: against u', mu N     smoothed: mu N tanh(radius u' / vs)
//
// Symbols: radius of the pin, m; length of the guide, m (left out: its moment presses nothing); v unit axis of body i,
// h = r_Pj - r_Pi. The equation Phi, whose value c is where it stuck, holds in motion while it sticks, and in no other
// analysis. Never singular. Source: Coulomb; Haug, section 6.5.
#pragma once

#include "catena/elements/gap_element.hpp"
#include "catena/elements/pair_motion.hpp"

namespace catena {

template <class S = double>
struct Friction {
  static constexpr std::string_view type = "friction";
  static constexpr std::string_view summary = "Dry friction of a revolute or translational joint, in motion.";
  static constexpr std::string_view equation = "|friction| <= mu_static N,  = mu N against the motion while it slides";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr UnitKind value_unit = UnitKind::none;
  static constexpr bool one_sided = true;  // listed among the forces of a scene
  static constexpr bool dry = true;        // and no gap

  Vec2<S> s_i{}, s_j{}, axis_i{1.0, 0.0};
  bool turns = true;
  int joint = -1;  // number of the joint
  S mu{}, mu_static{-1.0}, vs{}, radius{}, length{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Friction::s_i, 0, "the point P_i of body i"},
                           PointField{"j", &Friction::s_j, 1, "the point P_j of body j"},
                           AxisField{"axis_i", &Friction::axis_i, 0, false, "direction of the guide on body i"});
  }
  /// What a scene sets in their place: the joint says where the friction acts.
  static constexpr auto keys() {
    return std::make_tuple(
        ColumnField{"joint", "the revolute or translational joint"},
        NumberField{"mu", &Friction::mu, UnitKind::none, Domain::not_negative, true, "coefficient while it slides"},
        NumberField{"mu_static", &Friction::mu_static, UnitKind::none, Domain::not_negative, false,
                    "up to which it sticks (default: mu)"},
        NumberField{"vs", &Friction::vs, UnitKind::velocity, Domain::positive, false,
                    "friction is mu N tanh(speed / vs) (default: exact, it sticks and slides)"},
        NumberField{"radius", &Friction::radius, UnitKind::length, Domain::positive, false,
                    "of the pin of a revolute joint, which needs it"},
        NumberField{"length", &Friction::length, UnitKind::length, Domain::positive, false,
                    "of the guide of a translational joint (default: its moment presses nothing)"});
  }

  bool in_angle() const { return turns; }
  void complete(const Frame<S>&, const Frame<S>&) { normalise(axis_i); }
  const char* check() const {
    if (turns && !(value_of(radius) > 0)) return "friction of a revolute joint needs the \"radius\" of its pin";
    return check_impact_and_friction(0, value_of(mu), value_of(mu_static));
  }

  /// u.
  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    if (turns) return j.phi - i.phi;
    return dot(i.axis(axis_i), separation(i, j, s_i, s_j));
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = measure(a.i, a.j) - a.c;
  }
};

}  // namespace catena
