// Whether an equilibrium under forces without a potential is stable, by the small motions about it.
//
//   M x'' + K x = 0 on the null space of Phi_q, K unsymmetric:   stable where every omega2 is real and above zero
//
// (circulatory_modes.hpp). Whether there is flutter depends on the masses, which all bodies need for it. Without them
// only that is judged which K decides alone: everything where K is symmetric on the null space, as with laws that read
// the coordinates on which they act; else divergence if the number of negative values is odd, as it then is with any
// masses. Damping is left out. Not
// judged: other equilibria without masses, mechanisms beyond dense algebra; the reason is given.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "catena/analysis/spectrum/circulatory_modes.hpp"

namespace catena {

struct StaticStability {
  bool judged = false;
  bool stable = false;
  CirculatoryModes motions;  ///< in the metric of lengths where the masses are not known
  bool in_masses = false;    ///< else in that of lengths
  std::string why_not;       ///< where it was not judged: a clause
};

/// At the point where the system is.
StaticStability judge_stability(StaticSystem& system, std::span<const double> lambda);

}  // namespace catena
