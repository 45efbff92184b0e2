// Derivatives of motions whose laws of state jump or bend: carried over the instants at which they switch.
//
// A particle of 1 kg from x0 at v0 under a force F(x, v, t), in closed form on both sides of the switch; derivatives of
// the closed forms by complex steps.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <string>

#include "design/measured.hpp"

namespace catena::testing {
namespace {

using Number = std::complex<double>;
using State = std::array<Number, 2>;  // x, v at 1 s

/// `extra`: more elements, each with a comma before it.
TextRun switched(const std::string& law, const std::string& options, const std::string& extra = "") {
  return run_text(R"({"catena": 1, "parameters": {"x0": 0.5, "v0": 3, "a": 4, "c": 1},
      "tables": {"held": {"x": [0, 1], "y": [0, "=-a"], "beyond": "hold"}},
      "bodies": {"b": {"mass": 1, "particle": true, "position": ["x0", 0], "velocity": ["v0", 0]}},
      "constraints": [{"type": "absolute_y", "i": "b", "value": 0}],
      "forces": [{"type": "point_force", "name": "f", "i": "b", "force": [")" +
                  law + R"(", 0]})" + extra + R"(],
      "analyses": [{"type": "sensitivity", "parameters": ["x0", "v0", "a", "c"], "of": {"type": "dynamics",
        "until": 1, "every": 0.25, )" +
                  options + R"("measures": {"x": {"final": "b.x"}, "v": {"final": "b.vx"},
                                           "sum": {"integral": "b.vx"}}}}]})");
}

using Motion = std::function<State(Number x0, Number v0, Number a, Number c)>;

void expect_derivatives(const TextRun& run, const Motion& motion, double tolerance) {
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  for (std::size_t p = 0; p < 4; ++p) {
    std::array<Number, 4> at = {0.5, 3, 4, 1};
    at[p] += Number(0, 1e-30);
    const State end = motion(at[0], at[1], at[2], at[3]);
    EXPECT_NEAR(value(run, "x"), end[0].real(), tolerance);
    EXPECT_NEAR(gradient(run, "x", p), end[0].imag() / 1e-30, tolerance) << p;
    EXPECT_NEAR(gradient(run, "v", p), end[1].imag() / 1e-30, tolerance) << p;
    EXPECT_NEAR(gradient(run, "sum", p), (end[0].imag() - at[0].imag()) / 1e-30, 2 * tolerance) << p;
  }
}

/// From a state on under a constant force.
State thrown(Number x, Number v, Number f, Number d) { return {x + v * d + f * d * d / 2.0, v + f * d}; }

// F = a before x = c and -a behind it.
State bang_bang(Number x0, Number v0, Number a, Number c) {
  const Number t = (std::sqrt(v0 * v0 + 2.0 * a * (c - x0)) - v0) / a;
  return thrown(c, v0 + a * t, -a, 1.0 - t);
}

TEST(SwitchingLaws, AForceThatJumpsAtAPlace) {
  expect_derivatives(switched("=-a*(b.x-c)/abs(b.x-c)", R"("tolerance": 1e-10, )"), bang_bang, 2e-8);
  // A ramp 1e-9 m wide: what the motion may miss is a tenth of that.
  const std::string ramp = "=a*(1-2*max(0,min(1,(b.x-c)*1e9)))";
  expect_derivatives(switched(ramp, R"("tolerance": 1e-10, )"), bang_bang, 1e-6);
  expect_derivatives(switched("=-a*(b.x-c)/abs(b.x-c)", R"("tolerance": 1e-7, )"), bang_bang, 2e-8);
}

// v comes through zero, and the particle turns back: F = -2 a - c before, -a - c behind.
TEST(SwitchingLaws, AForceThatJumpsWithTheVelocity) {
  expect_derivatives(
      switched("=-1.5*a-c-0.5*a*b.vx/abs(b.vx)", R"("tolerance": 1e-10, )"),
      [](Number x0, Number v0, Number a, Number c) {
        const Number t = v0 / (2.0 * a + c);
        return thrown(x0 + v0 * t / 2.0, 0, -a - c, 1.0 - t);
      },
      2e-8);
}

// A place that moves with time: x = c + t.
TEST(SwitchingLaws, AForceThatJumpsAtAPlaceThatMoves) {
  expect_derivatives(
      switched("=-a*(b.x-c-t)/abs(b.x-c-t)", R"("tolerance": 1e-10, )"),
      [](Number x0, Number v0, Number a, Number c) {
        const Number t = (std::sqrt((v0 - 1.0) * (v0 - 1.0) + 2.0 * a * (c - x0)) - v0 + 1.0) / a;
        return thrown(c + t, v0 + a * t, -a, 1.0 - t);
      },
      2e-8);
}

// F = -a x up to x = 1, and -a beyond it: c has no part in it.
TEST(SwitchingLaws, AForceThatBends) {
  const Motion held = [](Number x0, Number v0, Number a, Number) {
    const Number w = std::sqrt(a), size = std::sqrt(x0 * x0 + v0 * v0 / a), phase = std::atan(w * x0 / v0);
    const Number t = (std::asin(1.0 / size) - phase) / w;
    return thrown(1, size * w * std::cos(w * t + phase), -a, 1.0 - t);
  };
  for (const std::string law : {"=-a*min(b.x,1)", "=held(b.x)"}) {
    SCOPED_TRACE(law);
    expect_derivatives(switched(law, R"("tolerance": 1e-8, )"), held, 1e-9);
    expect_derivatives(switched(law, R"("tolerance": 1e-12, )"), held, 1e-11);
  }
  // Beside a stop that is not reached: by the equations of phases.
  const std::string stop = R"(, {"type": "stop", "column": "b.x", "max": 9, "restitution": 0.5})";
  expect_derivatives(switched("=-a*min(b.x,1)", R"("tolerance": 1e-10, )", stop), held, 1e-10);
  expect_derivatives(switched("=-a*(b.x-c)/abs(b.x-c)", R"("tolerance": 1e-10, )", stop), bang_bang, 2e-8);
}

// Nothing is compared here that tells the instant: no value, and a warning.
TEST(SwitchingLaws, AJumpThatIsNotTold) {
  const TextRun run = switched("=-a*(b.x-c)/sqrt((b.x-c)^2)", R"("tolerance": 1e-10, )");
  EXPECT_NEAR(value(run, "x"), bang_bang(0.5, 3, 4, 1)[0].real(), 1e-8);
  for (const std::string name : {"x", "v", "sum"}) EXPECT_TRUE(std::isnan(gradient(run, name, 0))) << name;
  EXPECT_TRUE(warns(run, "forces of laws of state jump"));
}

}  // namespace
}  // namespace catena::testing
