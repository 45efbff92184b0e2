#include "catena/analysis/statics/static_judge.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/run/far_places.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/statics/solvers/static_steps.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Takes the part along a mode out of the change, in the metric (1, 1, radius^2).
void take_out(StaticSystem& system, std::span<const double> mode, std::vector<double>& change) {
  const std::span<const double> inverse_arms = system.matrix().inverse_arms();
  double along = 0, square = 0;
  for (std::size_t c = 0; c < change.size(); ++c) {
    const double weighted = mode[c] / (inverse_arms[c] * inverse_arms[c]);
    along += change[c] * weighted;
    square += mode[c] * weighted;
  }
  for (std::size_t c = 0; c < change.size() && square > 0; ++c) change[c] -= along / square * mode[c];
}

// The same for motions of any shapes, which they are orthogonalised for.
void take_out_all(StaticSystem& system, std::vector<std::vector<double>> shapes, std::vector<double>& change) {
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    for (std::size_t before = 0; before < k; ++before) take_out(system, shapes[before], shapes[k]);
    take_out(system, shapes[k], change);
  }
}

}  // namespace

Certificate StaticJudge::certify_point(const std::vector<double>& q, std::span<const double> lambda,
                                       const ActiveSet& gaps) {
  return with_weak_open(system_, q, gaps, [&] { return certify(system_, lambda); });
}

const StaticAccuracy& StaticJudge::weigh(std::span<const double> lambda) {
  return accuracy_ = judge_balance(system_, lambda, tolerance_);
}

bool StaticJudge::is_accurate(std::span<const double> lambda, const Certificate& certificate) {
  weigh(lambda);
  const double rounding = std::max(10 * system_.rounding_change(), rounding_of_far_places(system_.evaluator()));
  if (!(system_.phi_norm() <= std::max(tolerance_, rounding))) return false;
  if (accuracy_.balanced || !accuracy_.rounded) return accuracy_.balanced;
  std::vector<double> force(at(system_.plan().columns)), gap(at(system_.plan().rows), 0.0);
  system_.residual(lambda, force);
  for (double& f : force) f = -f;
  const StaticStep step = system_.solve(force, gap, force_rounding);
  std::vector<double> change(step.change.begin(), step.change.end());
  if (certificate.neutral && !certificate.mode.empty()) take_out(system_, certificate.mode, change);
  if (system_.change_norm(change) <= descent::rounded_change || certificate.neutral_modes < 2)
    return system_.change_norm(change) <= descent::rounded_change;
  // Of several neutral motions a certificate has one.
  std::optional<FreeMotions> free = find_free_motions(system_, lambda, neutral_part);
  if (!free) return false;
  take_out_all(system_, std::move(free->shapes), change);
  return system_.change_norm(change) <= descent::rounded_change;
}

}  // namespace catena
