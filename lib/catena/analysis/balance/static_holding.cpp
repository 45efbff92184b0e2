#include "catena/analysis/balance/static_holding.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/disjoint_sets.hpp"

namespace catena {
namespace {

// Groups of plan bodies tied together; immobile bodies and the ground share the last place.
class Groups {
 public:
  explicit Groups(int moving) : ground_(moving), sets_(moving + 1) {}
  void tie(int a, int b) { sets_.join(std::min(a, ground_), std::min(b, ground_)); }
  bool are_tied(int a, int b) { return sets_.are_joined(a, b); }
  bool is_held(int b) { return are_tied(b, ground_); }

 private:
  int ground_;
  DisjointSets sets_;
};

/// The bodies and the ground, tied by constraints and by forces that hold: loads act on a body without holding it.
Groups tie_bodies(const Plan& plan, const Evaluator& evaluator) {
  Groups groups(plan.moving);
  const auto tie_all = [&](const auto& block) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    for (int e = 0; e < block.size(); ++e)
      groups.tie(block.body_i[at(e)], E::bodies == 1 ? plan.bodies : block.body_j[at(e)]);
  };
  for_each_list(plan.blocks, [&](const auto& block, int) { tie_all(block); });
  for_each_list(plan.forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if constexpr (stiffness_pattern<E>().size() > 0 && !only_turning(stiffness_pattern<E>())) tie_all(block);
  });
  // Laws of state may hold by what they read: the search for an equilibrium shows whether they do.
  for (const CompiledLaw<double>& law : evaluator.laws()) {
    if (law.bodies.empty()) continue;
    groups.tie(law.i, plan.bodies);
    if (law.j >= 0) groups.tie(law.j, plan.bodies);
  }
  return groups;
}

/// The first group of bodies that nothing holds: their names, and the load on all of them about the ground's origin.
struct LooseBodies {
  NameList names;
  bool turns = false;          // a particle alone does not
  double load[3] = {0, 0, 0};  // N, N, N m
  double size = 0;             // the largest part of it
};

LooseBodies first_loose(Groups& groups, const StaticSystem& system, const Evaluator& evaluator) {
  const Plan& plan = system.plan();
  LooseBodies loose;
  int first = -1;
  for (int b = 0; b < plan.moving; ++b) {
    if (groups.is_held(b)) continue;
    if (first < 0) first = b;
    if (!groups.are_tied(b, first)) continue;
    loose.names.add(evaluator.model().body_name(plan.model_body[at(b)]));
    loose.turns = loose.turns || b != first || plan.column[at(3 * b + 2)] >= 0;
    double force[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      const int c = plan.column[at(3 * b + k)];
      if (c >= 0) force[k] = -system.gradient()[at(c)];
      loose.size = std::max(loose.size, std::abs(force[k]));
    }
    const Vec2<double> place = evaluator.ground_frame(b).origin();
    loose.load[0] += force[0];
    loose.load[1] += force[1];
    loose.load[2] += force[2] + place.x * force[1] - place.y * force[0];
  }
  return loose;
}

}  // namespace

std::optional<Report> find_loose_bodies(const StaticSystem& system, const Evaluator& evaluator) {
  Groups groups = tie_bodies(system.plan(), evaluator);
  const LooseBodies loose = first_loose(groups, system, evaluator);
  if (loose.names.count() == 0) return {};
  const bool many = loose.names.count() > 1;
  const char *bodies = many ? "the bodies" : "body", *them = many ? "them" : "it";
  if (std::hypot(loose.load[0], loose.load[1], loose.load[2]) > thresholds::no_force * loose.size) {
    return Report{Status::unbounded,
                  fmt::format("nothing holds {} {}: no constraint or spring ties {} to the ground, and the load "
                              "({:.4g}, {:.4g}) N moves {} without end; which joint or spring is missing?",
                              bodies, loose.names.text(), them, loose.load[0], loose.load[1], them),
                  {}};
  }
  return Report{Status::refused,
                fmt::format("{} {} {} free to move along x{}: no constraint or spring ties {} to the ground, so every "
                            "place is an equilibrium",
                            bodies, loose.names.text(), many ? "are" : "is",
                            loose.turns ? ", along y and to turn" : " and along y", them),
                {}};
}

}  // namespace catena
