// Bodies that need no solving: fixed ones, and those welded to the ground directly or through others.
//
// A welded body's pose follows from the weld alone, phi_j = phi_i + c and r_j = r_Pi - A_j s'Pj, so neither its
// coordinates nor the weld's rows enter any matrix.
#pragma once

#include <vector>

#include "catena/model/model.hpp"

namespace catena {

struct Elimination {
  std::vector<char> immobile;         ///< per body of the model
  std::vector<Frame<double>> pose;    ///< per body: where an immobile one is; the given pose of the others
  std::vector<char> weld_eliminated;  ///< per weld of the model
};

/// `keep_weld[k]`: weld k stays a constraint because its reaction is needed (empty: none). Linear time.
Elimination eliminate_bodies(const Model& model, const std::vector<char>& keep_weld);

}  // namespace catena
