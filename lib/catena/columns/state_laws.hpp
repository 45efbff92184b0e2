// Laws of state: which columns they read, looked up and checked.
//
//   "torque": "=-40*(arm.angle - 0.5) - 3*arm.omega"    =>    inputs = {angle of arm, omega of arm}
//
// Own columns are replaced by their formulas. What is known before accelerations are may be read: t, places, angles and
// velocities of bodies and points, angles, slides and lengths of joints and springs with their rates, and the forces of
// springs, unless these are laws that read, through each other, the law's own force. Everything else is refused;
// reactions and accelerations depend on all forces and would close an algebraic loop, whose names are told.
#pragma once

#include <string>
#include <vector>

#include "catena/model/model.hpp"

namespace catena {

/// Why a law cannot be as it is.
struct LawProblem {
  int law = -1;
  std::string input;                    ///< the name at fault, may be empty
  std::string message;                  ///< a sentence without full stop
  std::vector<std::string> candidates;  ///< names that were possibly meant, in no order
};

/// Makes function number `place` of a force element a law of state; names[k] is the column that is input k of the
/// formula. bind_state_laws() comes once the model is complete. Throws ModelError for an element that is no force or
/// has no such function.
void set_state_law(Model& model, int element, int place, Formula<double> formula, std::vector<std::string> names);

/// Which force each law is the magnitude of, and the formulas of own columns in place of their names. For models with
/// derivatives this is all: what inputs are is taken from the model in plain numbers.
template <class S>
std::vector<LawProblem> complete_state_laws(BasicModel<S>& model);

/// Does that and looks up what laws read, once all bodies, elements and own columns of the model are there.
std::vector<LawProblem> bind_state_laws(Model& model);

/// `"torque" of torque "motor"`.
std::string describe_law(const Model& model, int law);

extern template std::vector<LawProblem> complete_state_laws(Model&);

}  // namespace catena
