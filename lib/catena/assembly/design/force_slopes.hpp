// The slope of all forces along a direction, with derivatives by design parameters.
//
//   Q_q v        at rest, of gravity, force elements and laws of state alike, whether they have an energy or not
//
// By dual numbers over dual numbers: the mechanism's state moves along v, what its numbers move by with the parameters
// is carried with that. What reads rates counts at rest. Not a number where a formula has no derivative. Units of
// generalized forces over those of v. Source: apps/manual/sensitivity.md.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/assembly/design/design_mechanism.hpp"

namespace catena {

class ForceSlopes {
 public:
  /// `evaluator`: that of the mechanism; both must outlive this object.
  ForceSlopes(const Evaluator& evaluator, const DesignMechanism& mechanism);
  ~ForceSlopes();

  /// v: the rates that the mechanism is set to. Size coordinates().
  void along(std::span<DesignScalar> out) const;

 private:
  const Evaluator& evaluator_;
  const DesignMechanism& mechanism_;
  std::vector<CompiledLaw<DesignScalar>> laws_;
};

}  // namespace catena
