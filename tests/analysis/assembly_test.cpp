// Assembly that cannot succeed: which constraints it names. Whole turns; coordinates that are held.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "analysis/linkages.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// What assembly makes of a model.
struct Attempt {
  explicit Attempt(const Model& model) : plan(Plan::make(model)), evaluator(plan, model, work) {
    q = evaluator.given_configuration();
    outcome = Assembler(evaluator).assemble(q);
    for (const Misfit& misfit : outcome.misfits) names.push_back(std::string(model.element_name(misfit.element)));
  }
  std::shared_ptr<const Plan> plan;
  EvaluationWork work;
  Evaluator evaluator;
  std::vector<double> q;
  AssemblyOutcome outcome;
  std::vector<std::string> names;  ///< of the misfits
};

/// Particles that are all tied to each other by rods, some of which have a wrong length (part of their own).
std::shared_ptr<Model> tied_particles(int count, const std::map<std::string, double>& wrong, double scale = 1) {
  auto model = std::make_shared<Model>();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Vec2<double>> place;
  for (int k = 0; k < count; ++k) {
    place.push_back(scale * Vec2<double>{any(random), any(random)});
    const Vec2<double> sketch = place.back() + 0.02 * scale * Vec2<double>{any(random), any(random)};
    model->add_body("p" + std::to_string(k), {.position = sketch, .particle = true});
  }
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const std::string name = "rod" + std::to_string(i) + "-" + std::to_string(j);
      const auto found = wrong.find(name);
      const double length = norm(place[static_cast<std::size_t>(i)] - place[static_cast<std::size_t>(j)]);
      model->add(name, Coupler<>{}, i, j, length * (1 + (found == wrong.end() ? 0 : found->second)));
    }
  }
  return model;
}

// A frame of fifteen rods between six particles, six more than it needs: least squares would blame them all.
TEST(Assembly, NamesTheOneRodThatIsTooLong) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const char* culprit : {"rod0-1", "rod2-4", "rod3-5"}) {
      const auto right = tied_particles(6, {}, scale), wrong = tied_particles(6, {{culprit, 0.1}}, scale);
      EXPECT_TRUE(Attempt(*right).outcome.ok());
      const Attempt attempt(*wrong);
      EXPECT_EQ(attempt.outcome.status, Status::not_assembled);
      ASSERT_EQ(attempt.names, std::vector<std::string>{culprit}) << attempt.outcome.message;
      const int rod = wrong->find_element(culprit);
      const double length = Attempt(*wrong).evaluator.element_value(rod).f;
      // Met by all the others, the places are those of the frame that fits.
      EXPECT_NEAR(attempt.outcome.misfits[0].size / length, 0.1 / 1.1, 0.01);
      EXPECT_FALSE(attempt.outcome.misfits[0].angle);
    }
  }
}

TEST(Assembly, NamesWhatIsTooLargeToBeEvaluated) {
  Model model;
  model.add_body("far", {.mass = 1, .inertia = 1, .position = {1e200, 0}});
  model.add("tie", Coupler<double>{}, ground, 0, 1.0);
  const Attempt attempt(model);
  EXPECT_EQ(attempt.outcome.status, Status::not_assembled);
  EXPECT_NE(attempt.outcome.message.find("coupler \"tie\" cannot be evaluated"), std::string::npos)
      << attempt.outcome.message;
}

TEST(Assembly, NamesTwoCulprits) {
  const Attempt attempt(*tied_particles(8, {{"rod0-3", 0.1}, {"rod2-5", -0.12}}));
  EXPECT_EQ(std::set(attempt.names.begin(), attempt.names.end()), (std::set<std::string>{"rod0-3", "rod2-5"}))
      << attempt.outcome.message;
}

// Ten triangles on each other, twenty rods; in one of them a rod is longer than the other side and the base together.
TEST(Assembly, NamesTheTriangleThatDoesNotClose) {
  Model model;
  std::vector<Vec2<double>> place = {{0, 0}, {1, 0}};
  std::vector<std::pair<int, const char*>> node = {{ground, ""}, {ground, ""}};
  for (int k = 0; k < 10; ++k) {
    const std::size_t n = place.size();
    const Vec2<double> a = place[n - 2], b = place[n - 1], across = perpendicular(b - a);
    const Vec2<double> tip = 0.5 * (a + b) + (k % 2 ? -0.8 : 0.8) * across;
    const std::string name = std::to_string(k);
    const int left = add_rod(model, "left" + name, a, tip);
    // Of this one the sketch shows the right place but it is far too long.
    const int right = add_rod(model, "right" + name, b, k == 5 ? b + 6 * (tip - b) : tip);
    const auto foot = [&](const std::string& pin_name, std::size_t at, int rod) {
      const auto [body, point] = node[at];
      body == ground ? pin(model, pin_name, place[at], rod, "from") : pin(model, pin_name, body, point, rod, "from");
    };
    foot("a" + name, n - 2, left);
    foot("b" + name, n - 1, right);
    pin(model, "tip" + name, left, "to", right, "to");
    place.push_back(tip);
    node.push_back({left, "to"});
  }
  const Attempt attempt(model);
  EXPECT_EQ(attempt.outcome.status, Status::not_assembled);
  ASSERT_FALSE(attempt.names.empty());
  // The pins of that triangle; those that stand on it may take over a little.
  const std::set<std::string> loop = {"a5", "b5", "tip5"};
  for (const Misfit& misfit : attempt.outcome.misfits) {
    if (misfit.size < 0.1 * attempt.outcome.misfits[0].size) break;
    EXPECT_TRUE(loop.count(std::string(model.element_name(misfit.element)))) << attempt.outcome.message;
  }
}

TEST(Assembly, NamesDriversThatContradictEachOther) {
  const FourBar bars;
  auto model = driven_four_bar(bars, TimeFunction<double>(1.0));
  model->add_driver("other", AbsoluteAngle<>{}, model->find_body("crank"), ground, TimeFunction<double>(1.3));
  const Attempt attempt(*model);
  ASSERT_EQ(attempt.names.size(), 2u) << attempt.outcome.message;
  EXPECT_EQ(std::set(attempt.names.begin(), attempt.names.end()), (std::set<std::string>{"drive", "other"}));
  for (const Misfit& misfit : attempt.outcome.misfits) {
    EXPECT_TRUE(misfit.angle);
    EXPECT_NEAR(misfit.size, 0.15, 1e-3);
  }
  EXPECT_NE(attempt.outcome.message.find("\"drive\", \"other\" contradict"), std::string::npos)
      << attempt.outcome.message;
}

// Drivers of different bodies: one of them cannot be met, both take part.
TEST(Assembly, NamesADriverThatAnotherDoesNotAllow) {
  const FourBar bars;
  auto model = driven_four_bar(bars, TimeFunction<double>(1.0));
  const double rocker = bars.at(1.0).rocker;
  model->add_driver("other", AbsoluteAngle<>{}, model->find_body("rocker"), ground, TimeFunction<double>(rocker + 0.3));
  const Attempt attempt(*model);
  ASSERT_FALSE(attempt.names.empty());
  EXPECT_TRUE(attempt.names.front() == "drive" || attempt.names.front() == "other") << attempt.outcome.message;
  EXPECT_NE(attempt.outcome.message.find("\"drive\", \"other\" contradict"), std::string::npos)
      << attempt.outcome.message;
}

// Estimates that are off by whole turns: the bodies turn as a whole, nothing else moves.
TEST(Assembly, MovesWholeTurnsFirst) {
  const FourBar bars;
  for (const int turns : {-3, 1, 40}) {
    const auto model = driven_four_bar(bars, TimeFunction<double>(1.0 + 2 * pi * turns));
    Attempt attempt(*model);
    ASSERT_TRUE(attempt.outcome.ok()) << attempt.outcome.message;
    const auto angle = [&](const char* body) {
      return attempt.q[static_cast<std::size_t>(
          3 * attempt.plan->plan_body[static_cast<std::size_t>(model->find_body(body))] + 2)];
    };
    EXPECT_NEAR(angle("crank"), 1.0 + 2 * pi * turns, 1e-12 * (1 + std::abs(turns)));
    EXPECT_NEAR(angle("coupler"), bars.at(1.0).coupler, 1e-11);
    EXPECT_NEAR(angle("rocker"), bars.at(1.0).rocker, 1e-11);
    EXPECT_LT(attempt.outcome.moved, 1e-9) << "whole turns are no motion";
  }
}

TEST(Assembly, LeavesHeldCoordinatesAlone) {
  Model model;
  const int first = model.add_body("first", {.position = {0.1, 0.2}, .angle = 0.3});
  const int second = model.add_body("second", {.position = {1.4, -0.2}, .angle = -0.1});
  model.add("pin", Revolute<>{{0.5, 0}, {-0.5, 0}}, first, second);
  model.bodies[static_cast<std::size_t>(second)].hold_x = true;
  model.bodies[static_cast<std::size_t>(first)].hold_angle = true;
  const Attempt attempt(model);
  ASSERT_TRUE(attempt.outcome.ok()) << attempt.outcome.message;
  const std::vector<double> given = attempt.evaluator.given_configuration();
  const auto place = [&](int body) {
    return static_cast<std::size_t>(3 * attempt.plan->plan_body[static_cast<std::size_t>(body)]);
  };
  EXPECT_EQ(attempt.q[place(second)], given[place(second)]);
  EXPECT_EQ(attempt.q[place(first) + 2], given[place(first) + 2]);
  EXPECT_NE(attempt.q[place(first)], given[place(first)]);
}

}  // namespace
}  // namespace catena::testing
