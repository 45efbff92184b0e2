// Scenes that can be read and even solved but cannot be meant: distances below zero, gears that do not touch, loops
// that do not close.
#include <gtest/gtest.h>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// A block on a rail, led by its distance from the origin.
TextRun led_block(const std::string& distance, const std::string& analysis) {
  return run_text(R"({"catena": 1, "bodies": {"block": {"position": [0.5, 0]}},
      "constraints": [{"type": "absolute_y", "i": "block", "value": 0}, {"type": "absolute_angle", "i": "block", "value": 0}],
      "drivers": [{"type": "absolute_distance", "name": "rod", "i": "block", "ground": [0, 0], "value": )" +
                  distance + R"(}], "analyses": [)" + analysis + "]}");
}

void expect_refused(const TextRun& run, const std::string& instant) {
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::refused);
  const std::string& message = run.analysis().report.message;
  EXPECT_NE(message.find("absolute_distance \"rod\" is not above zero at t = " + instant + " s"), std::string::npos)
      << message;
}

TEST(DoubtfulScene, DistancesThatVanish) {
  const std::string to_ten = R"({"type": "kinematics", "until": 10, "every": 1})";
  expect_refused(led_block(R"({"polynomial": [0.5, -0.1]})", to_ten), "5");
  expect_refused(led_block(R"({"polynomial": [-0.5, 0.01]})", to_ten), "0");
  // A dip between two rows, and one in a list of instants that goes back.
  expect_refused(led_block(R"({"polynomial": [0.2489, -1, 1]})", to_ten), "0.466833752096");
  expect_refused(led_block(R"({"polynomial": [0.5, -0.1]})", R"({"type": "kinematics", "at": [1, 8, 2]})"), "5");
  EXPECT_EQ(led_block(R"({"polynomial": [0.2501, -1, 1]})", to_ten).outcome.exit_code, 0);
  EXPECT_EQ(led_block(R"({"polynomial": [0.5, -0.1]})", R"({"type": "kinematics", "until": 4.99})").outcome.exit_code,
            0);
}

// A ball on a pin's arm, with a force that is meant otherwise than its keys say.
TEST(DoubtfulScene, KeysWithoutEffect) {
  const auto run_with = [](const std::string& force) {
    return run_text(R"({"catena": 1, "bodies": {"b": {"mass": 1, "inertia": 1, "position": [0, 1]}},
      "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "b", "at": [0, 0]}],
      "forces": [{"name": "F", )" +
                    force + R"(}], "analyses": [{"type": "check"}, {"type": "dynamics", "at": [0, 0.1]}]})");
  };
  const std::string floor = R"("type": "contact", "i": "ground", "j": "b",
                               "curve": {"line": {"point": [0, -5], "axis": [1, 0]}})";
  const std::string bound = R"("type": "stop", "column": "pin.angle", "max": 1)";
  const std::string rub = R"("type": "friction", "joint": "pin", "radius": 0.1, "mu": 0.1)";
  const std::pair<std::string, const char*> doubtful[] = {
      {floor + R"(, "c": 5)", "\"c\" has no effect without \"k\""},
      {floor + R"(, "exponent": 1.5)", "\"exponent\" has no effect without \"k\""},
      {floor + R"(, "k": 1e5, "restitution": 0.5)", "\"restitution\" has no effect beside \"k\""},
      {floor + R"(, "mu": 0.1, "mu_static": 0.2, "vs": 0.01)", "\"mu_static\" has no effect beside \"vs\""},
      {bound + R"(, "c": 5)", "\"c\" has no effect without \"k\""},
      {bound + R"(, "k": 5, "restitution": 0.5)", "\"restitution\" has no effect beside \"k\""},
      {rub + R"(, "length": 0.2)", "\"length\" has no effect"},
      {rub + R"(, "mu_static": 0.2, "vs": 0.01)", "\"mu_static\" has no effect beside \"vs\""}};
  for (const auto& [force, expected] : doubtful) {
    const TextRun run = run_with(force);
    ASSERT_EQ(run.outcome.exit_code, 0) << force << run.outcome.error_text;
    for (std::size_t k : {0u, 1u}) {
      const std::vector<std::string>& warnings = run.analysis(k).report.warnings;
      ASSERT_EQ(warnings.size(), 1U) << force;
      EXPECT_NE(warnings[0].find(expected), std::string::npos) << warnings[0];
      EXPECT_NE(warnings[0].find("\"F\""), std::string::npos) << warnings[0];
    }
  }
  for (const std::string& meant :
       {floor + R"(, "k": 1e5, "c": 5, "exponent": 1.5, "mu": 0.1, "mu_static": 0.2)",
        floor + R"(, "restitution": 0.5)", bound + R"(, "k": 5, "c": 5)", rub + R"(, "vs": 0.01)"}) {
    const TextRun run = run_with(meant);
    for (std::size_t k : {0u, 1u}) EXPECT_TRUE(run.analysis(k).report.warnings.empty()) << meant;
  }
}

// Two wheels on bearings 0.3 m apart.
TextRun two_gears(const std::string& radii) {
  return run_text(R"({"catena": 1, "bodies": {"a": {}, "b": {"position": [0.3, 0]}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "a"}, {"type": "revolute", "i": ["ground", [0.3, 0]], "j": "b"},
        {"type": "gear", "name": "mesh", "i": "a", "j": "b", )" +
                  radii + R"(}],
      "drivers": [{"type": "absolute_angle", "i": "a", "value": {"polynomial": [0, 1]}}],
      "analyses": [{"type": "check"}, {"type": "kinematics", "until": 1, "every": 0.5}]})");
}

TEST(DoubtfulScene, GearsThatDoNotTouch) {
  for (const char* fits :
       {R"("radius_i": 0.1, "radius_j": 0.2)", R"("radius_i": 0.4, "radius_j": 0.1, "internal": true)"}) {
    const TextRun run = two_gears(fits);
    for (std::size_t k : {0u, 1u}) EXPECT_TRUE(run.analysis(k).report.warnings.empty()) << fits;
  }
  for (const char* wrong :
       {R"("radius_i": 0.1, "radius_j": 0.21)", R"("radius_i": 0.1, "radius_j": 0.2, "internal": true)"}) {
    const TextRun run = two_gears(wrong);
    EXPECT_EQ(run.outcome.exit_code, 0);
    for (std::size_t k : {0u, 1u}) {
      ASSERT_EQ(run.analysis(k).report.warnings.size(), 1u) << wrong;
      EXPECT_NE(run.analysis(k).report.warnings[0].find("gear \"mesh\" do not touch: their centres are 0.3 m apart"),
                std::string::npos)
          << run.analysis(k).report.warnings[0];
    }
  }
}

// What is met is not listed among the misfits.
TEST(DoubtfulScene, MisfitsNameOnlyWhatIsMissed) {
  const TextRun run =
      run_text(R"({"catena": 1, "bodies": {"a": {"rod": {"from": [0, 0], "to": [1, 0]}}, "far": {"position": [5, 5]}},
      "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "a.from"},
        {"type": "revolute", "name": "P", "i": ["ground", [3, 0]], "j": "a.to"},
        {"type": "absolute_angle", "name": "met", "i": "far", "value": 1}],
      "analyses": [{"type": "assemble"}]})");
  EXPECT_EQ(run.outcome.exit_code, 1);
  const std::string& message = run.analysis().report.message;
  EXPECT_NE(message.find("revolute \"O\" misses by 1 m, revolute \"P\" misses by 1 m; likely"), std::string::npos)
      << message;
}

// A key that is missing is reported once, not again by what cannot work without it.
TEST(DoubtfulScene, OneErrorForAMissingCurve) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"cam": {}, "foot": {"position": [0, 1]}},
      "constraints": [{"type": "cam_flat", "name": "C", "i": "cam", "j": "foot", "axis_j": [1, 0]}]})");
  EXPECT_EQ(run.outcome.exit_code, 3);
  ASSERT_EQ(run.outcome.errors.size(), 1u);
  EXPECT_EQ(run.outcome.errors[0].message, "cam_flat \"C\" needs \"curve\"");
}

}  // namespace
}  // namespace catena::testing
