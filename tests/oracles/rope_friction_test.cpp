// Ropes that slide over pulleys with friction against closed forms (Euler and Eytelwein), and Runge and Kutta's method
// of order four on equations of the tests' own. Tackles: rope_friction_tackles_test.cpp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "oracles/rope_friction_scenes.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

using namespace rope_friction;

/// Two weights on a rope over a drum of the ground: both hang, a on the left (end i).
struct Atwood {
  double ma, mb, mu, r = 0.2, ya = -2, yb = -2, v = 0;  // v: of b downwards
  std::string k = "";
  std::string text(double t) const {
    return scene(
        weight("a", ma, -r, ya, 0, v) + "," + weight("b", mb, r, yb, 0, -v), "",
        fmt::format(R"({{"type": "rope", "name": "rope", "i": "a", "over": [{{"at": ["ground", [0, 0]], "radius":
      {:.17g}, "side": -1, "mu": {:.17g}}}], "j": "b"{}}})",
                    r, mu, k),
        R"("a.y", "b.y", "b.vy", "rope.force", "rope.force_j", "rope.length", "energy.dissipated", "energy.balance")",
        dynamics(t));
  }
};

TEST(RopeFriction, AtwoodsMachineSlides) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Atwood at{.ma = random(0.5, 2), .mb = 0, .mu = random(0.05, 0.6), .r = random(0.05, 0.3)};
    const double e = std::exp(at.mu * pi), t = 0.3;
    at.mb = at.ma * e * random(1.1, 2);
    const bool other_way = seed % 2 == 0;
    if (other_way) std::swap(at.ma, at.mb);
    const TextRun run = good_run(at.text(t));
    const double light = std::min(at.ma, at.mb), heavy = std::max(at.ma, at.mb);
    const double a = (heavy - light * e) / (heavy + light * e) * g, way = a * t * t / 2;
    const double low = light * (g + a), high = heavy * (g - a);
    EXPECT_NEAR(high / low, e, 1e-12 * e);
    EXPECT_NEAR(run.last("b.y"), at.yb + (other_way ? way : -way), 1e-10);
    EXPECT_NEAR(run.last("rope.force"), other_way ? high : low, 1e-9);
    EXPECT_NEAR(run.last("rope.force_j"), other_way ? low : high, 1e-9);
    EXPECT_NEAR(run.last("energy.dissipated"), (high - low) * way, 1e-8);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
  }
}

TEST(RopeFriction, TheDrumHolds) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Atwood at{.ma = random(0.5, 2), .mb = 0, .mu = random(0.05, 0.6)};
    at.mb = at.ma * std::exp(at.mu * pi * random(-0.99, 0.99));
    const TextRun run = good_run(at.text(2));
    EXPECT_NEAR(run.last("a.y"), at.ya, 1e-10);
    EXPECT_NEAR(run.last("b.vy"), 0, 1e-10);
    EXPECT_NEAR(run.last("rope.force"), at.ma * g, 1e-9);
    EXPECT_NEAR(run.last("rope.force_j"), at.mb * g, 1e-9);
    EXPECT_NEAR(run.last("energy.dissipated"), 0, 1e-12);
    EXPECT_TRUE(changes(run).empty());
  }
}

// Thrown, the heavier weight goes up until it comes to rest, and stays there or comes down again.
TEST(RopeFriction, ComesToRestAndSticksOrSlidesBack) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const bool sticks = seed % 2 == 0;
    Atwood at{.ma = random(0.5, 2), .mb = 0, .mu = random(0.05, 0.4), .v = -random(0.3, 1)};
    const double e = std::exp(at.mu * pi);
    at.mb = at.ma * (sticks ? std::pow(e, random(0.2, 0.9)) : e * random(1.2, 2));
    const double up = (at.mb * e - at.ma) / (at.mb * e + at.ma) * g;  // of b downwards, while it goes up
    const double stop = -at.v / up, way = at.v * at.v / up / 2, t = stop + 0.3;
    const double back = sticks ? 0 : (at.mb - at.ma * e) / (at.mb + at.ma * e) * g;
    const TextRun run = good_run(at.text(t));
    EXPECT_NEAR(run.last("b.y"), at.yb + way - back * 0.09 / 2, 1e-9);
    EXPECT_NEAR(run.last("b.vy"), -back * 0.3, 1e-9);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
    const std::vector<Change> all = changes(run);
    ASSERT_EQ(all.size(), sticks ? 1U : 0U);
    if (!sticks) continue;
    EXPECT_EQ(all[0].kind, "stick");
    EXPECT_NEAR(all[0].t, stop, 1e-10);
    EXPECT_NEAR(run.last("rope.force"), at.ma * g, 1e-9);
    EXPECT_NEAR(run.last("rope.force_j"), at.mb * g, 1e-9);
  }
}

// A drum on a pin takes part as long as the rope does not slip on it.
TEST(RopeFriction, ADrumThatTurns) {
  int slipped = 0, stuck = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double ma = random(0.5, 3), mb = random(0.5, 3), mu = random(0.02, 0.3), r = random(0.1, 0.3), t = 0.4;
    const double inertia = random(0.001, 0.3);
    const double e = std::exp(mu * pi);
    // Of b downwards; the drum's rim, alpha r downwards on the side of b.
    double a = (mb - ma) * g / (ma + mb + inertia / (r * r)), rim = a;
    double ta = ma * (g + a), tb = mb * (g - a);
    const bool slips = std::max(ta / tb, tb / ta) > e;
    if (slips) {
      const bool down = tb > ta;
      a = down ? (mb - ma * e) / (mb + ma * e) * g : -(ma - mb * e) / (ma + mb * e) * g;
      ta = ma * (g + a);
      tb = mb * (g - a);
      rim = (tb - ta) * r * r / inertia;
    }
    ++(slips ? slipped : stuck);
    const TextRun run = good_run(scene(
        weight("a", ma, -r, -2, 0, 0) + "," + weight("b", mb, r, -2, 0, 0) +
            fmt::format(R"(, "drum": {{"mass": 1, "inertia": {:.17g}}})", inertia),
        R"({"type": "revolute", "i": "ground", "j": "drum"})",
        fmt::format(
            R"({{"type": "rope", "name": "rope", "i": "a", "over": [{{"at": "drum", "radius": {:.17g}, "side": -1,
        "mu": {:.17g}}}], "j": "b"}})",
            r, mu),
        R"("b.y", "drum.angle", "rope.force", "rope.force_j", "energy.balance", "energy.dissipated")", dynamics(t)));
    EXPECT_NEAR(run.last("b.y"), -2 - a * t * t / 2, 1e-9);
    EXPECT_NEAR(run.last("drum.angle"), -rim * t * t / 2 / r, 1e-8);
    EXPECT_NEAR(run.last("rope.force"), ta, 1e-8);
    EXPECT_NEAR(run.last("rope.force_j"), tb, 1e-8);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
    EXPECT_NEAR(run.last("energy.dissipated"), (tb - ta) * (a - rim) * t * t / 2, 1e-8);
  }
  EXPECT_GT(slipped, 5);
  EXPECT_GT(stuck, 5);
}

// Drums that do not move relative to each other slip together: their exponents add up, also where a body carries them.
TEST(RopeFriction, DrumsBesideEachOtherAreOne) {
  for (const bool carried : {false, true}) {
    const double mu1 = 0.1, mu2 = 0.25, r = 0.1, ma = 1, e = std::exp((mu1 + mu2) * pi / 2), t = 0.3;
    const double mb = 1.3 * e * ma, a = (mb - ma * e) / (mb + ma * e) * g;
    const std::string at = carried ? "frame" : "ground";
    const TextRun run = good_run(scene(
        weight("a", ma, -1 - r, -2, 0, 0) + "," + weight("b", mb, 1 + r, -2, 0, 0) +
            (carried ? R"(, "frame": {"mass": 1, "inertia": 1})" : ""),
        carried ? R"({"type": "weld", "i": "ground", "j": "frame"})" : "",
        fmt::format(
            R"({{"type": "rope", "name": "rope", "i": "a", "over": [{{"at": ["{0}", [-1, 0]], "radius": {1}, "side":
          -1, "mu": {2}}}, {{"at": ["{0}", [1, 0]], "radius": {1}, "side": -1, "mu": {3}}}], "j": "b"}})",
            at, r, mu1, mu2),
        R"("b.y", "rope.force", "rope.force_j", "energy.balance")", dynamics(t)));
    EXPECT_NEAR(run.last("b.y"), -2 - a * t * t / 2, 1e-10);
    EXPECT_NEAR(run.last("rope.force_j") / run.last("rope.force"), e, 1e-10);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
  }
}

// A slack rope becomes taut with a jerk: both weights stop where the drum holds the impulses, else it slips in it.
TEST(RopeFriction, AJerk) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double ma = random(0.5, 2), mb = random(0.5, 2), mu = random(0.05, 0.5), r = 0.1, slack = 0.1;
    const double va = random(0.1, 1), vb = random(0.1, 1);  // both away from the drum
    const double e = std::exp(mu * pi), t = slack / (va + vb) + 0.5;
    const double ratio = mb * vb / (ma * va);
    double after = 0;  // of b away
    if (ratio > e) after = (mb * vb - e * ma * va) / (mb + e * ma);
    if (ratio < 1 / e) after = -(ma * va - e * mb * vb) / (ma + e * mb);
    // Without gravity and without tension nothing slows down what slides on.
    const TextRun run = good_run(scene(
        weight("a", ma, -r, -2, 0, -va) + "," + weight("b", mb, r, -2, 0, -vb), "",
        fmt::format(
            R"({{"type": "rope", "name": "rope", "i": "a", "over": [{{"at": "ground", "radius": {}, "side": -1, "mu":
          {:.17g}}}], "j": "b", "length": {:.17g}}})",
            r, mu, 4 + pi * r + slack),
        R"("a.vy", "b.vy", "energy.balance", "energy.dissipated")", dynamics(t), 0));
    EXPECT_NEAR(run.last("a.vy"), after, 1e-10);
    EXPECT_NEAR(run.last("b.vy"), -after, 1e-10);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-10);
    EXPECT_NEAR(run.last("energy.dissipated"), (ma * va * va + mb * vb * vb - (ma + mb) * after * after) / 2, 1e-10);
  }
}

/// Runge and Kutta's method of order four.
template <std::size_t n>
void step(std::array<double, n>& y, double h,
          const std::function<std::array<double, n>(const std::array<double, n>&)>& f) {
  const auto plus = [](std::array<double, n> a, double part, const std::array<double, n>& b) {
    for (std::size_t k = 0; k < n; ++k) a[k] += part * b[k];
    return a;
  };
  const auto k1 = f(y), k2 = f(plus(y, h / 2, k1)), k3 = f(plus(y, h / 2, k2)), k4 = f(plus(y, h, k3));
  for (std::size_t k = 0; k < n; ++k) y[k] += h / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
}

// A pendulum on a rope that runs off a drum while a weight pulls it in: the angle of contact changes with the swing.
//
//   b is l along the rope from where it leaves the drum, phi from the vertical; angle of contact pi - phi
TEST(RopeFriction, APendulumIsPulledInOverADrum) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double r = random(0.05, 0.2), mu = random(0.05, 0.3), mb = random(0.5, 1), l0 = random(1, 2);
    const double ma = mb * std::exp(mu * pi) * random(2.5, 3.5), phi0 = random(-0.6, 0.6), t = 0.3;
    // The rope comes up to the drum on the left, a at x = -r, and leaves it on the right: tangent point
    // r (cos phi, sin phi), along (sin phi, -cos phi).
    const auto place = [&](double l, double phi) {
      return std::array<double, 2>{r * std::cos(phi) + l * std::sin(phi), r * std::sin(phi) - l * std::cos(phi)};
    };
    // (length at a) + r (pi - phi) + l is constant: a moves down by s, s' = -(l' - r phi').
    //   b, along: T_b = mb (g cos phi + l phi'^2 + s'')       across: l phi'' + 2 l' phi' - r phi'^2 = -g sin phi
    //   a:        ma (g - s'') = T_a = T_b e^(mu (pi - phi))
    using Y = std::array<double, 4>;  // l, phi, rates
    const auto rates = [&](const Y& y) {
      const double e = std::exp(mu * (pi - y[1]));
      const double phi2 = -(g * std::sin(y[1]) + 2 * y[2] * y[3] - r * y[3] * y[3]) / y[0];
      const double s2 = (ma * g - e * mb * (y[0] * y[3] * y[3] + g * std::cos(y[1]))) / (ma + e * mb);
      return Y{y[2], y[3], -s2 + r * phi2, phi2};
    };
    Y y{l0, phi0, 0, 0};
    const int steps = 3000;
    for (int n = 0; n < steps; ++n) step<4>(y, t / steps, rates);
    const auto b = place(l0, phi0), end = place(y[0], y[1]);
    const TextRun run = good_run(scene(
        weight("a", ma, -r, -1, 0, 0) + "," + weight("b", mb, b[0], b[1], 0, 0), "",
        fmt::format(
            R"({{"type": "rope", "name": "rope", "i": "a", "over": [{{"at": "ground", "radius": {:.17g}, "side": -1,
          "mu": {:.17g}}}], "j": "b"}})",
            r, mu),
        R"("b.x", "b.y", "rope.force", "rope.force_j", "energy.balance")", dynamics(t)));
    EXPECT_NEAR(run.last("b.x"), end[0], 1e-8);
    EXPECT_NEAR(run.last("b.y"), end[1], 1e-8);
    EXPECT_NEAR(run.last("rope.force") / run.last("rope.force_j"), std::exp(mu * (pi - y[1])), 1e-7);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
}

// A weight hauls another one up that swings against a second drum and off it again.
TEST(RopeFriction, MeetsAndLeavesAPulley) {
  const TextRun run = good_run(scene(
      weight("a", 3, -0.1, -2, 0, 0) + "," + weight("b", 0.5, 1.2, -0.9, -0.5, 0), "",
      R"({"type": "rope", "name": "rope", "i": "a", "over": [{"at": "ground", "radius": 0.1, "side": -1, "mu": 0.2},
        {"at": ["ground", [0.15, -0.4]], "radius": 0.05, "side": 1, "mu": 0.3}], "j": "b"})",
      R"("energy.dissipated", "energy.balance")", dynamics(0.7)));
  const std::vector<Change> all = changes(run);
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const Change& change) { return change.kind == "unwrap"; }));
  EXPECT_GT(run.last("energy.dissipated"), 1);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
}

// How much of the friction a given position uses up: ln(T_out / T_in) / E.
TEST(RopeFriction, WhatHolds) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Atwood at{.ma = random(0.5, 2), .mb = random(0.5, 2), .mu = random(0.05, 0.6)};
    std::string text = at.text(1);
    text.replace(text.find(R"("outputs")"), std::string::npos,
                 R"("outputs": ["a.y"], "analyses": [{"type": "equilibrium", "friction": "hold"}]})");
    const TextRun run = good_run(text);
    const double used = std::abs(std::log(at.mb / at.ma)) / (at.mu * pi);
    EXPECT_NEAR(field<double>(run, "utilisation"), used, 1e-9);
    EXPECT_EQ(field<bool>(run, "held"), used <= 1);
  }
}

}  // namespace
}  // namespace catena::testing
