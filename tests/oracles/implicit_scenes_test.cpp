// radau, alpha and `auto` where other things happen as well: contacts, friction, stops, cables and impacts beside the
// same scenes by rk8, a very light body, a stiff bearing that turns, and a stiff damper beside a ball that bounces.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/sanitized.hpp"
#include "oracles/scene_text.hpp"
#include "scene/event_entries.hpp"
#include "scene/run_text.hpp"
#include "stress/touching_scene.hpp"

namespace catena::testing {
namespace {

/// Until when two runs have had the same events; infinite: always.
double alike_until(const std::vector<EventEntry>& a, const std::vector<EventEntry>& b) {
  for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
    if (k < std::min(a.size(), b.size()) && a[k].kind == b[k].kind && std::abs(a[k].t - b[k].t) < 1e-3) continue;
    return k > 0 ? a[k - 1].t : 0;
  }
  return HUGE_VAL;
}

/// The largest difference of columns that are no forces, in their own sizes, at rows of the same instants before `end`.
double apart_before(const TextRun& a, const TextRun& b, double end) {
  double most = 0;
  const std::vector<double> t = a.column("t"), u = b.column("t");
  for (const auto& column : a.analysis().columns) {
    if (column.name.find(".force") != std::string::npos) continue;
    const std::vector<double> x = a.column(column.name), y = b.column(column.name);
    double size = 1;
    for (const double value : x) size = std::max(size, std::abs(value));
    for (std::size_t k = 0; k < std::min(x.size(), y.size()) && t[k] < end; ++k) {
      if (t[k] == u[k]) most = std::max(most, std::abs(x[k] - y[k]) / size);
    }
  }
  return most;
}

// Bounces that accumulate end where they are no longer told apart, which a coarser run decides a bounce earlier: what
// comes after events that differ is not compared, nor blocks on two feet (kind 9), whose bounces all do.
TEST(ImplicitMethods, MoveWhatTouchesAsRungeKutta) {
  int compared = 0;
  for (unsigned seed = 1; seed <= size_of_test(96u, 12u); ++seed) {
    if (seed % TouchingScene::kinds == 9) continue;
    SCOPED_TRACE(seed);
    Json scene = Json::parse(TouchingScene(seed, {}).text());
    Json& analysis = scene["analyses"][0];
    analysis["digits"] = false;
    analysis["tolerance"] = 1e-11;
    const TextRun exact = run_text(scene.dump());
    const bool second_order = seed % 3 == 0;
    const double tolerance = second_order ? std::pow(10, -3.0 - seed % 2) : std::pow(10, -3.0 - seed % 6);
    analysis["tolerance"] = tolerance;
    analysis["method"] = second_order ? "alpha" : "radau";
    const TextRun run = run_text(scene.dump());
    ASSERT_TRUE(exact.analysis().report.ok()) << exact.analysis().report.message;
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    const double end = alike_until(events_of(exact), events_of(run));
    EXPECT_LE(apart_before(exact, run, end), 10 * tolerance);
    compared += end == HUGE_VAL;
  }
  EXPECT_GE(compared, size_of_test(60, 6));
}

// Its reference has twenty digits; in the lowest position the light cart is faster than the pole by 4429 rad/s.
TEST(Radau, FollowsAVeryLightCart) {
  for (const double tolerance : {1e-8, 1e-10, 1e-11}) {
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"cart": {"mass": 1e-6, "inertia": 1e-6},
        "pole": {"mass": 1, "inertia": 0, "position": [1, 0]}},
        "constraints": [{"type": "absolute_y", "i": "cart", "value": 0},
          {"type": "absolute_angle", "i": "cart", "value": 0}, {"type": "revolute", "i": "cart", "j": ["pole", [-1, 0]]}],
        "outputs": ["cart.x", "pole.angle"], "analyses": [{"type": "dynamics", "digits": false, "method": "radau",
          "at": [0.2, 0.4, 1, 2.5], "tolerance": )" +
        text_of(tolerance) + "}]}");
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    const double x[] = {0.01943608126629917, 0.38025030971885804, 1.998934624974967, 1.9767094394206486};
    const double theta[] = {1.3733152420743628, 0.6684232311708883, -1.524675515758677, -1.3545578357850632};
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(run.column("cart.x")[k], x[k], 10 * tolerance) << k;
      EXPECT_NEAR(run.column("pole.angle")[k] + std::acos(-1) / 2, theta[k], 10 * tolerance) << k;
    }
  }
}

/// Angle and rate of a rod of 1 m on a rigid pin: phi'' = -1.5 g cos phi, by Runge and Kutta's rule of order 4.
std::pair<double, double> rod_on_a_pin(double angle, double rate, double until) {
  constexpr int parts = 40000;
  const double h = until / parts;
  const auto f = [](double a) { return -1.5 * 9.81 * std::cos(a); };
  for (int k = 0; k < parts; ++k) {
    const double a1 = f(angle), v2 = rate + h / 2 * a1, a2 = f(angle + h / 2 * rate), v3 = rate + h / 2 * a2,
                 a3 = f(angle + h / 2 * v2), v4 = rate + h * a3, a4 = f(angle + h * v3);
    angle += h / 6 * (rate + 2 * v2 + 2 * v3 + v4);
    rate += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return {angle, rate};
}

std::string rod_on_a_bearing(double stiffness, double damping, const std::string& more, const std::string& analysis) {
  return R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"rod": {"mass": 1, "rod": {"from": [3, 0], "to": [4, 0]}}
    , "ball": {"mass": 1, "particle": true, "position": [0, 0.5]}}, "forces": [{"type": "bushing",
    "i": ["ground", [3, 0]], "j": "rod.from", "kx": )" +
         text_of(stiffness) + R"(, "ky": )" + text_of(stiffness) + R"(, "cx": )" + text_of(damping) + R"(, "cy": )" +
         text_of(damping) + "}" + more + R"(], "outputs": ["rod.angle", "ball.y"], "analyses": [)" + analysis + "]}";
}

// A stiff bearing that turns spoils Newton's matrix within a step; steps grow no longer than it serves.
TEST(Radau, FollowsARodOnAStiffBearing) {
  for (const double stiffness : {1e8, 1e10}) {
    const TextRun run = run_text(rod_on_a_bearing(
        stiffness, 0.5 * std::sqrt(stiffness), "",
        R"({"type": "dynamics", "digits": false, "method": "radau", "at": [1, 2], "tolerance": 1e-8})"));
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    EXPECT_NEAR(run.first("rod.angle"), rod_on_a_pin(0, 0, 1).first, 1e-7 + 400 / stiffness);
    EXPECT_NEAR(run.last("rod.angle"), rod_on_a_pin(0, 0, 2).first, 1e-7 + 400 / stiffness);
    EXPECT_LT(run.analysis().report.counters.steps + run.analysis().report.counters.rejected, 6000) << stiffness;
  }
}

// The ball is a parabola between its bounces; explicit steps of the rod would be 100,000 a second.
TEST(Auto, TurnsImplicitBesideABallThatBounces) {
  const TextRun run = run_text(
      rod_on_a_bearing(1e12, 5e5,
                       R"(, {"type": "contact", "name": "floor", "i": "ground", "j": "ball", "restitution": 0.8,
      "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}})",
                       R"({"type": "dynamics", "digits": false, "until": 1, "every": 1, "tolerance": 1e-7})"));
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  const double first = std::sqrt(2 * 0.5 / 9.81), up = 0.8 * 9.81 * first, second = first + 2 * up / 9.81;
  const double rest = 1 - second;
  EXPECT_NEAR(run.last("ball.y"), 0.8 * up * rest - 9.81 / 2 * rest * rest, 1e-9);
  EXPECT_NEAR(run.last("rod.angle"), rod_on_a_pin(0, 0, 1).first, 1e-6);
  const auto events = events_of(run);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NEAR(events[1].t, second, 1e-9);
  EXPECT_EQ(field<std::string>(run, "method"), "rk8, radau");
  EXPECT_LT(run.analysis().report.counters.steps, 40000);
}

// Both matrices of a step are made once a step at most, and not where it keeps its length and converges well.
TEST(Radau, MakesItsMatricesOnceAStep) {
  for (const int rods : {10, size_of_test(40, 12)}) {
    const std::string n = std::to_string(rods);
    const std::string bushing = R"("kx": 1e7, "ky": 1e7, "cx": 300, "cy": 300})";
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "replicate": [{"count": )" + n +
        R"(, "bodies": {"r{k}": {"mass": "=1/)" + n + R"(", "rod": {"from": ["=(k-1)/)" + n + R"(", 0], "to": ["=k/)" +
        n + R"(", 0]}}}}, {"count": )" + std::to_string(rods - 1) +
        R"(, "forces": [{"type": "bushing", "i": "r{k}.to", "j": "r{k+1}.from", )" + bushing + R"(]}],
        "forces": [{"type": "bushing", "i": "ground", "j": "r1.from", )" +
        bushing + R"(], "outputs": ["r1.angle"], "analyses": [{"type": "dynamics", "digits": false, "method": "radau",
        "until": 0.1, "every": 0.1, "tolerance": 1e-6}]})");
    ASSERT_TRUE(run.analysis().report.ok()) << run.outcome.error_text << run.analysis().report.message;
    const auto& counters = run.analysis().report.counters;
    const std::int64_t tried = counters.steps + counters.rejected;
    EXPECT_LE(counters.factorizations, 2 * tried + 10) << rods;
    EXPECT_LE(counters.rejected, counters.steps / 5) << rods;
    EXPECT_LE(counters.steps, 15 * rods + 100) << rods;
  }
}

// A parallelogram lies flat eight times within three seconds, and goes on as one.
TEST(ImplicitMethods, CrossSingularPositions) {
  const auto angle_by = [](const std::string& method, const std::string& tolerance) {
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"a": {"rod": {"from": [0, 0], "to": [0, 1]}, "mass": 1,
        "angular_velocity": -8}, "b": {"rod": {"from": [0, 1], "to": [2, 1]}, "mass": 1},
        "c": {"rod": {"from": [2, 0], "to": [2, 1]}, "mass": 1}}, "constraints": [
        {"type": "revolute", "i": "ground", "j": "a.from"}, {"type": "revolute", "i": "a.to", "j": "b.from"},
        {"type": "revolute", "i": "b.to", "j": "c.to"}, {"type": "revolute", "i": ["ground", [2, 0]], "j": "c.from"}],
        "outputs": ["a.angle", "c.angle"], "analyses": [{"type": "dynamics", "digits": false, "until": 3, "every": 3,
        "method": ")" +
        method + R"(", "tolerance": )" + tolerance + "}]}");
    EXPECT_TRUE(run.analysis().report.ok()) << method << run.analysis().report.message;
    EXPECT_NEAR(run.last("a.angle"), run.last("c.angle"), 1e-9) << method;
    return run.last("a.angle");
  };
  // Of 26 rad: tolerances are those of the state.
  const double exact = angle_by("rk8", "1e-11");
  EXPECT_NEAR(angle_by("radau", "1e-6"), exact, 1e-5);
  EXPECT_NEAR(angle_by("alpha", "1e-5"), exact, 1e-4);
}

}  // namespace
}  // namespace catena::testing
