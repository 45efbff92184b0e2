// What contacts, stops and joints that rub exert and how they slip, in motion: against Newton's and Euler's equations
// of the bodies that they act on, and against the velocities of the material that touches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81;

/// Two free bodies: `drum`, in whose frame the curve is, and `ball`, which comes to touch it.
struct Pair {
  double drum_mass, drum_inertia, ball_mass, ball_inertia, radius;
  std::string contact;  ///< its further keys
};

std::string scene_of(const Pair& p, double circle, RandomNumbers& draw) {
  const double angle = draw(1.2, 1.9), reach = circle + p.radius, speed = draw(-0.5, 0.5), spin = draw(-3, 3);
  const double drum_spin = draw(-3, 3);
  std::string text = R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"drum": {"mass": )" + text_of(p.drum_mass);
  text += ", \"inertia\": " + text_of(p.drum_inertia) + ", \"angular_velocity\": " + text_of(drum_spin) +
          R"(, "velocity": [0, 1]}, "ball": {"mass": )" + text_of(p.ball_mass) + ", \"inertia\": ";
  text += text_of(p.ball_inertia) + ", \"position\": " + pair_of(reach * std::cos(angle), reach * std::sin(angle)) +
          ", \"velocity\": " + pair_of(speed, -0.5) + ", \"angular_velocity\": " + text_of(spin);
  // Both are pulled towards each other, so that they press.
  text += R"(}}, "forces": [{"type": "spring_damper", "name": "pull", "i": "drum", "j": "ball", "k": 900, "c": 5,
    "length": 0}, {"type": "contact", "name": "C", "i": "drum", "j": "ball", "radius": )" +
          text_of(p.radius) + ", \"curve\": {\"circle\": {\"centre\": [0, 0], \"radius\": " + text_of(circle) + "}}" +
          p.contact + R"(}], "outputs": ["drum", "ball", "C.fx", "C.fy", "C.torque", "C.i.fx", "C.i.fy", "C.i.torque",
    "C.force", "C.friction", "C.slip", "C.gap", "pull.force"],
    "analyses": [{"type": "dynamics", "at": [0.03, 0.05, 0.08], "tolerance": 1e-10}]})";
  return text;
}

class ContactColumns : public ::testing::TestWithParam<const char*> {};

// The force on each body is what its acceleration lacks; forces and moments of the two sides are opposite; what slips
// is the material at the place where the disc touches.
TEST_P(ContactColumns, AreWhatAcceleratesTheBodies) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers draw(seed);
    const double circle = draw(0.2, 0.4), drum_mass = draw(1, 3), ball_mass = draw(1, 3), radius = draw(0.03, 0.1);
    const Pair pair{drum_mass, 0.4 * drum_mass * circle * circle, ball_mass, 0.01, radius, GetParam()};
    const TextRun run = run_text(scene_of(pair, circle, draw));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    double largest = 0;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto at = [&](const std::string& name) { return run.column(name).at(row); };
      largest = std::max(largest, at("C.force"));
      const double hx = at("ball.x") - at("drum.x"), hy = at("ball.y") - at("drum.y"), h = std::hypot(hx, hy);
      const double nx = hx / h, ny = hy / h, pull = at("pull.force");
      const double size = 1 + std::abs(pull) + at("C.force");
      EXPECT_NEAR(at("C.fx"), ball_mass * at("ball.ax") + pull * nx, 1e-8 * size);
      EXPECT_NEAR(at("C.fy"), ball_mass * (at("ball.ay") + g) + pull * ny, 1e-8 * size);
      EXPECT_NEAR(at("C.torque"), pair.ball_inertia * at("ball.alpha"), 1e-8 * size);
      EXPECT_NEAR(at("C.i.fx"), -at("C.fx"), 1e-12 * size);
      EXPECT_NEAR(at("C.i.fy"), -at("C.fy"), 1e-12 * size);
      EXPECT_NEAR(at("C.i.torque"), -at("C.torque") - (hx * at("C.fy") - hy * at("C.fx")), 1e-12 * size);
      if (at("C.force") == 0) continue;
      // The circle runs counter-clockwise: its direction is R n.
      const double tx = -ny, ty = nx, bx = -radius * nx, by = -radius * ny;
      const double px = hx + bx, py = hy + by;
      const double slip = tx * (at("ball.vx") - at("ball.omega") * by - at("drum.vx") + at("drum.omega") * py) +
                          ty * (at("ball.vy") + at("ball.omega") * bx - at("drum.vy") - at("drum.omega") * px);
      // With depth d of a compliant contact the slide is measured along the curve: a part d / radius of it more.
      const double part = std::abs(at("C.gap")) / circle;
      EXPECT_NEAR(at("C.slip"), slip, 1e-8 + 3 * part * (1 + std::abs(slip)));
    }
    EXPECT_GT(largest, 1) << "they never pressed";
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ContactColumns,
                         ::testing::Values("", R"(, "mu": 0.4)", R"(, "mu": 5)", R"(, "mu": 0.4, "vs": 0.05)",
                                           R"(, "k": 4e6, "c": 2000)", R"(, "k": 4e4, "c": 200, "mu": 0.4)"));

/// A value of the last row.
class LastRow {
 public:
  explicit LastRow(const std::string& text) : run_(run_text(text)) {
    EXPECT_EQ(run_.outcome.exit_code, 0) << run_.outcome.error_text;
  }
  double operator()(const std::string& name) const { return run_.last(name); }

 private:
  TextRun run_;
};

// Elastic stops of a coordinate, of the angle of a pin, and of a distance.
TEST(StopColumns, AreWhatAcceleratesTheBody) {
  const std::string outputs = R"(, "outputs": ["b", "S.fx", "S.fy", "S.torque", "S.i.fx", "S.i.torque", "S.force"],
    "analyses": [{"type": "dynamics", "at": 0.2, "tolerance": 1e-10}]})";
  for (const std::string bound : {R"("max": 0.15)", R"("min": -1, "max": 0.15)"}) {
    const LastRow slide(R"({"catena": 1, "bodies": {"b": {"mass": 2, "particle": true, "velocity": [1, 0.5]}},
      "forces": [{"type": "stop", "name": "S", "column": "b.x", "k": 80, )" +
                        bound + "}]" + outputs);
    EXPECT_GT(slide("S.force"), 1);
    EXPECT_NEAR(slide("S.fx"), 2 * slide("b.ax"), 1e-9);
    EXPECT_LT(slide("S.fx"), -1);
    EXPECT_NEAR(slide("S.fy"), 0, 1e-12);
    EXPECT_NEAR(slide("S.i.fx"), -slide("S.fx"), 1e-12);
    const LastRow turn(R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 0.3, "angular_velocity": 1}},
      "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "b"}],
      "forces": [{"type": "stop", "name": "S", "column": "pin.angle", "k": 20, )" +
                       bound + "}]" + outputs);
    EXPECT_NEAR(turn("S.torque"), 0.3 * turn("b.alpha"), 1e-9);
    EXPECT_LT(turn("S.torque"), -0.1);
    EXPECT_NEAR(turn("S.i.torque"), -turn("S.torque"), 1e-12);
  }
  const LastRow distance(R"({"catena": 1, "bodies": {"b": {"mass": 2, "particle": true, "position": [0.3, 0.4],
    "velocity": [0.8, 1]}}, "forces": [{"type": "spring_damper", "name": "idle", "i": "ground", "j": "b", "k": 0},
    {"type": "stop", "name": "S", "column": "idle.length", "k": 90, "max": 0.6}])" +
                         outputs);
  EXPECT_GT(distance("S.force"), 1);
  EXPECT_NEAR(distance("S.fx"), 2 * distance("b.ax"), 1e-9);
  EXPECT_NEAR(distance("S.fy"), 2 * distance("b.ay"), 1e-9);
}

// What presses in a pin is its force, N, whatever its radius; a joint whose mu is zero slips all the same.
TEST(FrictionColumns, OfJoints) {
  for (const std::string analysis : {"dynamics", "inverse_dynamics"}) {
    for (const std::string mu : {"0", "0.2"}) {
      const LastRow pin(R"({"catena": 1, "gravity": [0, -9.81],
        "bodies": {"b": {"mass": 2, "inertia": 0.1, "position": [0.3, 0]}},
        "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "b", "at": [0, 0]}],
        "drivers": [{"type": "absolute_angle", "name": "motor", "i": "b", "value": {"polynomial": [0, 3]}}],
        "forces": [{"type": "friction", "name": "F", "joint": "pin", "radius": 0.02, "mu": )" +
                        mu + R"(}],
        "outputs": ["pin.fx", "pin.fy", "F.force", "F.friction", "F.slip"],
        "analyses": [{"type": ")" +
                        analysis + R"(", "at": 0.4}]})");
      const double N = std::hypot(pin("pin.fx"), pin("pin.fy"));
      EXPECT_GT(N, 1);
      EXPECT_NEAR(pin("F.force"), N, 1e-9);
      EXPECT_NEAR(pin("F.friction"), -std::stod(mu) * 0.02 * N, 1e-10);
      EXPECT_NEAR(pin("F.slip"), 3, 1e-10);
      const LastRow guide(R"({"catena": 1, "gravity": [0, -9.81],
        "bodies": {"b": {"mass": 2, "inertia": 0.1, "position": [0.3, 0]}},
        "constraints": [{"type": "translational", "name": "guide", "i": "ground", "j": ["b", [-0.05, 0]],
                         "axis_i": [1, 0]}],
        "drivers": [{"type": "absolute_x", "name": "motor", "i": "b", "value": {"polynomial": [0.3, 2]}}],
        "forces": [{"type": "friction", "name": "F", "joint": "guide", "length": 0.25, "mu": )" +
                          mu + R"(}],
        "outputs": ["guide.joint.fy", "guide.torque", "F.force", "F.friction", "F.slip"],
        "analyses": [{"type": ")" +
                          analysis + R"(", "at": 0.4}]})");
      const double press = 2 * g + std::abs(2 * g * 0.05) / 0.125;
      EXPECT_NEAR(guide("F.force"), press, 1e-9);
      EXPECT_NEAR(guide("F.friction"), -std::stod(mu) * press, 1e-9);
      EXPECT_NEAR(guide("F.slip"), 2, 1e-10);
    }
  }
}

}  // namespace
}  // namespace catena::testing
