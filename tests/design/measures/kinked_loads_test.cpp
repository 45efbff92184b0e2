// Gradients of integrals over loads that bend where a cable becomes taut, a law of state takes another branch, or
// a table or a spring's curve is held beyond its end: their derivatives jump there.
//
// References of the slider-crank: its loads in closed form, integrated by Gauss's rule of 60 points between all kinks,
// differences of fourth order in the parameters.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "design/measured.hpp"

namespace catena::testing {
namespace {

const std::string slider_crank = R"({"catena": 1,
    "parameters": {"r": 0.1, "l": 0.35, "k": 800, "L": 0.3, "w": 12, "s": 1}, "gravity": [0, -9.81],
    "tables": {"lin": {"x": [0, 2], "y": [0, 2], "beyond": "hold"}},
    "bodies": {"crank": {"mass": 1, "rod": {"from": [0, 0], "to": ["r", 0]}},
               "rod": {"mass": 2, "rod": {"from": ["r", 0], "to": ["=r+l", 0]}},
               "pist": {"mass": 1.5, "particle": true, "position": ["=r+l", 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
                    {"type": "revolute", "i": "crank.to", "j": "rod.from"},
                    {"type": "revolute", "i": "rod.to", "j": "pist"}, {"type": "absolute_y", "i": "pist"}])";

TextRun gradients_of(const std::string& start, const std::string& force, const std::string& parameters,
                     const std::string& analysis, const std::string& mode, const std::string& measures) {
  return run_text(
      slider_crank + R"(, "drivers": [{"type": "absolute_angle", "name": "d", "i": "crank",
      "value": {"polynomial": [)" +
      start + R"(, "w"]}}], "forces": [)" + force + R"(], "analyses": [{"type": "sensitivity", "parameters": )" +
      parameters + R"(, "mode": ")" + mode + R"(", "of": {"type": ")" + analysis + R"(", "until": 0.5, "every": 0.02)" +
      (analysis == "dynamics" ? R"(, "tolerance": 1e-10)" : "") + R"(, "measures": {)" + measures + "}}}]}");
}

TEST(KinkedLoads, WorkOfADriverAgainstACableOrTheSameAsALaw) {
  const std::string cable = R"({"type": "cable", "name": "c", "i": ["ground", [0.6, 0.1]], "j": "pist", "k": "k",
                                "length": "L"})";
  const std::string law = R"_({"type": "spring_damper", "name": "c", "i": ["ground", [0.6, 0.1]], "j": "pist",
                               "k": 0, "length": 1, "force": "=k*max(c.length-L, 0)"})_";
  constexpr std::array work = {143.0480183, 29.0734944747, 34.68283275, 1.09402318};  // by r, l, L, w
  for (const std::string& force : {cable, law}) {
    for (const std::string analysis : {"inverse_dynamics", "dynamics"}) {
      for (const std::string mode : {"forward", "adjoint"}) {
        SCOPED_TRACE(force + analysis + mode);
        const TextRun run = gradients_of("0", force, R"(["r", "l", "L", "w"])", analysis, mode,
                                         R"_("I": {"integral": "=abs(d.power)"}, "rms": {"rms": "d.load"})_");
        ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
        for (std::size_t p = 0; p < 4; ++p) EXPECT_NEAR(gradient(run, "I", p), work[p], 2e-7) << p;
        EXPECT_NEAR(gradient(run, "rms", 2), 3.50522356, 1e-8);
      }
    }
  }
}

TEST(KinkedLoads, ASpringWhoseCurveIsHeldBeyondItsEnds) {
  const std::string spring = R"({"type": "spring_damper", "name": "s", "i": ["ground", [0.7, 0.1]], "j": "pist",
      "length": "L", "curve": {"points": [[-0.02, -10], [0.1, 80]], "beyond": "hold"}})";
  constexpr std::array mean = {-60.988829020, -338.838475201, -344.878884473};  // by r, l, L
  for (const std::string analysis : {"inverse_dynamics", "dynamics"}) {
    for (const std::string mode : {"forward", "adjoint"}) {
      SCOPED_TRACE(analysis + mode);
      const TextRun run =
          gradients_of("0.3", spring, R"(["r", "l", "L"])", analysis, mode, R"("F": {"mean": "s.force"})");
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      for (int p = 0; p < 3; ++p) EXPECT_NEAR(gradient(run, "F", p), mean[static_cast<std::size_t>(p)], 1e-8) << p;
    }
  }
}

// The angle a = 0.3 + w t passes the end of the table, 2, at t* = 1.7 / w: the integral of lin(s a) is
// s (0.3 t* + w t*^2 / 2) + 2 (T - t*).
TEST(KinkedLoads, ATableThatIsHeldBeyondItsEnd) {
  const double t = 1.7 / 12;
  for (const std::string analysis : {"kinematics", "inverse_dynamics", "dynamics"}) {
    for (const std::string mode : {"forward", "adjoint"}) {
      SCOPED_TRACE(analysis + mode);
      const TextRun run =
          gradients_of("0.3", "", R"(["s", "w"])", analysis, mode, R"_("I": {"integral": "=lin(s*crank.angle)"})_");
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      EXPECT_NEAR(gradient(run, "I", 0), 0.3 * t + 6 * t * t, 1e-9);
      EXPECT_NEAR(gradient(run, "I", 1), t * t / 2, 1e-10);
    }
  }
}

}  // namespace
}  // namespace catena::testing
