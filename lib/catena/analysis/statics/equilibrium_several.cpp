// Several equilibria of one scene: the first from the given start, the others from random starts around it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/analysis/statics/static_attempts.hpp"
#include "catena/analysis/statics/turning_groups.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Starts for every equilibrium wanted, and for two more.
constexpr int starts_each = 15;
// Displacement of places as a part of that of angles times the length scale. Where bodies turn angles lead in the first
// half of the starts; angles may be held, and places what sets equilibria apart. Springs may reach further than the
// length scale, which is that of bodies: places are displaced by up to eight times as much, in turn.
constexpr double shaken_places = 0.5, shaken_beside_angles = 0.1;
constexpr std::array<double, 4> reaches{1, 2, 4, 8};
// Places closer than this, in extents or rad (whole turns aside), are the same, if their energies are.
constexpr double same_place = thresholds::same_value, same_energy = 1e-9;

struct Candidate {
  std::vector<double> q, lambda;
  EquilibriumReport report;
};

bool are_same(const Candidate& a, const Candidate& b, double extent, double energy_size) {
  if (std::abs(a.report.energy - b.report.energy) > same_energy * energy_size) return false;
  for (std::size_t k = 0; k < a.q.size(); ++k) {
    const double d = a.q[k] - b.q[k];
    const double apart = k % 3 == 2 ? std::remainder(d, 2 * std::numbers::pi) : d / extent;
    if (std::abs(apart) > same_place) return false;
  }
  return true;
}

}  // namespace

EquilibriumReport Equilibrium::find_several(const Needs& needs, RowObserver& observer) {
  const std::vector<double> start = q_;
  const bool turns = std::any_of(plan_->coordinate.begin(), plan_->coordinate.end(), [](int k) { return k % 3 == 2; });
  std::vector<Candidate> found;
  EquilibriumReport first;
  const int starts = starts_each * (options_.find + 2);
  int used = 0;
  for (; used < starts && static_cast<int>(found.size()) < options_.find; ++used) {
    q_ = start;
    solved_ = false;
    // In turn: close to the start, far from it, and in between.
    constexpr double angles[] = {std::numbers::pi, 0.3, 1.0};
    const double reach = reaches[at(used / 3) % reaches.size()];
    const double place = turns && 2 * used < starts ? shaken_beside_angles : shaken_places * reach;
    if (used > 0) shake(system_, q_, static_cast<unsigned>(used), angles[at(used % 3)], place);
    Candidate candidate;
    candidate.report = solve();
    if (used == 0) first = candidate.report;
    if (candidate.report.status == Status::cancelled) return candidate.report;
    // A loose body or an energy without a minimum is the same from every start.
    if (used == 0 && !first.ok() && first.status != Status::not_converged && first.status != Status::not_assembled)
      break;
    if (!candidate.report.ok() || turns_a_guide_over(evaluator_, start, q_)) continue;
    candidate.q = q_;
    candidate.lambda = lambda_;
    const double energy_size = std::max(std::abs(candidate.report.energy), system_.load_size() * system_.length());
    const bool known = std::any_of(found.begin(), found.end(), [&](const Candidate& other) {
      return are_same(candidate, other, system_.extent(), energy_size);
    });
    if (!known) found.push_back(std::move(candidate));
  }
  if (found.empty()) return first;
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.report.energy < b.report.energy; });
  EquilibriumReport report = found.front().report;
  report.counters = evaluator_.counters;
  for (const Candidate& candidate : found) {
    const EquilibriumReport& r = candidate.report;
    report.found.push_back({r.energy, r.stable, r.negative_modes, r.residual});
  }
  report.warnings.push_back(fmt::format("{} different equilibria found from {} starts, {} wanted; there may be others",
                                        found.size(), used, options_.find));
  for (const Candidate& candidate : found) {
    q_ = candidate.q;
    lambda_ = candidate.lambda;
    neutral_ = candidate.report.neutral;
    system_.move_to(q_);
    if (!send_row(needs, observer, report)) break;
  }
  q_ = found.front().q;
  lambda_ = found.front().lambda;
  neutral_ = found.front().report.neutral;
  system_.move_to(q_);
  return report;
}

}  // namespace catena
