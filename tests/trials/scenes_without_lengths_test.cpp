// Particles that are given at one place, with nothing that is a length: errors are compared with the way that they
// make, 1e-9 ... 1e9 m, in 1e-3 ... 1e3 s, and not with 1 m. Closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct LengthlessCase {
  std::string name, gravity, velocity, forces;
  double until;
  double (*place)(double t);  // in sizes, at a time in paces
};

std::string of_x(const std::string& force) {
  return R"({"type": "point_force", "i": "b", "force": [)" + force + ", 0]}";
}

/// Of 1 kg; `size` m and `pace` s are what the motion is made of.
std::vector<LengthlessCase> lengthless_cases(double size, double pace) {
  const double a = size / pace / pace;
  std::vector<LengthlessCase> cases;
  cases.push_back({"fall", pair_of(-a, 0), "[0, 0]", "", 3, [](double t) { return -t * t / 2; }});
  cases.push_back({"pushed to and fro", "[0, 0]", "[0, 0]",
                   of_x(R"({"harmonic": {"amplitude": )" + text_of(a) + R"(, "omega": )" + text_of(1 / pace) + "}}"),
                   20, [](double t) { return t - std::sin(t); }});
  cases.push_back({"slowed down", "[0, 0]", pair_of(size / pace, 0), of_x("\"=-b.vx/" + text_of(pace) + "\""), 5,
                   [](double t) { return 1 - std::exp(-t); }});
  cases.push_back({"on a spring", "[0, 0]", "[0, 0]",
                   of_x(text_of(a)) + R"(, {"type": "spring_damper", "i": "ground", "j": "b", "length": 0, "k": )" +
                       text_of(1 / pace / pace) + "}",
                   20, [](double t) { return 1 - std::cos(t); }});
  return cases;
}

TEST(ScenesWithoutLengths, AreAsExactAtAnySize) {
  RandomNumbers random(1);
  for (int k = -9; k <= 9; k += 3) {
    const double size = std::pow(10.0, k), pace = std::pow(10.0, random(-3, 3));
    for (const LengthlessCase& c : lengthless_cases(size, pace)) {
      for (const char* method : {"rk8", "adams", "radau"}) {
        SCOPED_TRACE(c.name + ", " + text_of(size) + " m, " + text_of(pace) + " s, " + method);
        const TextRun run = run_text(
            R"({"catena": 1, "gravity": )" + c.gravity +
            R"(, "bodies": {"b": {"particle": true, "mass": 1, "velocity": )" + c.velocity + R"(}}, "forces": [)" +
            c.forces + R"(], "outputs": ["b.x"], "analyses": [{"type": "dynamics", "until": )" +
            text_of(c.until * pace) + R"(, "tolerance": 1e-8, "max_steps": 100000, "method": ")" + method + R"("}]})");
        ASSERT_EQ(run.outcome.analyses.size(), 1u) << run.outcome.error_text;
        ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
        const std::vector<double> t = run.column("t"), x = run.column("b.x");
        double largest = 0, error = 0;
        for (std::size_t r = 0; r < t.size(); ++r) {
          const double place = c.place(t[r] / pace);
          largest = std::max(largest, std::abs(place));
          error = std::max(error, std::abs(x[r] / size - place));
        }
        EXPECT_LE(error, 1e-7 * largest);
      }
    }
  }
}

// A rod has a size, and falls a million million times as far.
TEST(ScenesWithoutLengths, FallsOfAnyLengthEnd) {
  for (const double until : {1.0, 1e3, 1e5, 1e6}) {
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"mass": 1, "inertia": 0.01}}, "outputs": ["b.y"],
            "analyses": [{"type": "dynamics", "max_steps": 100000, "until": )" +
        text_of(until) + "}]}");
    ASSERT_EQ(run.analysis().report.status, Status::ok) << until << ": " << run.analysis().report.message;
    const double fallen = 9.81 * until * until / 2;
    EXPECT_NEAR(run.last("b.y"), -fallen, 1e-12 * fallen);
  }
}

}  // namespace
}  // namespace catena::testing
