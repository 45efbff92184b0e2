// What a spectrum under forces without a potential means, in sentences for reports: divergence, flutter, free motions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/analysis/spectrum/circulatory_modes.hpp"

namespace catena {

/// Names of the bodies that take part in motions with omega2 = 0. The system must be at the place of the modes.
std::vector<std::string> free_bodies_of(StaticSystem& system, std::span<const double> lambda,
                                        const CirculatoryModes& found);

/// A sentence each for free motions, negative omega2 and pairs; nothing where all is stable. `free_bodies`: of
/// free_bodies_of.
std::vector<std::string> describe_motions(const StaticSystem& system, const Evaluator& evaluator,
                                          const CirculatoryModes& found, const std::vector<std::string>& free_bodies);

}  // namespace catena
