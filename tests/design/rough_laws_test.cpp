// Laws of state at places where a part of their expression has no derivative.
#include <gtest/gtest.h>

#include "design/measured.hpp"

namespace catena::testing {
namespace {

/// A particle on the x axis between a spring and a force by `law`.
std::string pulled(const std::string& law, const std::string& analysis) {
  return R"({"catena": 1, "parameters": {"k": 6, "c": 2, "F": 3},
  "bodies": {"p": {"mass": 1, "particle": true, "position": [0.2, 0]}},
  "constraints": [{"type": "absolute_y", "i": "p", "value": 0}],
  "forces": [{"type": "spring_damper", "i": "ground", "j": "p", "k": "k", "length": 0},
             {"type": "point_force", "i": "p", "force": [")" +
         law + R"(", 0]}], "outputs": ["p.x"], "analyses": [)" + analysis + "]}";
}

// Drag by the square of the speed, at rest: x = F / k whatever the drag.
TEST(RoughLaws, DragAtRestIsSmooth) {
  for (const std::string law :
       {"=F-c*p.vx*sqrt(p.vx^2)", "=F-c*sqrt(p.vx^2)", "=F-c*(p.vx^2)^0.75", "=F-c*p.vx*p.vx^0.5"}) {
    SCOPED_TRACE(law);
    const TextRun run = run_text(pulled(law, R"({"type": "sensitivity", "parameters": ["k", "c", "F"],
                 "of": {"type": "equilibrium", "measures": {"x": {"final": "p.x"}}}})"));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(value(run, "x"), 0.5, 1e-10);
    EXPECT_NEAR(gradient(run, "x", 0), -3.0 / 36, 1e-10);
    EXPECT_NEAR(gradient(run, "x", 1), 0, 1e-12);
    EXPECT_NEAR(gradient(run, "x", 2), 1.0 / 6, 1e-10);
  }
}

// A motion that begins at rest with such a drag in it, against differences of whole runs.
TEST(RoughLaws, AMotionThatBeginsAtRestHasDerivatives) {
  const TextRun run = run_text(
      pulled("=F-c*p.vx*sqrt(p.vx^2)", R"({"type": "sensitivity", "parameters": ["k", "c", "F"], "verify": true,
        "of": {"type": "dynamics", "until": 0.5, "every": 0.1, "tolerance": 1e-11,
               "measures": {"x": {"final": "p.x"}}}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  for (const std::size_t p : {0u, 1u, 2u}) EXPECT_TRUE(std::isfinite(gradient(run, "x", p)));
  EXPECT_LT(field<double>(run, "deviation"), 1e-6);
}

// |F - 3| at F = 3: no derivative exists there, and the expression is named.
TEST(RoughLaws, AKinkIsNamed) {
  const TextRun run = run_text(pulled("=F-c*sqrt((F-3)^2)+0*t", R"({"type": "sensitivity", "parameters": ["F"],
                               "of": {"type": "equilibrium", "measures": {"x": {"final": "p.x"}}}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(std::isnan(gradient(run, "x", 0)));
  EXPECT_TRUE(warns(run, "the expression of"));
}

}  // namespace
}  // namespace catena::testing
