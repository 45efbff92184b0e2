// Forces that bend or jump: what drivers do against laws of state, with rows far apart. Against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A law of a place and its work from 0 to there.
struct KinkedLaw {
  std::string text;
  double (*work)(double x, double at, double width);
};

double ramp(double x) { return x > 0 ? x * x / 2 : 0; }
double clamped(double x, double at, double width) { return ramp(x - at + width) - ramp(x - at - width); }

// Of strength one; `at` is where they bend, `width` how far from there again.
const KinkedLaw kinked_laws[] = {
    {"max(0, X - A)", [](double x, double at, double) { return ramp(x - at); }},
    {"min(W, abs(X - A))",
     [](double x, double at, double width) {
       const double d = std::abs(x - at), inside = std::min(d, width);
       return std::copysign(inside * inside / 2 + width * (d - inside), x - at);
     }},
    {"max(0, W/20 - abs(X - A))",
     [](double x, double at, double width) {
       const double w = width / 20, d = std::min(std::abs(x - at), w);
       return std::copysign(w * d - d * d / 2, x - at);
     }},
    {"(X - A)/abs(X - A)", [](double x, double at, double) { return std::abs(x - at); }},
    {"step(X - A)", [](double x, double at, double width) { return clamped(x, at, width) - width * (x - at); }},
};

std::string put_in(std::string text, char letter, const std::string& name) {
  std::string out;
  for (const char c : text) out += c == letter ? name : std::string(1, c);
  return out;
}

// A block is driven by a sin(w t + p) against a force that bends, over a few swings with rows as far apart as they are.
// The energies balance whatever the sums are, for the driver gives what the law takes.
TEST(KinkedLaws, WorkOfDriversAgainstThem) {
  expect_no_fault(1, 150, [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double a = random(0.1, 0.6), w = random(1, 6), p = random(0, 6), until = random(1, 4);
    const double at = random(-0.4, 0.4), width = random(0.02, 0.3), strength = random(1, 10);
    const KinkedLaw& law = kinked_laws[seed % 5];
    const int rows = seed % 3 == 0 ? 40 : seed % 3 == 1 ? 2 : 5;
    std::string text = put_in(put_in(law.text, 'A', "(" + text_of(at) + ")"), 'W', text_of(width));
    text = put_in(text, 'X', "b.x");
    const TextRun run = run_text(
        R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 1}},
        "tables": {"step": {"x": )" +
        pair_of(-width, width) + R"(, "y": )" + pair_of(-width, width) + R"(, "beyond": "hold"}},
        "constraints": [{"type": "translational", "i": "ground", "j": "b", "axis_i": [1, 0]}],
        "drivers": [{"type": "absolute_x", "name": "d", "i": "b",
          "value": {"harmonic": {"amplitude": )" +
        text_of(a) + R"(, "omega": )" + text_of(w) + R"(, "phase": )" + text_of(p) + R"(}}}],
        "forces": [{"type": "point_force", "i": "b", "force": ["=-)" +
        text_of(strength) + "*(" + text + ")" + R"(", 0]}], "outputs": ["d.work"],
        "analyses": [{"type": "inverse_dynamics", "digits": false, "until": )" +
        text_of(until) + R"(, "every": )" + text_of(until / rows) + "}]}");
    if (run.outcome.exit_code != 0) return run.outcome.error_text;
    const auto x = [&](double t) { return a * std::sin(w * t + p); };
    const auto v = [&](double t) { return a * w * std::cos(w * t + p); };
    const double taken = strength * (law.work(x(until), at, width) - law.work(x(0), at, width));
    const double done = taken + v(until) * v(until) - v(0) * v(0);
    // A jump, of one or of the width, is enclosed to 1e-8 of the way.
    const double size = seed % 5 == 3 ? 1 : width;
    const double allowed = 2e-8 * (strength * size * a * w * until + a * a * w * w);
    const double off = std::abs(run.last("d.work") - done);
    return off <= allowed ? "" : text + ": " + text_of(off) + " off, allowed " + text_of(allowed);
  });
}

// The same where the law is one of the velocity: F = -s |v - u|, by the middle rule.
TEST(KinkedLaws, WorkOfDriversAgainstThoseOfVelocities) {
  expect_no_fault(1, 30, [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double a = random(0.1, 0.6), w = random(1, 6), until = random(1, 4), u = random(-1, 1) * a * w;
    const double strength = random(1, 10);
    double taken = 0, exchanged = 0;
    constexpr int parts = 400'000;
    for (int n = 0; n < parts; ++n) {
      const double v = a * w * std::cos(w * until * (n + 0.5) / parts);
      taken += strength * std::abs(v - u) * v * until / parts;
      exchanged += strength * std::abs((v - u) * v) * until / parts;
    }
    const TextRun run = run_text(
        R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 1}},
        "constraints": [{"type": "revolute", "i": "ground", "j": "b"}],
        "drivers": [{"type": "absolute_angle", "name": "d", "i": "b",
          "value": {"harmonic": {"amplitude": )" +
        text_of(a) + R"(, "omega": )" + text_of(w) + R"(}}}],
        "forces": [{"type": "torque", "i": "b", "torque": "=-)" +
        text_of(strength) + "*abs(b.omega - (" + text_of(u) + "))" + R"("}], "outputs": ["d.work"],
        "analyses": [{"type": "inverse_dynamics", "digits": false, "until": )" +
        text_of(until) + R"(, "every": )" + text_of(until / 3) + "}]}");
    if (run.outcome.exit_code != 0) return run.outcome.error_text;
    const double v = a * w * std::cos(w * until), done = taken + (v * v - a * a * w * w) / 2;
    const double off = std::abs(run.last("d.work") - done), allowed = 2e-9 * exchanged;
    return off <= allowed ? "" : text_of(off) + " off, allowed " + text_of(allowed);
  });
}

}  // namespace
}  // namespace catena::testing
