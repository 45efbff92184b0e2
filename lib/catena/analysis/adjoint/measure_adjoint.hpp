// Gradients of measures of a motion by a way back over it: what an analysis asks of whatever goes back.
//
//   m = sum over pulses of weight x c(q, qd, qdd, lambda, p) at t        dm/dp by measure, then parameter
//
// The motion is followed while it runs, states at which measures look are kept. Source: apps/manual/sensitivity.md.
#pragma once

#include <optional>
#include <vector>

#include "catena/analysis/measures/measure_set.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class MeasureAdjoint {
 public:
  using MeasureGradients = std::vector<std::vector<double>>;
  virtual ~MeasureAdjoint() = default;
  /// Keeps the state at an instant at which measures look.
  virtual void keep(const Snapshot& snapshot) = 0;
  /// Nothing where there are none.
  virtual std::optional<MeasureGradients> find_gradients(const ColumnSet& columns,
                                                         const std::vector<std::vector<ColumnPulse>>& pulses) = 0;
};

}  // namespace catena
