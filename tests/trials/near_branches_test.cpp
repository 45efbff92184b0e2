// A slider-crank whose rod is longer than its crank by 1e-4 ... 1e-10 of it, and its derivatives.
//
//   sin(theta) = -sin(z) / (1 + d),  x = cos(z) + (1 + d) cos(theta) > 0        dt = sqrt(M(z) / M(z0)) / z'(0) dz
//
// Without loads the kinetic energy M z'^2 / 2 stays. At z = pi/2 branches pass at sqrt(2 d) rad: the slider turns back.
//
// And cranks that are parallel but for d of their length. From 1e-10 on they turn where they are flat; closer by
// rounding decides where the branches pass, and they go straight on: parallel, as a pendulum on two cranks,
// I w^2 / 2 + G sin z = const.
#include "trials/near_branches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catena::testing {
namespace {

using namespace near_branches;

/// The time at which the crank is at z, by the midpoint rule with points that crowd at the corner.
double time_at(double z, double d) {
  constexpr double corner = std::numbers::pi / 2;
  constexpr int points = 40000;
  double sum = 0;
  for (const double side : {start, z}) {
    // at = corner + (side - corner) u^4
    for (int n = 0; n < points; ++n) {
      const double u = (n + 0.5) / points;
      sum += (side == z ? 1 : -1) * (side - corner) * 4 * u * u * u *
             std::sqrt(mass_at(corner + (side - corner) * std::pow(u, 4), d)) / points;
    }
  }
  return sum / std::sqrt(mass_at(start, d)) / rate;
}

using Passage = std::tuple<const char*, double, double>;
class NearBranches : public ::testing::TestWithParam<Passage> {};

TEST_P(NearBranches, TurnWithTheirOwn) {
  const auto [method, d, tolerance] = GetParam();
  const TextRun run = run_text(slider_crank(d, tolerance, method).dump());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
  const double z = run.last("crank.angle");
  ASSERT_GT(z, std::numbers::pi / 2 + 0.2);
  EXPECT_GT(run.last("slider.x"), 0);
  EXPECT_NEAR(run.last("rod.angle"), -std::asin(std::sin(z) / (1 + d)), 1e-7);
  EXPECT_NEAR(time_at(z, d), until, 1e-8 + 100 * tolerance);
}
INSTANTIATE_TEST_SUITE_P(
    All, NearBranches,
    ::testing::Combine(::testing::Values("auto", "rk8", "rk5", "adams", "baumgarte", "partitioning"),
                       ::testing::Values(1e-4, 1e-6, 1e-8, 1e-10), ::testing::Values(1e-4, 1e-6, 1e-8)));

// Where the rod is as long as the crank both are flat for an instant, and the motion goes straight on.
TEST(NearBranches, GoStraightOnWhereTheyCross) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const TextRun run = run_text(slider_crank(0, tolerance, "rk8").dump());
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    EXPECT_LT(run.last("slider.x"), -0.5);
    for (const std::string& warning : run.analysis().report.warnings)
      EXPECT_EQ(warning.find("branches pass"), std::string::npos) << warning;
    EXPECT_TRUE(tells(run, "two branches of the motion crossed"));
  }
}

/// Parallel cranks in a row, joined by `count` bars: at the angle pi all are flat. They turn evenly.
std::string parallel_cranks(int count) {
  Json scene = Json::parse(R"scene({
    "catena": 1,
    "bodies": {},
    "replicate": [
      { "first": 0,
        "bodies": { "crank{k}": { "mass": 1, "angular_velocity": 4,
          "rod": { "from": ["=k", 0], "to": ["=k + cos(2.6)", "=sin(2.6)"] } } },
        "constraints": [{ "type": "revolute", "i": ["ground", ["=k", 0]], "j": "crank{k}.from" }] },
      { "first": 0,
        "bodies": { "bar{k}": { "mass": 1,
          "rod": { "from": ["=k + cos(2.6)", "=sin(2.6)"], "to": ["=k + 1 + cos(2.6)", "=sin(2.6)"] } } },
        "constraints": [
          { "type": "revolute", "i": "crank{k}.to", "j": "bar{k}.from" },
          { "type": "revolute", "i": "bar{k}.to", "j": "crank{k+1}.to" }] }],
    "analyses": [{ "type": "dynamics", "until": 0.25 }],
    "outputs": ["crank0.angle"] })scene");
  scene["replicate"][0]["count"] = count + 1;
  scene["replicate"][1]["count"] = count;
  return scene.dump();
}

// One four-bar crosses; of two several combinations vanish at once, and twenty have more than 120 equations.
TEST(NearBranches, WhatIsNotJudgedIsTold) {
  const std::pair<int, const char*> cases[] = {
      {1, "branches of the motion crossed"}, {2, "several combinations"}, {20, "small mechanisms only"}};
  for (const auto& [count, words] : cases) {
    const TextRun run = run_text(parallel_cranks(count));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    EXPECT_NEAR(run.last("crank0.angle"), 3.6, 1e-6);
    EXPECT_TRUE(tells(run, words)) << count;
    EXPECT_EQ(run.analysis().report.warnings.size(), 1u) << count;
  }
}

// Nearer than rounding lets steps turn: the motion turns, or ends with words on the branches, or goes straight on and
// says so, with no digits claimed; joints that are given twice change nothing in that.
using Narrow = std::tuple<const char*, double, double, bool>;
class NarrowPassages : public ::testing::TestWithParam<Narrow> {};

TEST_P(NarrowPassages, AreNotMistakenInSilence) {
  const auto [method, d, tolerance, doubled] = GetParam();
  const TextRun run = run_text(slider_crank(d, tolerance, method, doubled).dump());
  if (run.outcome.exit_code != 0) {
    EXPECT_LT(d, 1e-10);
    EXPECT_NE(run.analysis().report.message.find("two branches"), std::string::npos) << run.analysis().report.message;
    return;
  }
  const bool turned = run.last("slider.x") > 0;
  EXPECT_EQ(turned, !tells_straight_passage(run));
  if (d >= 1e-10) {
    EXPECT_TRUE(turned);
  }
}
INSTANTIATE_TEST_SUITE_P(All, NarrowPassages,
                         ::testing::Combine(::testing::Values("rk8", "rk5", "adams", "baumgarte", "partitioning"),
                                            ::testing::Values(1e-13, 1e-12, 1e-11, 3e-11, 1e-10, 1e-9),
                                            ::testing::Values(1e-4, 1e-8, 1e-10), ::testing::Bool()));

// Steps of a fixed length cannot be shortened: they turn, end with a status, or say that they went straight on.
TEST(NearBranches, FixedStepsThatAreTooLongForATurnSaySo) {
  int told = 0;
  for (const double step : {0.003, 0.007, 0.011, 0.017, 0.023, 0.029}) {
    Json scene = slider_crank(1e-9, 1e-8, "rk8");
    scene["analyses"][0]["step"] = step;
    const TextRun run = run_text(scene.dump());
    if (run.outcome.exit_code != 0) continue;
    EXPECT_EQ(run.last("slider.x") < 0, tells_straight_passage(run)) << step;
    told += tells_straight_passage(run);
  }
  EXPECT_GT(told, 0);
}

TEST(NearBranches, DoubledJointsGoStraightOnWhereTheyCross) {
  const TextRun run = run_text(slider_crank(0, 1e-8, "rk8", true).dump());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
  EXPECT_LT(run.last("slider.x"), -0.5);
  EXPECT_FALSE(tells_straight_passage(run));
}

constexpr double crank_start = 1, crank_rate = 12;

Json four_bar(double d, double tolerance) {
  constexpr double crank = 1, coupler = 2, ground = 2;
  const double rocker = crank + d, ax = crank * std::cos(crank_start), ay = crank * std::sin(crank_start);
  const double dx = ground - ax, dy = -ay, distance = std::hypot(dx, dy);
  const double along = (coupler * coupler - rocker * rocker + distance * distance) / (2 * distance);
  const double across = std::sqrt(coupler * coupler - along * along);
  const double bx = ax + (along * dx - across * dy) / distance, by = ay + (along * dy + across * dx) / distance;
  const auto body = [](double x, double y, double inertia_of_it, double angle) {
    return Json{{"mass", 1}, {"inertia", inertia_of_it}, {"position", {x, y}}, {"angle", angle}};
  };
  Json scene = {{"catena", 1},
                {"gravity", {0, -9.81}},
                {"bodies",
                 {{"crank", body(ax / 2, ay / 2, 0.1, crank_start)},
                  {"coupler", body((ax + bx) / 2, (ay + by) / 2, 0.3, std::atan2(by - ay, bx - ax))},
                  {"rocker", body((ground + bx) / 2, by / 2, 0.1, std::atan2(by, bx - ground))}}},
                {"constraints",
                 {{{"type", "revolute"}, {"i", {"ground", {0, 0}}}, {"j", {"crank", {-crank / 2, 0}}}},
                  {{"type", "revolute"}, {"i", {"crank", {crank / 2, 0}}}, {"j", {"coupler", {-coupler / 2, 0}}}},
                  {{"type", "revolute"}, {"i", {"coupler", {coupler / 2, 0}}}, {"j", {"rocker", {rocker / 2, 0}}}},
                  {{"type", "revolute"}, {"i", {"ground", {ground, 0}}}, {"j", {"rocker", {-rocker / 2, 0}}}}}},
                {"analyses", {{{"type", "dynamics"}, {"until", 1.2}, {"every", 0.05}, {"tolerance", tolerance}}}},
                {"outputs", {"crank.angle", "rocker.angle", "crank.omega"}}};
  scene["bodies"]["crank"]["angular_velocity"] = crank_rate;
  return scene;
}

// Rounding must not be mistaken for a distance of branches: steps shortened to it never ended.
TEST(NearBranches, OfNearlyParallelCranksAreNotTakenFromRounding) {
  for (const double d : {0.0, 1e-14, -2e-14, 3e-13, 1e-12, -1e-12, 1e-11, -1e-11, 3e-11, 6e-11}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      const TextRun run = run_text(four_bar(d, tolerance).dump());
      ASSERT_EQ(run.outcome.exit_code, 0) << d << ", " << tolerance << ": " << run.analysis().report.message;
      EXPECT_LT(run.analysis().report.counters.steps, 100) << d << ", " << tolerance;
      if (std::abs(d) >= 1e-12 || d == 0) {
        EXPECT_EQ(tells_straight_passage(run), d != 0) << d << ", " << tolerance;
      }
      const double z = run.last("crank.angle"), rate_at_end = run.last("crank.omega");
      EXPECT_NEAR(run.last("rocker.angle"), z, 1e-6) << d << ", " << tolerance;
      constexpr double inertia_of_both = 2 * (0.1 + 0.25) + 1, weight = 9.81 * (0.5 + 0.5 + 1);
      EXPECT_NEAR(inertia_of_both * (rate_at_end * rate_at_end - crank_rate * crank_rate) / 2,
                  weight * (std::sin(crank_start) - std::sin(z)), 3e4 * tolerance + 1e-6)
          << d << ", " << tolerance;
    }
  }
}

// All tolerances agree, with the motion of cranks that are a little less parallel.
TEST(NearBranches, OfCranksThatAreNotParallelTurnAtEveryTolerance) {
  for (const double d : {1e-10, 2e-10, 1e-9}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      const TextRun run = run_text(four_bar(d, tolerance).dump()), apart = run_text(four_bar(1e-8, 1e-8).dump());
      ASSERT_EQ(run.outcome.exit_code, 0) << d << ", " << tolerance << ": " << run.analysis().report.message;
      EXPECT_LT(run.analysis().report.counters.steps, 1500) << d << ", " << tolerance;
      for (const char* angle : {"crank.angle", "rocker.angle"})
        EXPECT_NEAR(run.last(angle), apart.last(angle), 2e-3) << d << ", " << tolerance;
    }
  }
}

}  // namespace
}  // namespace catena::testing
