// Gradients of motions with contacts whose force is a power of the depth that is no whole number, against the motion
// integrated in the root of time, s = theta^2, in which all is smooth, with complex parameters: derivatives by complex
// steps.
#include <gtest/gtest.h>

#include <array>
#include <complex>

#include "analysis/sanitized.hpp"
#include "design/measured.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Complex = std::complex<double>;

/// A ball that falls from h with v downwards on a floor m d'' = m g - k d^n - c d'.
struct Fall {
  static constexpr std::array<const char*, 7> names{"g", "h", "v", "m", "k", "n", "c"};
  std::array<Complex, 7> value{};
  double until = 0;

  /// y at the end, its integral, the integral of the force, the root mean square of y'.
  std::array<Complex, 4> measures() const {
    const auto& [g, h, v, m, k, n, c] = value;
    const Complex touch = (std::sqrt(v * v + 2.0 * g * h) - v) / g, root = std::sqrt(until - touch);
    const auto slope = [&, &g = g, &m = m, &k = k, &n = n, &c = c](Complex theta, const std::array<Complex, 5>& y) {
      const Complex force = (y[0] == 0.0 ? Complex(0) : k * std::pow(y[0], n)) + c * y[1], q = 2.0 * theta;
      return std::array<Complex, 5>{q * y[1], q * (g - force / m), q * y[0], q * force, q * y[1] * y[1]};
    };
    // Runge and Kutta's method of order 4: the force is of order theta^3 and better, the end right to 1e-12.
    constexpr int steps = 2000;
    const Complex l = root / static_cast<double>(steps);
    std::array<Complex, 5> y{0, v + g * touch, 0, 0, 0};
    const auto moved = [&y](const std::array<Complex, 5>& by, Complex factor) {
      std::array<Complex, 5> sum = y;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * by[i];
      return sum;
    };
    for (int step = 0; step < steps; ++step) {
      const Complex theta = static_cast<double>(step) * l;
      const auto k1 = slope(theta, y), k2 = slope(theta + l / 2.0, moved(k1, l / 2.0)),
                 k3 = slope(theta + l / 2.0, moved(k2, l / 2.0)), k4 = slope(theta + l, moved(k3, l));
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += l / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
    const Complex above = h * touch - v * touch * touch / 2.0 - g * touch * touch * touch / 6.0;
    const Complex squares = (std::pow(v + g * touch, 3) - v * v * v) / (3.0 * g);
    return {-y[0], above - y[2], y[3], std::sqrt((squares + y[4]) / until)};
  }
  /// Of these by every parameter.
  std::array<std::array<double, 4>, 7> slopes() const {
    std::array<std::array<double, 4>, 7> slopes{};
    for (std::size_t p = 0; p < value.size(); ++p) {
      Fall beside = *this;
      beside.value[p] += Complex(0, 1e-30);
      const std::array<Complex, 4> moved = beside.measures();
      for (std::size_t m = 0; m < moved.size(); ++m) slopes[p][m] = moved[m].imag() / 1e-30;
    }
    return slopes;
  }
};

std::string text_of_fall(const Fall& fall, const std::string& mode, double tolerance) {
  std::string values, names;
  for (std::size_t p = 0; p < fall.value.size(); ++p) {
    values += (p > 0 ? ", \"" : "\"") + std::string(Fall::names[p]) + "\": " + text_of(fall.value[p].real());
    names += (p > 0 ? ", \"" : "\"") + std::string(Fall::names[p]) + "\"";
  }
  return R"({"catena": 1, "parameters": {)" + values + R"(}, "gravity": [0, "=-g"],
    "bodies": {"b": {"particle": true, "mass": "m", "position": [0, "h"], "velocity": [0, "=-v"]}},
    "constraints": [{"type": "absolute_x", "i": "b", "value": 0}],
    "forces": [{"type": "contact", "name": "F", "i": "ground", "j": "b", "k": "k", "c": "c", "exponent": "n",
                "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
    "analyses": [{"type": "sensitivity", "mode": ")" +
         mode + R"(", "parameters": [)" + names + R"(], "of": {"type": "dynamics", "until": )" + text_of(fall.until) +
         R"(, "every": 0.1, "tolerance": )" + text_of(tolerance) + R"(, "measures": {"y": {"final": "b.y"},
      "way": {"integral": "b.y"}, "push": {"integral": "F.force"}, "speed": {"rms": "b.vy"}}}}]})";
}

/// Derivatives are to be right to ten times the tolerance of the run, by their own size or what measure and parameter
/// make of it.
std::string fault_of(const Fall& fall, double tolerance) {
  const auto expected = fall.measures();
  const auto slopes = fall.slopes();
  const std::array<std::string, 4> measures{"y", "way", "push", "speed"};
  for (const std::string mode : {"forward", "adjoint"}) {
    const TextRun run = run_text(text_of_fall(fall, mode, tolerance));
    if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
    if (field<std::string>(run, "mode") != mode)
      return "not by the " + mode + ::testing::PrintToString(run.analysis().report.warnings);
    for (std::size_t m = 0; m < measures.size(); ++m) {
      for (std::size_t p = 0; p < fall.value.size(); ++p) {
        const double slope = slopes[p][m], found = gradient(run, measures[m], p);
        const double by = std::max(std::abs(fall.value[p].real()), 1e-3);
        const double unit = std::max(std::abs(slope), std::abs(expected[m]) / by);
        if (std::abs(found - slope) <= 10 * tolerance * unit) continue;
        return mode + ": d " + measures[m] + "/d " + Fall::names[p] + " = " + text_of(found) +
               " by n = " + text_of(fall.value[5].real()) + ", c = " + text_of(fall.value[6].real()) + ", expected " +
               text_of(slope);
      }
    }
  }
  return {};
}

Fall random_fall(unsigned seed, bool damped) {
  RandomNumbers random(seed);
  Fall fall;
  fall.value[0] = random(8, 11);
  fall.value[1] = random(0.2, 0.6);
  fall.value[2] = random(0.01, 1);
  fall.value[3] = random(0.5, 2);
  fall.value[4] = random(2e3, 4e4);
  fall.value[5] = random(1.1, 2.9);
  fall.value[6] = damped ? random(0.5, 5) : 0;
  // A tenth of a time in which the ball would come through by the way that it sinks in.
  const auto& [g, h, v, m, k, n, c] = fall.value;
  const double speed = std::sqrt((v * v + 2.0 * g * h).real()), touch = (speed - v.real()) / g.real();
  const double order = n.real() + 1, depth = std::pow(order * m.real() * speed * speed / (2 * k.real()), 1 / order);
  fall.until = touch + random(0.1, 1) * depth / speed;
  return fall;
}

TEST(PowerContactGradients, OfUndampedFloors) {
  expect_no_fault(1, size_of_test(6u, 1u), [](unsigned seed) { return fault_of(random_fall(seed, false), 1e-8); });
}
TEST(PowerContactGradients, OfDampedFloors) {
  expect_no_fault(1, size_of_test(6u, 1u), [](unsigned seed) { return fault_of(random_fall(seed, true), 1e-8); });
}
TEST(PowerContactGradients, AtSmallTolerances) {
  expect_no_fault(1, size_of_test(3u, 1u), [](unsigned seed) { return fault_of(random_fall(seed, true), 1e-11); });
}

// Hertz's law without weight: the ball leaves at the speed at which it came, after (2 d / v) sqrt(pi) G(1 + a) / G(1/2
// + a), a = 1 / (n + 1), d the depth at which it turns, m v^2 / 2 = k d^(n+1) / (n + 1).
TEST(PowerContactGradients, OfBallsThatHaveLeft) {
  expect_no_fault(1, size_of_test(8u, 2u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double h = random(0.05, 0.2), v = random(0.5, 2), m = random(0.5, 2), k = random(5e3, 5e4);
    const double n = random(1.1, 2.9), a = 1 / (n + 1);
    const double depth = std::pow((n + 1) * m * v * v / (2 * k), a);
    const double pressed = 2 * depth / v * std::sqrt(std::acos(-1.0)) * std::tgamma(1 + a) / std::tgamma(0.5 + a);
    const double until = h / v + pressed + random(0.02, 0.1), after = until - h / v - pressed;
    const TextRun run =
        run_text(R"({"catena": 1, "parameters": {"h": )" + text_of(h) + R"(, "v": )" + text_of(v) + R"(, "m": )" +
                 text_of(m) + R"(, "k": )" + text_of(k) +
                 R"(}, "bodies": {"b": {"particle": true, "mass": "m", "position": [0, "h"], "velocity": [0, "=-v"]}},
        "constraints": [{"type": "absolute_x", "i": "b", "value": 0}],
        "forces": [{"type": "contact", "name": "F", "i": "ground", "j": "b", "k": "k", "exponent": )" +
                 text_of(n) + R"(, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
        "analyses": [{"type": "sensitivity", "parameters": ["h", "v", "m", "k"], "of": {"type": "dynamics", "until": )" +
                 text_of(until) +
                 R"(, "tolerance": 1e-9, "measures": {"y": {"final": "b.y"}, "t": {"field": "events[2].t"}}}}]})");
    if (run.outcome.exit_code != 0) return run.outcome.error_text;
    // The time on the floor goes with v^(2 a - 1) (m / k)^a.
    const std::array<double, 4> leaves{1 / v, -h / (v * v) + (2 * a - 1) * pressed / v, a * pressed / m,
                                       -a * pressed / k};
    const std::array<double, 4> size{h, v, m, k};
    for (std::size_t p = 0; p < 4; ++p) {
      const double slope = -v * leaves[p] + (p == 1 ? after : 0), unit = std::max(std::abs(slope), v * after / size[p]);
      if (!(std::abs(gradient(run, "y", p) - slope) <= 1e-8 * unit))
        return "y by " + std::to_string(p) + ": " + text_of(gradient(run, "y", p)) + ", expected " + text_of(slope);
      if (!(std::abs(gradient(run, "t", p) - leaves[p]) <= 1e-8 * std::max(std::abs(leaves[p]), pressed / size[p])))
        return "t by " + std::to_string(p) + ": " + text_of(gradient(run, "t", p)) + ", expected " + text_of(leaves[p]);
    }
    return {};
  });
}

// d (d^n) / dn = d^n ln d, of a linear floor whose exponent is a parameter as well.
TEST(PowerContactGradients, ByTheExponentOfALinearFloor) {
  Fall fall;
  fall.value = {9.81, 0.3, 0.2, 1.2, 5e3, 1.0, 2.0};
  fall.until = 0.25;
  EXPECT_EQ(fault_of(fall, 1e-9), "");
}

}  // namespace
}  // namespace catena::testing
