// The search for one static equilibrium: the order of solvers, repetitions after a failure, and leaving points that are
// no minimum.
//
//   few degrees of freedom and a start that can be assembled nearby   descent from there, else Newton
//   otherwise                                                         Newton; where its full steps do not settle,
//                                                                     descent; else again from displaced angles
//   two of them did not converge                                      descent from the start
//   automatic and several of them did not converge                    Ipopt; then Newton from other angles again
//   automatic and nothing converged                                   damped settling (StaticSettling)
//   forces that follow their body: no energy                          damped settling, no certificate
//   Ipopt or NLopt converged, chosen or automatic                     refined by Newton
//   stationary but no minimum                                         a push along the most negative mode, and on
//   gaps                                                              Newton on the smoothed complementarity, else
//                                                                     Ipopt; either ends on the exact active set
//
// Random numbers are fixed: the same scene gives the same answer.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "catena/analysis/balance/static_accuracy.hpp"
#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/statics/static_gaps.hpp"
#include "catena/analysis/statics/static_newton.hpp"
#include "catena/base/status.hpp"

namespace catena {

enum class StaticSolver { automatic, newton, ipopt, nlopt };

struct StaticSearchOptions {
  StaticSolver solver = StaticSolver::automatic;
  double tolerance = 1e-11;
  bool stationary = false;  ///< any stationary point will do
  bool warm = false;        ///< q and lambda are a solution for slightly different numbers
  bool verbose = false;
};

struct StaticResult {
  Report report;
  Certificate certificate;
  bool has_energy = true;
  std::string_view solver = "newton";
  int iterations = 0;
  double residual = 0;              ///< largest residual force, N
  std::vector<int> dependent_rows;  ///< constraint rows that follow from others
  ActiveSet gaps;                   ///< which are closed
};

class StaticSearch {
 public:
  StaticSearch(StaticSystem& system, const StaticSearchOptions& options) : system_(system), options_(options) {}

  /// Finds an equilibrium from q; leaves q, lambda and the system there, or at the best that was found.
  StaticResult find(std::vector<double>& q, std::vector<double>& lambda);

  /// Disturbs every coordinate by a random amount: angles by at most `angle`, rad, places by `place` of that in
  /// length scales. The same seed gives the same numbers.
  void shake(std::vector<double>& q, unsigned seed, double angle, double place = 0.1) const;

 private:
  enum class Way { valley, newton, ipopt, nlopt, settling };
  StaticOutcome minimise(std::vector<double>& q, std::vector<double>& lambda, bool warm, Way way, StaticResult& result);
  StaticOutcome minimise_with_gaps(std::vector<double>& q, std::vector<double>& lambda, bool warm, Way way,
                                   StaticResult& result);
  Certificate certify_with_gaps(const std::vector<double>& q, std::span<const double> lambda, const ActiveSet& gaps);
  StaticOutcome polish_by_newton(std::vector<double>& q, std::vector<double>& lambda, StaticOutcome outcome);
  bool is_accurate(std::span<const double> lambda, const Certificate& certificate);
  void leave(const Certificate& certificate, std::vector<double>& q, double size);
  StaticResult find_without_energy(std::vector<double>& q, std::vector<double>& lambda);
  std::optional<Report> find_overflow(std::span<double> lambda);
  Report explain(const StaticOutcome& outcome, const std::vector<double>& start, const StaticResult& result);
  void describe_point(const StaticResult& result, Report& report);

  StaticSystem& system_;
  StaticSearchOptions options_;
  StaticAccuracy accuracy_;  // of the last point that was judged
};

}  // namespace catena
