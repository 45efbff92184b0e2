// Places that hold each other, where they give way: instants and places in closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81, mu = 0.4;

/// A frame turned by `tilt`, as is gravity: directions and places in it.
struct Turned {
  double c, s;
  explicit Turned(double tilt) : c(std::cos(tilt)), s(std::sin(tilt)) {}
  std::string at(double x, double y) const { return fmt::format("[{:.17g}, {:.17g}]", c * x - s * y, s * x + c * y); }
};

/// What starts at t, and when, of places that are named.
std::string told(const TextRun& run) {
  std::string all;
  for (const EventEntry& event : events_of(run))
    all += fmt::format("{}{} {:.6f}", all.empty() ? "" : ", ", event.name, event.t);
  return all;
}

std::string box(int number, const Turned& frame, double tilt) {
  return fmt::format(R"("b{0}": {{"mass": 1, "inertia": 0.1, "position": {1}, "angle": {2:.17g},
 "points": {{"l": [-0.5, -0.2], "r": [0.5, -0.2]}}}})",
                     number, frame.at(0, 0.2 + 0.4 * number), tilt);
}

std::string foot(int number, const char* side, const Turned& frame) {
  const std::string line = number == 0 ? fmt::format(R"("point": [0, 0], "axis": {})", frame.at(1, 0))
                                       : std::string(R"("point": [0, 0.2], "axis": [1, 0])");
  return fmt::format(
      R"({{"type": "contact", "name": "{1}{0}", "i": "{2}", "j": "b{0}.{1}", "mu": {3}, "curve": {{"line": {{{4}}}}}}})",
      number, side, number == 0 ? "ground" : fmt::format("b{}", number - 1), mu, line);
}

/// Boxes on each other; what pulls the uppermost along grows as 3 t. Nothing moves before both feet of one slip.
TextRun stack(int boxes, double tilt) {
  const Turned frame(tilt);
  std::string bodies, feet;
  for (int k = 0; k < boxes; ++k) {
    bodies += (k == 0 ? "" : ", ") + box(k, frame, tilt);
    for (const char* side : {"l", "r"}) feet += foot(k, side, frame) + ", ";
  }
  const std::string pull =
      fmt::format(R"([{{"polynomial": [0, {:.17g}]}}, {{"polynomial": [0, {:.17g}]}}])", 3 * frame.c, 3 * frame.s);
  return run_text(fmt::format(
      R"({{"catena": 1, "gravity": {}, "bodies": {{{}}}, "forces": [{}
 {{"type": "point_force", "i": "b{}", "force": {}}}], "outputs": ["b{}.x"],
 "analyses": [{{"type": "dynamics", "until": 1.5}}]}})",
      frame.at(0, -g), bodies, feet, boxes - 1, pull, boxes - 1));
}

TEST(PlacesTogether, BothFeetOfTheUppermostBoxSlipAtOnce) {
  for (const double tilt : {0.0, 0.7}) {
    for (const int boxes : {1, 2, 3}) {
      SCOPED_TRACE(fmt::format("{} boxes, turned by {}", boxes, tilt));
      const TextRun run = stack(boxes, tilt);
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
      EXPECT_EQ(told(run), fmt::format("l{0} {1:.6f}, r{0} {1:.6f}", boxes - 1, mu * g / 3));
      EXPECT_LT(run.analysis().report.counters.steps, 300) << "what rests takes no small steps";
      // From then on 3 t - mu g = x''.
      const Turned frame(tilt);
      const double since = 1.5 - mu * g / 3, start = -frame.s * (0.2 + 0.4 * (boxes - 1));
      const double x = run.column("b" + std::to_string(boxes - 1) + ".x").back();
      EXPECT_NEAR(x, start + frame.c * since * since * since / 2, 1e-7);
    }
  }
}

// A plank of 1 kg on three feet at -1, 0, 1; a weight of 3 kg walks from 0 to the right with 1 m/s: past 1 m it turns
// about the last foot, where 3 (x - 1) = 1.
TEST(PlacesTogether, AllFeetButTheLastOpenAtOnce) {
  std::string feet;
  for (int k = 0; k < 3; ++k)
    feet += fmt::format(R"({}{{"type": "contact", "name": "f{}", "i": "ground", "j": "plank.f{}",
 "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}})",
                        k == 0 ? "" : ", ", k, k);
  const TextRun run = run_text(fmt::format(
      R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{"plank": {{"mass": 1, "inertia": 1,
 "points": {{"f0": [-1, 0], "f1": [0, 0], "f2": [1, 0]}}}}, "load": {{"mass": 3, "particle": true}}}},
 "constraints": [{{"type": "absolute_x", "i": "plank"}}],
 "drivers": [{{"type": "absolute_x", "name": "walk", "i": "load", "value": {{"polynomial": [0, 1]}}}}],
 "forces": [{}, {{"type": "contact", "name": "sole", "i": "plank", "j": "load",
 "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}}],
 "outputs": ["plank.angle"], "analyses": [{{"type": "dynamics", "until": 1.4}}]}})",
      feet));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_EQ(told(run), fmt::format("f0 {0:.6f}, f1 {0:.6f}", 4.0 / 3));
}

// A wheel that touches a wall as well, and is turned towards it by a torque 3 t: floor and wall slip together where
//   M = r mu (N_floor + N_wall),  N_wall = mu N_floor,  N_floor + mu N_wall = m g
TEST(PlacesTogether, AWheelInACorner) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"wheel": {"mass": 1, "inertia": 0.045,
 "position": [0.3, 0.3]}}, "forces": [
 {"type": "contact", "name": "floor", "i": "ground", "j": "wheel", "radius": 0.3, "mu": 0.4,
  "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}},
 {"type": "contact", "name": "wall", "i": "ground", "j": "wheel", "radius": 0.3, "mu": 0.4,
  "curve": {"line": {"point": [0, 0], "axis": [0, -1]}}},
 {"type": "torque", "i": "wheel", "torque": {"polynomial": [0, 3]}}],
 "outputs": ["wheel.omega"], "analyses": [{"type": "dynamics", "until": 0.6}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double slips = 0.3 * mu * (1 + mu) * g / (1 + mu * mu) / 3;
  EXPECT_EQ(told(run), fmt::format("floor {0:.6f}, wall {0:.6f}", slips));
}

// A box that slides on one that stands, whose feet share their friction: reactions are the least ones, and the box's
// free motion, along which nothing holds it, must leave them what they are. m = 1.5 kg, push F = 12 N through its
// centroid at 0.2 m above its feet, 0.5 m to each side: N_r - N_l = 0.4 (mu N_l + mu N_r) = 0.4 mu m g.
TEST(PlacesTogether, ReactionsBesideAFreeMotion) {
  const auto feet = [](const char* host, const char* box, double height, double friction) {
    std::string both;
    for (const char* side : {"l", "r"})
      both += fmt::format(R"({{"type": "contact", "name": "{1}_{2}", "i": "{0}", "j": "{1}.{2}", "mu": {3},
 "curve": {{"line": {{"point": [0, {4}], "axis": [1, 0]}}}}}}, )",
                          host, box, side, friction, height);
    return both;
  };
  const auto body = [](const char* name, double x, double y, double mass) {
    return fmt::format(R"("{}": {{"mass": {}, "inertia": 0.1, "position": [{}, {}],
 "points": {{"l": [-0.5, -0.2], "r": [0.5, -0.2]}}}})",
                       name, mass, x, y);
  };
  const TextRun run = run_text(fmt::format(
      R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{{}, {}}}, "forces": [{} {}
 {{"type": "point_force", "i": "upper", "force": [12, 0]}}],
 "outputs": ["upper.x", "upper_l.force", "upper_r.force", "lower_l.force", "lower_r.force"],
 "analyses": [{{"type": "dynamics", "until": 0.3, "every": 0.01}}]}})",
      body("lower", -0.0069247467277, 0.2, 2), body("upper", -0.029733070358, 0.6, 1.5),
      feet("ground", "lower", 0, 0.6), feet("lower", "upper", 0.2, 0.3)));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double weight = 1.5 * g, difference = 0.4 * 0.3 * weight, a = (12 - 0.3 * weight) / 1.5;
  const std::vector<double> t = run.column("t"), x = run.column("upper.x"), left = run.column("upper_l.force"),
                            right = run.column("upper_r.force"), below_l = run.column("lower_l.force"),
                            below_r = run.column("lower_r.force");
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(x[k] - x[0], a * t[k] * t[k] / 2, 1e-9);
    EXPECT_NEAR(left[k], (weight - difference) / 2, 1e-9) << t[k];
    EXPECT_NEAR(right[k], (weight + difference) / 2, 1e-9) << t[k];
    EXPECT_NEAR(below_l[k] + below_r[k], weight + 2 * g, 1e-9) << t[k];
  }
}

// Kane's example in little: a rod hits a rough floor at an angle; Newton's law would give it energy.
TEST(PlacesTogether, PoissonsLawIsTold) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"rod": {"mass": 1, "inertia": "=1/3",
 "position": [0, 0.8303397191969474], "angle": 2.1795878447516186, "velocity": [1.8445498105819773, 0],
 "angular_velocity": -4.577293780013457, "points": {"a": [-1, 0]}}}, "forces": [
 {"type": "contact", "name": "tip", "i": "ground", "j": "rod.a", "mu": 0.5698, "restitution": 0.8276,
  "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
 "outputs": ["energy.total", "energy.balance"], "analyses": [{"type": "dynamics", "until": 0.01, "every": 0.01}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<double> energy = run.column("energy.total");
  EXPECT_LT(energy.back(), energy.front());
  EXPECT_NEAR(run.column("energy.balance").back(), 0, 1e-9);
  const std::vector<std::string>& warnings = run.analysis().report.warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings.front().find("Poisson"), std::string::npos) << warnings.front();
  EXPECT_NE(warnings.front().find("\"tip\""), std::string::npos) << warnings.front();
}

}  // namespace
}  // namespace catena::testing
