// Elastic cables, and ropes over pulleys, that become taut or slack in a motion: there f = k max(l - L, 0) has a kink,
// and its derivative
//
//   f_p = k (l_p - L_p) where l > L, else 0
//
// jumps at an instant that moves. Steps do not end there, as they do where contacts change, and derivatives carried
// over such a step miss by k l_p times its length, whatever the tolerance: they are not given. Told from samples of
// every step; a cable that is at its length to rounding is on the side on which it is found next. Units: m.
#pragma once

#include <string>
#include <vector>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/model/model.hpp"

namespace catena {

class CableKinks {
 public:
  explicit CableKinks(const Model& model);
  /// Why a motion has no derivatives from this stretch on; empty: no cable passes its kink in it.
  std::string passed(const MotionStretch& stretch);

 private:
  std::vector<int> side_;  // by cable, then by rope: 1 slack, -1 taut, 0 not known yet
};

}  // namespace catena
