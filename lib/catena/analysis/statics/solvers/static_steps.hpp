// What the searches for equilibria share: how they end, their iterations, places to return to, and how far they moved.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {

/// How an iteration ended.
enum class StaticEnd {
  minimum,     ///< converged, the inertia of the last matrix that of a minimum
  stationary,  ///< converged to a point that is no minimum, or where any stationary point was asked for
  diverged,    ///< multipliers or steps without bound, or not finite
  slow,        ///< iterations exhausted
  singular,    ///< no factorization: a direction in which nothing resists
  unbounded,   ///< the energy falls without end
  turning,     ///< whole turns downhill to where it was, with less energy: from there the same again
  cancelled,   ///< stopped by the user
};

struct StaticOutcome {
  StaticEnd end = StaticEnd::slow;
  int iterations = 0;
  double step = 0;      ///< last change: length scales or rad
  double residual = 0;  ///< last residual force, N
  bool exact = false;   ///< the last matrix was the true one

  bool converged() const { return end == StaticEnd::minimum || end == StaticEnd::stationary; }
};

/// The iterations of a search. `step` makes one of them; where it returns false it has said in `outcome` how the search
/// ended. Without an end after `most` of them it was slow, as `outcome` says from the beginning.
template <class Step>
void iterate(StaticSystem& system, int most, StaticOutcome& outcome, Step&& step) {
  for (int k = 1; k <= most; ++k) {
    outcome.iterations = k;
    ++system.evaluator().counters.iterations;
    if (system.is_cancelled()) {
      outcome.end = StaticEnd::cancelled;
      return;
    }
    if (!step()) return;
  }
}

/// Rad: Newton's steps turn no body further, as elements are not linear.
inline constexpr double newton_turn = 1;
/// Changes below this, length scales or rad, are followed by the exact K: it is worth trying there.
inline constexpr double exact_change = 0.3;

/// No further gain is possible with the true matrix where changes are below this, length scales or rad.
inline constexpr double last_change = 1e-10;
/// Of what is added to the diagonal of K, as a shift or as damping, after a step that led nowhere: it is about as much
/// shorter then.
inline constexpr double growth_after_failure = 8;
/// Rounding of a sum of forces, in parts of the largest: searches go on to it where their steps are cheap.
inline constexpr double force_rounding = 1e-15;
/// What is added to the convex K, of the largest stiffness, where nothing else resists.
inline constexpr double least_shift = 1e-9;

/// A place that a search may have to return to: its coordinates and multipliers, and where curves touch there, as they
/// are searched from where they touched last.
struct KeptPlace {
  std::vector<double> q, lambda;
  std::vector<CurvePlace> curves;

  void keep(StaticSystem& system, std::span<const double> q_now, std::span<const double> lambda_now);
  /// Moves the system there.
  void take_back(StaticSystem& system, std::span<double> q_now, std::span<double> lambda_now) const;
};

/// Of all bodies the largest.
struct Travel {
  double turn = 0;    ///< rad
  double length = 0;  ///< m, along x or y

  /// So many extents (m), or radians, away that the rounding of places is as large as the mechanism.
  bool is_lost(double extent) const {
    return thresholds::position_rounding * length > extent || thresholds::position_rounding * turn > 1;
  }
};
/// By a change of the plan's columns.
Travel travel_of(const Plan& plan, std::span<const double> change);
/// Between two configurations.
Travel travel_between(std::span<const double> from, std::span<const double> to);

/// Fills and factors the convex K, with shifts that grow where it has no factors. False: it has none.
bool factorize_convex(StaticSystem& system, std::span<const double> lambda);

}  // namespace catena
