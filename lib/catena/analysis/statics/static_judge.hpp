// The one test that accepts a point as an equilibrium: its certificate, and whether forces balance and constraints hold
// to the tolerance.
//
// A residual that may be rounding of the stiffest spring (static_accuracy.hpp) may as well be the whole force of a soft
// one. It is accepted only if a Newton step with the factors of the certificate would hardly move anything. The part of
// that step along a neutral motion is left out, as nothing determines it.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/balance/static_accuracy.hpp"
#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/statics/solvers/static_gaps.hpp"

namespace catena {

class StaticJudge {
 public:
  StaticJudge(StaticSystem& system, double tolerance) : system_(system), tolerance_(tolerance) {}

  /// Gaps that are closed without force may open: the point is certified as if they were. The system, which is at q, is
  /// left with all that are closed.
  Certificate certify_point(const std::vector<double>& q, std::span<const double> lambda, const ActiveSet& gaps);
  /// Whether forces balance and constraints hold where the system is, just after certify_point().
  bool is_accurate(std::span<const double> lambda, const Certificate& certificate);
  /// Judges the balance alone, without a certificate.
  const StaticAccuracy& weigh(std::span<const double> lambda);
  /// Of the last point that was judged.
  const StaticAccuracy& accuracy() const { return accuracy_; }

 private:
  StaticSystem& system_;
  double tolerance_;
  StaticAccuracy accuracy_;
};

}  // namespace catena
