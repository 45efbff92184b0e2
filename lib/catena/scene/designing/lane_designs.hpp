// Designs of a sweep in lanes: sixteen analyses side by side, with the measures that each would have by itself.
//
// A sweep can be computed so if it repeats one analysis that lanes know: kinematics or inverse_dynamics
// (lane_motion_designs.hpp), or equilibrium (lane_rest_designs.hpp). A design that leaves its group, or in which
// anything is missing, is left to the analysis itself: what lanes give is what that gives to rounding, and every
// failure is its own.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/batch/kernels/lane_code.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {

class LaneDesigns {
 public:
  /// Nothing, with the reason, where the designs of the context's sweep cannot be computed in lanes. One object a
  /// thread; `context` must outlive it.
  static std::unique_ptr<LaneDesigns> make(const AnalysisContext& context, std::string& why_not);

  LaneDesigns() = default;
  virtual ~LaneDesigns() = default;
  LaneDesigns(const LaneDesigns&) = delete;
  LaneDesigns& operator=(const LaneDesigns&) = delete;

  /// What came of a design: its measures in order; or nothing, with the reason, and it is to be analysed by itself.
  struct Outcome {
    std::optional<std::vector<double>> measures;
    std::string why_not;
  };
  /// Of at most lane_count designs, each with the values of its parameters.
  virtual void measure(std::span<const ParameterSeeds> designs, std::span<Outcome> outcomes) = 0;
};

}  // namespace catena
