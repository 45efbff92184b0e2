// One solver from one start, on the way of an attempt (static_attempts.hpp).
//
//   newton             where its full steps do not settle, descent from their end
//   valley             descent from the assembled start
//   ipopt, nlopt, settling     refined by Newton's method, unless that leads to another equilibrium
//   gaps               Newton on the smoothed complementarity, or Ipopt; either ends on the exact active set
#pragma once

#include <vector>

#include "catena/analysis/statics/solvers/static_newton.hpp"
#include "catena/analysis/statics/static_attempts.hpp"

namespace catena {

class StaticTrial {
 public:
  StaticTrial(StaticSystem& system, const StaticSearchOptions& options) : system_(system), options_(options) {}

  /// Leaves q, lambda and the system where it ended. `warm`: q and lambda are near a solution. Solver, iterations and
  /// closed gaps go to `result`.
  StaticOutcome run(std::vector<double>& q, std::vector<double>& lambda, bool warm, StaticWay way,
                    StaticResult& result);

 private:
  StaticOutcome run_smooth(std::vector<double>& q, std::vector<double>& lambda, bool warm, StaticWay way);
  StaticOutcome run_with_gaps(std::vector<double>& q, std::vector<double>& lambda, bool warm, StaticWay way,
                              StaticResult& result);
  /// Brings q onto the constraints; where they cannot be met nothing changes.
  bool assemble(std::vector<double>& q);
  StaticOutcome optimise_by_nlopt(std::vector<double>& q, std::vector<double>& lambda);
  StaticOutcome optimise(std::vector<double>& q, std::vector<double>& lambda, bool warm, StaticWay way);
  StaticOutcome polish_by_newton(std::vector<double>& q, std::vector<double>& lambda, StaticOutcome outcome);

  StaticSystem& system_;
  const StaticSearchOptions& options_;
};

}  // namespace catena
