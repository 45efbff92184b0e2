// Paths of a particle on springs and elastic cables, one of whose feet the parameter moves: cables become taut and
// slack on the way, and the path has corners.
//
//   m g + sum k_i (l_i - L_i) u_i = 0,   a cable pulls alone       solved here by Newton's method in small steps of p
//
// A case counts where both stiffnesses are above zero in each of these steps: the path goes to its end, and its rows
// are the places found here.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct HeldParticle {
  struct Line {
    double x, y, k, length;
    bool cable;
  };
  std::vector<Line> lines;
  double weight = 1, to = 1;
  bool stop = false;  // one that is never met

  explicit HeldParticle(unsigned seed) {
    RandomNumbers random(seed);
    const int count = 2 + static_cast<int>(seed % 3);
    for (int k = 0; k < count; ++k) {
      const double angle = random(0, 6.283), radius = random(0.6, 1.6);
      const double stiffness = std::pow(10.0, random(1, 2.3)), part = random(0.7, 1.3), kind = random(0, 1);
      lines.push_back(
          {radius * std::cos(angle), -1 + radius * std::sin(angle), stiffness, radius * part, k == 0 || kind < 0.4});
    }
    weight = random(0, 20);
    to = random(1, 4) * (seed % 2 ? 1 : -1);
    stop = seed % 4 < 2;
  }
  double foot(const Line& line, double p) const { return line.x + (&line == lines.data() ? 0.3 * p : 0); }

  /// The place at p from a place near it; none where a stiffness is not above zero.
  std::optional<std::array<double, 2>> solve(double p, std::array<double, 2> z) const {
    for (int round = 0; round < 60; ++round) {
      double fx = 0, fy = -weight, xx = 0, xy = 0, yy = 0;
      for (const Line& line : lines) {
        const double dx = z[0] - foot(line, p), dy = z[1] - line.y, l = std::hypot(dx, dy);
        if (line.cable && l <= line.length) continue;
        const double across = line.k * (1 - line.length / l), along = line.k * line.length / (l * l * l);
        fx -= across * dx;
        fy -= across * dy;
        xx += across + along * dx * dx;
        xy += along * dx * dy;
        yy += across + along * dy * dy;
      }
      const double det = xx * yy - xy * xy;
      if (!(det > 0) || !(xx > 0)) return std::nullopt;
      const double mx = (yy * fx - xy * fy) / det, my = (xx * fy - xy * fx) / det;
      z = {z[0] + mx, z[1] + my};
      if (std::hypot(mx, my) <= 1e-13) return z;
    }
    return std::nullopt;
  }
  std::string text() const {
    std::string forces;
    for (const Line& line : lines) {
      const std::string x = &line == lines.data() ? "\"=" + text_of(line.x) + "+0.3*P\"" : text_of(line.x);
      forces += std::string(R"({"type": ")") + (line.cable ? "cable" : "spring_damper") + R"(", "i": ["ground", [)" +
                x + ", " + text_of(line.y) + R"(]], "j": "b", "k": )" + text_of(line.k) + R"(, "length": )" +
                text_of(line.length) + "},";
    }
    return R"({"catena": 1, "parameters": {"P": 0}, "bodies": {"b": {"particle": true, "mass": 1, "position": [0, -1]}},
      "forces": [)" +
           forces + (stop ? R"({"type": "stop", "column": "b.y", "min": -9, "max": 9},)" : "") +
           R"({"type": "point_force", "i": "b", "force": [0, )" + text_of(-weight) +
           R"(]}], "outputs": ["b.x", "b.y"], "analyses": [{"type": "equilibrium"}, {"type": "path", "parameter": "P",
           "to": )" +
           text_of(to) + "}]}";
  }
};

/// Whether the case counts, and what is wrong.
bool counts(unsigned seed, std::string& fault) {
  const HeldParticle particle(seed);
  const TextRun run = run_text(particle.text());
  if (!run.analysis().report.ok()) return false;
  const std::vector<double> values = run.column("P", 1), x = run.column("b.x", 1), y = run.column("b.y", 1);
  // The start is the one that the library found; its path is followed here.
  std::array<double, 2> z{run.last("b.x"), run.last("b.y")};
  constexpr int parts = 2000;
  std::vector<std::array<double, 2>> places;
  for (int k = 0; k <= parts; ++k) {
    const std::optional<std::array<double, 2>> next = particle.solve(particle.to * k / parts, z);
    if (!next || std::hypot((*next)[0] - z[0], (*next)[1] - z[1]) > 0.02) return false;
    places.push_back(z = *next);
  }
  const Report& report = run.analysis(1).report;
  if (!report.ok()) {
    fault = std::string(to_string(report.status)) + ": " + report.message;
    return true;
  }
  for (std::size_t row = 0; row < values.size(); ++row) {
    const double p = values[row];
    const auto near = places[static_cast<std::size_t>(std::lround(std::clamp(p / particle.to, 0.0, 1.0) * parts))];
    const std::optional<std::array<double, 2>> right = particle.solve(p, near);
    if (!right || !(std::hypot((*right)[0] - x[row], (*right)[1] - y[row]) <= 1e-9)) {
      fault = "row " + std::to_string(row) + " at " + text_of(p) + " is another place";
      return true;
    }
  }
  return true;
}

TEST(PathsPastCables, GoToTheirEnd) {
  int counted = 0;
  const unsigned last = size_of_test(120u, 10u);
  for (unsigned seed = 1; seed <= last; ++seed) {
    std::string fault;
    counted += counts(seed, fault);
    EXPECT_EQ(fault, "") << seed;
  }
  EXPECT_GE(counted, size_of_test(40, 2));
}

}  // namespace
}  // namespace catena::testing
