// Mechanisms that move under forces, with independently known solutions.
#pragma once

#include <memory>
#include <numbers>

#include "catena/model/model.hpp"

namespace bench {

/// n uniform rods of 1 m and 1 kg in a straight horizontal line, at rest.
std::shared_ptr<catena::Model> straight_chain(int n);

/// IFToMM A02: n four-bars of 1 m side by side, upright, pushed to the right with 1 m/s.
std::shared_ptr<catena::Model> four_bars(int n);

/// Andrews' squeezing mechanism as the Test Set for IVP Solvers defines it.
std::shared_ptr<catena::Model> squeezer();

/// The Test Set's car axis: two masses on a bar, one of them guided along an axle that a road lifts.
std::shared_ptr<catena::Model> car_axis();

/// The exact motion of four_bars(n), whose cranks turn alike: theta'' = -k cos(theta), by a symplectic composition of
/// order 6 in small steps and 64 bits.
class Parallelogram {
 public:
  explicit Parallelogram(int n) : k_(9.81L * ((n + 1) / 2.0L + n) / ((n + 1) / 3.0L + n)) {}
  /// The end of the first crank at t, s; times must not decrease.
  catena::Vec2<double> crank_end(double t);

 private:
  long double k_, angle_ = std::numbers::pi_v<long double> / 2, rate_ = -1, t_ = 0;
};

}  // namespace bench
