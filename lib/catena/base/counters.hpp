// Counts of the work an analysis did. Economy is a feature: tests assert these numbers, `--stats` prints them.
#pragma once

#include <cstdint>

namespace catena {

struct Counters {
  std::int64_t symbolic = 0;          ///< symbolic analyses (orderings, patterns of factors)
  std::int64_t factorizations = 0;    ///< numeric factorizations, refactorizations included
  std::int64_t refactorizations = 0;  ///< those that reused the pivot order
  std::int64_t solves = 0;            ///< back-substitutions, one a right-hand side
  std::int64_t iterations = 0;        ///< Newton iterations
  std::int64_t configurations = 0;    ///< evaluations of the bodies' trigonometry
  std::int64_t phis = 0;              ///< evaluations of the constraints
  std::int64_t jacobians = 0;         ///< evaluations of Phi_q
  std::int64_t nus = 0;               ///< evaluations of the velocity right-hand side
  std::int64_t gammas = 0;            ///< evaluations of the acceleration right-hand side
  std::int64_t forces = 0;            ///< evaluations of the applied forces
  std::int64_t hessians = 0;          ///< evaluations of second derivatives
  std::int64_t fallbacks = 0;         ///< times a safer kernel had to take over
  std::int64_t steps = 0;             ///< time steps taken
  std::int64_t rejected = 0;          ///< time steps rejected

  Counters& operator+=(const Counters& other) {
    symbolic += other.symbolic;
    factorizations += other.factorizations;
    refactorizations += other.refactorizations;
    solves += other.solves;
    iterations += other.iterations;
    configurations += other.configurations;
    phis += other.phis;
    jacobians += other.jacobians;
    nus += other.nus;
    gammas += other.gammas;
    forces += other.forces;
    hessians += other.hessians;
    fallbacks += other.fallbacks;
    steps += other.steps;
    rejected += other.rejected;
    return *this;
  }
  friend bool operator==(const Counters&, const Counters&) = default;
};

}  // namespace catena
