#include "catena/analysis/statics/static_attempts.hpp"

#include <random>

#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/analysis/statics/turning_groups.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Degrees of freedom up to which the energy is followed downhill from the start: the work grows with them, that of
// Newton's method does not.
constexpr int few_freedoms = 30;
// Coordinates up to which it is followed, whatever the degrees of freedom, after other methods have failed.
constexpr int most_downhill_columns = 3000;
// Displacements of angles, rad: of the first displaced start, and of those after it.
constexpr double little = 0.1, much = 1.0;

/// Reproducible numbers in [-1, 1): of seeds that follow each other, too, the first ones have nothing in common.
class RandomPushes {
 public:
  explicit RandomPushes(unsigned seed) : generator_(seed) {}
  double operator()() { return static_cast<double>(generator_() >> 8) / (1 << 23) - 1; }

 private:
  std::mt19937 generator_;
};

}  // namespace

StaticAttempts::StaticAttempts(const StaticSystem& system, const StaticSearchOptions& options) {
  if (options.solver == StaticSolver::ipopt || options.solver == StaticSolver::nlopt) {
    list_ = {{.way = options.solver == StaticSolver::ipopt ? StaticWay::ipopt : StaticWay::nlopt}};
    return;
  }
  const bool automatic = options.solver == StaticSolver::automatic, smooth = !system.has_gaps();
  const Plan& plan = system.plan();
  const bool few = !options.warm && !options.stationary && smooth && plan.columns - plan.rows <= few_freedoms;
  if (few) list_.push_back({.way = StaticWay::valley});
  for (unsigned seed = 0; seed < static_cast<unsigned>(most_static_trials); ++seed) {
    list_.push_back({.displacement = seed});
    if (seed == 1 && !few && smooth && plan.columns <= most_downhill_columns)
      list_.push_back({.way = StaticWay::valley});
    if (seed == starts_before_ipopt && automatic && ipopt_is_built_in()) list_.push_back({.way = StaticWay::ipopt});
  }
  settles_last_ = automatic && smooth;
}

bool StaticAttempts::go_on(int trial) {
  if (trial >= most_static_trials || ++place_ >= list_.size()) return false;
  if (settles_last_ && trial + 1 == most_static_trials) list_[place_] = {.way = StaticWay::settling};
  return true;
}

void shake(const StaticSystem& system, std::vector<double>& q, unsigned seed, double angle, double place) {
  const Plan& plan = system.plan();
  const TurningGroups groups(system.evaluator());
  std::vector<std::optional<double>> turned(at(plan.moving));  // by the body that stands for those that turn with it
  RandomPushes push(seed);
  for (int c = 0; c < plan.columns; ++c) {
    const int coordinate = plan.coordinate[at(c)];
    if (coordinate % 3 != 2) {
      q[at(coordinate)] += place * angle * system.length() * push();
      continue;
    }
    const int group = groups.of(coordinate / 3);
    if (group == TurningGroups::with_the_ground) continue;
    std::optional<double>& turn = turned[at(group)];
    if (!turn) turn = angle * push();
    q[at(coordinate)] += *turn;
  }
}

std::vector<double> start_of(const StaticAttempt& attempt, const StaticSystem& system,
                             const std::vector<double>& start) {
  std::vector<double> q = start;
  if (attempt.displacement > 0) shake(system, q, attempt.displacement, attempt.displacement == 1 ? little : much);
  return q;
}

}  // namespace catena
