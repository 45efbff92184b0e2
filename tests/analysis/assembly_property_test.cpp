// What assembly promises, on random mechanisms of all joint types sketched more or less well.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "analysis/random_mechanisms.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/assembly/plan.hpp"

namespace catena::testing {
namespace {

/// A model in the state that its sketch gives, and what assembly makes of it.
struct Assembled {
  explicit Assembled(std::shared_ptr<const Model> m)
      : model(std::move(m)),
        plan(Plan::make(*model)),
        evaluator(plan, *model, work),
        given(evaluator.given_configuration()) {
    q = given;
    before = residual(given);
    outcome = Assembler(evaluator).assemble(q);
    after = residual(q);
  }
  /// Largest residual: lengths in length scales, angles in rad.
  double residual(std::span<const double> at) {
    std::vector<double> phi(static_cast<std::size_t>(plan->rows));
    evaluator.set_time(0);
    evaluator.set_configuration(at);
    evaluator.phi(phi);
    double largest = 0;
    for (std::size_t r = 0; r < phi.size(); ++r) {
      largest = std::max(largest, std::abs(phi[r]) / (plan->row_is_angle[r] ? 1 : evaluator.length_scale()));
    }
    return largest;
  }
  /// Pose of body k of the recipe, in the ground frame.
  std::array<double, 3> pose(std::size_t k) const {
    const int b = plan->plan_body[static_cast<std::size_t>(model->find_body("b" + std::to_string(k)))];
    const auto place = static_cast<std::size_t>(3 * b);
    return {q[place] + evaluator.origin(b).x, q[place + 1] + evaluator.origin(b).y, q[place + 2]};
  }

  std::shared_ptr<const Model> model;
  std::shared_ptr<const Plan> plan;
  EvaluationWork work;
  Evaluator evaluator;
  std::vector<double> given, q;
  double before = 0, after = 0;
  AssemblyOutcome outcome;
};

// However bad the sketch: assembled to the tolerance, or left as it was with constraints named.
TEST(AssemblyProperty, NeverReturnsAWorseConfiguration) {
  int assembled = 0, refused = 0;
  const bool passed = rc::check([&] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const int groups = *rc::gen::inRange(0, 8);
    const Recipe recipe = RandomMechanism(seed, groups).recipe();
    Setting setting;
    setting.sketch = std::pow(10.0, *rc::gen::inRange(-4, 2));
    setting.seed = seed;
    setting.driven = *rc::gen::arbitrary<bool>();
    setting.doubled = *rc::gen::arbitrary<bool>();
    const auto model = build(recipe, setting);
    // Half of the driven ones are asked for a place of the first crank that it cannot reach.
    const bool contradicted = setting.driven && *rc::gen::arbitrary<bool>();
    if (contradicted) model->add("elsewhere", AbsoluteX<>{}, model->find_body("b0"), ground, 50 * recipe.extent());
    const Assembled result(model);
    if (result.outcome.ok()) {
      ++assembled;
      RC_ASSERT(!contradicted);
      RC_ASSERT(result.after <= 1e-12);
      RC_ASSERT(std::abs(result.outcome.residual - result.after) <= 1e-15);
      RC_ASSERT(result.outcome.misfits.empty());
    } else {
      ++refused;
      RC_ASSERT(result.outcome.status == Status::not_assembled);
      RC_ASSERT(result.q == result.given);
      RC_ASSERT(!result.outcome.misfits.empty());
      RC_ASSERT(result.outcome.misfits.front().size > 0);
      RC_ASSERT(result.outcome.message.find('"') != std::string::npos);
    }
  });
  EXPECT_TRUE(passed);
  EXPECT_GT(assembled, 50);
  EXPECT_GT(refused, 10);
}

// A good sketch of a driven mechanism leads back to the mechanism it was made of, whole turns too many or not.
TEST(AssemblyProperty, FindsTheMechanismThatWasSketched) {
  int found = 0, tried = 0;
  const bool passed = rc::check([&] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const int groups = *rc::gen::inRange(0, 6);
    const Recipe recipe = RandomMechanism(seed, groups).recipe();
    Setting setting;
    setting.sketch = 1e-4;
    setting.seed = seed;
    setting.doubled = *rc::gen::arbitrary<bool>();
    const Assembled result(build(recipe, setting));
    ++tried;
    if (!result.outcome.ok()) return;
    double off = 0;
    for (std::size_t k = 0; k < recipe.place.size(); ++k) {
      const auto [x, y, angle] = result.pose(k);
      off = std::max({off, std::abs(x - recipe.place[k].x) / recipe.extent(),
                      std::abs(y - recipe.place[k].y) / recipe.extent(), std::abs(angle - recipe.angle[k])});
    }
    // A mechanism near a dead point has another configuration as near.
    if (off < 1e-8) ++found;
  });
  EXPECT_TRUE(passed);
  EXPECT_GE(found, 0.95 * tried) << found << " of " << tried;
}

// Without drivers: no further away than the configuration that the sketch was made of.
TEST(AssemblyProperty, StaysNearTheSketchWhereFreedomIsLeft) {
  int tried = 0, near = 0;
  const bool passed = rc::check([&] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const int groups = *rc::gen::inRange(0, 6);
    const Recipe recipe = RandomMechanism(seed, groups).recipe();
    Setting setting;
    setting.driven = false;
    const Assembled exact(build(recipe, setting));
    setting.sketch = 1e-3;
    setting.seed = seed;
    const Assembled result(build(recipe, setting));
    ++tried;
    if (!result.outcome.ok()) return;
    const std::vector<double> radius = result.evaluator.attachment_radii();
    const auto distance = [&](const Assembled& to) {
      double sum = 0;
      for (std::size_t b = 0; 3 * b + 3 < result.given.size(); ++b) {
        const Vec2<double> shift =
            to.evaluator.origin(static_cast<int>(b)) - result.evaluator.origin(static_cast<int>(b));
        const double x = to.q[3 * b] + shift.x - result.given[3 * b],
                     y = to.q[3 * b + 1] + shift.y - result.given[3 * b + 1];
        const double turn = radius[b] * (to.q[3 * b + 2] - result.given[3 * b + 2]);
        sum += x * x + y * y + turn * turn;
      }
      return std::sqrt(sum);
    };
    if (distance(result) <= 1.0001 * distance(exact)) ++near;
  });
  EXPECT_TRUE(passed);
  EXPECT_GE(near, 0.95 * tried) << near << " of " << tried;
}

}  // namespace
}  // namespace catena::testing
