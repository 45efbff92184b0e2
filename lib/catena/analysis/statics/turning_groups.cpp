#include "catena/analysis/statics/turning_groups.hpp"

#include <cmath>
#include <numeric>

#include "catena/base/at.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"

namespace catena {
namespace {

/// Calls f(entry) for every element of a type that holds.
template <template <class> class E, class F>
void each_that_holds(const Evaluator& evaluator, F&& f) {
  for (const auto& entry : std::get<std::vector<ElementEntry<E<double>, double>>>(evaluator.model().constraints)) {
    if (!evaluator.plan().is_released(entry.id)) f(entry);
  }
}

/// The plan body of a model body that moves; -1 for the ground and what is fixed to it.
int moving_body(const Plan& plan, int model_body) {
  const int body = model_body < 0 ? -1 : plan.plan_body[at(model_body)];
  return body < plan.moving ? body : -1;
}

}  // namespace

TurningGroups::TurningGroups(const Evaluator& evaluator) : leader_(at(evaluator.plan().moving) + 1) {
  std::iota(leader_.begin(), leader_.end(), 0);
  const Plan& plan = evaluator.plan();
  const auto join_pair = [&](const auto& entry) { join(moving_body(plan, entry.i), moving_body(plan, entry.j)); };
  each_that_holds<Translational>(evaluator, join_pair);
  each_that_holds<Weld>(evaluator, join_pair);
  each_that_holds<RelativeAngle>(evaluator, join_pair);
  each_that_holds<AbsoluteAngle>(evaluator, [&](const auto& entry) { join(moving_body(plan, entry.i), -1); });
}

int TurningGroups::of(int plan_body) const {
  const int ground = static_cast<int>(leader_.size()) - 1;
  int body = plan_body < 0 || plan_body >= ground ? ground : plan_body;
  // Each step halves the way to the one that leads.
  while (leader_[at(body)] != body) body = leader_[at(body)] = leader_[at(leader_[at(body)])];
  return body == ground ? with_the_ground : body;
}

void TurningGroups::join(int i, int j) {
  const int ground = static_cast<int>(leader_.size()) - 1;
  const int a = of(i), b = of(j);
  if (a == b) return;
  // The ground leads wherever it is.
  if (a == with_the_ground) {
    leader_[at(b)] = ground;
  } else {
    leader_[at(a)] = b == with_the_ground ? ground : b;
  }
}

bool turns_a_guide_over(const Evaluator& evaluator, std::span<const double> before, std::span<const double> after) {
  const Plan& plan = evaluator.plan();
  const auto turn = [&](int model_body) {
    const int body = moving_body(plan, model_body);
    return body < 0 ? 0.0 : after[at(3 * body + 2)] - before[at(3 * body + 2)];
  };
  bool any = false;
  each_that_holds<Translational>(evaluator,
                                 [&](const auto& entry) { any = any || std::cos(turn(entry.j) - turn(entry.i)) < 0; });
  return any;
}

}  // namespace catena
