// Integrals of power, integrated along with the motion where columns or the balance check need them.
//
//   dissipated   of dampers
//   loads        work of the applied loads that have no potential: functions of time, follower forces
//   driver k     -lambda nu of its equation: load x dc/dt (apps/manual/dynamics.md#driver-loads)
//
// The balance T + V - (T0 + V0) - (loads + drivers) + dissipated is zero up to the error of integration. Units: J, W.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

class EnergyAccount {
 public:
  explicit EnergyAccount(const Evaluator& evaluator);

  std::size_t size() const { return 2 + drivers_.size(); }
  /// The powers at the evaluator's configuration; lambda: multipliers of the solver's rows there.
  void powers(std::span<const double> qd, std::span<const double> lambda, std::span<double> out);
  /// The same where one driver, by its element, does all that drivers do.
  void powers_of_one(std::span<const double> qd, int driver, double power, std::span<double> out);

  /// Adds to `work` what drivers do where velocities jump: -p (nu- + nu+) / 2, with the impulses p of the solver's
  /// rows; nu before and behind the jump.
  void add_jolt(std::span<const double> p, std::span<const double> before, std::span<const double> after,
                std::span<double> work) const;

  static double dissipated(std::span<const double> work) { return work[0]; }
  static double& dissipated(std::span<double> work) { return work[0]; }
  static double of_loads(std::span<const double> work) { return work[1]; }
  /// Of loads and drivers together.
  static double supplied(std::span<const double> work);
  /// Scatters the drivers' work to `by_element`, which has one entry an element of the model.
  void driver_work(std::span<const double> work, std::span<double> by_element) const;

 private:
  const Evaluator& evaluator_;
  struct Driver {
    int element, row;
  };
  std::vector<Driver> drivers_;
  std::vector<double> nu_;
};

}  // namespace catena
