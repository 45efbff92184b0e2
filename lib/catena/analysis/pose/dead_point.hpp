// Why no velocity meets all constraints and drivers at a place: a dead point, or rows that contradict each other.
//
//   Phi_q qd = nu  has no solution:  w^T Phi_q = 0  but  w^T nu != 0  for some w
//
// If w depends on the place, w^T Phi_q vanishes here only: the drivers ask for a motion that the mechanism cannot make
// from here, a dead point (lock-up). If the rows depend on each other wherever the mechanism goes, they contradict each
// other everywhere (two drivers of one angle). A dependence lasts if it holds along every motion z from here:
//
//   w^T (Phi_q z)_q z = 0  for all z with  Phi_q z = 0,      = - w^T (gamma(z) + gamma(-z) - 2 gamma(0)) / 2
//
// The quadratic forms of all w are taken along p + 2 random z, p the number of left null vectors: with probability one
// a combination that vanishes along these vanishes along all, and lasts. If nu contradicts a lasting combination, the
// rows contradict each other everywhere; if it only contradicts others, the place is a dead point. Singular:
// dependences that end only to third order count as lasting.
#pragma once

#include <optional>

#include "catena/analysis/pose/singular_point.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {

/// Dense algebra of p rows and p + 2 columns takes a second with so many; with more, dead points are not looked for.
inline constexpr int most_dependences = 400;

/// The dead point that the mechanism is in at the assembled place q and the evaluator's time, with the driver
/// concerned; nothing where velocities exist, or where rows contradict each other for good. `threshold`: length (sine)
/// below which rows count as dependent: how exactly the place is known. The evaluator is left at q.
std::optional<SingularPoint> find_dead_point(Evaluator& evaluator, std::span<const double> q,
                                             double threshold = dependence::follows_at_start);

}  // namespace catena
