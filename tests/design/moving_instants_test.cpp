// Gradients across instants at which drivers jump and which parameters move: against closed forms, and of random
// motions against differences of whole runs.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "analysis/sanitized.hpp"
#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

/// A point on the x axis that a driver moves by `law`.
std::string driven_point(const std::string& law, const std::string& parameters, const std::string& analysis) {
  return R"({"catena": 1, "parameters": {)" + parameters + R"(},
  "bodies": {"p": {"mass": 2, "particle": true}},
  "constraints": [{"type": "absolute_y", "i": "p", "value": 0}],
  "drivers": [{"type": "absolute_x", "name": "drive", "i": "p", "value": )" +
         law + R"(}], "outputs": ["p.x", "p.vx", "p.ax"], "analyses": [)" + analysis + "]}";
}

constexpr auto types = {"kinematics", "inverse_dynamics", "dynamics"};

std::string sensitivity(const std::string& parameters, const std::string& type, const std::string& run,
                        const std::string& measures) {
  return R"({"type": "sensitivity", "parameters": [)" + parameters + R"(], "of": {"type": ")" + type + R"(", )" + run +
         R"(, "measures": {)" + measures + "}}}";
}

// x rises by 3 u^2 - 2 u^3 from T to T + w: accelerations 6 (1 - 2 u) / w^2 jump at both ends, integral a^2 = 12 / w^3.
TEST(MovingInstants, OfARiseWhoseAccelerationJumps) {
  for (const std::string type : types) {
    SCOPED_TRACE(type);
    const double T = 0.4, w = 0.7;
    const TextRun run = run_text(driven_point(
        R"({"step": {"t0": "T", "t1": "=T+w", "from": 0, "to": 1, "order": 3}})", R"("T": 0.4, "w": 0.7)",
        sensitivity(R"("T", "w")", type, R"("until": 2, "every": 0.5)",
                    R"--("effort": {"integral": "=p.ax^2"}, "size": {"rms": "p.ax"}, "area": {"integral": "p.x"},
                    "most": {"max": "p.ax"}, "least": {"min": "p.ax"}, "span": {"range": "p.ax"},
                    "half": {"integral": "=max(p.ax, 0)"
  }, "then": {"at": 0.75, "of": "p.vx"})--")));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const double effort = 12 / (w * w * w);
    EXPECT_NEAR(value(run, "effort"), effort, 1e-9 * effort);
    EXPECT_NEAR(gradient(run, "effort", 0), 0, 1e-8 * effort);
    EXPECT_NEAR(gradient(run, "effort", 1), -36 / std::pow(w, 4), 1e-7);
    EXPECT_NEAR(gradient(run, "size", 1), -36 / std::pow(w, 4) / (4 * std::sqrt(effort / 2)), 1e-8);
    EXPECT_NEAR(gradient(run, "area", 0), -1, 1e-10);
    EXPECT_NEAR(gradient(run, "area", 1), -0.5, 1e-10);
    EXPECT_NEAR(value(run, "most"), 6 / (w * w), 1e-9);
    EXPECT_NEAR(gradient(run, "most", 0), 0, 1e-7);
    EXPECT_NEAR(gradient(run, "most", 1), -12 / (w * w * w), 1e-7);
    EXPECT_NEAR(gradient(run, "least", 0), 0, 1e-7);
    EXPECT_NEAR(gradient(run, "least", 1), 12 / (w * w * w), 1e-7);
    EXPECT_NEAR(gradient(run, "span", 1), -24 / (w * w * w), 1e-7);
    EXPECT_NEAR(gradient(run, "half", 1), -1.5 / (w * w), 1e-7);  // the largest velocity, 3/2 w
    const double u = (0.75 - T) / w, slope = 6 * (1 - 2 * u) / (w * w);
    EXPECT_NEAR(gradient(run, "then", 0), -slope, 1e-9);
    EXPECT_NEAR(gradient(run, "then", 1), -6 * (u - u * u) / (w * w) - slope * u, 1e-9);
  }
}

// A table whose ends are moved, held beyond them: velocity 1/w between T and T + w.
TEST(MovingInstants, OfATableThatBeginsAndEndsElsewhere) {
  for (const std::string type : types) {
    SCOPED_TRACE(type);
    const TextRun run = run_text(
        driven_point(R"({"spline": {"t": ["T", "=T+w"], "value": [0, 1], "beyond": "hold"}})", R"("T": 0.4, "w": 0.7)",
                     sensitivity(R"("T", "w")", type, R"("until": 2, "every": 0.5)",
                                 R"("flow": {"integral": "=p.vx^2"}, "size": {"rms": "p.vx"}, "mean": {"mean": "p.vx"},
                    "area": {"integral": "p.x"}, "most": {"max": "p.vx"}, "end": {"final": "p.x"})")));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const double w = 0.7;
    EXPECT_NEAR(value(run, "flow"), 1 / w, 1e-11);
    EXPECT_NEAR(gradient(run, "flow", 0), 0, 1e-10);
    EXPECT_NEAR(gradient(run, "flow", 1), -1 / (w * w), 1e-9);
    EXPECT_NEAR(gradient(run, "size", 1), -1 / (w * w) / (4 * std::sqrt(0.5 / w)), 1e-9);
    EXPECT_NEAR(gradient(run, "mean", 1), 0, 1e-10);
    EXPECT_NEAR(gradient(run, "area", 0), -1, 1e-10);
    EXPECT_NEAR(gradient(run, "area", 1), -0.5, 1e-10);
    EXPECT_NEAR(gradient(run, "most", 0), 0, 1e-9);
    EXPECT_NEAR(gradient(run, "most", 1), -1 / (w * w), 1e-9);
    EXPECT_NEAR(gradient(run, "end", 1), 0, 1e-10);
  }
}

// The rise ends with the run, at T: integral of v^2 = 6 / (5 T), of a^2 = 12 / T^3, x(T) = 1.
TEST(MovingInstants, ThatEndTheRun) {
  const std::string law = R"({"step": {"t0": 0, "t1": "T", "from": 0, "to": 1, "order": 3}})";
  const std::string measures = R"("flow": {"integral": "=p.vx^2"}, "effort": {"integral": "=p.ax^2"},
      "area": {"integral": "p.x"}, "end": {"final": "p.x"}, "there": {"at": "T", "of": "p.x"})";
  for (const std::string type : types) {
    SCOPED_TRACE(type);
    const double T = 0.8;
    const TextRun run = run_text(
        driven_point(law, R"("T": 0.8)", sensitivity(R"("T")", type, R"("until": "T", "every": 0.5)", measures)));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(gradient(run, "flow", 0), -1.2 / (T * T), 1e-8);
    EXPECT_NEAR(gradient(run, "effort", 0), -36 / std::pow(T, 4), 1e-6);
    EXPECT_NEAR(gradient(run, "area", 0), 0.5, 1e-9);
    EXPECT_NEAR(gradient(run, "end", 0), 0, 1e-9);
    EXPECT_NEAR(gradient(run, "there", 0), 0, 1e-9);
    // An end that stays has the jump in it or not.
    const TextRun fixed = run_text(
        driven_point(law, R"("T": 0.8)", sensitivity(R"("T")", type, R"("until": 0.8, "every": 0.5)", measures)));
    ASSERT_EQ(fixed.outcome.exit_code, 0) << fixed.outcome.error_text;
    EXPECT_TRUE(std::isnan(gradient(fixed, "effort", 0)));
    EXPECT_TRUE(warns(fixed, "moves with the parameters, but not with the end"));
    EXPECT_NEAR(gradient(fixed, "area", 0), -0.5, 1e-9);  // integral of -x' t / T
    EXPECT_NEAR(gradient(fixed, "end", 0), 0, 1e-9);
  }
}

TEST(MovingInstants, RowsAtThemHaveNoDerivativeOfWhatJumps) {
  for (const std::string type : types) {
    SCOPED_TRACE(type);
    const TextRun run =
        run_text(driven_point(R"({"step": {"t0": "T", "t1": "=T+0.5", "from": 0, "to": 1, "order": 3}})", R"("T": 0.5)",
                              sensitivity(R"("T")", type, R"("until": 1.5, "every": 0.25)", "")));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_EQ(run.column("t").size(), 7u);
    for (const std::size_t row : {2u, 4u}) {  // 0.5 and 1 s
      EXPECT_NEAR(run.column("d(p.x)/d(T)")[row], 0, 1e-9);
      EXPECT_TRUE(std::isnan(run.column("d(p.vx)/d(T)")[row]));
      EXPECT_TRUE(std::isnan(run.column("d(p.ax)/d(T)")[row]));
    }
    // Between them at u = 1/2: v' = 0, a' = -12 / w^3.
    EXPECT_NEAR(run.column("d(p.x)/d(T)")[3], -3, 1e-9);
    EXPECT_NEAR(run.column("d(p.vx)/d(T)")[3], 0, 1e-8);
    EXPECT_NEAR(run.column("d(p.ax)/d(T)")[3], 96, 1e-7);
    EXPECT_NEAR(run.column("d(p.x)/d(T)")[5], 0, 1e-9);
    EXPECT_TRUE(warns(run, "a function of time jumps"));
  }
}

TEST(MovingInstants, WhereTwoJumpsMoveApartThereIsNoDerivative) {
  const TextRun run = run_text(driven_point(
      R"({"sum": [{"step": {"t0": "T", "t1": 2, "from": 0, "to": 1, "order": 3}},
                  {"step": {"t0": 0, "t1": "U", "from": 0, "to": 1, "order": 3}}]})",
      R"("T": 0.5, "U": 0.5)",
      sensitivity(R"("T", "U")", "kinematics", R"("until": 3, "every": 1)",
                  R"("flow": {"integral": "=p.vx^2"}, "effort": {"integral": "=p.ax^2"})")));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  for (const std::size_t p : {0u, 1u}) {
    EXPECT_TRUE(std::isfinite(gradient(run, "flow", p)));  // velocities do not jump
    EXPECT_TRUE(std::isnan(gradient(run, "effort", p)));
  }
  EXPECT_TRUE(warns(run, "move apart"));
}

// Second derivatives bend at the knot T of a table, where they are largest: the peak moves with the knot.
TEST(MovingInstants, OfAKnotAtWhichAccelerationsAreLargest) {
  for (const std::string type : types) {
    SCOPED_TRACE(type);
    const double T = 0.5, E = 2, a = 1, b = 0.3;
    const TextRun run = run_text(
        driven_point(R"({"spline": {"t": [0, "T", 2], "value": [0, 1, 0.3]}})", R"("T": 0.5)",
                     sensitivity(R"("T")", type, R"("until": 1.5, "every": 0.25)", R"("least": {"min": "p.ax"})")));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    // 2 E M = 6 ((b - a) / (E - T) - a / T) for the second derivative M at the knot.
    EXPECT_NEAR(value(run, "least"), 3 / E * ((b - a) / (E - T) - a / T), 1e-8);
    EXPECT_NEAR(gradient(run, "least", 0), 3 / E * ((b - a) / ((E - T) * (E - T)) + a / (T * T)), 1e-6);
    EXPECT_TRUE(std::isnan(run.column("d(p.ax)/d(T)")[2]));
    EXPECT_TRUE(std::isfinite(run.column("d(p.vx)/d(T)")[2]));
    EXPECT_TRUE(std::isfinite(run.column("d(p.ax)/d(T)")[3]));
  }
}

// A motion that begins where a driver does: earlier or later are different motions.
TEST(MovingInstants, AtTheStartOfAMotionHaveNoDerivative) {
  const TextRun run = run_text(driven_point(
      R"({"step": {"t0": "T", "t1": 1, "from": 0, "to": 1, "order": 3}})", R"("T": 0)",
      sensitivity(R"("T")", "dynamics", R"("until": 2, "every": 0.5)", R"("effort": {"integral": "=p.ax^2"})")));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(std::isnan(gradient(run, "effort", 0)));
  EXPECT_TRUE(warns(run, "the motion begins at t = 0 s"));
}

// A ball that falls from h until it is at the height r: v = -sqrt(2 g (h - r)), T = sqrt(2 (h - r) / g).
TEST(MovingEnds, OfARunThatAnEventStops) {
  const double h = 3, r = 0.5, g = 9.81;
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"h": 3, "r": 0.5},
  "bodies": {"ball": {"mass": 2, "particle": true, "position": [0, "h"]}}, "outputs": ["ball.y"],
  "analyses": [{"type": "sensitivity", "parameters": ["h", "r"], "of": {"type": "dynamics", "until": 5, "every": 0.1,
    "tolerance": 1e-11, "events": [{"when": "ball.y", "value": "r", "action": "stop"}], "measures": {
      "speed": {"final": "ball.vy"}, "place": {"final": "ball.y"}, "time": {"final": "t"}, "least": {"min": "ball.vy"},
      "area": {"integral": "ball.vy"}, "mean": {"mean": "ball.vy"}, "most": {"max": "ball.y"},
      "early": {"at": 0.2, "of": "ball.y"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double T = std::sqrt(2 * (h - r) / g), v = -g * T, by = 1 / (g * T);  // dT/dh = -dT/dr
  const std::map<std::string, std::pair<double, double>> known = {{"speed", {-g * by, g * by}},
                                                                  {"place", {0, 1}},
                                                                  {"time", {by, -by}},
                                                                  {"least", {-g * by, g * by}},
                                                                  {"area", {-1, 1}},
                                                                  {"mean", {-g / 2 * by, g / 2 * by}},
                                                                  {"most", {1, 0}},
                                                                  {"early", {1, 0}}};
  EXPECT_NEAR(value(run, "speed"), v, 1e-8);
  for (const auto& [name, gradients] : known) {
    EXPECT_NEAR(gradient(run, name, 0), gradients.first, 1e-7) << name;
    EXPECT_NEAR(gradient(run, name, 1), gradients.second, 1e-7) << name;
  }
}

// An event at a fixed instant stops it, and the run knows.
TEST(MovingEnds, OfARunThatStopsAtAFixedInstant) {
  const TextRun run = run_text(driven_point(
      R"({"polynomial": [0, 0, "c"]})", R"("c": 1.5)",
      R"({"type": "sensitivity", "parameters": ["c"], "of": {"type": "kinematics", "until": 3, "every": 0.5,
        "events": [{"when": "t", "value": 1.25, "action": "stop"}],
        "measures": {"end": {"final": "p.x"}, "area": {"integral": "p.x"}, "most": {"max": "p.vx"}}}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(gradient(run, "end", 0), 1.25 * 1.25, 1e-10);
  EXPECT_NEAR(gradient(run, "area", 0), std::pow(1.25, 3) / 3, 1e-10);
  EXPECT_NEAR(gradient(run, "most", 0), 2.5, 1e-10);
}

// Events that are recorded change nothing.
TEST(MovingEnds, ARecordedEventLeavesTheDerivativesOfOthers) {
  const TextRun run = run_text(driven_point(
      R"({"polynomial": [0, 0, "c"]})", R"("c": 1.5)",
      R"({"type": "sensitivity", "parameters": ["c"], "verify": true, "of": {"type": "kinematics", "until": 2,
        "every": 0.5, "events": [{"name": "mark", "when": "p.x", "value": "=c/2", "action": "record"}],
        "measures": {"end": {"final": "p.x"}, "area": {"integral": "p.x"}, "when": {"field": "events[1].t"}}}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(gradient(run, "end", 0), 4, 1e-10);
  EXPECT_NEAR(gradient(run, "area", 0), 8.0 / 3, 1e-10);
  EXPECT_NEAR(value(run, "when"), std::sqrt(0.5), 1e-9);
  EXPECT_TRUE(std::isnan(gradient(run, "when", 0)));
  EXPECT_LT(field<double>(run, "deviation"), 1e-6);
}

// Rows that move: derivatives of rows are those at fixed instants, and are compared there.
TEST(Verify, ComparesAtTheSameInstants) {
  const TextRun run = run_text(driven_point(
      R"({"harmonic": {"amplitude": 1, "omega": "w"}})", R"("w": 3)",
      R"({"type": "sensitivity", "parameters": ["w"], "verify": true, "of": {"type": "kinematics", "until": "=6/w",
        "every": "=1/w", "measures": {"area": {"integral": "p.x"}, "end": {"final": "p.x"}}}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(gradient(run, "end", 0), 0, 1e-9);  // sin 6
  EXPECT_NEAR(gradient(run, "area", 0), -(1 - std::cos(6)) / 9, 1e-9);
  EXPECT_LT(field<double>(run, "deviation"), 1e-6);
}

/// A law that begins at T or ends at T + w, or both, with jumps of velocity or acceleration in it; zero at t = 0 if it
/// is to be.
std::string random_law(RandomNumbers& random, double size, bool from_zero) {
  const std::string t0 = "\"=T*" + text_of(random(0.6, 1.4)) + "\"";
  const std::string t1 = "\"=T*1.4+w*" + text_of(random(0.6, 1.4)) + "\"";
  const auto number = [&] { return text_of(size * random(-1, 1)); };
  const std::string ends =
      R"("t0": )" + t0 + R"(, "t1": )" + t1 + R"(, "from": )" + (from_zero ? "0" : number()) + R"(, "to": )" + number();
  const char* laws[] = {"cycloidal", "poly345", "modified_trapezoid", "modified_sine"};
  const std::string smooth =
      R"({"harmonic": {"amplitude": )" + number() + R"(, "omega": )" + text_of(random(1, 4)) + "}}";
  switch (static_cast<int>(random(0, 5))) {
    case 0:
      return R"({"step": {)" + ends + R"(, "order": 3}})";
    case 1:
      return R"({"law": {"type": ")" + std::string(laws[static_cast<int>(random(0, 4))]) + "\", " + ends + "}}";
    case 2:
      return R"({"spline": {"t": [)" + t0 + ", " + t1 + R"(, "=T*1.4+w*1.7"], "value": [)" +
             (from_zero ? "0" : number()) + ", " + number() + ", " + number() + R"(], "end": ")" +
             (random(0, 1) < 0.5 ? "natural" : "clamped") + R"(", "beyond": ")" +
             (random(0, 1) < 0.5 ? "hold" : "line") + R"("}})";
    case 3:
      return R"({"sum": [{"step": {)" + ends + R"(, "order": 3}}, )" + smooth + "]}";
    default:
      return R"({"product": [{"spline": {"t": [)" + t0 + ", " + t1 + R"(], "value": [0.5, 1.5], "beyond": "hold"}}, )" +
             smooth + "]}";
  }
}

/// A trolley that is driven along, and a pendulum on it, which is driven too or swings freely.
std::string random_scene(unsigned seed, bool free, double T, double w, const std::string& analysis) {
  RandomNumbers random(seed);
  // A motion that begins in its constraints: assembly is as exact as it moves bodies, which differences see.
  const std::string along = random_law(random, 0.5, free), swing = random_law(random, 1.5, false);
  const std::string moment = random_law(random, 3, false);
  std::string scene = R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"T": )" + text_of(T) + R"(, "w": )" +
                      text_of(w) + R"(, "L": "=0.6+w/4"},
  "bodies": {"cart": {"mass": 2, "particle": true}, "bob": {"mass": "=1+T/5", "rod": {"from": [0, 0], "to": ["=L*0.6", "=-L*0.8"]}}},
  "constraints": [{"type": "absolute_y", "i": "cart", "value": 0}, {"type": "revolute", "name": "pin", "i": "cart", "j": "bob.from"}],
  "drivers": [{"type": "absolute_x", "name": "along", "i": "cart", "value": )" +
                      along + "}";
  if (!free) scene += R"(, {"type": "absolute_angle", "name": "swing", "i": "bob", "value": )" + swing + "}";
  return scene + R"(], "forces": [{"type": "torque", "i": "bob", "torque": )" + moment +
         R"(}], "outputs": ["bob.to.x", "bob.omega", "bob.alpha"], "analyses": [)" + analysis + "]}";
}

constexpr auto measured =
    R"("measures": {"place": {"integral": "bob.to.x"}, "speed": {"integral": "=bob.to.vx*bob.omega"},
  "jerky": {"integral": "bob.to.ay"}, "effort": {"rms": "bob.alpha"}, "mean": {"mean": "=cart.vx*bob.to.y"},
  "most": {"max": "bob.alpha"}, "least": {"min": "bob.omega"}, "span": {"range": "bob.to.ax"},
  "then": {"at": 1.237, "of": "bob.omega"}, "end": {"final": "bob.to.vy"},
  "near": {"path": ["bob.to.x", "bob.to.y"], "to": [[0.9, -0.2], [-0.3, -1.1]]}})";

class RandomLaws : public ::testing::TestWithParam<const char*> {};

TEST_P(RandomLaws, GradientsAgreeWithDifferencesOfWholeRuns) {
  const std::string type = GetParam();
  const bool free = type == "dynamics";
  const std::string inner = R"({"type": ")" + type + R"(", "until": 2.113, "every": 0.37, )" +
                            (free ? R"("tolerance": 1e-11, )" : "") + measured + "}";
  int compared = 0, skipped = 0, refused = 0;
  for (unsigned seed = 1; seed <= size_of_test(8u, 3u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(1000 + seed);
    const double T = random(0.3, 0.6), w = random(0.4, 0.8), h = 2e-4;
    const TextRun run = run_text(
        random_scene(seed, free, T, w, R"({"type": "sensitivity", "parameters": ["T", "w"], "of": )" + inner + "}"));
    SCOPED_TRACE(random_scene(seed, free, T, w, inner));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    for (std::size_t p = 0; p < 2; ++p) {
      std::map<int, TextRun> beside;
      for (const int k : {-2, -1, 1, 2})
        beside.emplace(k, run_text(random_scene(seed, free, p == 0 ? T + k * h : T, p == 1 ? w + k * h : w, inner)));
      for (const MeasureResult& m : run.analysis().measures) {
        const auto difference = [&](int k) {
          return (value(beside.at(k), m.name) - value(beside.at(-k), m.name)) / (2 * k * h);
        };
        const double fine = difference(1), coarse = difference(2), richardson = (4 * fine - coarse) / 3;
        const double size = std::max({std::abs(richardson), std::abs(*m.value), 0.1});
        // A tie that passes, or a jerk that jumps at an instant at which is looked: differences do not settle.
        if (std::abs(fine - coarse) > 1e-3 * size) {
          ++skipped;
          continue;
        }
        // An extreme beside a jump may be told from it by rounding alone: none is given then, and said.
        if (!std::isfinite(m.gradient[p]) && !m.trouble.empty()) {
          ++refused;
          continue;
        }
        ++compared;
        EXPECT_NEAR(m.gradient[p], richardson, 1e-6 * size) << m.name << " by " << (p == 0 ? "T" : "w");
      }
    }
  }
  EXPECT_GT(compared, size_of_test(100, 30));
  EXPECT_LT(skipped, compared / 8);
  EXPECT_LE(refused, 3);
}

INSTANTIATE_TEST_SUITE_P(Analyses, RandomLaws, ::testing::Values("kinematics", "inverse_dynamics", "dynamics"));

}  // namespace
}  // namespace catena::testing
