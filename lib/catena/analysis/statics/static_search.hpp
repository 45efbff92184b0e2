// The search for one static equilibrium.
//
//   attempts from the start, in the order of static_attempts.hpp, each by one solver (static_trial.hpp)
//   a point that is accepted (static_judge.hpp) ends it
//   stationary but no minimum                 a push along the most negative mode, then the same solver again
//   forces that follow their body: no energy  damped settling (static_settling.hpp), judged by its small motions
//                                             (static_stability.hpp); beside one that diverges a stable one is looked
//                                             for on both sides, and it is kept where there is none
//
// Random numbers are fixed: the same scene gives the same answer.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/statics/solvers/static_newton.hpp"
#include "catena/analysis/statics/static_judge.hpp"
#include "catena/analysis/statics/static_result.hpp"

namespace catena {

class StaticSearch {
 public:
  StaticSearch(StaticSystem& system, const StaticSearchOptions& options)
      : system_(system), options_(options), judge_(system, options.tolerance) {}

  /// Finds an equilibrium from q; leaves q, lambda and the system there, or at the best that was found.
  StaticResult find(std::vector<double>& q, std::vector<double>& lambda);

 private:
  StaticResult find_minimum(std::vector<double>& q, std::vector<double>& lambda);
  StaticResult find_without_energy(std::vector<double>& q, std::vector<double>& lambda);
  StaticOutcome settle(std::vector<double>& q, std::vector<double>& lambda, int most_steps, StaticResult& result);
  /// Looks beside an equilibrium that diverges for a stable one; false, and nothing changed, where there is none.
  bool leave_divergence(std::vector<double>& q, std::vector<double>& lambda, StaticResult& result);
  void describe_stability(std::span<const double> lambda, StaticResult& result);
  void leave(const Certificate& certificate, std::vector<double>& q, double size);
  Report explain(const StaticOutcome& outcome, const std::vector<double>& start, const StaticResult& result);

  StaticSystem& system_;
  StaticSearchOptions options_;
  StaticJudge judge_;
};

}  // namespace catena
