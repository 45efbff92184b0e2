#include "catena/analysis/statics/static_stability.hpp"

#include <fmt/format.h>

namespace catena {

StaticStability judge_stability(StaticSystem& system, std::span<const double> lambda) {
  StaticStability result;
  StaticTangent tangent(system);
  std::string lack;
  const std::unique_ptr<CirculatoryMotions> motions = motions_in_masses(system, tangent, lack);
  if (!motions->are_small()) {
    result.why_not = fmt::format(
        "their stiffness is unsymmetric, which dense algebra treats up to {} degrees of freedom; this mechanism has "
        "{}: "
        "nothing certifies that this equilibrium is stable",
        CirculatoryMotions::most_freedoms, motions->freedoms());
    return result;
  }
  if (!lack.empty()) result.why_not = "whether this equilibrium is stable depends on masses, and " + lack;
  result.in_masses = lack.empty();
  if (!motions->find(lambda, 0, result.motions)) {
    result.why_not = "the eigenvalues of their stiffness did not settle, so that nothing certifies this equilibrium";
    return result;
  }
  CirculatoryModes& found = result.motions;
  if (!result.in_masses) {
    std::erase_if(found.modes, [](const CirculatoryMode& mode) { return mode.is_pair(); });
    found.pairs = 0;
  }
  // Of a symmetric K the signs are those in any metric; an odd number of negative values has a determinant below zero.
  result.judged = result.in_masses || found.symmetric || found.negative % 2 == 1;
  result.stable = result.judged && found.stable();
  if (result.judged) result.why_not.clear();
  return result;
}

}  // namespace catena
