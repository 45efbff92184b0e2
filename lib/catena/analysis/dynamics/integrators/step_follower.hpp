// Sees every step that an integration makes, between its end and the rows in it; it changes nothing.
#pragma once

#include "catena/analysis/dynamics/integrators/integrator.hpp"
#include "catena/analysis/motion/equations_of_motion.hpp"

namespace catena {

class StepFollower {
 public:
  virtual ~StepFollower() = default;
  /// The integrator stands at the first instant. `equations`: those that it solves.
  virtual void begin(const Integrator& integrator, const EquationsOfMotion& equations) = 0;
  virtual void step(const Integrator& integrator, const EquationsOfMotion& equations) = 0;
  /// Velocities have jumped.
  virtual void jump() = 0;
};

}  // namespace catena
