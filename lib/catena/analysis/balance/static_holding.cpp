#include "catena/analysis/balance/static_holding.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Groups of plan bodies tied together; immobile bodies and the ground share the last place.
class Groups {
 public:
  explicit Groups(int moving) : ground_(moving), parent_(at(moving) + 1) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  void tie(int a, int b) { parent_[at(root(std::min(a, ground_)))] = root(std::min(b, ground_)); }
  int root(int b) {
    while (parent_[at(b)] != b) b = parent_[at(b)] = parent_[at(parent_[at(b)])];
    return b;
  }
  bool is_held(int b) { return root(b) == root(ground_); }

 private:
  int ground_;
  std::vector<int> parent_;
};

}  // namespace

std::optional<Report> find_loose_bodies(const StaticSystem& system, const Evaluator& evaluator) {
  const Plan& plan = system.plan();
  Groups groups(plan.moving);
  for_each_list(plan.blocks, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    for (int e = 0; e < block.size(); ++e) {
      groups.tie(block.body_i[at(e)], E::bodies == 1 ? plan.bodies : block.body_j[at(e)]);
    }
  });
  for_each_list(plan.forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    // Loads act on a body without holding it.
    if constexpr (stiffness_pattern<E>().size() > 0 && !only_turning(stiffness_pattern<E>())) {
      for (int e = 0; e < block.size(); ++e) {
        groups.tie(block.body_i[at(e)], E::bodies == 1 ? plan.bodies : block.body_j[at(e)]);
      }
    }
  });
  // So may laws of state, by what they read: then the search for an equilibrium shows it.
  for (const CompiledLaw<double>& law : evaluator.laws()) {
    if (law.bodies.empty()) continue;
    groups.tie(law.i, plan.bodies);
    if (law.j >= 0) groups.tie(law.j, plan.bodies);
  }
  int first = -1, count = 0;
  double load[3] = {0, 0, 0}, size = 0;
  std::string names;
  for (int b = 0; b < plan.moving; ++b) {
    if (groups.is_held(b)) continue;
    if (first < 0) first = b;
    if (groups.root(b) != groups.root(first)) continue;
    if (++count <= 3) {
      names += fmt::format("{}\"{}\"", count > 1 ? ", " : "", evaluator.model().body_name(plan.model_body[at(b)]));
    }
    double force[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      const int c = plan.column[at(3 * b + k)];
      if (c >= 0) force[k] = -system.gradient()[at(c)];
      size = std::max(size, std::abs(force[k]));
    }
    const Vec2<double> place = evaluator.ground_frame(b).origin();
    load[0] += force[0];
    load[1] += force[1];
    load[2] += force[2] + place.x * force[1] - place.y * force[0];
  }
  if (first < 0) return {};
  if (count > 3) names += fmt::format(" and {} more", count - 3);
  const bool loaded = std::hypot(load[0], load[1], load[2]) > 1e-9 * size;
  Report report;
  report.status = loaded ? Status::unbounded : Status::refused;
  report.message =
      loaded ? fmt::format(
                   "nothing holds {} {}: no constraint or spring ties {} to the ground, and the load "
                   "({:.4g}, {:.4g}) N moves {} without end; which joint or spring is missing?",
                   count > 1 ? "the bodies" : "body", names, count > 1 ? "them" : "it", load[0], load[1],
                   count > 1 ? "them" : "it")
             : fmt::format(
                   "{} {} free to move along x, along y and to turn: no constraint or spring ties {} to "
                   "the ground, so every place is an equilibrium",
                   count > 1 ? "the bodies" : "body", names + (count > 1 ? " are" : " is"), count > 1 ? "them" : "it");
  return report;
}

}  // namespace catena
