// Equilibria of forces without a potential: settled to a balance, then judged by their small motions.
#include <algorithm>

#include "catena/analysis/balance/static_turns.hpp"
#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/spectrum/circulatory_words.hpp"
#include "catena/analysis/statics/solvers/static_descent.hpp"
#include "catena/analysis/statics/solvers/static_settling.hpp"
#include "catena/analysis/statics/solvers/static_steps.hpp"
#include "catena/analysis/statics/static_attempts.hpp"
#include "catena/analysis/statics/static_explanation.hpp"
#include "catena/analysis/statics/static_search.hpp"

namespace catena {
namespace {

// Of a push away from an equilibrium that diverges, rad or length scales.
constexpr double pushes_aside[] = {0.1, 0.8};
// Beside it a stable one is found in a few dozen steps, or there is none near.
constexpr int usual_steps_aside = 200, most_settling_steps = 1000;

}  // namespace

StaticOutcome StaticSearch::settle(std::vector<double>& q, std::vector<double>& lambda, int most_steps,
                                   StaticResult& result) {
  StaticOutcome outcome = solve_by_settling(system_, q, lambda, result.gaps,
                                            {.max_iterations = most_steps, .tolerance = options_.tolerance});
  result.iterations += outcome.iterations;
  if (outcome.end == StaticEnd::unbounded || outcome.end == StaticEnd::cancelled) return outcome;
  judge_.weigh(lambda);
  if (outcome.converged() && !judge_.accuracy().holds()) outcome.end = StaticEnd::slow;
  return outcome;
}

StaticResult StaticSearch::find_without_energy(std::vector<double>& q, std::vector<double>& lambda) {
  StaticResult result;
  result.has_energy = false;
  result.solver = "settling";
  const std::vector<double> start = q;
  const std::vector<CurvePlace> places = system_.evaluator().curve_places();
  StaticOutcome outcome;
  for (unsigned trial = 0; trial < starts_before_ipopt; ++trial) {
    if (trial > 0) q = start_of({.way = StaticWay::settling, .displacement = trial}, system_, start);
    system_.evaluator().go_to_curve_places(places);
    outcome = settle(q, lambda, most_settling_steps, result);
    if (outcome.end == StaticEnd::unbounded || outcome.end == StaticEnd::cancelled || outcome.converged()) break;
  }
  result.residual = outcome.residual;
  if (!outcome.converged()) {
    result.report = explain(outcome, start, result);
    return result;
  }
  result.stability = with_weak_open(system_, q, result.gaps, [&] { return judge_stability(system_, lambda); });
  const StaticStability& s = *result.stability;
  const bool left = !options_.stationary && s.judged && s.motions.negative > 0 && leave_divergence(q, lambda, result);
  warn_of_rounding(judge_.accuracy(), result.report);
  name_weak_gaps(system_.evaluator(), result);
  drop_whole_turns(system_, start, q);
  describe_stability(lambda, result);
  if (left)
    result.report.warnings.emplace_back("an equilibrium that is not stable was left for a stable one beside it");
  return result;
}

bool StaticSearch::leave_divergence(std::vector<double>& q, std::vector<double>& lambda, StaticResult& result) {
  KeptPlace before;
  before.keep(system_, q, lambda);
  const double residual = result.residual;
  const ActiveSet gaps = result.gaps;
  const auto& modes = result.stability->motions.modes;
  const auto lowest = std::find_if(modes.begin(), modes.end(), [](const CirculatoryMode& m) { return !m.is_pair(); });
  const std::vector<double> shape = lowest->shape;
  const double largest = system_.change_norm(shape);
  for (const double size : pushes_aside) {
    for (const double side : {1.0, -1.0}) {
      system_.close_gaps(gaps.closed);
      before.take_back(system_, q, lambda);
      system_.advance(q, shape, side * size / largest, 10);
      if (!restore_constraints(system_, q)) continue;
      const StaticOutcome outcome = settle(q, lambda, usual_steps_aside, result);
      if (outcome.end == StaticEnd::cancelled) break;
      if (!outcome.converged()) continue;
      StaticStability beside =
          with_weak_open(system_, q, result.gaps, [&] { return judge_stability(system_, lambda); });
      if (!beside.stable) continue;
      result.stability = std::move(beside);
      result.residual = outcome.residual;
      return true;
    }
  }
  result.residual = residual;
  result.gaps = gaps;
  system_.close_gaps(gaps.closed);
  before.take_back(system_, q, lambda);
  judge_.weigh(lambda);
  return false;
}

void StaticSearch::describe_stability(std::span<const double> lambda, StaticResult& result) {
  const StaticStability& s = *result.stability;
  std::vector<std::string>& warnings = result.report.warnings;
  const std::string cause = forces_without_energy(system_.evaluator().model());
  if (!s.judged) {
    warnings.push_back(cause + ": the forces balance here, but " + s.why_not);
    return;
  }
  result.free_bodies = free_bodies_of(system_, lambda, s.motions);
  for (std::string& sentence : describe_motions(system_, system_.evaluator(), s.motions, result.free_bodies))
    warnings.push_back(std::move(sentence));
  if (s.stable && !s.motions.symmetric && is_damped(system_.evaluator())) {
    warnings.push_back(cause +
                       ": this equilibrium is stable without damping, which is left out; a little of it may make "
                       "flutter of such motions");
  }
}

}  // namespace catena
