// Measures whose derivatives are in doubt: root mean squares of columns that are zero, and extremes that are reached
// several times. Where all that may count agrees there is a gradient; else none, and a reason. Kinks of integrands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "analysis/sanitized.hpp"
#include "design/measured.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

TextRun run_sensitivity_of(const std::string& scene, const std::string& parameters, const std::string& mode,
                           const std::string& run, const std::string& measures) {
  return run_text(R"({"catena": 1, )" + scene + R"(, "analyses": [{"type": "sensitivity", "mode": ")" + mode +
                  R"(", "parameters": )" + parameters + R"(, "of": {)" + run + R"(, "measures": {)" + measures +
                  "}}}]}");
}

// A floor that is not reached, a place that is not left: zero whatever h is.
TEST(ZerosAndTies, RootMeanSquaresOfWhatStaysZero) {
  for (const std::string mode : {"forward", "adjoint"}) {
    const TextRun run = run_sensitivity_of(
        R"("gravity": [0, -9.81], "parameters": {"h": 1.0, "u": 0.0},
        "bodies": {"p": {"particle": true, "mass": 1, "position": [0, "h"], "velocity": ["u", 0]}},
        "forces": [{"type": "contact", "name": "C", "i": "ground", "j": "p", "k": 100,
                    "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}])",
        R"(["h", "u"])", mode, R"("type": "dynamics", "until": "=0.1*h", "every": 0.1)",
        R"("force": {"rms": "C.force"}, "x": {"rms": "p.x"}, "vx": {"rms": "p.vx"})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_EQ(value(run, "force"), 0);
    EXPECT_EQ(gradient(run, "force", 0), 0);
    EXPECT_EQ(gradient(run, "force", 1), 0);
    EXPECT_EQ(gradient(run, "x", 0), 0);
    // x = u t grows on both sides of u = 0.
    EXPECT_TRUE(std::isnan(gradient(run, "x", 1)));
    EXPECT_TRUE(std::isnan(gradient(run, "vx", 1)));
    EXPECT_TRUE(warns(run, "a root mean square has a kink there"));
  }
}

// rms of u t over T is |u| T / sqrt 3: beside the kink there is a derivative, however near.
TEST(ZerosAndTies, RootMeanSquaresOfWhatIsNearlyZero) {
  for (const double u : {1e-9, -1e-9}) {
    const TextRun run = run_sensitivity_of(R"("parameters": {"u": )" + text_of(u) + R"(},
        "bodies": {"p": {"particle": true, "mass": 1, "position": [0, 0], "velocity": ["u", 0]}})",
                                           R"(["u"])", "forward", R"("type": "dynamics", "until": 0.3, "every": 0.1)",
                                           R"("x": {"rms": "p.x"})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(gradient(run, "x", 0), std::copysign(0.3 / std::sqrt(3.0), u), 1e-9);
  }
}

// x = a cos(w t) + v / w sin(w t), w^2 = k / m: the same amplitude again and again, sqrt(a^2 + v^2 m / k), by which the
// phase does not count.
TEST(ZerosAndTies, ExtremesThatComeBack) {
  expect_no_fault(1, size_of_test(8u, 2u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double a = random(0.1, 0.5), k = random(30, 80), m = random(0.5, 2), v = seed % 2 == 0 ? 0 : random(-1, 1);
    const double amplitude = std::sqrt(a * a + v * v * m / k), w = std::sqrt(k / m);
    const TextRun run = run_sensitivity_of(
        R"("parameters": {"a": )" + text_of(a) + R"(, "k": )" + text_of(k) + R"(, "m": )" + text_of(m) + R"(, "v": )" +
            text_of(v) +
            R"(}, "bodies": {"b": {"particle": true, "mass": "m", "position": ["a", 0], "velocity": ["v", 0]}},
        "constraints": [{"type": "absolute_y", "i": "b", "value": 0}],
        "forces": [{"type": "spring_damper", "i": ["ground", [-2, 0]], "j": "b", "k": "k", "length": 2}])",
        R"(["a", "k", "m", "v"])", seed % 4 < 2 ? "adjoint" : "forward",
        R"("type": "dynamics", "tolerance": 1e-10, "every": 0.5, "until": )" + text_of(random(20, 30) / w),
        R"("most": {"max": "b.x"}, "least": {"min": "b.x"}, "range": {"range": "b.x"}, "speed": {"max": "b.vx"})");
    if (run.outcome.exit_code != 0) return run.outcome.error_text;
    const std::array<double, 4> by{a / amplitude, -v * v * m / (k * k) / (2 * amplitude), v * v / k / (2 * amplitude),
                                   v * m / k / amplitude};
    const std::array<double, 4> w_by{0, w / (2 * k), -w / (2 * m), 0};
    for (std::size_t p = 0; p < 4; ++p) {
      const std::array<std::pair<const char*, double>, 4> expected{
          {{"most", by[p]}, {"least", -by[p]}, {"range", 2 * by[p]}, {"speed", w * by[p] + w_by[p] * amplitude}}};
      // Ten times the tolerance, of what the swing changes by with the parameter elsewhere: less than 30 a unit of it.
      for (const auto& [name, slope] : expected) {
        if (std::abs(gradient(run, name, p) - slope) <= 10 * 1e-10 * std::max(30.0, std::abs(slope))) continue;
        return std::string(name) + " by " + std::to_string(p) + ": " + text_of(gradient(run, name, p)) + ", expected " +
               text_of(slope) + " " + measure(run, name).trouble;
      }
    }
    return {};
  });
}

// max |x| of the same at v = 0 is reached at both ends of the swing, which move apart with the rest of the spring.
TEST(ZerosAndTies, ExtremesThatMoveApart) {
  const TextRun run = run_sensitivity_of(
      R"("parameters": {"a": 0.2, "l": 2.0}, "bodies": {"b": {"particle": true, "mass": 1.3, "position": ["a", 0]}},
      "constraints": [{"type": "absolute_y", "i": "b", "value": 0}],
      "forces": [{"type": "spring_damper", "i": ["ground", [-2, 0]], "j": "b", "k": 50, "length": "l"}])",
      R"(["a", "l"])", "forward", R"("type": "dynamics", "tolerance": 1e-10, "until": 1.5, "every": 0.5)",
      R"("away": {"max": "=b.x^2"})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(gradient(run, "away", 0), 0.4, 1e-8);
  EXPECT_TRUE(std::isnan(gradient(run, "away", 1)));
  EXPECT_TRUE(warns(run, "with different derivatives"));
}

// h + s (t - a)^2 (t - b) is h at t = a, its top, and again where the run ends, t = b; and h - s (t - a)^2 (t - b)
// where it begins.
TEST(ZerosAndTies, ExtremesInsideAndAtAnEndOfTheRun) {
  expect_no_fault(1, size_of_test(12u, 3u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double a = random(0.2, 0.4), end = random(0.8, 1.2), h = random(-1, 1), s = random(0.5, 2);
    const bool last = seed % 2 == 0, far = seed % 3 == 0;  // beyond the run: the top alone is left
    const std::string b = text_of((last ? end : 0) + (far ? (last ? 0.1 : -0.1) : 0)),
                      top = text_of(last ? a : end - a);
    const std::string cube = std::string(last ? " + " : " - ") + "s*(t - a)^2*(t - b)";
    const TextRun run = run_sensitivity_of(
        R"("parameters": {"a": )" + top + R"(, "b": )" + b + R"(, "h": )" + text_of(h) + R"(, "s": )" + text_of(s) +
            R"(, "T": )" + text_of(end) + R"(}, "bodies": {"p": {"particle": true, "mass": 1, "velocity": [1, 0]}})",
        R"(["a", "b", "h", "s", "T"])", seed % 4 < 2 ? "adjoint" : "forward",
        R"("type": "dynamics", "until": "=T", "every": 0.1)", R"("most": {"max": "=h)" + cube + R"("})");
    if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
    if (std::abs(value(run, "most") - h) > 1e-10) return "most is " + text_of(value(run, "most"));
    const std::array<double, 5> by{0, 0, 1, 0, 0};
    for (std::size_t p = 0; p < by.size(); ++p) {
      const double given = gradient(run, "most", p);
      // By b the end moves alone; by T it is the run's end that does.
      const bool none = !far && (p == 1 || (p == 4 && last));
      if (none ? !std::isnan(given) : !(std::abs(given - by[p]) <= 1e-8))
        return "by number " + std::to_string(p) + " " + text_of(given) + " " + measure(run, "most").trouble;
    }
    return far || warns(run, "its extreme is reached") ? "" : "no reason";
  });
}

/// The integral of |cos| from 0 to u.
double way(double u) {
  const double n = std::floor(u / std::numbers::pi + 0.5);
  return 2 * n + std::sin(u - n * std::numbers::pi);
}

// A wheel that is driven by a sin(w t); its speed is a w cos(w t). h is the speed at w t = theta.
TEST(MeasureKinks, IntegralsOfDrivenMotions) {
  for (unsigned seed = 1; seed <= size_of_test(40u, 8u); ++seed) {
    RandomNumbers random(seed);
    const double a = random(0.5, 2), w = random(2, 6), end = random(0.5, 2.5), theta = random(0.02, 1.55);
    const double pi = std::numbers::pi, u = w * end, turns = std::floor(u / pi), h = a * w * std::cos(theta);
    const double reached = std::clamp(u - turns * pi, theta, pi - theta);
    const double slow_angle = turns * (pi - 2 * theta) + reached - theta;
    const double slow_way = 2 * turns * (1 - std::sin(theta)) + way(reached) - way(theta);
    for (const std::string mode : {"forward", "adjoint"}) {
      SCOPED_TRACE(fmt::format("{} {}", seed, mode));
      const TextRun run = run_sensitivity_of(
          R"json("parameters": {"a": )json" + text_of(a) + R"json(, "w": )json" + text_of(w) + R"json(, "h": )json" +
              text_of(h) + R"json(},
        "bodies": {"wheel": {"mass": 1, "inertia": 1}},
        "constraints": [{"type": "revolute", "i": "ground", "j": "wheel"}],
        "columns": {"speed": "=abs(wheel.omega)"},
        "drivers": [{"type": "absolute_angle", "i": "wheel", "value": {"harmonic": {"amplitude": "a", "omega": "w"}}}])json",
          R"json(["a", "w", "h"])json", mode, R"json("type": "kinematics", "every": 0.1, "until": )json" + text_of(end),
          R"json("way": {"integral": "=abs(wheel.omega)"}, "fast": {"integral": "=max(h, speed)"})json");
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      EXPECT_NEAR(value(run, "way"), a * way(u), 1e-9);
      EXPECT_NEAR(gradient(run, "way", 0), way(u), 1e-8);
      EXPECT_NEAR(gradient(run, "way", 1), a * end * std::abs(std::cos(u)), 1e-8);
      EXPECT_NEAR(value(run, "fast"), a * (way(u) - slow_way) + h * slow_angle / w, 1e-8);
      EXPECT_NEAR(gradient(run, "fast", 0), way(u) - slow_way, 1e-8);
      EXPECT_NEAR(gradient(run, "fast", 2), slow_angle / w, 1e-8);
    }
  }
}

// A weight on a spring, x = a cos(w t), w = sqrt(k).
TEST(MeasureKinks, IntegralsOfFreeMotions) {
  for (unsigned seed = 1; seed <= size_of_test(24u, 6u); ++seed) {
    RandomNumbers random(seed);
    const double a = random(0.5, 2), w = random(2, 6), end = random(0.5, 2.5);
    const double u = w * end, f = way(u), half = (f + std::sin(u)) / 2;
    const double by_k = a * (end * std::abs(std::cos(u)) - f / w) / (2 * w * w);
    for (const std::string mode : {"forward", "adjoint"}) {
      SCOPED_TRACE(fmt::format("{} {}", seed, mode));
      const TextRun run = run_sensitivity_of(
          R"json("parameters": {"a": )json" + text_of(a) + R"json(, "k": )json" + text_of(w * w) + R"json(},
        "bodies": {"weight": {"mass": 1, "particle": true, "position": ["a", 0]}},
        "constraints": [{"type": "absolute_y", "i": "weight", "value": 0}],
        "forces": [{"type": "spring_damper", "i": "ground", "j": "weight", "k": "k", "length": 0}])json",
          R"json(["a", "k"])json", mode,
          R"json("type": "dynamics", "tolerance": 1e-11, "every": 0.3, "until": )json" + text_of(end),
          R"json("all": {"integral": "=abs(weight.x)"}, "right": {"mean": "=max(0, weight.x)"})json");
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      EXPECT_NEAR(value(run, "all"), a * f / w, 1e-8);
      EXPECT_NEAR(gradient(run, "all", 0), f / w, 1e-7);
      EXPECT_NEAR(gradient(run, "all", 1), by_k, 1e-7);
      EXPECT_NEAR(gradient(run, "right", 0), half / (w * end), 1e-7);
      EXPECT_NEAR(gradient(run, "right", 1),
                  (by_k + a * (end * std::cos(u) - std::sin(u) / w) / (2 * w * w)) / (2 * end), 1e-7);
    }
  }
}

// x / |x| of x = cos(w t) is a step: its integral to T behind the first zero is pi / w - T.
TEST(MeasureKinks, StepsHaveNoDerivativeAndAReason) {
  for (const std::string mode : {"forward", "adjoint"}) {
    const TextRun run = run_sensitivity_of(
        R"json("parameters": {"w": 2.0}, "bodies": {"p": {"particle": true, "mass": 1}},
        "constraints": [{"type": "absolute_y", "i": "p", "value": 0}],
        "drivers": [{"type": "absolute_x", "i": "p",
                     "value": {"harmonic": {"amplitude": 1, "omega": "w", "phase": "=pi/2"}}}])json",
        R"json(["w"])json", mode, R"json("type": "kinematics", "until": 1.3, "every": 0.1)json",
        R"json("side": {"integral": "=p.x/abs(p.x)"})json");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(value(run, "side"), std::numbers::pi / 2 - 1.3, 1e-9);
    EXPECT_TRUE(std::isnan(gradient(run, "side", 0)));
    EXPECT_TRUE(warns(run, "where it switches from one branch to another"));
  }
}

// p = a c sin t, q = b c sin t with a = b: max(p, q) has a kink by a and by b, none by c.
TEST(MeasureKinks, BranchesThatStayEqual) {
  for (unsigned seed = 1; seed <= size_of_test(8u, 3u); ++seed) {
    RandomNumbers random(seed);
    const double a = random(0.5, 2), c = random(0.5, 2), end = random(2, 6);
    for (const std::string mode : {"forward", "adjoint"}) {
      SCOPED_TRACE(fmt::format("{} {}", seed, mode));
      const TextRun run = run_sensitivity_of(
          R"json("parameters": {"a": )json" + text_of(a) + R"json(, "b": )json" + text_of(a) + R"json(, "c": )json" +
              text_of(c) + R"json(},
        "bodies": {"p": {"particle": true, "mass": 1}, "q": {"particle": true, "mass": 1}},
        "constraints": [{"type": "absolute_y", "i": "p", "value": 0}, {"type": "absolute_y", "i": "q", "value": 0}],
        "drivers": [
          {"type": "absolute_x", "i": "p", "value": {"harmonic": {"amplitude": "=a*c", "omega": 1}}},
          {"type": "absolute_x", "i": "q", "value": {"harmonic": {"amplitude": "=b*c", "omega": 1}}}])json",
          R"json(["a", "b", "c"])json", mode, R"json("type": "kinematics", "every": 0.5, "until": )json" + text_of(end),
          R"json("top": {"max": "=max(p.x, q.x)"}, "sum": {"integral": "=max(p.x, q.x)"},
             "mean": {"mean": "=abs(p.x - q.x)"})json");
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      EXPECT_NEAR(gradient(run, "top", 2), a, 1e-8);
      EXPECT_NEAR(gradient(run, "sum", 2), a * (1 - std::cos(end)), 1e-8);
      EXPECT_NEAR(gradient(run, "mean", 2), 0, 1e-12);
      for (const char* name : {"top", "sum", "mean"}) {
        EXPECT_TRUE(std::isnan(gradient(run, name, 0))) << name;
        EXPECT_TRUE(std::isnan(gradient(run, name, 1))) << name;
      }
      EXPECT_TRUE(warns(run, "both branches of an abs, min or max"));
    }
  }
}

}  // namespace
}  // namespace catena::testing
