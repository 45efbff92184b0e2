// The mass matrix M = diag(m, m, J) of the bodies that are solved for, and the check that it is complete.
//
// A particle needs no inertia: its angle does not move. mass: 0 or inertia: 0 is a massless coordinate, which the
// equations of motion must determine otherwise; a mass or inertia that is not given is refused. Units: kg, kg m^2.
#pragma once

#include <string>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"

namespace catena {

struct MassMatrix {
  std::vector<double> mass;  ///< by coordinate, 3 plan.moving; of a particle's angle: zero
  /// Small masses in place of zero ones, a first guess until EquationsOfMotion::weigh_massless(); zero for all other
  /// coordinates.
  std::vector<double> substitute;
  std::vector<int> massless;  ///< coordinates that can move and have no mass

  /// Takes the masses from the evaluator's model; a report naming the body if a mass or inertia is missing.
  Report load(const Evaluator& evaluator);
};

}  // namespace catena
