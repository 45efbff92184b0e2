// Gradients of motions with elastic cables and ropes that become taut and slack: closed forms by complex steps, both
// ways; none, and a reason, where a law of state reads the cable.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "analysis/sanitized.hpp"
#include "design/measured.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Complex = std::complex<double>;

/// A weight m below a cable of stiffness k and length l, which leaves y upwards by v and only sways up and down.
struct Hanging {
  Complex k, l, m, v, y;

  /// y and y' at t: piece by piece of the parabola where the cable is slack, of the swing where it is taut.
  std::array<Complex, 2> at(double t) const {
    const double g = 9.81;
    const Complex w = std::sqrt(k / m), sag = m * g / k;
    Complex place = y, speed = v, left = t;
    while (true) {
      const bool taut = place.real() < -l.real() || (std::abs(place.real() + l.real()) < 1e-14 && speed.real() < 0);
      const Complex a = place + l + sag, b = speed / w;
      // Both roads end at y = -l: downwards, and upwards half a turn less what lies above the middle later.
      Complex lasts;
      if (!taut) {
        lasts = (speed + std::sqrt(speed * speed + 2 * g * (place + l))) / g;
      } else {
        // Arcs by the tangents of their halves, which leave a small imaginary part what it is.
        const Complex size = std::sqrt(a * a + b * b), start = 2.0 * std::atan(-b / (size + a));
        const Complex end = 2.0 * std::atan(std::sqrt((size - sag) / (size + sag)));
        lasts = (2 * std::numbers::pi - end - start) / w;
        if (lasts.real() * w.real() > 2 * std::numbers::pi) lasts -= 2 * std::numbers::pi / w;
        if (size.real() < sag.real()) lasts = std::numeric_limits<double>::infinity();
      }
      if (lasts.real() >= left.real()) {
        if (!taut) return {place + speed * left - g / 2 * left * left, speed - g * left};
        const Complex c = std::cos(w * left), s = std::sin(w * left);
        return {-l - sag + a * c + b * s, w * (b * c - a * s)};
      }
      if (!taut) {
        speed -= g * lasts;
      } else {
        speed = w * (b * std::cos(w * lasts) - a * std::sin(w * lasts));
      }
      place = -l;
      left -= lasts;
    }
  }
};

constexpr std::array<const char*, 5> hanging_parameters = {"k", "l", "m", "v", "y"};
Complex& part(Hanging& hanging, std::size_t p) {
  return *std::array{&hanging.k, &hanging.l, &hanging.m, &hanging.v, &hanging.y}[p];
}

std::string scene_of(Hanging hanging, double until, const std::string& mode) {
  std::string numbers;
  for (std::size_t p = 0; p < hanging_parameters.size(); ++p)
    numbers += (p > 0 ? ", \"" : "\"") + std::string(hanging_parameters[p]) + "\": " + text_of(part(hanging, p).real());
  return R"({"catena": 1, "gravity": [0, -9.81], "parameters": {)" + numbers +
         R"(}, "bodies": {"b": {"particle": true, "mass": "m", "position": [0, "y"], "velocity": [0, "v"]}},
    "constraints": [{"type": "absolute_x", "i": "b", "value": 0}],
    "forces": [{"type": "cable", "name": "c", "i": ["ground", [0, 0]], "j": "b", "length": "l", "k": "k"}],
    "analyses": [{"type": "sensitivity", "mode": ")" +
         mode + R"(", "parameters": ["k", "l", "m", "v", "y"], "of": {"type": "dynamics", "until": )" + text_of(until) +
         R"(, "tolerance": 1e-11, "measures": {"place": {"final": "b.y"}, "mean": {"mean": "b.y"})" +
         (mode == "forward" ? R"(, "pull": {"max": "c.force"})" : "") + "}}}]}";
}

/// A motion whose ends and kinks lie apart.
Hanging draw(RandomNumbers& random, double& until) {
  Hanging hanging;
  hanging.k = random(300, 1500);
  hanging.l = random(0.4, 0.9);
  hanging.m = random(0.5, 2);
  hanging.v = random(-2, 2);
  hanging.y = -hanging.l.real() + random(0.05, 0.4);
  until = random(0.4, 1.6);
  return hanging;
}

TEST(CableGradients, OfOneThatBecomesTautAndSlack) {
  expect_no_fault(1, size_of_test(24u, 4u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    double until = 0;
    const Hanging hanging = draw(random, until);
    const TextRun run = run_text(scene_of(hanging, until, seed % 2 == 0 ? "forward" : "adjoint"));
    if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
    // The same pull comes again with every bounce, which the way back does not tell apart.
    if (went_back(run) != (seed % 2 == 1)) return "the other way";
    for (const auto& field : run.analysis().fields) {
      if (field.name == "events") return "a kink is told as an event";
    }
    const double step = 1e-30, g = 9.81;
    if (std::abs(value(run, "place") - hanging.at(until)[0].real()) > 1e-9)
      return "place is " + text_of(value(run, "place"));
    // The first time that it is taut tells all of the pull: the energy stays.
    const bool pulls = !went_back(run) && measure(run, "pull").t.value_or(0) > 0;
    for (std::size_t p = 0; p < hanging_parameters.size(); ++p) {
      Hanging beside = hanging;
      part(beside, p) += Complex(0, step);
      const double by_y = beside.at(until)[0].imag() / step;
      const Complex fall = beside.v * beside.v + 2 * g * (beside.y + beside.l), weight = beside.m * g;
      const Complex most = weight + std::sqrt(weight * weight + beside.k * beside.m * fall);
      // Of the mean by the trapezoidal rule's own limit: 4000 intervals, kinks within leave h^3.
      double mean = 0;
      constexpr int parts = 4000;
      for (int n = 0; n <= parts; ++n)
        mean += beside.at(until * n / parts)[0].imag() / step / parts * (n == 0 || n == parts ? 0.5 : 1);
      const std::array<std::pair<const char*, double>, 3> expected{
          {{"place", by_y}, {"mean", mean}, {"pull", most.imag() / step}}};
      for (const auto& [name, slope] : expected) {
        const bool is_pull = std::string(name) == "pull";
        // The largest is reached only if the swing passed its lowest point.
        if (is_pull && (!pulls || std::abs(value(run, name) - most.real()) > 1e-6 * most.real())) continue;
        const double allowed = (std::string(name) == "mean" ? 2e-6 : 1e-8) * std::max(1.0, std::abs(slope));
        if (std::abs(gradient(run, name, p) - slope) <= allowed) continue;
        return std::string(name) + " by " + hanging_parameters[p] + " is " + text_of(gradient(run, name, p)) +
               ", expected " + text_of(slope) + " " + measure(run, name).trouble;
      }
    }
    return {};
  });
}

// y = -l - m g / k + a cos(w t) + v / w sin(w t) about where it would rest.
TEST(CableGradients, OfOneThatStaysTaut) {
  Hanging hanging{800, 0.7, 1.3, 0.05, -0.715};
  for (const std::string mode : {"forward", "adjoint"}) {
    const TextRun run = run_text(scene_of(hanging, 0.5, mode));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(value(run, "place"), hanging.at(0.5)[0].real(), 1e-10);
    for (std::size_t p = 0; p < hanging_parameters.size(); ++p) {
      Hanging beside = hanging;
      part(beside, p) += Complex(0, 1e-30);
      EXPECT_NEAR(gradient(run, "place", p), beside.at(0.5)[0].imag() / 1e-30, 1e-10) << hanging_parameters[p];
    }
  }
}

// The same weight on a rope over a pulley, whose other end is held: 0.7 m hang below the pulley where it is taut.
TEST(CableGradients, OfARopeOverAPulleyThatBecomesTautAndSlack) {
  for (const double y : {-0.3, -0.715}) {
    Hanging hanging{800, 0.7, 1.3, 0.05, y};
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"k": 800, "l": 0.7, "m": 1.3, "v": 0.05, "y": )" +
        text_of(y) + R"(}, "bodies": {
        "b": {"particle": true, "mass": "m", "position": [0.1, "y"], "velocity": [0, "v"]}},
        "constraints": [{"type": "absolute_x", "i": "b", "value": 0.1}],
        "forces": [{"type": "rope", "name": "r", "i": ["ground", [-0.1, -0.2]],
          "over": [{"at": ["ground", [0, 0]], "radius": 0.1, "side": -1}], "j": "b", "length": "=l + 0.2 + 0.1*pi",
          "k": "k"}],
        "analyses": [{"type": "sensitivity", "parameters": ["k", "l", "m", "v", "y"], "of": {"type": "dynamics",
          "until": 0.9, "tolerance": 1e-11, "measures": {"place": {"final": "b.y"}}}}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(value(run, "place"), hanging.at(0.9)[0].real(), 1e-9);
    for (std::size_t p = 0; p < hanging_parameters.size(); ++p) {
      Hanging beside = hanging;
      part(beside, p) += Complex(0, 1e-30);
      const double slope = beside.at(0.9)[0].imag() / 1e-30;
      EXPECT_NEAR(gradient(run, "place", p), slope, 1e-8 * std::max(1.0, std::abs(slope))) << hanging_parameters[p];
    }
  }
}

// A law of state reads the cable as it reads springs: then it stays a force, and steps do not end at its kink.
TEST(CableGradients, OfOneThatALawReadsAreNotGivenBeyondItsKink) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"k": 800}, "bodies": {
      "b": {"particle": true, "mass": 1.3, "position": [0, -0.3], "velocity": [0, 0.4]}},
      "constraints": [{"type": "absolute_x", "i": "b", "value": 0}],
      "forces": [{"type": "cable", "name": "c", "i": ["ground", [0, 0]], "j": "b", "length": 0.7, "k": "k"},
                 {"type": "point_force", "i": "b", "force": [0, "=-0.01*c.force"]}],
      "analyses": [{"type": "sensitivity", "parameters": ["k"], "of": {"type": "dynamics", "until": 0.5,
        "tolerance": 1e-11, "measures": {"place": {"final": "b.y"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(std::isnan(gradient(run, "place", 0)));
  EXPECT_TRUE(warns(run, "cable \"c\" has become taut")) << ::testing::PrintToString(run.analysis().report.warnings);
}

}  // namespace
}  // namespace catena::testing
