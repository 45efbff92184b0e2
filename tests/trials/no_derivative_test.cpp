// Parameters by which there is no derivative: null, with the reason, beside those by which there is one.
#include <fmt/format.h>

#include <cmath>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::string warnings_of(const TextRun& run) {
  std::string all;
  for (const std::string& warning : run.analysis().report.warnings) all += warning + "\n";
  return all;
}

// A bob on two rods of one length side by side, that "l" lengthens both and "one" only one of them: hanging at rest the
// bob goes down with "l"; with "one" the rods contradict each other.
TEST(NoDerivative, OfOneOfTwoEqualRods) {
  const std::string text = R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"l": 2, "one": 2},
    "bodies": {"bob": {"mass": 1, "inertia": 1, "position": [0.1, -1.9]}},
    "constraints": [
      {"type": "absolute_angle", "name": "level", "i": "bob"},
      {"type": "absolute_distance", "name": "first", "i": ["bob", [0, 0]], "ground": [0, 0], "value": "=l"},
      {"type": "absolute_distance", "name": "second", "i": ["bob", [0, 0]], "ground": [0, 0], "value": "=l+one-2"}],
    "analyses": [{"type": "sensitivity", "of": {"type": "equilibrium"}, "parameters": ["l", "one"], "mode": "forward"}]})";
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("d(bob.y)/d(l)"), -1, 1e-9);
  EXPECT_TRUE(std::isnan(run.last("d(bob.y)/d(one)")));
  EXPECT_NE(warnings_of(run).find("depends on other constraints"), std::string::npos) << warnings_of(run);
}

double gradient_of(const TextRun& run, const std::string& measure, std::size_t parameter) {
  for (const MeasureResult& found : run.analysis().measures) {
    if (found.name == measure) return found.gradient.at(parameter);
  }
  ADD_FAILURE() << "no measure " << measure << "; " << run.analysis().report.message << run.outcome.error_text;
  return 0;
}

// The bob again, at rest or pushed aside; adjoints do not see what contradicts, and leave it to the other way.
std::string rods_measured(const std::string& mode, const std::string& drivers, const std::string& analysis) {
  return fmt::format(R"({{"catena": 1, "gravity": [0, -9.81], "parameters": {{"l": 2, "one": 2}},
    "bodies": {{"bob": {{"mass": 1, "inertia": 1, "position": [0.1, -1.9]}}}},
    "constraints": [
      {{"type": "absolute_angle", "name": "level", "i": "bob"}},
      {{"type": "absolute_distance", "name": "first", "i": ["bob", [0, 0]], "ground": [0, 0], "value": "=l"}},
      {{"type": "absolute_distance", "name": "second", "i": ["bob", [0, 0]], "ground": [0, 0], "value": "=l+one-2"}}],
    "drivers": [{}],
    "analyses": [{{"type": "sensitivity", "of": {}, "parameters": ["l", "one"], "mode": "{}"}}]}})",
                     drivers, analysis, mode);
}

TEST(NoDerivative, OfOneOfTwoEqualRodsInAnyModeAndAnalysis) {
  for (const std::string mode : {"forward", "adjoint", "auto"}) {
    const TextRun rest =
        run_text(rods_measured(mode, "", R"({"type": "equilibrium", "measures": {"y": {"final": "bob.y"}}})"));
    EXPECT_NEAR(gradient_of(rest, "y", 0), -1, 1e-9) << mode;
    EXPECT_TRUE(std::isnan(gradient_of(rest, "y", 1))) << mode;
    EXPECT_NE(warnings_of(rest).find("depends on other constraints"), std::string::npos) << warnings_of(rest);
    for (const std::string type : {"kinematics", "inverse_dynamics"}) {
      const TextRun driven = run_text(rods_measured(
          mode, R"({"type": "absolute_x", "name": "push", "i": ["bob", [0, 0]], "value": 0.1})",
          fmt::format(R"({{"type": "{}", "until": 0.1, "every": 0.1, "measures": {{"y": {{"final": "bob.y"}}}}}})",
                      type)));
      EXPECT_NEAR(gradient_of(driven, "y", 0), -2 / std::sqrt(4 - 0.01), 1e-9) << mode << " " << type;
      EXPECT_TRUE(std::isnan(gradient_of(driven, "y", 1))) << mode << " " << type;
      EXPECT_NE(warnings_of(driven).find("depends on other constraints"), std::string::npos) << warnings_of(driven);
    }
  }
}

// A bar on three parallel cranks of length 1 + "all", the driven one longer by "a": x = (1 + all) cos(1.5 + w t).
TEST(NoDerivative, OfOneOfThreeParallelCranks) {
  const auto crank = [](double x, const std::string& longer) {
    return fmt::format(
        R"({{"mass": 1, "inertia": 0.1, "position": [{}, "=(1+all{})/2"], "angle": 1.5707963267948966}})", x, longer);
  };
  const auto pins = [](const std::string& name, double x, const std::string& longer) {
    return fmt::format(R"({{"type": "revolute", "i": ["ground", [{1}, 0]], "j": ["{0}", ["=-(1+all{2})/2", 0]]}},
      {{"type": "revolute", "name": "{0}_bar", "i": ["{0}", ["=(1+all{2})/2", 0]], "j": ["bar", [{3}, 0]]}})",
                       name, x, longer, x - 1);
  };
  for (const std::string mode : {"forward", "adjoint", "auto"}) {
    const TextRun run = run_text(fmt::format(
        R"({{"catena": 1, "parameters": {{"a": 0, "all": 0, "w": 1}},
        "bodies": {{"c1": {}, "c2": {}, "c3": {}, "bar": {{"mass": 1, "inertia": 1, "position": [1, 1]}}}},
        "constraints": [{}, {}, {}],
        "drivers": [{{"type": "absolute_angle", "name": "drive", "i": "c1", "value": {{"polynomial": [1.5, "=w"]}}}}],
        "analyses": [{{"type": "sensitivity", "parameters": ["a", "all", "w"], "mode": "{}",
          "of": {{"type": "kinematics", "until": 0.5, "every": 0.1, "measures": {{"x": {{"final": "bar.x"}}}}}}}}]}})",
        crank(0, "+a"), crank(2, ""), crank(1, ""), pins("c1", 0, "+a"), pins("c2", 2, ""), pins("c3", 1, ""), mode));
    EXPECT_TRUE(std::isnan(gradient_of(run, "x", 0))) << mode;
    EXPECT_NEAR(gradient_of(run, "x", 1), std::cos(2), 1e-9) << mode;
    EXPECT_NEAR(gradient_of(run, "x", 2), -0.5 * std::sin(2), 1e-9) << mode;
    EXPECT_NE(warnings_of(run).find("depends on other constraints"), std::string::npos) << warnings_of(run);
  }
}

// A bar on a pin at one end, held by a spring whose line passes through the pin: nothing resists its turning.
TEST(NoDerivative, OfAPlaceThatNothingHolds) {
  const std::string text = R"({"catena": 1, "gravity": [0, 0], "parameters": {"k": 10},
    "bodies": {"bar": {"mass": 1, "inertia": 1, "position": [0.3, 0.4], "angle": 0.2},
               "load": {"mass": 1, "inertia": 1, "position": [2, 0.1]}},
    "constraints": [{"type": "revolute", "name": "pin", "i": ["ground", [0, 0]], "j": ["bar", [-0.3, -0.4]]},
                    {"type": "absolute_angle", "name": "level", "i": "load"},
                    {"type": "absolute_y", "name": "guide", "i": ["load", [0, 0]]}],
    "forces": [{"type": "spring_damper", "name": "spring", "i": ["ground", [0, 0]], "j": ["load", [0, 0]], "k": "=k",
                "length": 1}],
    "analyses": [{"type": "sensitivity", "of": {"type": "equilibrium"}, "parameters": ["k"], "mode": "forward"}]})";
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(std::isnan(run.last("d(bar.angle)/d(k)")));
  EXPECT_NE(warnings_of(run).find("neutral"), std::string::npos) << warnings_of(run);
}

// The energy of a place of rest is that at fixed multipliers, V_p + lambda^T Phi_p: it has a derivative where the place
// itself has none, V = k (x - z)^2 / 2 of a spring that is held beside a bar that turns freely.
TEST(NoDerivative, OfANeutralPlaceButOfItsEnergy) {
  for (const std::string mode : {"forward", "adjoint", "auto"}) {
    for (const std::string place : {"", R"(, "turn": {"final": "bar.angle"})"}) {
      const TextRun run = run_text(fmt::format(
          R"({{"catena": 1, "gravity": [0, 0], "parameters": {{"k": 10, "x": 2, "z": 0.5}},
          "bodies": {{"bar": {{"mass": 1, "inertia": 1, "position": [0.3, 0.4], "angle": 0.2}},
                     "load": {{"mass": 1, "inertia": 1, "position": [2, 0.1]}}}},
          "constraints": [{{"type": "revolute", "name": "pin", "i": ["ground", [0, 0]], "j": ["bar", [-0.3, -0.4]]}},
                          {{"type": "absolute_angle", "name": "level", "i": "load", "value": 0}},
                          {{"type": "absolute_x", "name": "x_held", "i": ["load", [0, 0]], "value": "=x"}},
                          {{"type": "absolute_y", "name": "y_held", "i": ["load", [0, 0]], "value": 0}}],
          "forces": [{{"type": "spring_damper", "name": "spring", "i": ["ground", [0, 0]], "j": ["load", [0, 0]],
                      "k": "=k", "length": "=z"}}],
          "analyses": [{{"type": "sensitivity", "parameters": ["k", "x", "z"], "mode": "{}",
            "of": {{"type": "equilibrium", "measures": {{"energy": {{"field": "energy"}}{}}}}}}}]}})",
          mode, place));
      EXPECT_NEAR(gradient_of(run, "energy", 0), 1.125, 1e-11) << mode;
      EXPECT_NEAR(gradient_of(run, "energy", 1), 15, 1e-10) << mode;
      EXPECT_NEAR(gradient_of(run, "energy", 2), -15, 1e-10) << mode;
      EXPECT_EQ(warnings_of(run).find("is not built"), std::string::npos) << warnings_of(run);
      if (place.empty()) continue;
      EXPECT_TRUE(std::isnan(gradient_of(run, "turn", 0))) << mode;
      EXPECT_NE(warnings_of(run).find("\"turn\": the equilibrium is neutral"), std::string::npos) << warnings_of(run);
    }
  }
}

TEST(NoDerivative, OfTheEnergyByOneOfTwoEqualRods) {
  for (const std::string mode : {"forward", "adjoint", "auto"}) {
    for (const std::string place : {"", R"(, "y": {"final": "bob.y"})"}) {
      const TextRun run = run_text(rods_measured(
          mode, "",
          fmt::format(R"({{"type": "equilibrium", "measures": {{"energy": {{"field": "energy"}}{}}}}})", place)));
      EXPECT_NEAR(gradient_of(run, "energy", 0), -9.81, 1e-9) << mode;
      EXPECT_TRUE(std::isnan(gradient_of(run, "energy", 1))) << mode;
      EXPECT_NE(warnings_of(run).find("\"energy\": \"second\" depends on other constraints"), std::string::npos)
          << warnings_of(run);
    }
  }
}

}  // namespace
}  // namespace catena::testing
