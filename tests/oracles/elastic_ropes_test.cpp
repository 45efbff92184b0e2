// Elastic ropes over pulleys that roll, and with friction over such that do not, against linear springs, closed forms,
// and Runge and Kutta's method of order four on equations of the tests' own, in which the rope slides by a return to
// the limits of its tensions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/good_run.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81, pi = std::numbers::pi;

/// Two weights on an elastic rope over a drum on a pin: a hangs on the left, b on the right, la and lb below it.
struct Drum {
  double ma, mb, inertia, r, la, lb, k, length;
  double mu = -1;                    // negative: the rope does not slip
  double va = 0, vb = 0, omega = 0;  // a and b downwards

  double way() const { return la + lb + pi * r; }
  std::string text(const std::string& analysis) const {
    const std::string grip = mu < 0 ? R"("pulley": "rolls")" : fmt::format(R"("mu": {:.17g})", mu);
    return fmt::format(
        R"({{"catena": 1, "gravity": [0, {:.17g}], "bodies": {{
      "a": {{"particle": true, "mass": {:.17g}, "position": [{:.17g}, {:.17g}], "velocity": [0, {:.17g}]}},
      "b": {{"particle": true, "mass": {:.17g}, "position": [{:.17g}, {:.17g}], "velocity": [0, {:.17g}]}},
      "drum": {{"mass": 1, "inertia": {:.17g}, "angular_velocity": {:.17g}}}}},
      "constraints": [{{"type": "revolute", "i": "ground", "j": "drum"}},
        {{"type": "absolute_x", "i": "a"}}, {{"type": "absolute_x", "i": "b"}}],
      "forces": [{{"type": "rope", "name": "rope", "i": "a", "over": [{{"at": "drum", "radius": {:.17g}, "side": -1, {}}}],
        "j": "b", "k": {:.17g}, "length": {:.17g}}}],
      "outputs": ["a.y", "b.y", "drum.angle", "rope.force", "{}", "energy.dissipated", "energy.balance"],
      "analyses": [{}]}})",
        -g, ma, -r, -la, -va, mb, r, -lb, -vb, inertia, omega, r, grip, k, length,
        mu < 0 ? "rope:2.force" : "rope.force_j", analysis);
  }
};
std::string dynamics(double t) {
  return fmt::format(R"({{"type": "dynamics", "at": [0, {:.17g}], "tolerance": 1e-11}})", t);
}

/// The same by Runge and Kutta: l_a, l_b, angle, their rates; w: how much rope has passed to the side of a.
struct Reference {
  using Y = std::array<double, 6>;
  Drum d;
  std::array<double, 2> yields, stretch;  // of the parts, at first
  Y y;
  double w = 0, dissipated = 0;
  int passages = 0;

  std::array<double, 2> tensions(const Y& at, double passed) const {
    const double turn = d.r * at[2];
    return {std::max((stretch[0] + at[0] - d.la - turn - passed) / yields[0], 0.0),
            std::max((stretch[1] + at[1] - d.lb + turn + passed) / yields[1], 0.0)};
  }
  /// What has passed, as the tensions come back to their limits.
  double passed(const Y& at) const {
    if (d.mu < 0) return 0;
    const auto [ta, tb] = tensions(at, w);
    const double e = std::exp(d.mu * pi);
    // T_b = e T_a, or T_a = e T_b, after dw to the side of a.
    if (tb > e * ta) return w + (e * ta - tb) / (1 / yields[1] + e / yields[0]);
    if (ta > e * tb) return w + (ta - e * tb) / (1 / yields[0] + e / yields[1]);
    return w;
  }
  Y rates(const Y& at) const {
    const auto [ta, tb] = tensions(at, passed(at));
    return {at[3], at[4], at[5], g - ta / d.ma, g - tb / d.mb, d.r * (ta - tb) / d.inertia};
  }
  void go(double t, int steps) {
    const double h = t / steps;
    const auto plus = [](Y a, double part, const Y& b) {
      for (std::size_t k = 0; k < a.size(); ++k) a[k] += part * b[k];
      return a;
    };
    for (int n = 0; n < steps; ++n) {
      const auto [ta, tb] = tensions(y, w);
      const Y k1 = rates(y), k2 = rates(plus(y, h / 2, k1)), k3 = rates(plus(y, h / 2, k2)), k4 = rates(plus(y, h, k3));
      for (std::size_t k = 0; k < y.size(); ++k) y[k] += h / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
      const double now = passed(y);
      const auto [na, nb] = tensions(y, now);
      dissipated += std::abs(now - w) * (std::abs(ta - tb) + std::abs(na - nb)) / 2;
      passages += now != w;
      w = now;
    }
  }
};

Reference reference(const Drum& d) {
  // With friction parts end in the middle of the arc; where the rope rolls what is on the drum stretches nothing.
  const double half = d.mu < 0 ? 0 : pi * d.r / 2;
  Reference of{.d = d, .yields = {}, .stretch = {}, .y = {d.la, d.lb, 0, d.va, d.vb, d.omega}};
  of.yields = {(d.la + half) / d.way() / d.k, (d.lb + half) / d.way() / d.k};
  const double tension = d.k * std::max(d.way() - d.length, 0.0);
  of.stretch = {of.yields[0] * tension, of.yields[1] * tension};
  return of;
}

Drum random_drum(RandomNumbers& random) {
  Drum d{.ma = random(0.5, 3),
         .mb = random(0.5, 3),
         .inertia = random(0.002, 0.1),
         .r = random(0.05, 0.3),
         .la = random(1, 3),
         .lb = random(1, 3),
         .k = random(200, 2000),
         .length = 0};
  d.length = d.way() - random(0.5, 1.5) * g * std::sqrt(d.ma * d.mb) / d.k;
  d.va = random(-0.2, 0.2);
  d.vb = random(-0.2, 0.2);
  d.omega = random(-1, 1);
  return d;
}

TEST(ElasticRopes, RollOverADrum) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const Drum d = random_drum(random);
    const double t = 0.2;
    Reference of = reference(d);
    of.go(t, 4000);
    const auto [ta, tb] = of.tensions(of.y, 0);
    const TextRun run = good_run(d.text(dynamics(t)));
    EXPECT_NEAR(run.last("a.y"), -of.y[0], 2e-8);
    EXPECT_NEAR(run.last("b.y"), -of.y[1], 2e-8);
    EXPECT_NEAR(run.last("drum.angle"), of.y[2], 2e-7);
    if (ta > 0.1 && tb > 0.1) {
      EXPECT_NEAR(run.last("rope.force"), ta, 1e-4);
      EXPECT_NEAR(run.last("rope:2.force"), tb, 1e-4);
    }
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
}

// With the inertia of the drum in between two springs swing as two coupled ones.
TEST(ElasticRopes, FrequenciesOfAtwoodsMachine) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Drum d = random_drum(random);
    d.mb = d.ma;
    d.va = d.vb = d.omega = 0;
    d.length = d.way() - d.ma * g / d.k;
    const double ka = d.k * d.way() / d.la, kb = d.k * d.way() / d.lb, rho = d.r * d.r / d.inertia;
    const double p = ka / d.ma + rho * ka, q = kb / d.mb + rho * kb;
    const double half = (p + q) / 2, root = std::sqrt((p - q) * (p - q) / 4 + rho * rho * ka * kb);
    const TextRun run = good_run(d.text(R"({"type": "modes", "count": 3})"));
    const std::vector<double> squares = run.column("omega2");
    ASSERT_EQ(squares.size(), 3U);
    EXPECT_NEAR(squares[0], 0, 1e-9 * squares[2]);
    EXPECT_NEAR(squares[1], half - root, 1e-9 * squares[2]);
    EXPECT_NEAR(squares[2], half + root, 1e-9 * squares[2]);
  }
}

// At rest each part carries what hangs on it, and the difference turns the drum against its spring.
TEST(ElasticRopes, AtRestOnADrumWithASpring) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Drum d = random_drum(random);
    const double kt = random(5, 20);
    const double ka = d.k * d.way() / d.la, kb = d.k * d.way() / d.lb, before = d.k * (d.way() - d.length);
    const double angle = d.r * (d.ma - d.mb) * g / kt;
    // T_a = before + ka (l_a - la - r angle) = ma g, and T_b alike.
    const double la = d.la + d.r * angle + (d.ma * g - before) / ka, lb = d.lb - d.r * angle + (d.mb * g - before) / kb;
    std::string text = d.text(R"({"type": "equilibrium"})");
    const std::string from = R"("forces": [)", remark = R"(, "energy.dissipated", "energy.balance")";
    text.replace(text.find(from), from.size(),
                 from + fmt::format(R"({{"type": "torsion_spring", "i": "ground", "j": "drum", "k": {:.17g}}}, )", kt));
    text.erase(text.find(remark), remark.size());
    const TextRun run = good_run(text);
    EXPECT_NEAR(run.last("drum.angle"), angle, 1e-9);
    EXPECT_NEAR(run.last("a.y"), -la, 1e-9);
    EXPECT_NEAR(run.last("b.y"), -lb, 1e-9);
    EXPECT_NEAR(run.last("rope.force"), d.ma * g, 1e-8);
    EXPECT_NEAR(run.last("rope:2.force"), d.mb * g, 1e-8);
  }
}

TEST(ElasticRopes, SlipOverADrumWithFriction) {
  int slipped = 0, stuck = 0, returned = 0;
  for (unsigned seed = 1; seed <= size_of_test(40u, 14u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Drum d = random_drum(random);
    d.mu = random(0.02, 0.25);
    // A heavy drum hardly turns, a light one goes with the rope.
    d.inertia *= seed % 3 == 0 ? 1000 : 1;
    const double t = 0.3;
    Reference of = reference(d);
    of.go(t, 12000);
    const auto [ta, tb] = of.tensions(of.y, of.w);
    ++(of.passages == 0 ? stuck : of.passages == 12000 ? slipped : returned);
    if (!(ta > 0.5 && tb > 0.5)) continue;
    const TextRun run = good_run(d.text(dynamics(t)));
    EXPECT_NEAR(run.last("a.y"), -of.y[0], 1e-6);
    EXPECT_NEAR(run.last("b.y"), -of.y[1], 1e-6);
    EXPECT_NEAR(run.last("drum.angle"), of.y[2], 1e-5);
    EXPECT_NEAR(run.last("rope.force"), ta, 1e-3);
    EXPECT_NEAR(run.last("rope.force_j"), tb, 1e-3);
    EXPECT_NEAR(run.last("energy.dissipated"), of.dissipated, 1e-5);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
  EXPECT_GT(returned, size_of_test(10, 3));
  EXPECT_GT(stuck, 0);
}

// Made fast beside a drum that stands still, the rope creeps over it as the weight swings: T_0 at its end is what is
// left of the weight's pull, and lags behind it.
TEST(ElasticRopes, MadeFastBehindADrum) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double m = random(0.5, 2), r = random(0.05, 0.2), l0 = random(0.5, 1.5), l1 = random(0.5, 2),
                 mu = random(0.1, 0.4);
    const double k = random(200, 1000), v0 = random(-1, 1), t = 0.7, e = std::exp(mu * pi / 2);
    // From (-l0, r) along the x axis over the drum about the origin, then down at x = r.
    const double arc = pi * r / 2, way = l0 + arc + l1, before = m * g * random(0.5, 1);
    const std::array<double, 2> y{(l0 + arc / 2) / way / k, (l1 + arc / 2) / way / k};
    using Y = std::array<double, 2>;  // how far the weight has gone down, its speed
    double w = 0, dissipated = 0;     // how much has passed towards the end made fast
    const auto tensions = [&](double x, double passed) {
      return std::array<double, 2>{std::max(before - passed / y[0], 0.0), std::max(before + (x + passed) / y[1], 0.0)};
    };
    const auto passed = [&](double x) {
      const auto [t0, t1] = tensions(x, w);
      if (t1 > e * t0) return w + (e * t0 - t1) / (1 / y[1] + e / y[0]);
      if (t0 > e * t1) return w + (t0 - e * t1) / (1 / y[0] + e / y[1]);
      return w;
    };
    const auto rates = [&](const Y& at) { return Y{at[1], g - tensions(at[0], passed(at[0]))[1] / m}; };
    Y at{0, v0};
    const int steps = 40000;
    const double h = t / steps;
    for (int n = 0; n < steps; ++n) {
      const auto old = tensions(at[0], w);
      const Y k1 = rates(at), k2 = rates({at[0] + h / 2 * k1[0], at[1] + h / 2 * k1[1]}),
              k3 = rates({at[0] + h / 2 * k2[0], at[1] + h / 2 * k2[1]}),
              k4 = rates({at[0] + h * k3[0], at[1] + h * k3[1]});
      for (std::size_t c = 0; c < 2; ++c) at[c] += h / 6 * (k1[c] + 2 * k2[c] + 2 * k3[c] + k4[c]);
      const double now = passed(at[0]);
      const auto next = tensions(at[0], now);
      dissipated += std::abs(now - w) * (std::abs(old[0] - old[1]) + std::abs(next[0] - next[1])) / 2;
      w = now;
    }
    const auto [t0, t1] = tensions(at[0], w);
    const TextRun run = good_run(fmt::format(
        R"({{"catena": 1, "gravity": [0, {:.17g}], "bodies": {{"b": {{"particle": true, "mass": {:.17g}, "position":
          [{:.17g}, {:.17g}], "velocity": [0, {:.17g}]}}}}, "constraints": [{{"type": "absolute_x", "i": "b"}}],
          "forces": [{{"type": "rope", "name": "rope", "i": ["ground", [{:.17g}, {:.17g}]], "over": [{{"at": "ground",
          "radius": {:.17g}, "side": -1, "mu": {:.17g}}}], "j": "b", "k": {:.17g}, "length": {:.17g}}}],
          "outputs": ["b.y", "rope.force", "rope.force_j", "energy.dissipated", "energy.balance"], "analyses": [{}]}})",
        -g, m, r, -l1, -v0, -l0, r, r, mu, k, way - before / k, dynamics(t)));
    EXPECT_NEAR(run.last("b.y"), -l1 - at[0], 1e-6);
    EXPECT_NEAR(run.last("rope.force"), t0, 1e-3);
    EXPECT_NEAR(run.last("rope.force_j"), t1, 1e-3);
    EXPECT_NEAR(run.last("energy.dissipated"), dissipated, 1e-5);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
}

// A rope without stiffness is one of a very large one: both slide alike.
TEST(ElasticRopes, AStiffOneSlidesAsOneWithoutStiffness) {
  const double ma = 1, mb = 3, mu = 0.2, r = 0.1, e = std::exp(mu * pi), t = 0.5;
  Drum d{.ma = ma, .mb = mb, .inertia = 1e6, .r = r, .la = 2, .lb = 2, .k = 1e7, .length = 0, .mu = mu};
  const double a = (mb - ma * e) / (mb + ma * e) * g, low = ma * (g + a);
  d.length = d.way() - low / d.k;
  const TextRun run = good_run(d.text(dynamics(t)));
  // At the start its tensions differ from those of the motion: a swing of a frequency of sqrt(k / ma) or so, in which
  // the rope slips to and fro and b gains a speed of g by that.
  EXPECT_NEAR(run.last("b.y"), -2 - a * t * t / 2, g / std::sqrt(d.k / ma) * t);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-7);
}

}  // namespace
}  // namespace catena::testing
