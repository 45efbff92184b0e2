// Derivatives of motions at rest, whose steps are longer than the derivatives need.
//
// A particle hangs on a spring of stiffness k, y0 = -m g / k: y_k'' = -(k / m) y_k - y0 / m with y_k(0) = y_k'(0) = 0,
// so y_k = -(y0 / k) (1 - cos(omega t)); and y_m'' = -(k / m) y_m - g / m, so y_m = -(g / k) (1 - cos(omega t)).
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "design/measured.hpp"

namespace catena::testing {
namespace {

struct Resting {
  std::string more_forces, more_constraints, more_keys;
};

constexpr double end = 0.4;

TextRun resting(const Resting& of, const std::string& mode) {
  return run_text(R"({"catena": 1, "gravity": [0, -10], "parameters": {"k": 100, "m": 1},
  "bodies": {"p": {"particle": true, "mass": "m", "position": [0, -0.1]}},
  "constraints": [{"type": "absolute_x", "i": "p", "value": 0})" +
                  of.more_constraints + R"(],
  "forces": [{"type": "spring_damper", "name": "s", "i": "ground", "j": "p", "k": "k", "length": 0})" +
                  of.more_forces + R"(], "outputs": ["p.y", "p.vy"],
  "analyses": [{"type": "sensitivity", "parameters": ["k", "m"], "mode": ")" +
                  mode + R"(", "of": {"type": "dynamics", "until": 0.4, "every": 0.1)" + of.more_keys +
                  R"(, "measures": {"end": {"final": "p.y"}, "mean": {"mean": "p.y"}}}}]})");
}

// By k of y; by m it is -g times as much.
double by_stiffness(double t) { return 0.1 / 100 * (1 - std::cos(10 * t)); }
double mean_by_stiffness() { return 0.1 / 100 * (1 - std::sin(10 * end) / (10 * end)); }
constexpr double of_mass = -100;

const std::string floor_below = R"(, {"type": "contact", "name": "floor", "i": "ground", "j": "p",
          "curve": {"line": {"point": [0, -9], "axis": [1, 0]}}})";

TEST(RestingMotions, DerivativesOfAMassOnASpring) {
  // By tangents; with steps of other methods; with constraints that depend on each other, in dual numbers; with a
  // contact that is never reached.
  const Resting cases[] = {
      {"", "", ""},
      {"", "", R"(, "method": "rk5")"},
      {"", "", R"(, "method": "adams")"},
      {"", R"(, {"type": "absolute_x", "i": "p", "value": 0})", ""},
      {floor_below, "", ""},
  };
  for (const Resting& one : cases) {
    SCOPED_TRACE(one.more_forces + one.more_constraints + one.more_keys);
    const TextRun run = resting(one, "forward");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(run.last("d(p.y)/d(k)"), by_stiffness(end), 1e-10);
    EXPECT_NEAR(run.last("d(p.vy)/d(k)"), 0.01 * std::sin(10 * end), 1e-9);
    EXPECT_NEAR(run.last("d(p.y)/d(m)"), of_mass * by_stiffness(end), 1e-8);
    EXPECT_NEAR(gradient(run, "mean", 0), mean_by_stiffness(), 1e-10);
    EXPECT_NEAR(gradient(run, "mean", 1), of_mass * mean_by_stiffness(), 1e-8);
  }
}

TEST(RestingMotions, TheWayBack) {
  const Resting cases[] = {
      {"", "", ""}, {"", "", R"(, "method": "rk5")"}, {"", "", R"(, "method": "adams")"}, {floor_below, "", ""}};
  for (const Resting& one : cases) {
    SCOPED_TRACE(one.more_forces + one.more_keys);
    const TextRun run = resting(one, "adjoint");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_TRUE(went_back(run));
    EXPECT_NEAR(gradient(run, "end", 0), by_stiffness(end), 1e-10);
    EXPECT_NEAR(gradient(run, "end", 1), of_mass * by_stiffness(end), 1e-8);
    EXPECT_NEAR(gradient(run, "mean", 0), mean_by_stiffness(), 1e-10);
    EXPECT_NEAR(gradient(run, "mean", 1), of_mass * mean_by_stiffness(), 1e-8);
  }
}

// A particle on a spring whose curve is a straight line, f = 5 + 750 e, and held beyond e = -0.02 and 0.1, passes both
// ends again and again: derivatives of a motion whose steps do not end there. Reference: its pieces in closed form,
// ends by bisection, differences of fourth order by L and m.
TEST(BendingMotions, DerivativesOfAMassOnASpringThatIsHeldBeyondItsCurve) {
  for (const std::string mode : {"forward", "adjoint"}) {
    for (const std::string method : {"rk8", "rk5", "adams"}) {
      SCOPED_TRACE(mode + method);
      const TextRun run = run_text(R"({"catena": 1, "parameters": {"L": 1, "m": 1},
  "bodies": {"p": {"particle": true, "mass": "m", "position": [1.05, 0], "velocity": [-3.5, 0]}},
  "constraints": [{"type": "absolute_y", "i": "p", "value": 0}],
  "forces": [{"type": "spring_damper", "i": "ground", "j": "p", "length": "L",
              "curve": {"points": [[-0.02, -10], [0.1, 80]], "beyond": "hold"}}],
  "analyses": [{"type": "sensitivity", "parameters": ["L", "m"], "mode": ")" +
                                   mode + R"(", "of": {"type": "dynamics", "until": 1, "every": 0.1,
    "tolerance": 1e-10, "method": ")" +
                                   method + R"(", "measures": {"end": {"final": "p.x"}}}}]})");
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      EXPECT_NEAR(value(run, "end"), 0.68683919279, 1e-8);
      EXPECT_NEAR(gradient(run, "end", 0), -5.73703695956, 1e-7);
      EXPECT_NEAR(gradient(run, "end", 1), 2.32128525407, 1e-7);
    }
  }
}

}  // namespace
}  // namespace catena::testing
