// Checks the balance of energy of a motion: detects wrong integrations from the motion itself.
//
//   missing = T + V - (T0 + V0) - work of drivers and loads + dissipated
//   allowed = permitted x tolerance x (largest T + range of V) + rounding of V, |V|, weights and loads x length scale
//
// Where constraints are not kept but drift by the size of the tolerance, weights do the work  tolerance x weights x
// length scale  on the way: allowed as well, or no mechanism at rest would ever do.
//
// Constraints hold bodies against loads Q by forces up to F, the sum of all |Q|, which a stack hands down: balanced to
// eps times a dozen terms. Of what is left of F a body takes up a way F h^2 / m in a step h, on which its load works;
// steps at rest may be long:
//
//   rounding of what is held:   16 eps  sum |Q| / m  F  sum h^2       h: between checks
//
// Of a stack of ten that is pushed for 40 s the balance missed 6e-9 J, a ninth of this; of twenty for 100 s a fifth.
// Where bodies move this is 16 eps of what they could gain in free fall.
//
// A motion that sets out from rest is judged by what its forces do besides its energy, which is next to nothing then:
// velocities are known to tolerance x sqrt(a L) (error_scale.hpp), a: accelerations, be they due to loads or to drivers
//
//   start from rest:             permitted x tolerance x sqrt(largest T x sum M |a| L)
//
// Chains of twelve that a driver starts with a jerk miss 1e-7 of their first 1e-27 J at a tolerance of 1e-10, and 1e-3
// of 1e-11 J at 1e-4: 1e-5 and 1e-4 of this. The root keeps it small where accelerations grow at a singular position.
//
// Errors of positions and velocities of `tolerance` (of the scale of the motion) change the energy by a few times
// tolerance x (T + V); a motion with a much larger error of energy is wrong. No check is possible where forces without
// a potential act and their work is not summed up. Units: J.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "catena/analysis/motion/mass_matrix.hpp"
#include "catena/base/status.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class BalanceWatch {
 public:
  /// Whether forces and constraints of a model neither supply nor dissipate energy: tried with a motion of all bodies.
  static bool conserves(const Evaluator& evaluator);

  /// `work_known`: snapshots carry work and dissipation; `drifts`: constraints are not kept. Evaluates energies at the
  /// start.
  void begin(const Snapshot& start, const MassMatrix& masses, double tolerance, bool work_known, bool drifts);
  /// Energy of what came before, in phases of one motion: a part of its errors is that of the whole.
  void know_energy(double energy) { earlier_ = energy; }
  /// Largest kinetic energy and range of the potential, so far.
  double energy() const { return std::max(earlier_, largest_kinetic_ + largest_potential_ - least_potential_); }
  /// Records the energy of a state of the motion, at the configuration of its evaluator.
  void observe(const Snapshot& state);
  /// not_converged, with figures, where energy was lost or gained at the last state by more than is allowed; `loads`:
  /// generalized forces near there, whose work in the rounding of places none can know; accelerations there.
  Report check(double t, std::span<const double> loads, std::span<const double> accelerations) const;

 private:
  double unknown_of_velocities(std::span<const double> accelerations) const;

  double tolerance_ = 0, initial_ = 0, missing_ = 0, largest_kinetic_ = 0, least_potential_ = 0, largest_potential_ = 0;
  double earlier_ = 0, weight_ = 0;  // of all bodies, times the length scale: V is zero by chance alone
  double length_ = 1;
  double t_ = 0, squared_times_ = 0;  // of the latest state, s; sum of (time between states)^2, s^2
  std::vector<double> mass_;          // by coordinate
  bool work_known_ = false, drifts_ = false;
};

}  // namespace catena
