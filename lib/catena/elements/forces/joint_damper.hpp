// joint_damper: viscous damping of a joint; a scene writes it as `c` of a revolute or a translational joint.
//
//   turning       n = ct (phid_j - phid_i)       +n on i, -n on j
//   sliding       f = c sd,  sd = v^T (velocity of P_j - velocity of the point of i at the same place),  v = A_i v'
//                 on i +f v, on j -f v, both at P_j
//   dissipation   ct (phid_j - phid_i)^2 + c sd^2
//
// sd is the rate of the slide v^T (r_Pj - r_Pi). Symbols: v' a unit vector in the frame of i, c N s/m, ct N m s/rad,
// f N, n N m. Never singular. Source: Haug, section 6.2, along a given line.
#pragma once

#include "catena/elements/force_element.hpp"
#include "catena/elements/pair_motion.hpp"

namespace catena {

template <class S = double>
struct JointDamper {
  static constexpr std::string_view type = "joint_damper";
  static constexpr std::string_view summary = "Viscous damping of a joint.";
  static constexpr std::string_view equation =
      "n = ct (phid_j - phid_i),  f = c d/dt (v^T (r_Pj - r_Pi)),  +n, +f v on i and -n, -f v on j at P_j";
  static constexpr int bodies = 2;
  static constexpr int functions = 0;

  Vec2<S> s_j{}, axis_i{};
  S c{}, ct{};

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"j", &JointDamper::s_j, 1, "the point P_j of body j"},
        AxisField{"axis_i", &JointDamper::axis_i, 0, false, "direction of the line in body i"},
        NumberField{"c", &JointDamper::c, UnitKind::damping, Domain::not_negative, false, "damping of sliding"},
        NumberField{"ct", &JointDamper::ct, UnitKind::torsion_damping, Domain::not_negative, false,
                    "damping of turning"});
  }
  /// The joint that it belongs to is what is drawn.
  template <class Pen>
  void draw(Pen&) const {}

  void complete(const Frame<S>&, const Frame<S>&) {
    if (has_direction(axis_i)) normalise(axis_i);
  }
  const char* check() const {
    return value_of(c) == 0 || has_direction(axis_i) ? nullptr : "damping along a line needs its direction axis_i";
  }

  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    const T n = T(ct) * (a.v.omega - a.u.omega);
    const Vec2<T> f = (T(c) * slide_rate(a)) * a.i.axis(axis_i);
    on_i.moment += n;
    on_j.moment -= n;
    add_force_at(arm_on_i(a), f, on_i);
    add_force_at(a.j.axis(s_j), -f, on_j);
  }
  /// None: at rest it exerts nothing.
  template <class T>
  T potential(const ForceArguments<T>&) const {
    return T(0.0);
  }
  double dissipation(const ForceArguments<double>& a) const {
    const double turning = a.v.omega - a.u.omega, sliding = slide_rate(a);
    return value_of(ct) * turning * turning + value_of(c) * sliding * sliding;
  }

 private:
  /// From the centroid of i to P_j.
  template <class T>
  Vec2<T> arm_on_i(const ForceArguments<T>& a) const {
    const Vec2<T> arm_j = a.j.axis(s_j);
    return {a.j.x - a.i.x + arm_j.x, a.j.y - a.i.y + arm_j.y};
  }
  template <class T>
  T slide_rate(const ForceArguments<T>& a) const {
    const Vec2<T> arm_i = arm_on_i(a), arm_j = a.j.axis(s_j);
    const Vec2<T> apart{a.v.vx - a.v.omega * arm_j.y - a.u.vx + a.u.omega * arm_i.y,
                        a.v.vy + a.v.omega * arm_j.x - a.u.vy - a.u.omega * arm_i.x};
    return dot(a.i.axis(axis_i), apart);
  }
};

/// The damper of a joint with damping c: of turning, or along its line.
template <class S, class Joint>
JointDamper<S> damper_of(const Joint& joint) {
  JointDamper<S> damper;
  damper.s_j = joint.s_j;
  if constexpr (requires { joint.axis_i; }) {
    damper.axis_i = joint.axis_i;
    damper.c = joint.c;
  } else {
    damper.ct = joint.c;
  }
  return damper;
}

}  // namespace catena
