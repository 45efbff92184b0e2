// Laws of state, compiled for a plan. Their values, with any scalar, are in law_values.hpp.
//
//   F = f(columns(q, qd), t)        dF/dq, dF/dqd by dual numbers that are seeded at one body after the other
//
// A law may read the force of a spring whose own force is a law: laws are then evaluated through each other, in no
// circle (columns/state_laws.hpp refuses those). What they read is found once, when the model's values are taken over;
// nothing allocates after that. Tables that end go on as straight lines here: analyses look at every step whether one
// was left. Singular where the formula is: it is then not finite.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/plan.hpp"

namespace catena {

/// What one input of a law shows. Bodies are plan bodies, `bodies` of the plan stands for the ground.
template <class S>
struct LawInput {
  ColumnKind kind = ColumnKind::time;
  int element = -1;                ///< of which the attachment is, or the force
  int i = -1, j = -1;              ///< of a body column i alone
  Vec2<S> point_i, point_j, axis;  ///< in the bodies' centroidal frames
};

template <class S>
struct CompiledLaw {
  int element = -1, place = 0;
  int i = -1, j = -1;  ///< the plan bodies that its force acts on; j = -1: on one alone
  Formula<S> formula;
  std::vector<LawInput<S>> inputs;
  std::vector<int> bodies;  ///< the moving plan bodies that its value depends on, ascending
};

/// The laws of a model; `structure` are those of the same model in plain numbers, which are bound. Throws ModelError
/// where a law is not bound.
template <class S>
std::vector<CompiledLaw<S>> compile_laws(const BasicModel<S>& model, std::span<const StateLaw<double>> structure,
                                         const Plan& plan);

}  // namespace catena
