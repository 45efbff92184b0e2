#include "catena/analysis/balance/static_turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/disjoint_sets.hpp"

namespace catena {
namespace {

constexpr double turn = 2 * std::numbers::pi;

// Elements that count the turns of one body relative to the other.
template <class E>
constexpr bool counts_turns =
    std::is_same_v<E, AbsoluteAngle<double>> || std::is_same_v<E, RelativeAngle<double>> ||
    std::is_same_v<E, Weld<double>> || std::is_same_v<E, Gear<double>> || std::is_same_v<E, Belt<double>> ||
    std::is_same_v<E, RackPinion<double>> || std::is_same_v<E, Stop<double>> || std::is_same_v<E, Rope<double>> ||
    std::is_same_v<E, RopePart<double>> || std::is_same_v<E, ElasticRope<double>> ||
    std::is_same_v<E, TorsionSpring<double>> || std::is_same_v<E, Bushing<double>> ||
    std::is_same_v<E, CustomForce<double>> || std::is_same_v<E, CustomConstraint<double>>;
// A pinion that has turned is elsewhere on its rack.
template <class E>
constexpr bool turns_are_places = std::is_same_v<E, RackPinion<double>>;

}  // namespace

bool drop_whole_turns(const Plan& plan, std::span<const double> start, std::span<double> q) {
  const auto turns = [&](int b) { return std::round((q[at(3 * b + 2)] - start[at(3 * b + 2)]) / turn); };
  bool any = false;
  for (int b = 0; b < plan.moving; ++b) any = any || turns(b) != 0;
  if (!any) return false;
  // Groups of bodies; immobile ones and the ground share the last place.
  DisjointSets groups(plan.moving + 1);
  const auto tie = [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if constexpr (counts_turns<E>) {
      for (int e = 0; e < block.size(); ++e) {
        const int i = std::min(block.body_i[at(e)], plan.moving);
        const int j = E::bodies == 1 ? plan.moving : std::min(block.body_j[at(e)], plan.moving);
        groups.join(i, j);
        if (turns_are_places<E>) groups.join(i, plan.moving);
      }
    }
  };
  for_each_list(plan.blocks, tie);
  for_each_list(plan.forces, tie);
  // A law of state may read any angle, turns included.
  for (const auto& [acted, read] : plan.law_pairs) groups.join(read, plan.moving);
  std::vector<double> taken(at(plan.moving) + 1, std::nan(""));
  taken[at(groups.root(plan.moving))] = 0;
  for (int b = 0; b < plan.moving; ++b) {
    double& group = taken[at(groups.root(b))];
    if (std::isnan(group)) group = turns(b);
    q[at(3 * b + 2)] -= turn * group;
  }
  return true;
}

void drop_whole_turns(StaticSystem& system, std::span<const double> start, std::span<double> q) {
  if (drop_whole_turns(system.plan(), start, q)) system.move_to(q);
}

}  // namespace catena
