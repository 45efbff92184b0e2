// How a motion is to be integrated.
#pragma once

namespace catena {

enum class IntegrationMethod {
  automatic,  ///< chooses, and says what it chose
  rk8,        ///< Dormand-Prince, order 8, with projection
  rk5,        ///< Dormand-Prince, order 5, with projection
};

struct DynamicsOptions {
  IntegrationMethod method = IntegrationMethod::automatic;
  /// Of the state: positions relative to the scene's length scale, angles to 1 rad, velocities to the fastest so far.
  double tolerance = 1e-8;
  /// Fixed step, s; 0: chosen by the integrator.
  double step = 0;
};

}  // namespace catena
