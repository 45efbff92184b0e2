// A chain of rods in the library's coordinates beside the exact one, in the same configuration with the same rates.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cases/exact_chain.hpp"
#include "catena/analysis/motion/equations_of_motion.hpp"
#include "suites/bench.hpp"

namespace bench {

struct ChainKernel {
  explicit ChainKernel(int rods);
  /// Of the far end of the last rod, m/s^2.
  double tip_error(std::span<const double> qdd) const;

  ExactChain exact;
  std::shared_ptr<catena::Model> model;
  catena::EvaluationWork work;
  catena::Evaluator evaluator;
  std::vector<double> q, qd;  ///< plan order
};

/// One row: a call of EquationsOfMotion::accelerations.
void measure_accelerations(Bench& bench, const char* suite, int rods);

}  // namespace bench
