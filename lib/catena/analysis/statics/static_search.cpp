#include "catena/analysis/statics/static_search.hpp"

#include <algorithm>
#include <optional>

#include "catena/analysis/balance/static_turns.hpp"
#include "catena/analysis/pose/whole_turns.hpp"
#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/statics/solvers/static_descent.hpp"
#include "catena/analysis/statics/solvers/static_settling.hpp"
#include "catena/analysis/statics/static_attempts.hpp"
#include "catena/analysis/statics/static_explanation.hpp"
#include "catena/analysis/statics/static_trial.hpp"

namespace catena {
namespace {

// Of a push away from a point that is no minimum, rad or length scales: the first one, and the largest that it is
// doubled to.
constexpr double first_push = 0.05, largest_push = 0.8;

}  // namespace

// A push along the mode, its largest component `size` rad or length scales, to the side where the energy is lower.
void StaticSearch::leave(const Certificate& certificate, std::vector<double>& q, double size) {
  const double largest = system_.change_norm(certificate.mode);
  std::vector<double> best;
  double lowest = 0;
  const std::vector<CurvePlace> start = system_.evaluator().curve_places();
  std::vector<CurvePlace> places;  // of the best
  for (const double side : {1.0, -1.0}) {
    std::vector<double> trial = q;
    system_.evaluator().go_to_curve_places(start);
    system_.advance(trial, certificate.mode, side * size / largest, 10);
    const bool restored = restore_constraints(system_, trial);
    const double energy = restored ? system_.energy() : 0;
    if (best.empty() || (restored && energy < lowest)) {
      best = trial;
      lowest = energy;
      places = system_.evaluator().curve_places();
    }
  }
  q = best;
  system_.evaluator().go_to_curve_places(places);
}

// Attempts one after the other until a point is accepted; one that is no minimum is left towards lower energy.
StaticResult StaticSearch::find_minimum(std::vector<double>& q, std::vector<double>& lambda) {
  StaticResult result;
  const std::vector<double> start = q;
  const std::vector<CurvePlace> places = system_.evaluator().curve_places();  // at the start
  StaticAttempts attempts(system_, options_);
  StaticTrial trials(system_, options_);
  StaticOutcome outcome;
  double push = first_push;
  bool accepted = false, pushed = false;
  std::optional<Report> endless;
  for (int trial = 0; trial < most_static_trials; ++trial) {
    // Newton's steps with gaps may lead back to the point that was left; a damped motion does not.
    const bool settles = pushed && system_.has_gaps() && options_.solver == StaticSolver::automatic;
    const StaticWay way = settles ? StaticWay::settling : attempts.present().way;
    outcome = trials.run(q, lambda, options_.warm && trial == 0, way, result);
    // Past the top of a floor that it slides off it falls for ever; on the top it is at rest.
    const bool slid_off = outcome.end == StaticEnd::unbounded && options_.stationary && system_.has_gaps();
    if ((outcome.end == StaticEnd::unbounded && !slid_off) || outcome.end == StaticEnd::cancelled) break;
    // Another place may hold it.
    if (outcome.end == StaticEnd::turning || slid_off) endless = explain_unbounded(system_, start);
    if (outcome.converged()) {
      result.certificate = judge_.certify_point(q, lambda, result.gaps);
      const Certificate& c = result.certificate;
      const bool wanted = options_.stationary || c.negative_modes == 0;
      accepted = judge_.is_accurate(lambda, c) && c.valid && wanted;
      if (accepted || !c.valid || (!wanted && c.mode.empty())) break;
      if (!wanted) {
        leave(c, q, push);
        push = std::min(2 * push, largest_push);
        pushed = true;
        continue;
      }
    }
    if (!attempts.go_on(trial + 1)) break;
    q = start_of(attempts.present(), system_, start);
    system_.evaluator().go_to_curve_places(places);
  }
  if (!outcome.converged()) judge_.weigh(lambda);
  result.residual = judge_.accuracy().residual;
  if (!accepted) {
    const bool stopped = outcome.end == StaticEnd::unbounded || outcome.end == StaticEnd::cancelled;
    result.report = endless && !stopped ? *endless : explain(outcome, start, result);
    return result;
  }
  drop_whole_turns(system_, start, q);
  result.dependent_rows = system_.matrix().dependent_rows();
  add_warnings(system_, judge_.accuracy(), result);
  std::vector<std::string>& warnings = result.report.warnings;
  if (attempts.is_late_descent())
    warnings.emplace_back("found by following the energy downhill from the start, after other methods had failed");
  if (pushed) warnings.emplace_back("a stationary point that is no minimum was left towards lower energy");
  return result;
}

StaticResult StaticSearch::find(std::vector<double>& q, std::vector<double>& lambda) {
  StaticResult result;
  if (!options_.warm) move_whole_turns(system_.evaluator(), q);
  if (!system_.evaluator().conservative()) return find_without_energy(q, lambda);
  system_.move_to(q);
  if (std::optional<Report> overflow = find_overflow(system_, lambda)) {
    result.report = *overflow;
    return result;
  }
  return find_minimum(q, lambda);
}

Report StaticSearch::explain(const StaticOutcome& outcome, const std::vector<double>& start,
                             const StaticResult& result) {
  return explain_failure(system_, outcome, judge_.accuracy(), options_.tolerance, start, result);
}

}  // namespace catena
