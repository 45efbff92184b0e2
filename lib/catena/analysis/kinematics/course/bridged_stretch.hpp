// The stretch of time where a motion is taken from a bridge (kinematics_bridge.hpp), and what is still ahead on it; and
// the coordinates that no equation moves, which an interpolation would give with its rounding. Units: s.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/kinematics/course/kinematics_bridge.hpp"
#include "catena/analysis/pose/branches.hpp"
#include "catena/assembly/plan.hpp"

namespace catena {

struct BridgedStretch {
  MotionBridge bridge;  ///< empty: there is none
  double from = 0, to = 0;
  std::optional<SingularPoint> choice;  ///< the branch point on it where another branch is to be taken

  bool empty() const { return bridge.empty(); }
  bool covers(double t) const { return !bridge.empty() && t >= from && t <= to; }
  void span(double one, double other) {
    from = std::min(one, other);
    to = std::max(one, other);
  }
};

/// Coordinates that are no unknowns: of immobile bodies, angles of particles.
class FixedCoordinates {
 public:
  explicit FixedCoordinates(const Plan& plan) {
    for (int k = 0; k < plan.coordinates(); ++k) {
      const auto place = static_cast<std::size_t>(k);
      if (k >= 3 * plan.bodies || plan.column[place] < 0) places_.push_back(place);
    }
  }
  /// Extrapolation is exact for constants but for rounding, which nothing corrects where there is no unknown: the
  /// places of `known` go to q, zero to the rates. Spans may be empty.
  void restore(std::span<const double> known, std::span<double> q, std::span<double> qd, std::span<double> qdd) const {
    for (const std::size_t k : places_) {
      if (!q.empty()) q[k] = known[k];
      if (!qd.empty()) qd[k] = 0;
      if (!qdd.empty()) qdd[k] = 0;
    }
  }

 private:
  std::vector<std::size_t> places_;
};

}  // namespace catena
