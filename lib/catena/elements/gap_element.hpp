// Common properties of the one-sided elements (contact, stop, cable). They are constraint elements (element.hpp) whose
// row is a gap:
//
//   Psi(q) >= 0        p >= 0        p Psi = 0        V_q + Phi_q^T lambda - Psi_q^T p = 0
//
// so that the row's multiplier is -p. In addition to the members of a constraint:
//
//   one_sided = true       phi is Psi, smooth; p at Psi = 0 is the force, N, or torque, N m, that keeps it from closing
//   measure<T>(i, j)       the gap that is reported, m or rad: the same zero and the same sign as Psi
//   in_angle()             optional: whether this element's gap is in radians
//
// In equilibrium a gap is an inequality. Source: Nocedal and Wright, Numerical Optimization, chapter 12.
#pragma once

#include "catena/elements/element.hpp"

namespace catena {

template <class E>
concept OneSided = requires {
  requires E::one_sided;
};

/// Friction of a joint, which is listed with them but bounds nothing.
template <class E>
concept Dry = requires {
  requires E::dry;
};

/// nullptr, or what is wrong with the numbers of impacts and friction. A mu_static below zero was not given.
inline const char* check_impact_and_friction(double restitution, double mu, double mu_static) {
  if (restitution > 1) return "\"restitution\" is a part of the closing speed: 0 ... 1";
  if (mu_static >= 0 && mu_static < mu) return "\"mu_static\" may not be below \"mu\"";
  return nullptr;
}

/// Whether row `row` of this element is measured in radians.
template <class E>
bool row_in_angle(const E& element, int row) {
  if constexpr (requires { element.in_angle(); }) {
    return element.in_angle();
  } else {
    static_cast<void>(element);
    return row_unit<E>(row) == UnitKind::angle;
  }
}

}  // namespace catena
