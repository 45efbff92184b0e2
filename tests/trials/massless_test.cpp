// Bodies without mass are allowed wherever the constraints tie them to what has mass, whatever their size.
#include "trials/trial.hpp"

namespace catena::testing {
namespace {

std::string with_radius(const std::string& name, double radius) {
  const std::string text = read_file(std::string(CATENA_DATA_DIR) + "/trials/" + name + ".json");
  const std::size_t begin = text.find("\"R\": ") + 5, end = text.find_first_of(" }", begin);
  char number[32];
  std::snprintf(number, sizeof number, "%.17g", radius);
  return text.substr(0, begin) + number + text.substr(end);
}

TEST(Massless, AWheelOfAnySize) {
  for (const double radius : {1e-5, 1e-3, 0.1, 0.3, 1.0, 30.0, 1e3, 1e6}) {
    const TextRun run = run_text(with_radius("massless_wheel", radius));
    ASSERT_EQ(run.outcome.exit_code, 0) << radius << ": " << run.analysis().report.message;
    EXPECT_NEAR(run.last("block.x"), 0.5, 1e-8) << radius;
    EXPECT_NEAR(std::abs(run.last("wheel.angle")) * radius, 0.5, 1e-8) << radius;
  }
}

TEST(Massless, AStopIsEngagedBesideAWheel) {
  for (const double radius : {1e-4, 0.05, 1.0, 20.0}) {
    // Without its check, which asks for the stop that is not reached yet.
    std::string text = with_radius("engage_beside_massless", radius);
    const std::string check = "{ \"type\": \"check\" },";
    text.erase(text.find(check), check.size());
    const TextRun run = run_text(text);
    ASSERT_EQ(run.outcome.exit_code, 0) << radius << ": " << run.outcome.error_text;
    EXPECT_NEAR(at_instant(run, "block.x", 0.45152364), 0, 1e-9) << radius;
    EXPECT_NEAR(run.last("block.vx"), 0, 1e-9) << radius;
    EXPECT_NEAR(run.last("weight.y"), 0, 1e-9) << radius;
    EXPECT_NEAR(run.first("block.ax"), -9.81 / 2, 1e-9) << radius;
    EXPECT_NEAR(std::abs(run.last("rope2.i.fy")), 9.81, 1e-9) << radius;
    for (const double balance : run.column("energy.balance")) EXPECT_NEAR(balance, 0, 1e-8) << radius;
  }
}

// A plastic impact beside a massless wheel: the wheel takes no part of the momentum.
TEST(Massless, AWheelTakesNoMomentum) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"block": {"mass": 3, "inertia": 1, "velocity": [4, 0]}, "wheel": {"position": [0, -0.2], "mass": 0, "inertia": 0},
               "other": {"mass": 1, "inertia": 1, "position": [2, 0]}},
    "constraints": [{"type": "absolute_angle", "i": "block", "value": 0},
      {"type": "revolute", "i": ["ground", [0, -0.2]], "j": "wheel"},
      {"type": "rack_pinion", "i": "block", "j": "wheel", "axis_i": [1, 0], "radius": 0.2, "side": -1},
      {"type": "translational", "i": "ground", "j": "other", "axis_i": [1, 0], "axis_j": [1, 0]},
      {"type": "relative_x", "name": "coupling", "i": "block", "j": "other", "value": 0}],
    "outputs": ["block.vx", "other.vx", "wheel.omega", "energy"],
    "analyses": [{"type": "dynamics", "until": 1, "every": 0.25, "tolerance": 1e-10,
      "events": [{"when": "block.x", "value": 2, "action": "engage", "element": "coupling"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.last("other.vx"), 3, 1e-12);
  EXPECT_NEAR(run.last("wheel.omega"), -15, 1e-10);
  for (const double balance : run.column("energy.balance")) EXPECT_NEAR(balance, 0, 1e-9);
}

TEST(Massless, WhatNothingTiesToMassIsRefused) {
  for (const double radius : {1e-6, 0.1, 1e6}) {
    std::string text = with_radius("massless_wheel", radius);
    const std::size_t rack = text.find(",\n    { \"type\": \"rack_pinion\"");
    text.erase(rack, text.find("],\n  \"forces\"") - rack);
    const TextRun run = run_text(text);
    EXPECT_EQ(run.analysis().report.status, Status::refused) << radius;
    EXPECT_NE(run.analysis().report.message.find("the motion of body \"wheel\" is not determined: its inertia is zero"),
              std::string::npos)
        << run.analysis().report.message;
  }
}

}  // namespace
}  // namespace catena::testing
