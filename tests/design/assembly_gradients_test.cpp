// Derivatives of places that assembly finds from estimates far away: in closed form, and of random mechanisms against
// differences of whole runs extrapolated to fourth order.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "design/measured.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

// A particle given at (a, b), at up to nine times its distance from the centre, is assembled to the nearest place of
// the unit circle: x = a/r, y = b/r.
TEST(FarAssemblyGradients, OfTheNearestPlaceOfACircle) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double r = seed % 2 == 0 ? random(0.1, 1) : random(1, 9);
    const double angle = random(-3, 3), a = r * std::cos(angle), b = r * std::sin(angle);
    const TextRun run = run_text(R"({"catena": 1, "parameters": {"a": )" + text_of(a) + R"(, "b": )" + text_of(b) +
                                 R"(},
    "bodies": {"bead": {"particle": true, "mass": 1, "position": ["a", "b"]}},
    "constraints": [{"type": "absolute_distance", "i": "bead", "ground": [0, 0], "value": 1}],
    "outputs": ["bead.x", "bead.y"],
    "analyses": [{"type": "sensitivity", "parameters": ["a", "b"], "of": {"type": "assemble"}}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const double r3 = r * r * r;
    EXPECT_NEAR(run.first("bead.x"), a / r, 1e-12);
    EXPECT_NEAR(run.first("bead.y"), b / r, 1e-12);
    EXPECT_NEAR(run.first("d(bead.x)/d(a)"), b * b / r3, 1e-12 / r);
    EXPECT_NEAR(run.first("d(bead.x)/d(b)"), -a * b / r3, 1e-12 / r);
    EXPECT_NEAR(run.first("d(bead.y)/d(b)"), a * a / r3, 1e-12 / r);
  }
}

// A rod on a pin, given with its end at (x, y) and the angle e: its angle phi solves
// rho^2 (phi - e) + L (x sin(phi) - y cos(phi)) = 0, rho^2 = L^2/2 of its two pins; a carriage hangs at its end.
TEST(FarAssemblyGradients, OfARodAndWhatItCarries) {
  const double x = 1.3, y = -0.45, e = -1.1, l = 0.9;
  double phi = -0.5;
  for (int k = 0; k < 20; ++k) {
    const double g = l * l / 2 * (phi - e) + l * (x * std::sin(phi) - y * std::cos(phi));
    phi -= g / (l * l / 2 + l * (x * std::cos(phi) + y * std::sin(phi)));
  }
  const double bend = l * l / 2 + l * (x * std::cos(phi) + y * std::sin(phi));
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"x": 1.3, "y": -0.45, "e": -1.1, "L": 0.9},
  "bodies": {"rod": {"mass": 1, "inertia": 0.1, "position": [0.35, 0.8], "angle": "e", "points": {"tip": ["L", 0]}},
             "load": {"mass": 1, "inertia": 0.1, "position": ["x", "y"], "angle": 2}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "rod"},
                  {"type": "revolute", "i": "rod.tip", "j": "load"}],
  "outputs": ["rod.angle", "load.angle"],
  "analyses": [{"type": "sensitivity", "parameters": ["x", "y", "e", "L"], "of": {"type": "assemble"}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.first("rod.angle"), phi, 1e-12);
  EXPECT_NEAR(run.first("load.angle"), 2, 1e-12);
  EXPECT_NEAR(run.first("d(rod.angle)/d(x)"), -l * std::sin(phi) / bend, 1e-12);
  EXPECT_NEAR(run.first("d(rod.angle)/d(y)"), l * std::cos(phi) / bend, 1e-12);
  EXPECT_NEAR(run.first("d(rod.angle)/d(e)"), l * l / 2 / bend, 1e-12);
  const double by_length = l * (phi - e) + x * std::sin(phi) - y * std::cos(phi);
  EXPECT_NEAR(run.first("d(rod.angle)/d(L)"), -by_length / bend, 1e-12);
}

struct Estimate {
  std::string name;
  double value;
};

/// Rods in a row, a carriage on a guide or a point on a circle at the end; drawn anywhere about where they end.
struct FarMechanism {
  std::vector<Estimate> parameters;
  std::string body, outputs;

  explicit FarMechanism(RandomNumbers& random) {
    const int links = 1 + static_cast<int>(random(0, 3.99));
    parameters = {{"l", random(0.4, 0.8)}, {"off", random(-0.4, 0.4)}, {"turn", random(-0.8, 0.8)}};
    double x = 0, y = 0;
    std::string bodies, constraints = R"({"type": "revolute", "i": "ground", "j": "b0"})";
    for (int n = 0; n < links; ++n) {
      const std::string name = "b" + std::to_string(n);
      const double angle = random(-1.5, 1.5), dx = random(-0.3, 0.3), dy = random(-0.3, 0.3);
      const double share = random(-1, 1), share_of_turn = random(-1, 1), length = random(0.7, 1.3);
      bodies += (n > 0 ? ", \"" : "\"") + name + R"(": {"mass": 1, "inertia": 0.1, "position": ["=)" + text_of(x + dx) +
                " + off*" + text_of(share) + "\", \"=" + text_of(y + dy) + " - l*" + text_of(share / 3) +
                R"("], "angle": "=)" + text_of(angle) + " + turn*" + text_of(share_of_turn) +
                R"(", "points": {"tip": ["=l*)" + text_of(length) + "\", 0]}" + held(n, random) + "}";
      if (n > 0)
        constraints += R"(, {"type": "revolute", "i": "b)" + std::to_string(n - 1) + R"(.tip", "j": ")" + name + "\"}";
      outputs += (n > 0 ? ", \"" : "\"") + name + ".x\", \"" + name + ".angle\"";
      x += 0.6 * length * std::cos(angle);
      y += 0.6 * length * std::sin(angle);
    }
    const double kind = random(0, 1);
    if (links > 1 && kind < 0.4)
      constraints += R"(, {"type": "absolute_y", "i": "b)" + std::to_string(links - 1) + R"(.tip", "value": "=off/3"})";
    else if (links > 1 && kind < 0.7)
      constraints += R"(, {"type": "absolute_distance", "i": "b)" + std::to_string(links - 1) +
                     R"(.tip", "ground": [0.5, 0.2], "value": "=0.5*l"})";
    body = R"("bodies": {)" + bodies + R"(}, "constraints": [)" + constraints + "]";
  }

  /// One rod in some is held at its angle.
  std::string held(int number, RandomNumbers& random) const {
    const double draw = random(0, 1);
    return number == 1 && draw < 0.15 ? R"(, "hold": ["angle"])" : "";
  }

  std::string text(const std::vector<Estimate>& of, bool with_derivatives) const {
    std::string numbers, names;
    for (const Estimate& p : of) {
      numbers += (numbers.empty() ? "\"" : ", \"") + p.name + "\": " + text_of(p.value);
      names += (names.empty() ? "\"" : ", \"") + p.name + "\"";
    }
    const std::string assemble = R"({"type": "assemble"})";
    return R"({"catena": 1, "parameters": {)" + numbers + "}, " + body + R"(, "outputs": [)" + outputs +
           R"(], "analyses": [)" +
           (with_derivatives ? R"({"type": "sensitivity", "parameters": [)" + names + R"(], "of": )" + assemble + "}"
                             : assemble) +
           "]}";
  }
};

/// How many derivatives were compared.
int far_compared = 0;

std::string fault_of(const FarMechanism& mechanism) {
  const TextRun run = run_text(mechanism.text(mechanism.parameters, true));
  if (!run.outcome.error_text.empty()) return run.outcome.error_text;
  if (!run.analysis().report.ok()) return {};
  const std::vector<std::string> columns = [&] {
    std::vector<std::string> names;
    for (const char* kind : {".x", ".angle"}) {
      for (int n = 0; n < 4; ++n) {
        const std::string name = "b" + std::to_string(n) + kind;
        if (mechanism.outputs.find(name) != std::string::npos) names.push_back(name);
      }
    }
    return names;
  }();
  for (std::size_t p = 0; p < mechanism.parameters.size(); ++p) {
    for (const std::string& column : columns) {
      const double value = run.first(column);
      const double own = run.first("d(" + column + ")/d(" + mechanism.parameters[p].name + ")");
      std::array<double, 2> difference{};
      bool near = true;
      for (std::size_t level = 0; level < 2; ++level) {
        const double h = level == 0 ? 4e-4 : 2e-4;
        std::array<double, 2> beside{};
        for (std::size_t side = 0; side < 2; ++side) {
          std::vector<Estimate> moved = mechanism.parameters;
          moved[p].value += side == 0 ? -h : h;
          const TextRun there = run_text(mechanism.text(moved, false));
          beside[side] = there.outcome.exit_code == 0 ? there.first(column) : 1e9;
          // Another assembly is nearest beside: not a place that moves.
          near = near && std::abs(beside[side] - value) <= 3 * h * std::max(1.0, std::abs(own)) + 0.01;
        }
        difference[level] = (beside[1] - beside[0]) / (2 * h);
      }
      if (!near) continue;
      ++far_compared;
      // The extrapolated difference is off by the fifth derivative; runs are good to 1e-12.
      const double best = (4 * difference[1] - difference[0]) / 3;
      const double allowed = 1e-3 * std::abs(best - difference[1]) + 1e-8 * std::max(1.0, std::abs(best));
      if (std::abs(own - best) <= allowed) continue;
      return "d " + column + "/d " + mechanism.parameters[p].name + " = " + text_of(own) + ", differences " +
             text_of(best) + " +- " + text_of(allowed);
    }
  }
  return {};
}

TEST(FarAssemblyGradients, OfRandomMechanismsAreThoseOfWholeRuns) {
  far_compared = 0;
  expect_no_fault(1, size_of_test(20u, 5u), [](unsigned seed) {
    RandomNumbers random(seed);
    return fault_of(FarMechanism(random));
  });
  EXPECT_GT(far_compared, size_of_test(200, 50));
}

// A cam on a cam has no points whose distance from the centroid says how turning compares with moving: its own size
// does, and not that of what stands beside it and is not tied to it.
TEST(AssembledPlaces, OfABodyOnCurvesAreThoseWithoutWhatStandsBeside) {
  const auto assembled = [](bool beside) {
    const std::string other = R"(, "w": {"mass": 1, "inertia": 1, "position": [9, 9]})";
    const std::string pin = R"(, {"type": "revolute", "i": ["ground", [9, 4]], "j": ["w", [0, -5]]})";
    return run_text(R"({"catena": 1, "bodies": {"b": {"mass": 1, "inertia": 1, "position": [2, 0.1], "angle": 0.2})" +
                    (beside ? other : "") + R"(}, "constraints": [{"type": "cam_cam", "i": "ground", "j": "b",
          "curve_i": {"circle": {"centre": [0, 0], "radius": 1}},
          "curve_j": {"circle": {"centre": [0.5, 1.5], "radius": 1.1}}})" +
                    (beside ? pin : "") +
                    R"(], "analyses": [{"type": "assemble", "outputs": ["b.x", "b.y", "b.angle"]}]})");
  };
  const TextRun alone = assembled(false), together = assembled(true);
  for (const std::string column : {"b.x", "b.y", "b.angle"})
    EXPECT_NEAR(together.last(column), alone.last(column), 1e-12) << column;
}

}  // namespace
}  // namespace catena::testing
