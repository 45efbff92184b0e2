// Work of drivers and loads, and the balance of energy, where forces bend within steps: laws of state that take another
// branch, elastic cables that become taut. References in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A law F(x) that bends, and its integral.
struct BentLaw {
  std::string text;
  double (*integral)(double);  // of x - b, k = 1
};
const BentLaw laws[] = {
    {"max(p.x-B,0)", [](double s) { return s > 0 ? s * s / 2 : 0; }},
    {"abs(p.x-B)", [](double s) { return s * std::abs(s) / 2; }},
    {"min(p.x-B,0)^2", [](double s) { return s < 0 ? s * s * s / 3 : 0; }},
};

/// A particle of mass m on x = A sin(w t + phase) under two such laws: the driver's work is the change of m v^2 / 2
/// less that of the integrals.
std::string fault_of_laws(unsigned seed) {
  RandomNumbers random(seed);
  const double m = random(0.5, 3), amplitude = random(0.3, 2), w = random(1, 8), phase = random(0, 6);
  const double until = random(0.5, 4);
  std::string force = "=0";
  std::vector<std::pair<const BentLaw*, std::pair<double, double>>> used;
  for (int k = 0; k < 2; ++k) {
    const BentLaw& law = laws[static_cast<int>(random(0, 2.999))];
    const double b = random(-1, 1), size = random(-200, 200);
    std::string text = law.text;
    text.replace(text.find('B'), 1, "(" + text_of(b) + ")");
    force += "+(" + text_of(size) + ")*" + text;
    used.push_back({&law, {b, size}});
  }
  const auto place = [&](double t) { return amplitude * std::sin(w * t + phase); };
  const auto speed = [&](double t) { return amplitude * w * std::cos(w * t + phase); };
  const auto energy = [&](double t) {
    double sum = m * speed(t) * speed(t) / 2;
    for (const auto& [law, of] : used) sum -= of.second * law->integral(place(t) - of.first);
    return sum;
  };
  for (const std::string method : {"rk8", "rk5", "radau", "adams"}) {
    for (const double tolerance : {1e-6, 1e-8}) {
      const TextRun run = run_text(
          R"({"catena": 1, "bodies": {"p": {"particle": true, "mass": )" + text_of(m) + R"(, "position": )" +
          pair_of(place(0), 0) +
          R"(}}, "constraints": [{"type": "absolute_y", "i": "p", "value": 0}], "drivers": [{"type": "absolute_x",
          "name": "d", "i": "p", "value": {"harmonic": {"amplitude": )" +
          text_of(amplitude) + R"(, "omega": )" + text_of(w) + R"(, "phase": )" + text_of(phase) +
          R"(}}}], "forces": [{"type": "point_force", "i": "p", "force": [")" + force +
          R"(", 0]}], "outputs": ["d.work"], "analyses": [{"type": "dynamics", "digits": false, "method": ")" + method +
          R"(", "tolerance": )" + text_of(tolerance) + R"(, "until": )" + text_of(until) + R"(, "every": 0.2}]})");
      if (!run.analysis().report.ok()) return method + ": " + run.analysis().report.message;
      const std::vector<double> t = run.column("t"), work = run.column("d.work");
      double size = m * amplitude * amplitude * w * w / 2, most = 0;
      for (std::size_t k = 0; k < t.size(); ++k) {
        const double right = energy(t[k]) - energy(0);
        size = std::max(size, std::abs(right));
        most = std::max(most, std::abs(work[k] - right));
      }
      if (!(most < 10 * tolerance * size))
        return method + " at " + text_of(tolerance) + ": off by " + text_of(most) + " J of " + text_of(size);
    }
  }
  return "";
}

TEST(WorkOfSwitchingForces, OfADriverUnderLawsThatBend) { expect_no_fault(1, size_of_test(60u, 10u), fault_of_laws); }

/// A driven rod with two elastic cables, and a second one that swings on it: cables have no part in its motion. Not by
/// adams, which looks at the ends of its steps alone: a cable that pulls for less than one is not seen.
std::string fault_of_cables(unsigned seed) {
  RandomNumbers random(seed);
  const std::string amplitude = text_of(random(0.3, 1)), w = text_of(random(2, 8));
  std::string cables;
  for (int k = 0; k < 2; ++k) {
    const double x = random(-0.5, 0.5), y = random(-0.6, 0.6), length = random(0.3, 1), stiffness = random(100, 1000);
    cables += (k > 0 ? "," : "") + std::string(R"({"type": "cable", "i": ["ground", )") + pair_of(x, y) +
              R"(], "j": "a.to", "k": )" + text_of(stiffness) + R"(, "length": )" + text_of(length) + "}";
  }
  for (const std::string method : {"rk8", "rk5", "radau", "auto"}) {
    for (const std::string tolerance : {"1e-6", "1e-8"}) {
      const TextRun run = run_text(
          R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
          "a": {"mass": 2, "rod": {"from": [0, 0], "to": [0.6, 0]}},
          "b": {"mass": 1, "rod": {"from": [0.6, 0], "to": [0.6, -0.4]}}},
          "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"},
                          {"type": "revolute", "i": "a.to", "j": "b.from"}],
          "drivers": [{"type": "absolute_angle", "i": "a", "value": {"harmonic": {"amplitude": )" +
          amplitude + R"(, "omega": )" + w + R"(}}}], "forces": [)" + cables +
          R"(], "outputs": ["b.angle", "energy.balance", "energy.kinetic"], "analyses": [{"type": "dynamics",
          "until": 1.5, "every": 0.1, "digits": false, "method": ")" +
          method + R"(", "tolerance": )" + tolerance + "}]}");
      if (!run.analysis().report.ok()) return method + " at " + tolerance + ": " + run.analysis().report.message;
    }
  }
  return "";
}

TEST(WorkOfSwitchingForces, OfADriverAgainstCablesThatPullOnDrivenBodiesAlone) {
  expect_no_fault(1, size_of_test(40u, 8u), fault_of_cables);
}

/// A weight that falls on an elastic cable again and again: free fall from h above its length, then half a swing and
/// more,
///   s = s_e (1 - cos w t) + (v / w) sin w t,   s_e = m g / k,   v^2 = 2 g h,   slack again at w t = 2 (pi - atan(v /
///   (w s_e)))
std::string fault_of_weight(unsigned seed) {
  RandomNumbers random(seed);
  const double g = 9.81, m = random(0.5, 5), k = std::pow(10, random(2.5, 5.5)), length = random(0.4, 1.5);
  const double h = random(0.1, 0.3), w = std::sqrt(k / m), v = std::sqrt(2 * g * h);
  const double fall = std::sqrt(2 * h / g), taut = 2 / w * (std::numbers::pi - std::atan(v / (w * m * g / k)));
  const int bounces = static_cast<int>(random(3, 8.99));
  const double until = bounces * (2 * fall + taut) + fall / 2;
  const double right = h - length - g * fall * fall / 8;
  for (const auto& [method, tolerance] : {std::pair<std::string, double>{"rk8", 1e-12},
                                          {"rk8", 1e-11},
                                          {"rk8", 1e-9},
                                          {"radau", 1e-10},
                                          {"radau", 1e-9},
                                          {"auto", 1e-10}}) {
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"p": {"particle": true, "mass": )" + text_of(m) +
        R"(, "position": )" + pair_of(0, h - length) +
        R"(}}, "forces": [{"type": "cable", "i": "ground", "j": "p", "k": )" + text_of(k) + R"(, "length": )" +
        text_of(length) + R"(}], "outputs": ["p.y"], "analyses": [{"type": "dynamics", "digits": false, "until": )" +
        text_of(until) + R"(, "method": ")" + method + R"(", "tolerance": )" + text_of(tolerance) + "}]}");
    const std::string where = method + " at " + text_of(tolerance) + ": ";
    if (!run.analysis().report.ok()) return where + run.analysis().report.message;
    // Rounding, too, becomes one of phase.
    if (!(std::abs(run.last("p.y") - right) < 10 * tolerance * length + 1e-11))
      return where + "off by " + text_of(run.last("p.y") - right) + " m";
  }
  return "";
}

TEST(WorkOfSwitchingForces, AWeightFallsOnAnElasticCable) {
  expect_no_fault(1, size_of_test(60u, 10u), fault_of_weight);
}

}  // namespace
}  // namespace catena::testing
