// Places where a rope has no way, as its end comes into the circle of a pulley, told with the rope's name at the
// instant that closed forms give; ropes that are given beside a pulley, or wound round one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "analysis/sanitized.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A particle at (x, y) with the velocity (vx, vy), on a rope from (-1, 0) over a circle of the radius R about the
/// origin.
std::string scene(double x, double y, double vx, double vy, double R, const std::string& rope, const std::string& more,
                  const std::string& forces, const std::string& analysis) {
  return fmt::format(R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{"p": {{"particle": true, "mass": 1,
    "position": [{:.17g}, {:.17g}], "velocity": [{:.17g}, {:.17g}]}}}}, {} "forces": [{{"type": "rope", "name": "line",
    "i": ["ground", [-1, 0]], "over": [{{"at": ["ground", [0, 0]], "radius": {:.17g}, "side": -1}}], "j": "p"{}}}{}],
    "outputs": ["p.x", "p.y"], "analyses": [{}]}})",
                     x, y, vx, vy, more, R, rope, forces, analysis);
}

void expect_named(const TextRun& run, Status status, const std::string& part) {
  const std::string& message = run.analysis().report.message;
  EXPECT_EQ(run.analysis().report.status, status) << message;
  EXPECT_NE(message.find("rope \"line\""), std::string::npos) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

double instant_in(const TextRun& run) {
  const std::string& message = run.analysis().report.message;
  const std::size_t at = message.find("t = ");
  return at == std::string::npos ? std::nan("") : std::stod(message.substr(at + 4));
}

// 8 seeds: pushed up with the slack rope, past y = -sqrt(R^2 - x^2).
TEST(RopePlaces, EndsThatComeIntoACircle) {
  for (unsigned seed = 1; seed <= size_of_test(8u, 2u); ++seed) {
    std::mt19937 random(seed);
    const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
    const double R = draw(0.05, 0.3), x = draw(0.1, 0.9) * R, push = draw(15, 60), y = -draw(0.5, 2);
    const double t = std::sqrt(2 * (-y - std::sqrt(R * R - x * x)) / (push - 9.81));
    const std::string up = fmt::format(R"(, {{"type": "point_force", "i": "p", "force": [0, {:.17g}]}})", push);
    const std::string line = R"("constraints": [{"type": "absolute_x", "i": "p"}],)";
    const TextRun elastic =
        run_text(scene(x, y, 0, 0, R, R"(, "k": 1000)", line, up,
                       fmt::format(R"({{"type": "dynamics", "until": {:.17g}, "every": 0.1}})", 2 * t)));
    // A step that ends there finds it at once; one that flies past, slack, where the rope has turned.
    expect_named(elastic, Status::singular, "undefined");
    EXPECT_GT(instant_in(elastic), t * (1 - 1e-6)) << seed;
    EXPECT_LT(instant_in(elastic), 1.3 * t) << seed;
    expect_named(run_text(scene(x, y, 0, 0, R, "", line, up,
                                fmt::format(R"({{"type": "dynamics", "until": {:.17g}, "every": 0.1}})", 2 * t))),
                 Status::singular, "undefined");
    const std::string driven =
        line +
        fmt::format(R"("drivers": [{{"type": "absolute_y", "i": "p", "value": {{"polynomial": [{:.17g}, 1]}}}}],)", y);
    expect_named(run_text(scene(x, y, 0, 0, R, "", driven, "",
                                fmt::format(R"({{"type": "kinematics", "until": {:.17g}, "every": 0.01}})", -y))),
                 Status::singular, "inside the circle");
    // A spring that would hold it inside; searches that fail take seconds.
    if (seed > 2) continue;
    const std::string spring = up + R"(, {"type": "spring_damper", "i": "ground", "j": "p", "k": 5000, "length": 0})";
    for (const std::string stiffness : {"", R"(, "k": 1000)"}) {
      expect_named(run_text(scene(x, y, 0, 0, R, stiffness, "", spring, R"({"type": "equilibrium"})")),
                   Status::not_converged, "circle");
    }
  }
}

// The tangents from (-1, 0) and (x, y) at the upper side of the circle would cross: the rope lies straight beside it.
// Nearer to the circle they do not, and it winds round by nearly a whole turn.
TEST(RopePlaces, GivenBesideAPulleyOrWoundRoundIt) {
  const double R = 0.3, in = std::asin(R), contact = 1.6 * std::numbers::pi, out = in - contact;
  for (const double l : {0.05, 1.5}) {
    const double x = -R * std::sin(out) + l * std::cos(out), y = R * std::cos(out) + l * std::sin(out);
    for (const std::string stiffness : {"", R"(, "k": 1000)"}) {
      const TextRun run = run_text(scene(x, y, 0, 0, R, stiffness, "", "",
                                         R"({"type": "dynamics", "until": 0.001, "outputs": ["line.length"]})"));
      ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
      const std::vector<std::string>& warnings = run.analysis().report.warnings;
      const double beside = std::hypot(x + 1, y), round = std::sqrt(1 - R * R) + R * contact + l;
      EXPECT_NEAR(run.first("line.length"), l > 1 ? beside : round, 1e-9);
      const std::string told = "rope \"line\" winds ";
      ASSERT_EQ(warnings.size(), l > 1 ? 0U : 1U);
      if (warnings.empty()) continue;
      ASSERT_EQ(warnings[0].rfind(told, 0), 0U) << warnings[0];
      EXPECT_NEAR(std::stod(warnings[0].substr(told.size())), contact, 1e-3) << warnings[0];
    }
  }
}

}  // namespace
}  // namespace catena::testing
