// Bodies that constraints keep from turning against each other: guides, welds and prescribed angles.
//
//   phi_j - phi_i = constant       in every configuration that motion can reach
//
// A guide's equation is the sine of the angle between its axes, which a body that is turned over by half a turn meets
// as well; no motion leads there. Random starts therefore turn such bodies together. Of several equilibria none is kept
// that has a guide turned over; the only one of a search from the given start lies near it and is not looked at. Linear
// in the number of elements. Angles in rad.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

class TurningGroups {
 public:
  explicit TurningGroups(const Evaluator& evaluator);

  static constexpr int with_the_ground = -1;
  /// The plan body that stands for all that turn with this one, or with_the_ground.
  int of(int plan_body) const;

 private:
  void join(int i, int j);

  mutable std::vector<int> leader_;  // of each plan body another one of its group, or itself; the ground is the last
};

/// Whether a guide that holds lies in the one configuration (plan order) the other way round than in the other.
bool turns_a_guide_over(const Evaluator& evaluator, std::span<const double> before, std::span<const double> after);

}  // namespace catena
