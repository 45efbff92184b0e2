// Equilibria of designs in lanes: what they give is what every design gives by itself, failures included; a mechanism
// whose equilibria cannot be found in lanes says why.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "catena/analysis/batch/kernels/lane_kernels.hpp"
#include "catena/analysis/batch/lane_program.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "design/lane_families.hpp"

namespace catena::testing {
namespace {

/// An arm held by a spring: the lamp of the examples.
const std::string lamp = R"json( "gravity": [0, -9.81],
  "bodies": {"arm": {"mass": "m", "inertia": 0.03, "angle": -1, "position": ["=0.225*cos(1)", "=-0.225*sin(1)"],
    "points": {"pivot": [-0.225, 0], "hook": ["=reach - 0.225", 0]}}},
  "constraints": [{"type": "revolute", "name": "pivot", "i": "ground", "j": "arm.pivot"}],
  "forces": [{"type": "spring_damper", "name": "spring", "i": ["ground", [0.02, 0.15]], "j": "arm.hook",
    "k": "k", "length": "free"}],)json";

Family equilibria(std::string mechanism) {
  Family family;
  family.mechanism = std::move(mechanism);
  family.analysis = "equilibrium";
  family.some_fail = false;
  return family;
}

Family lamps() {
  Family family = equilibria(lamp);
  family.names = {"m", "k", "free", "reach"};
  family.ranges = {{0.5, 2}, {50, 300}, {0.02, 0.1}, {0.1, 0.3}};
  family.measures = {R"json({"final": "arm.angle"})json", R"json({"final": "pivot.fy"})json",
                     R"json({"final": "spring.force"})json", R"json({"field": "energy"})json"};
  family.size = 20;  // N
  return family;
}

/// Four-bars without a driver, drawn so that they must be assembled; some are out of reach.
Family spring_four_bars() {
  Family family = equilibria(four_bar + R"json(], "gravity": [0, -9.81], "forces": [
    {"type": "spring_damper", "name": "spring", "i": ["ground", [0.4, 1.9]], "j": "coupler.to", "k": "k", "length": 0.4},
    {"type": "torsion_spring", "name": "coil", "i": "ground", "j": "crank", "k": "e", "angle": 0.6}],)json");
  family.mechanism.insert(family.mechanism.find(R"json("i": "crank.to")json"), R"json("name": "A", )json");
  give_masses(family);
  family.names = {"a", "b", "c", "d", "k", "e"};
  family.ranges = {{0.2, 0.6}, {0.8, 1.6}, {0.7, 1.3}, {1.0, 2.9}, {20, 200}, {1, 30}};
  family.measures = {R"json({"final": "crank.angle"})json", R"json({"final": "A.fx"})json",
                     R"json({"final": "coil.torque"})json", R"json({"final": "=spring.force*sin(rocker.angle)"})json"};
  family.size = 200;
  family.some_fail = true;
  return family;
}

/// Three links that hang, pulled by all kinds of forces that have a potential.
Family loaded_chains() {
  Family family = equilibria(R"json( "gravity": [0, -9.81], "bodies": {
    "one": {"mass": 1, "rod": {"from": [0, 0], "to": ["a", 0.1]}},
    "two": {"mass": "b", "rod": {"from": ["a", 0.1], "to": ["=a + 0.5", 0]}},
    "three": {"mass": 0.5, "inertia": 0.02, "position": ["=a + 0.5", -0.4]}},
  "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "one.from"},
    {"type": "revolute", "name": "B", "i": "one.to", "j": "two.from"}],
  "forces": [{"type": "bushing", "name": "rubber", "i": "two.to", "j": ["three", [0, 0.4]], "kx": 900, "ky": "k",
      "kt": 2, "cx": 1},
    {"type": "point_force", "i": "three", "force": ["f", 2]}, {"type": "torque", "i": "one", "j": "two", "torque": 0.4},
    {"type": "cable", "name": "rope", "i": ["ground", [1.5, 1]], "j": "two.to", "length": 0.9, "k": 300},
    {"type": "spring_damper", "i": "one.to", "j": ["ground", [0.3, 0.8]], "k": 60, "length": 0.1, "force": "f", "c": 4},
    {"type": "torsion_spring", "i": "one", "j": "two", "k": 5, "angle": 0, "torque": 0.2}],)json");
  family.names = {"a", "b", "k", "f"};
  family.ranges = {{0.3, 0.6}, {0.5, 2}, {200, 2000}, {-4, 4}};
  family.measures = {R"json({"final": "two.angle"})json", R"json({"final": "three.y"})json",
                     R"json({"final": "B.fy"})json", R"json({"final": "rope.force"})json",
                     R"json({"field": "energy"})json"};
  family.size = 100;
  return family;
}

/// Constraints of other kinds: a slide with a rod without mass, wheels that roll on each other, a driver at an instant.
Family geared_slides() {
  Family family = equilibria(R"json( "gravity": [0, -9.81], "bodies": {
    "wheel": {"mass": 1, "inertia": 0.02, "position": [0, 0], "points": {"pin": [0.1, 0]}},
    "pinion": {"mass": 0.5, "inertia": 0.01, "position": ["=0.2 + r", 0], "points": {"eccentric": [0, 0.05]}},
    "slide": {"mass": 2, "inertia": 0.1, "position": ["=0.1 + l", -0.05]},
    "lever": {"mass": 1, "inertia": 0.05, "angle": 0.3, "position": [0, -0.5]}},
  "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "wheel"},
    {"type": "revolute", "i": ["ground", ["=0.2 + r", 0]], "j": "pinion"},
    {"type": "gear", "name": "mesh", "i": "wheel", "j": "pinion", "radius_i": 0.2, "radius_j": "r"},
    {"type": "translational", "name": "guide", "i": ["ground", [0, -0.05]], "j": "slide",
      "axis_i": ["=cos(c)", "=sin(c)"]},
    {"type": "coupler", "name": "rod", "i": "wheel.pin", "j": "slide", "value": "l"},
    {"type": "absolute_x", "i": "lever", "value": 0}, {"type": "absolute_y", "i": ["lever", [0.1, 0]], "value": -0.5}],
  "drivers": [{"type": "absolute_angle", "name": "hand", "i": "lever", "value": {"polynomial": [0.2, 0.1]}}],
  "forces": [{"type": "spring_damper", "name": "spring", "i": "pinion.eccentric", "j": "lever", "k": "k", "length": 0.3},
    {"type": "torsion_spring", "i": "ground", "j": "wheel", "k": 8, "angle": 0.4}],)json");
  family.names = {"r", "l", "c", "k"};
  family.ranges = {{0.1, 0.3}, {0.4, 0.8}, {-0.2, 0.2}, {20, 200}};
  family.measures = {R"json({"final": "pinion.angle"})json", R"json({"final": "slide.x"})json",
                     R"json({"final": "hand.load"})json", R"json({"final": "mesh.lambda1"})json",
                     R"json({"final": "guide.torque"})json"};
  family.keys = R"json(, "at": 1.5)json";
  family.size = 100;
  return family;
}

class RandomEquilibria : public ::testing::TestWithParam<Family (*)()> {};

TEST_P(RandomEquilibria, AreWhatEachIsByItself) { expect_same_as_alone(GetParam()()); }

INSTANTIATE_TEST_SUITE_P(Lanes, RandomEquilibria,
                         ::testing::Values(lamps, spring_four_bars, loaded_chains, geared_slides));

/// Links of a chain, each drawn at random, with springs between random points: one mechanism a seed.
Family random_springs(unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const int links = std::uniform_int_distribution(1, 5)(random);
  std::string bodies, constraints, forces;
  double x = 0, y = 0;
  for (int k = 0; k < links; ++k) {
    const double angle = number(-2.5, -0.5), length = number(0.2, 0.6), mass = number(0.2, 2);
    const double x_to = x + length * std::cos(angle), y_to = y + length * std::sin(angle);
    bodies += fmt::format(R"json({}"b{}": {{"mass": {}, "rod": {{"from": [{}, {}], "to": [{}, {}]}}}})json",
                          k ? ", " : "", k, mass, x, y, x_to, y_to);
    constraints += fmt::format(R"json({}{{"type": "revolute", "name": "p{}", "i": "{}", "j": "b{}.from"}})json",
                               k ? ", " : "", k, k ? fmt::format("b{}.to", k - 1) : "ground", k);
    x = x_to;
    y = y_to;
  }
  const int springs = std::uniform_int_distribution(1, 4)(random);
  for (int k = 0; k < springs; ++k) {
    const int on = std::uniform_int_distribution(0, links - 1)(random);
    const double along = number(-0.1, 0.1), px = number(-1.5, 1.5), py = number(-1, 1.5), stiffness = number(10, 150);
    forces += fmt::format(
        R"json({}{{"type": "spring_damper", "name": "s{}", "i": ["ground", [{}, {}]], "j": ["b{}", [{}, 0.02]],
        "k": "={}*k", "length": "free"}})json",
        k ? ", " : "", k, px, py, on, along, stiffness);
  }
  Family family = equilibria(
      fmt::format(R"json( "gravity": [0, -9.81], "bodies": {{{}}}, "constraints": [{}], "forces": [{}],)json", bodies,
                  constraints, forces));
  family.names = {"k", "free"};
  family.ranges = {{0.5, 2}, {0, 0.3}};
  family.measures = {R"json({"final": "b0.angle"})json", R"json({"final": "p0.fx"})json",
                     R"json({"final": "s0.force"})json", R"json({"field": "energy"})json"};
  family.size = 100;
  family.part_in_lanes = 0.5;
  return family;
}

TEST(LaneEquilibria, RandomChainsOnSprings) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    expect_same_as_alone(random_springs(seed));
  }
}

/// dV/dtheta of the lamp with its arm at theta, and where it vanishes downhill from -1 rad: small steps, then
/// bisection.
double lamp_at_rest(double m, double k, double free, double reach) {
  const auto slope = [&](double theta) {
    const double x = reach * std::cos(theta) - 0.02, y = reach * std::sin(theta) - 0.15, l = std::hypot(x, y);
    const double turning = (x * -reach * std::sin(theta) + y * reach * std::cos(theta)) / l;
    return m * 9.81 * 0.225 * std::cos(theta) + k * (l - free) * turning;
  };
  double low = -1;
  const double step = slope(low) > 0 ? -1e-3 : 1e-3, sense = slope(low) > 0 ? 1 : -1;
  while (sense * slope(low + step) > 0) low += step;
  double high = low + step;
  for (int n = 0; n < 60; ++n) {
    const double middle = (low + high) / 2;
    (sense * slope(middle) > 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

TEST(LaneEquilibria, LampsInClosedForm) {
  for (const char* kernels : {"baseline", "avx2", "avx512"}) {
    if (!select_lane_kernels(kernels)) continue;  // this processor does not have them
    const TextRun sweep = run_text(scene_of(lamps(), {1, 100, 0.05, 0.2},
                                            R"json({"type": "sweep", "of": )json" + analysis_of(lamps()) +
                                                R"json(, "over": {"m": [0.6, 1.2, 1.9], "k": [60, 150, 280],
                                                "free": [0.03, 0.09], "reach": [0.12, 0.28]}})json"));
    ASSERT_EQ(sweep.outcome.exit_code, 0) << sweep.outcome.error_text;
    ASSERT_EQ(sweep.column("m0").size(), 36u);
    EXPECT_GE(field<std::int64_t>(sweep, "in_lanes"), 30);
    for (std::size_t k = 0; k < 36; ++k) {
      const double angle =
          lamp_at_rest(sweep.column("m")[k], sweep.column("k")[k], sweep.column("free")[k], sweep.column("reach")[k]);
      // The slope is known to 1e-15 of some ten N m, its own slope is some N m/rad.
      EXPECT_NEAR(sweep.column("m0")[k], angle, 1e-13 * 100) << kernels << " " << k;
    }
  }
  for (const char* kernels : {"baseline", "avx2", "avx512"}) select_lane_kernels(kernels);  // the widest again
}

// The spring with which the lamp rests at -0.3 rad, found by values alone: of its balance there in closed form.
TEST(LaneEquilibria, SearchesByValuesFindTheSpring) {
  const double m = 1.2, free = 0.05, reach = 0.2, theta = -0.3;
  const double x = reach * std::cos(theta) - 0.02, y = reach * std::sin(theta) - 0.15, l = std::hypot(x, y);
  const double turning = (x * -reach * std::sin(theta) + y * reach * std::cos(theta)) / l;
  const double stiffness = -m * 9.81 * 0.225 * std::cos(theta) / ((l - free) * turning);
  for (const char* solver : {"bobyqa", "crs2"}) {
    const TextRun run = run_text(scene_of(lamps(), {m, 150, free, reach},
                                          fmt::format(R"json({{"type": "optimise", "of": {{"type": "equilibrium",
          "measures": {{"angle": {{"final": "arm.angle"}}}}}}, "variables": {{"k": {{"min": 60, "max": 300, "start": 150}}}},
          "minimise": "=(angle + 0.3)^2", "solver": "{}", "max_evaluations": 300}})json",
                                                      solver)));
    ASSERT_EQ(run.outcome.analyses.size(), 1u) << run.outcome.error_text;
    // The square of a difference of 1e-6 rad is what the search's tolerance leaves; the angle's slope is 1e-2 rad m/N.
    EXPECT_NEAR(run.last("k"), stiffness, 0.05) << solver;
    EXPECT_LT(field<double>(run, "objective"), 1e-8) << solver;
  }
}

// Beside lamps that come to rest: one that begins upright, in balance but not at rest; one whose energy falls without
// end; one whose spring has no stiffness and whose body no weight, which rests anywhere.
TEST(LaneEquilibria, DoubtfulOnesAreLeftToThemselves) {
  Family family = equilibria(R"json( "gravity": [0, "=-g"], "bodies": {"arm": {"mass": 1, "inertia": 0.1,
      "angle": "start", "position": ["=0.3*cos(start)", "=0.3*sin(start)"]}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": ["arm", [-0.3, 0]]}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "arm", "k": "k", "angle": "=-pi/2"},
      {"type": "torque", "i": "arm", "torque": "n"}],)json");
  family.names = {"g", "start", "k", "n"};
  family.measures = {R"json({"final": "arm.angle"})json"};
  const std::vector<std::vector<double>> designs{{9.81, -1, 1, 0.1}, {9.81, std::numbers::pi / 2, 0, 0},
                                                 {9.81, -1, 0, 5},   {0, -1, 0, 0},
                                                 {9.81, -2, 2, 0.3}, {9.81, 0.5, 0.5, 0.2}};
  std::string over;
  for (std::size_t p = 0; p < family.names.size(); ++p) {
    over += fmt::format("{}\"{}\": [", p ? ", " : "", family.names[p]);
    for (std::size_t k = 0; k < designs.size(); ++k) over += fmt::format("{}{:.17g}", k ? ", " : "", designs[k][p]);
    over += "]";
  }
  const TextRun sweep = run_text(scene_of(family, designs[0],
                                          R"json({"type": "sweep", "design": "together", "of": )json" +
                                              analysis_of(family) + R"json(, "over": {)json" + over + "}}"));
  ASSERT_EQ(sweep.outcome.exit_code, 0) << sweep.outcome.error_text;
  EXPECT_EQ(field<std::int64_t>(sweep, "in_lanes"), 3);
  for (std::size_t k = 0; k < designs.size(); ++k) {
    SCOPED_TRACE(k);
    const TextRun alone = run_text(scene_of(family, designs[k], analysis_of(family)));
    const AnalysisResult& result = alone.analysis();
    EXPECT_EQ(sweep.column("status")[k], static_cast<double>(result.report.status)) << result.report.message;
    if (result.report.ok())
      EXPECT_NEAR(sweep.column("m0")[k], *result.measures[0].value, 1e-12);
    else
      EXPECT_TRUE(std::isnan(sweep.column("m0")[k]));
  }
}

TEST(LaneEquilibria, SayWhyThereAreNone) {
  const auto obstacle = [](const Model& model) {
    std::string why;
    EXPECT_EQ(LaneProgram::make_static(model, Plan::make(model, {.one_sided = true}), why), nullptr);
    return why;
  };
  const auto pendulum = [] {
    Model model;
    BodyValues values;
    values.mass = 1;
    model.add_body("arm", values);
    model.add("pin", Revolute<double>{.s_i = {}, .s_j = {-0.3, 0}, .c = 0}, ground, 0);
    return model;
  };
  Model twice = pendulum();
  twice.add("again", Revolute<double>{.s_i = {}, .s_j = {-0.3, 0}, .c = 0}, ground, 0);
  EXPECT_NE(obstacle(twice).find("4 equations for 3"), std::string::npos);
  Model stopped = pendulum();
  Stop<double> stop;
  stop.min = 0;
  stopped.add("stop", stop, ground, 0);
  EXPECT_NE(obstacle(stopped).find("one-sided"), std::string::npos);
  Model curved = pendulum();
  SpringDamper<double> spring;
  spring.length = 0.1;
  const std::vector<Vec2<double>> points{{-1, -2}, {0, 0}, {1, 1}};
  spring.curve = ForceCurve<double>(points);
  curved.add_force("spring", spring, ground, 0);
  EXPECT_NE(obstacle(curved), "");
  Model chain = pendulum();
  for (int k = 0; k < 13; ++k) {
    BodyValues values;
    values.mass = 1;
    const int link = chain.add_body(fmt::format("link{}", k), values);
    chain.add(fmt::format("pin{}", k), Revolute<double>{.s_i = {0.3, 0}, .s_j = {-0.3, 0}, .c = 0}, link - 1, link);
  }
  EXPECT_NE(obstacle(chain).find("42 coordinates"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
