#include "catena/analysis/statics/static_stability.hpp"

#include <fmt/format.h>

#include "catena/analysis/motion/mass_matrix.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

/// The masses by columns; none, and why, where a body lacks one.
std::vector<double> masses_of(StaticSystem& system, std::string& why_not) {
  const Plan& plan = system.plan();
  MassMatrix masses;
  std::vector<double> mass;
  if (const Report missing = masses.load(system.evaluator()); !missing.ok()) {
    why_not = "whether this equilibrium is stable depends on masses that are not given: " + missing.message;
    return mass;
  }
  for (int c = 0; c < plan.columns; ++c) mass.push_back(masses.mass[at(plan.coordinate[at(c)])]);
  return mass;
}

}  // namespace

StaticStability judge_stability(StaticSystem& system, std::span<const double> lambda) {
  StaticStability result;
  StaticTangent tangent(system);
  const std::vector<double> mass = masses_of(system, result.why_not);
  std::optional<CirculatoryMotions> motions(std::in_place, system, tangent, mass);
  if (!motions->are_small()) {
    result.why_not = fmt::format(
        "their stiffness is unsymmetric, which dense algebra treats up to {} degrees of freedom; this mechanism has "
        "{}: "
        "nothing certifies that this equilibrium is stable",
        CirculatoryMotions::most_freedoms, motions->freedoms());
    return result;
  }
  if (const std::optional<int> column = motions->massless_column()) {
    const int coordinate = system.plan().coordinate[at(*column)];
    result.why_not =
        fmt::format("whether this equilibrium is stable depends on masses, and a motion of body \"{}\" moves none",
                    system.evaluator().model().body_name(system.plan().model_body[at(coordinate / 3)]));
    motions.emplace(system, tangent, std::span<const double>{});
  }
  result.in_masses = result.why_not.empty();
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
