// What drivers do, by every method, where no error of the motion says anything of it: a wheel that is turned on a fixed
// pin has a motion known beforehand, whatever pulls at its rim.
//
//   against a spring to the ground   W = k (l^2 - l0^2) / 2 of stretches l - length, of a cable max(0, l - length)
//   a torque 5 exp(-(20 (t - 3.3))^2) at 3 rad/s   W = -3 5 sqrt(pi) / 20
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double rim = 0.3, speed = 3, stiffness = 200, length = 0.5;

/// The energy of what pulls from (0.1, 0.6) at the rim of a wheel that has turned by `angle`.
double stored(double angle, bool pulls_only) {
  double stretch = std::hypot(rim * std::cos(angle) - 0.1, rim * std::sin(angle) - 0.6) - length;
  if (pulls_only) stretch = std::max(stretch, 0.0);
  return stiffness / 2 * stretch * stretch;
}

std::string wheel(const std::string& body, const std::string& driver, const std::string& force) {
  return R"({"catena": 1, "bodies": {"b": {"mass": 1, "inertia": 0.1})" + body +
         R"(}, "constraints": [{"type": "revolute", "i": "ground", "j": "b"}],
    "drivers": [{"type": "absolute_angle", "name": "D", "i": "b", "value": {"polynomial": [0, )" +
         text_of(speed) + "]}}" + driver + R"(], "forces": [)" + force + R"(], "outputs": ["D.work"], "analyses": [)";
}

std::string pull(const std::string& type) {
  return R"({"type": ")" + type + R"(", "i": ["b", [0.3, 0]], "j": ["ground", [0.1, 0.6]], "length": 0.5, "k": 200})";
}

std::string motion(const std::string& method, double until, double every, double tolerance = 1e-8) {
  return R"({"type": "dynamics", "until": )" + text_of(until) + R"(, "every": )" + text_of(every) +
         R"(, "tolerance": )" + text_of(tolerance) + R"(, "method": ")" + method + R"("}]})";
}

TEST(WorkOfDrivers, OfOneWheelAtASpringOrACable) {
  for (const std::string type : {"spring_damper", "cable"}) {
    for (const std::string method : {"auto", "rk8", "rk5", "adams", "radau", "alpha", "partitioning", "baumgarte"}) {
      for (const double every : {1.0, 5.0}) {
        SCOPED_TRACE(type + " " + method + " " + text_of(every));
        const TextRun run = run_text(wheel("", "", pull(type)) + motion(method, 10, every));
        ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
        const std::vector<double> t = run.column("t"), work = run.column("D.work");
        for (std::size_t k = 0; k < t.size(); ++k) {
          const double right = stored(speed * t[k], type == "cable") - stored(0, type == "cable");
          EXPECT_NEAR(work[k], right, 5e-7) << t[k];
        }
      }
    }
  }
}

// The wheel has a pendulum at its hub, which asks nothing of the driver: the mechanism is not driven as a whole.
TEST(WorkOfDrivers, BesideWhatMovesFreely) {
  const std::string free = R"(, "m": {"particle": true, "mass": 0.5, "position": [0.2, 0.9]})";
  const std::string hung =
      pull("spring_damper") + R"(, {"type": "spring_damper", "i": "b", "j": "m", "length": 0.5, "k": 30, "c": 0.2})";
  for (const std::string method : {"auto", "rk5", "adams", "radau", "partitioning", "baumgarte"}) {
    SCOPED_TRACE(method);
    const TextRun run = run_text(wheel(free, "", hung) + motion(method, 5, 1));
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
    EXPECT_NEAR(run.last("D.work"), stored(speed * 5, false) - stored(0, false), 2e-6);
  }
}

// Twelve rods in a row on the pin of the first, which is turned from rest to rest: what its driver has done is what
// moves.
TEST(WorkOfDrivers, OfAChainThatIsTurnedFromRest) {
  std::string bodies, pins;
  for (int k = 0; k < 12; ++k) {
    const std::string name = "l" + std::to_string(k);
    bodies += (k > 0 ? ", \"" : "\"") + name + R"(": {"mass": 0.1, "rod": {"from": )" + pair_of(0.1 * k, 0) +
              R"(, "to": )" + pair_of(0.1 * (k + 1), 0) + "}}";
    pins += std::string(k > 0 ? ", " : "") + R"({"type": "revolute", "i": ")" +
            (k > 0 ? "l" + std::to_string(k - 1) + ".to" : "ground") + R"(", "j": ")" + name + R"(.from"})";
  }
  const std::pair<std::string, double> runs[] = {{"auto", 1e-8},  {"rk8", 1e-8},   {"rk5", 1e-8},
                                                 {"rk5", 1e-10},  {"adams", 1e-8}, {"adams", 1e-10},
                                                 {"alpha", 1e-5}, {"radau", 1e-8}, {"partitioning", 1e-8}};
  for (const auto& [method, tolerance] : runs) {
    SCOPED_TRACE(method + " " + text_of(tolerance));
    const bool is_coarse = method == "alpha";  // of order 2
    const TextRun run = run_text(R"({"catena": 1, "bodies": {)" + bodies + R"(}, "constraints": [)" + pins +
                                 R"(], "drivers": [{"type": "absolute_angle", "name": "D", "i": "l0", "value": {"law":
        {"type": "cycloidal", "t0": 0.2, "t1": 0.8, "from": 0, "to": 0.3}}}],
      "outputs": ["D.work", "energy.kinetic"], "analyses": [)" +
                                 motion(method, 1, 0.1, tolerance));
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
    const std::vector<double> work = run.column("D.work"), kinetic = run.column("energy.kinetic");
    const double most = *std::max_element(kinetic.begin(), kinetic.end());
    for (std::size_t k = 0; k < work.size(); ++k)
      EXPECT_NEAR(work[k], kinetic[k], (is_coarse ? 1e-4 : 1e-6) * most) << k;
  }
}

// The pulse begins with 1e-289 N m, of which squares are zero.
TEST(WorkOfDrivers, UnderATorqueThatBeginsWithNextToNothing) {
  const std::string torque = R"js({"type": "torque", "i": "b", "torque": "=5*exp(-((t-3.3)*20)^2)"})js";
  for (const std::string method : {"auto", "rk8", "partitioning", "baumgarte", "radau"}) {
    SCOPED_TRACE(method);
    const TextRun run = run_text(wheel("", "", torque) + motion(method, 10, 5));
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
    EXPECT_NEAR(run.last("D.work"), -speed * 5 * std::sqrt(std::numbers::pi) / 20, 1e-6);
    EXPECT_LT(run.analysis().report.counters.steps, 1000);
  }
}

}  // namespace
}  // namespace catena::testing
