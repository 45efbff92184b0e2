// Motions that a first step could leap over: nothing moves or acts at its beginning and at its end, and in between
// forces do.
//
//   x'' = sin(2 pi t) / m, x(0) = 0, x'(0) = 0:   x = (t - sin(2 pi t) / (2 pi)) / (2 pi m)
//   x'' = a t (T - t) / m:                         x = a (T t^3 / 6 - t^4 / 12) / m
//
// And work of single drivers where several move all of the mechanism: against a spring to the ground it is the change
// of the energy in the spring, k (l - l0)^2 / 2.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

// `count` particles under a force each, of which the last one is asked for.
TextRun particles(int count, const std::string& force, const std::string& method, double until) {
  return run_text(R"({"catena": 1, "replicate": [{"count": )" + std::to_string(count) +
                  R"(, "bodies": {"p{k}": {"particle": true, "mass": 2, "position": [0, "=k"]}},
    "forces": [{"type": "point_force", "i": "p{k}", "force": [)" +
                  force + R"(, 0]}]}], "outputs": ["p)" + std::to_string(count) +
                  R"(.x"], "analyses": [{"type": "dynamics", "until": )" + text_of(until) +
                  R"(, "every": 0.5, "method": ")" + method + R"("}]})");
}

TEST(UnseenStarts, OfAForceOfWholePeriods) {
  for (const std::string method : {"adams", "alpha", "radau", "rk8", "auto"}) {
    SCOPED_TRACE(method);
    const TextRun run = particles(12, R"({"harmonic": {"amplitude": 1, "omega": 6.283185307179586}})", method, 4);
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    EXPECT_NEAR(run.last("p12.x"), 4 / (2 * pi) / 2, method == "alpha" ? 1e-5 : 1e-7);
  }
}

TEST(UnseenStarts, OfAForceThatRisesAndFalls) {
  for (const std::string method : {"adams", "alpha", "auto"}) {
    SCOPED_TRACE(method);
    const TextRun run = particles(12, "\"=5*t*(2-t)\"", method, 2);
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    EXPECT_NEAR(run.last("p12.x"), 5 * (2 * 8 / 6.0 - 16 / 12.0) / 2, method == "alpha" ? 1e-5 : 1e-7);
  }
}

// A rod whose driver rests until 0.2 s and from 0.8 s on: the torque of gravity does not matter, its spring does.
TEST(UnseenStarts, OfADriverThatRestsBeforeAndAfter) {
  for (const std::string method : {"adams", "rk8"}) {
    SCOPED_TRACE(method);
    const TextRun run = run_text(R"({"catena": 1, "bodies": {"r": {"mass": 2, "inertia": 0.5}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "r"}],
      "drivers": [{"type": "absolute_angle", "name": "D", "i": "r",
        "value": {"law": {"type": "cycloidal", "t0": 0.2, "t1": 0.8, "from": 0, "to": 1}}}],
      "forces": [{"type": "torsion_spring", "i": "ground", "j": "r", "k": 3}],
      "outputs": ["r.angle", "D.work"], "analyses": [{"type": "dynamics", "until": 1, "every": 0.1, "method": ")" +
                                 method + R"("}]})");
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    EXPECT_NEAR(run.last("D.work"), 1.5, 1e-6);
    EXPECT_NEAR(run.column("r.angle").at(5), 0.5, 1e-6);
  }
}

TEST(UnseenStarts, WorkOfSingleDriversOfSeveral) {
  const double speed[2] = {3.627180734018202, -0.606107222535142}, k[2] = {37.7, 202.4};
  const auto energy = [&](int wheel, double t) {
    const double angle = speed[wheel] * t;
    const double length = std::hypot(0.3 * std::cos(angle) - 0.1, 0.3 * std::sin(angle) - 0.6);
    return k[wheel] / 2 * (length - 0.3) * (length - 0.3);
  };
  std::string text = R"({"catena": 1, "bodies": {"b0": {"mass": 1, "inertia": 0.1}, "b1": {"mass": 1, "inertia": 0.1}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "b0"}, {"type": "revolute", "i": "ground", "j": "b1"}],
    "drivers": [)";
  for (int w = 0; w < 2; ++w)
    text += std::string(w ? "," : "") + R"({"type": "absolute_angle", "name": "D)" + std::to_string(w) +
            R"(", "i": "b)" + std::to_string(w) + R"(", "value": {"polynomial": [0, )" + text_of(speed[w]) + "]}}";
  text += R"(], "forces": [)";
  for (int w = 0; w < 2; ++w)
    text += std::string(w ? "," : "") + R"({"type": "spring_damper", "i": ["b)" + std::to_string(w) +
            R"(", [0.3, 0]], "j": ["ground", [0.1, 0.6]], "length": 0.3, "k": )" + text_of(k[w]) + "}";
  text +=
      R"(], "outputs": ["D0.work", "D1.work"], "analyses": [{"type": "dynamics", "until": 5, "every": 1, "method": ")";
  for (const std::string method : {"auto", "rk8", "rk5", "adams", "radau"}) {
    SCOPED_TRACE(method);
    const TextRun run = run_text(text + method + R"("}]})");
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    for (int w = 0; w < 2; ++w)
      EXPECT_NEAR(run.last("D" + std::to_string(w) + ".work"), energy(w, 5) - energy(w, 0), 2e-6) << w;
  }
}

}  // namespace
}  // namespace catena::testing
