// An instant t* at which a motion goes on in another way, with derivatives by design parameters.
//
//   M (qd+ - qd-) + Phi_q^T mu = F,   Phi_q qd+ = nu            F: a blow J at a point s of a body, [J; (A s) x J]
//   y_p+ = J_y (y_p- + y'- t*_p) + J_p - y'+ t*_p               y = [q, qd], y+ = J(y-, p)
//   t*_p = -(h_p - value_p) / h'                                where an event acts: its column h reaches its value
//
// t*_p of functions of time that jump is known beforehand (moving_instants.hpp). Units: s, m, N s. Source:
// apps/manual/sensitivity.md.
#pragma once

#include <algorithm>
#include <vector>

#include "catena/base/design_scalar.hpp"
#include "catena/base/frame.hpp"
#include "catena/base/vec2.hpp"

namespace catena {

/// A blow with derivatives.
struct DesignStrike {
  int body = -1;                 ///< number in the model
  Vec2<DesignScalar> point{};    ///< in the frame of its centroid
  Vec2<DesignScalar> impulse{};  ///< in ground axes
};

/// w^T F of a blow on a body whose frame this is; `w`: of its three coordinates.
inline DesignScalar work_of_blow(const DesignStrike& strike, const Frame<double>& f, const double* w) {
  const DesignScalar c(f.c), s(f.s);
  const Vec2<DesignScalar> arm{c * strike.point.x - s * strike.point.y, s * strike.point.x + c * strike.point.y};
  return DesignScalar(w[0]) * strike.impulse.x + DesignScalar(w[1]) * strike.impulse.y +
         DesignScalar(w[2]) * cross(arm, strike.impulse);
}

struct MotionCrossing {
  bool jumps = false;                   ///< velocities may: they are moved onto the constraints, after the blow
  std::vector<DesignStrike> strikes{};  ///< by group of parameters; empty: there is no blow
  std::vector<double> rate{};           ///< t*_p; empty: it follows from the event
  int event = -1;                       ///< that acts, by its number in the list; -1: none does
  double by_time = 0;                   ///< h' of its column, along the motion before

  /// Whether some parameter moves the instant.
  bool moves() const {
    return event >= 0 || std::any_of(rate.begin(), rate.end(), [](double r) { return r != 0; });
  }
};

}  // namespace catena
