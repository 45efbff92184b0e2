// Measures of driven motions whose rows are many turns apart: they are of the motion in time, not of its rows.
//
// References in closed form. A wheel of radius r turns by a = w t; a spring without length, of stiffness k, pulls its
// rim towards a point of the ground at the distance d from the axis, so that the driver's power is the rate of
//
//   V = k (r^2 + d^2 - 2 r d cos a) / 2
//
// The way of the slider of a slider-crank follows from its places at dead points.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>

#include "design/measured.hpp"

namespace catena::testing {
namespace {

using std::numbers::pi;
using Number = std::complex<double>;
using Wheel = std::array<Number, 4>;  // r, w, k, d
const Wheel given = {0.2, 31.8, 150, 0.5};
constexpr double aside = 1e-30, until = 5.8;

/// Measures of a wheel over 184.4 rad, by its parameters; `every`: s.
TextRun wheel(const std::string& type, const std::string& mode, double every, const std::string& measures) {
  return run_text(fmt::format(
      R"_({{"catena": 1, "parameters": {{"r": 0.2, "w": 31.8, "k": 150, "d": 0.5}},
      "tables": {{"held": {{"x": [-0.1, 0.1], "y": [-0.1, 0.1], "beyond": "hold"}}}},
      "bodies": {{"b": {{"mass": 2, "inertia": 0.1, "position": [0, 0], "points": {{"rim": ["r", 0]}}}}}},
      "constraints": [{{"type": "revolute", "i": "ground", "j": ["b", [0, 0]]}}],
      "drivers": [{{"type": "absolute_angle", "name": "D", "i": "b", "value": {{"polynomial": [0, "w"]}}}}],
      "forces": [{{"type": "spring_damper", "i": ["ground", ["d", 0]], "j": "b.rim", "k": "k", "length": 0}}],
      "analyses": [{{"type": "sensitivity", "parameters": ["r", "w", "k", "d"], "mode": "{}",
                     "of": {{"type": "{}", "until": 5.8, "every": {}, "measures": {{{}}}}}}}]}})_",
      mode, type, every, measures));
}

/// The integral over a of the size of sin a.
Number way_of_cosine(const Number& a) {
  const double halves = std::floor(a.real() / pi), sign = std::fmod(halves, 2) == 0 ? 1 : -1;
  return 2 * halves + sign * (sign - std::cos(a));
}

template <class Reference>
void expect_measure(const TextRun& run, const std::string& name, const Reference& reference, double tolerance) {
  const double size = std::abs(reference(given));
  EXPECT_NEAR(value(run, name), reference(given).real(), tolerance * size) << name;
  for (std::size_t p = 0; p < given.size(); ++p) {
    Wheel moved = given;
    moved[p] += Number(0, aside);
    EXPECT_NEAR(gradient(run, name, p), reference(moved).imag() / aside, 30 * tolerance * size / given[p].real())
        << name << " by " << p;
  }
}

TEST(FarRows, PowerOfADriverAgainstASpring) {
  const auto most = [](const Wheel& p) { return p[2] * p[0] * p[3] * p[1]; };
  const auto loss = [](const Wheel& p) { return p[2] * p[0] * p[3] * way_of_cosine(p[1] * until); };
  const auto mean = [&](const Wheel& p) {
    return (loss(p) + p[2] * p[0] * p[3] * (1.0 - std::cos(p[1] * until))) / 2.0 / until;
  };
  for (const double every : {until, until / 2, until / 700}) {
    for (const std::string mode : {"forward", "adjoint"}) {
      SCOPED_TRACE(fmt::format("{} every {}", mode, every));
      const TextRun run = wheel("inverse_dynamics", mode, every,
                                R"_("loss": {"integral": "=abs(D.power)"}, "mean": {"mean": "=max(D.power,0)"},
                                    "most": {"max": "=abs(D.power)"})_");
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      expect_measure(run, "loss", loss, 1e-10);
      expect_measure(run, "mean", mean, 1e-10);
      if (mode == "forward") expect_measure(run, "most", most, 1e-9);
    }
  }
}

// What is held, above zero for a twentieth of a turn alone, jumps or bends where nothing is compared.
TEST(FarRows, ColumnsThatAreHeldPulseOrJump) {
  const double a = 31.8 * until, turns = std::floor(a / (2 * pi)), rest = a - 2 * pi * turns;
  ASSERT_TRUE(rest > pi / 6 && rest < 5 * pi / 6);
  const auto above = [&](const Wheel& p) {
    const double half = std::acos(0.99);
    return p[0] / p[1] * (2 * turns + 1) * (std::sin(half) - 0.99 * half);
  };
  for (const std::string type : {"kinematics", "inverse_dynamics"}) {
    SCOPED_TRACE(type);
    const TextRun run =
        wheel(type, "forward", until,
              R"_("pulse": {"integral": "=max(b.rim.x-0.99*r,0)"}, "held": {"integral": "=held(b.rim.y)"},
            "jump": {"integral": "=b.rim.y/abs(b.rim.y)"}, "bend": {"integral": "=sqrt(b.rim.vy^2)"},
            "least": {"min": "=abs(b.rim.y-0.3*r)"}, "way": {"integral": "=abs(b.rim.vx)"},
            "square": {"rms": "=max(b.rim.vx,0)"}, "product": {"mean": "=abs(b.rim.x)*max(b.rim.y,0)"})_");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    expect_measure(run, "pulse", above, 1e-9);
    // Of 0.2 sin a, at most 0.1 in size: whole turns give nothing.
    EXPECT_NEAR(value(run, "held"), ((1 - std::cos(pi / 6)) * 0.2 + 0.1 * (rest - pi / 6)) / 31.8, 1e-11);
    EXPECT_NEAR(value(run, "jump"), rest / 31.8, 1e-9);
    EXPECT_NEAR(value(run, "bend"), 0.2 * (way_of_cosine(a + pi / 2).real() - 1), 1e-9);
    EXPECT_NEAR(value(run, "least"), 0, 1e-9);
    expect_measure(
        run, "way", [](const Wheel& p) { return p[0] * way_of_cosine(p[1] * until); }, 1e-10);
    // -0.2 w sin a from pi to 2 pi of every turn.
    EXPECT_NEAR(value(run, "square"), 0.2 * 31.8 * std::sqrt(turns * pi / 2 / a), 1e-9);
    const double part = rest < pi / 2 ? std::pow(std::sin(rest), 2) / 2 : 1 - std::pow(std::sin(rest), 2) / 2;
    EXPECT_NEAR(value(run, "product"), 0.04 * (turns + part) / a, 1e-11);
  }
}

/// The way of the slider: 2 r a half turn, and the rest.
Number way_of_slider(const Number& r, const Number& l, const Number& w, double t) {
  const auto place = [&](const Number& a) { return r * std::cos(a) + std::sqrt(l * l - std::pow(r * std::sin(a), 2)); };
  const double halves = std::floor(w.real() * t / pi);
  const Number rest = place(w * t) - place(halves * pi);
  return 2 * halves * r + (rest.real() < 0 ? -rest : rest);
}

TEST(FarRows, TheWayOfASliderOverRandomTurns) {
  std::mt19937 random(20);
  const auto between = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  for (int trial = 0; trial < 5; ++trial) {
    const double r = between(0.05, 0.2), l = r * between(1.5, 5), w = between(3, 40), t = between(0.5, 6);
    for (const std::string type : {"kinematics", "inverse_dynamics"}) {
      for (const int rows : {1, 3}) {
        SCOPED_TRACE(fmt::format("{} trial {}, {} rows", type, trial, rows));
        const TextRun run = run_text(fmt::format(
            R"_({{"catena": 1, "parameters": {{"r": {}, "l": {}, "w": {}}},
            "bodies": {{"c": {{"rod": {{"from": [0, 0], "to": ["r", 0]}}, "mass": 1}},
                        "b": {{"rod": {{"from": ["r", 0], "to": ["=r+l", 0]}}, "mass": 1}},
                        "p": {{"mass": 1, "particle": true, "position": ["=r+l", 0]}}}},
            "constraints": [{{"type": "revolute", "i": "ground", "j": "c.from"}},
                            {{"type": "revolute", "i": "c.to", "j": "b.from"}},
                            {{"type": "revolute", "i": "b.to", "j": "p"}}, {{"type": "absolute_y", "i": "p"}}],
            "drivers": [{{"type": "absolute_angle", "i": "c", "value": {{"polynomial": [0, "w"]}}}}],
            "analyses": [{{"type": "sensitivity", "parameters": ["r", "l", "w"], "of": {{"type": "{}", "until": {},
                           "every": {}, "measures": {{"way": {{"integral": "=abs(p.vx)"}}}}}}}}]}})_",
            r, l, w, type, t, t / rows));
        ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
        const double way = way_of_slider(r, l, w, t).real();
        EXPECT_NEAR(value(run, "way"), way, 1e-9 * way);
        const Number part(0, aside);
        EXPECT_NEAR(gradient(run, "way", 0), way_of_slider(r + part, l, w, t).imag() / aside, 1e-7 * way / r);
        EXPECT_NEAR(gradient(run, "way", 1), way_of_slider(r, l + part, w, t).imag() / aside, 1e-7 * way / l);
        EXPECT_NEAR(gradient(run, "way", 2), way_of_slider(r, l, w + part, t).imag() / aside, 1e-7 * way / w);
      }
    }
  }
}

// The same in lanes, where designs have rows of their own: T exp(-k) I_0(k), the mean of exp(-k (1 - cos)) over turns.
TEST(FarRows, OfASweepInLanes) {
  const TextRun run = run_text(R"_({"catena": 1, "parameters": {"w": 1},
    "bodies": {"b": {"position": [0, 0], "points": {"e": [0.3, 0]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "b", "at": [0, 0]}],
    "drivers": [{"type": "absolute_angle", "i": "b", "value": {"polynomial": [0, "w"]}}],
    "analyses": [{"type": "sweep", "over": {"w": [0.9, 1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6]},
      "of": {"type": "kinematics", "until": "=20*pi", "every": "=2*pi",
             "measures": {"m": {"integral": "=exp(-300*(1 - b.e.x/0.3))"}}}}]})_");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> found = run.column("m");
  ASSERT_EQ(found.size(), 8U);
  const double right = 20 * pi * std::exp(-300.0) * std::cyl_bessel_i(0.0, 300.0);
  for (const double m : found) EXPECT_NEAR(m, right, 1e-9);
}

}  // namespace
}  // namespace catena::testing
