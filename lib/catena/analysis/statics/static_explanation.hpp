// The messages of a search for an equilibrium: why none was found, and warnings about the one that was.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/balance/static_accuracy.hpp"
#include "catena/analysis/statics/solvers/static_newton.hpp"
#include "catena/analysis/statics/static_result.hpp"

namespace catena {

/// Refuses forces and stiffnesses at the system's configuration whose products overflow.
std::optional<Report> find_overflow(StaticSystem& system, std::span<double> lambda);
/// The energy falls without end: names the body that has gone farthest from `start`, or turned most; or `singular`,
/// with the element whose curve or table it has left on its way.
Report explain_unbounded(StaticSystem& system, const std::vector<double>& start);
/// Refuses one-sided elements beside forces that have no energy; the system has gaps.
Report refuse_gaps_without_energy(StaticSystem& system);

/// Why nothing was accepted. The system is where the last trial ended; `accuracy` is that of its last point. The system
/// is left elsewhere.
Report explain_failure(StaticSystem& system, const StaticOutcome& outcome, const StaticAccuracy& accuracy,
                       double tolerance, const std::vector<double>& start, const StaticResult& result);

/// Adds warnings: of gaps that touch without a force, of forces that balance only as well as rounding allows, and of
/// neutral and negative modes.
void add_warnings(StaticSystem& system, const StaticAccuracy& accuracy, StaticResult& result);
/// Names the gaps of which rounding decides whether they are closed.
void name_weak_gaps(const Evaluator& evaluator, StaticResult& result);
/// Warns where forces balance as well as rounding allows, but not to the tolerance.
void warn_of_rounding(const StaticAccuracy& accuracy, Report& report);

}  // namespace catena
