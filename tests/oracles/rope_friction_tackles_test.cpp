// Ropes that slide over several pulleys with friction, one of them moving: small systems of equations that try every
// state of the pulleys.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/rope_friction_scenes.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

using namespace rope_friction;

/// A rope from weight a over a pulley of the ground, down round the pulley of a block c, up over another one of the
/// ground, down to weight b; all move vertically.
struct Tackle {
  double ma, mb, mc, r = 0.1;
  std::array<double, 3> mu;
  std::array<double, 3> v{};  // of a, b, c upwards; v_a + v_b + 2 v_c = 0
  double ya = -4, yb = -4, yc = -3;

  std::string text(double t, const std::string& more = "") const {
    std::string over;
    const char* at[] = {R"(["ground", [)", R"(["c", [)", R"(["ground", [)"};
    for (int k = 0; k < 3; ++k) {
      const double x = k == 1 ? 0 : r * (2 * k - 2);
      over += fmt::format(R"({}{{"at": {}{:.17g}, 0]], "radius": {:.17g}, "side": {}, "mu": {:.17g}}})",
                          k > 0 ? "," : "", at[k], x, r, k == 1 ? 1 : -1, mu[static_cast<std::size_t>(k)]);
    }
    return scene(weight("a", ma, -3 * r, ya, 0, v[0]) + "," + weight("b", mb, 3 * r, yb, 0, v[1]) + "," +
                     weight("c", mc, 0, yc, 0, v[2]),
                 "", R"({"type": "rope", "name": "rope", "i": "a", "over": [)" + over + R"(], "j": "b")" + more + "}",
                 R"("a.y", "b.y", "c.y", "a.vy", "b.vy", "c.vy", "rope.force", "rope.force_j", "energy.balance",
                 "energy.dissipated")",
                 dynamics(t));
  }
  /// Rates at which the rope passes the pulleys towards a, from velocities or accelerations of a, b, c.
  static std::array<double, 3> passes(const std::array<double, 3>& w) { return {-w[0], -w[0] - w[2], w[1]}; }

  struct Motion {
    std::array<double, 3> a{};  // accelerations upwards
    std::array<double, 4> tension{};
  };
  /// Accelerations where pulley k slides to the side sigma_k, or sticks where that is zero; nothing where the rope
  /// would push.
  std::optional<Motion> motion(const std::array<int, 3>& sigma) const {
    // Unknowns a_a, a_b, a_c, T_0 ... T_3: seven equations.
    std::array<std::array<double, 8>, 7> m{};
    const auto row = [&](std::size_t n) -> std::array<double, 8>& { return m[n]; };
    row(0) = {ma, 0, 0, -1, 0, 0, 0, -ma * g};
    row(1) = {0, mb, 0, 0, 0, 0, -1, -mb * g};
    row(2) = {0, 0, mc, 0, -1, -1, 0, -mc * g};
    row(3) = {1, 1, 2, 0, 0, 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      if (sigma[k] == 0) {
        for (std::size_t c = 0; c < 3; ++c) {
          std::array<double, 3> unit{};
          unit[c] = 1;
          row(4 + k)[c] = passes(unit)[k];
        }
      } else {
        row(4 + k)[3 + k] = std::exp(-sigma[k] * mu[k] * pi);
        row(4 + k)[4 + k] = -1;
      }
    }
    for (std::size_t c = 0; c < 7; ++c) {
      std::size_t best = c;
      for (std::size_t n = c; n < 7; ++n) best = std::abs(m[n][c]) > std::abs(m[best][c]) ? n : best;
      if (std::abs(m[best][c]) < 1e-12) return {};
      std::swap(m[c], m[best]);
      for (std::size_t n = 0; n < 7; ++n) {
        const double part = m[n][c] / m[c][c];
        for (std::size_t k = c; k < 8 && n != c; ++k) m[n][k] -= part * m[c][k];
      }
    }
    Motion found;
    for (std::size_t k = 0; k < 7; ++k) (k < 3 ? found.a[k] : found.tension[k - 3]) = m[k][7] / m[k][k];
    return found;
  }
  /// Whether all can stay at rest. Where two pulleys hold, all is at rest, and T_1 + T_2 alone is known.
  bool can_rest() const {
    const auto e = [&](std::size_t k) { return std::exp(mu[k] * pi); };
    const double sum = mc * g;
    const double low = std::max({ma * g / e(0), sum - mb * g * e(2), sum / (1 + e(1))});
    const double high = std::min({ma * g * e(0), sum - mb * g / e(2), sum / (1 + 1 / e(1))});
    return v == std::array<double, 3>{} && low <= high;
  }
  /// The states of the pulleys at the present velocities, and the motion: every state is tried.
  std::optional<Motion> find() const {
    if (can_rest()) return Motion{{}, {ma * g, std::nan(""), std::nan(""), mb * g}};
    const std::array<double, 3> pass = passes(v);
    for (int code = 0; code < 27; ++code) {
      std::array<int, 3> sigma{code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
      const std::optional<Motion> found = motion(sigma);
      bool fits = found.has_value();
      for (std::size_t k = 0; k < 3 && fits; ++k) {
        const double e = std::exp(mu[k] * pi), ratio = found->tension[k + 1] / found->tension[k];
        fits = found->tension[k] > 0 && found->tension[k + 1] > 0;
        if (pass[k] != 0) fits = fits && sigma[k] == (pass[k] > 0 ? 1 : -1);
        if (pass[k] == 0 && sigma[k] == 0) fits = fits && ratio < e && ratio > 1 / e;
        if (pass[k] == 0 && sigma[k] != 0) fits = fits && passes(found->a)[k] * sigma[k] > 0;
      }
      if (fits) return found;
    }
    return {};
  }
};

// From rest: which of three pulleys, one of them moving, slide is found by trying all.
TEST(RopeFriction, TacklesFromRest) {
  std::array<int, 4> sliding{};
  for (unsigned seed = 1; seed <= size_of_test(120u, 50u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Tackle tackle{.ma = random(0.5, 3), .mb = random(0.5, 3), .mc = random(1, 6), .mu = {}};
    for (double& mu : tackle.mu) mu = random(0.02, 0.3);
    const std::optional<Tackle::Motion> motion = tackle.find();
    ASSERT_TRUE(motion);
    int slides = 0;
    for (const double pass : Tackle::passes(motion->a)) slides += std::abs(pass) > 1e-9;
    ++sliding[static_cast<std::size_t>(slides)];
    const double t = 0.2;
    const TextRun run = good_run(tackle.text(t));
    EXPECT_NEAR(run.last("a.y"), tackle.ya + motion->a[0] * t * t / 2, 1e-9);
    EXPECT_NEAR(run.last("b.y"), tackle.yb + motion->a[1] * t * t / 2, 1e-9);
    EXPECT_NEAR(run.last("c.y"), tackle.yc + motion->a[2] * t * t / 2, 1e-9);
    EXPECT_NEAR(run.last("rope.force"), motion->tension[0], 1e-7);
    EXPECT_NEAR(run.last("rope.force_j"), motion->tension[3], 1e-7);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
  }
  // Where two hold, all is at rest.
  for (const std::size_t n : {0, 2, 3}) EXPECT_GT(sliding[n], 0) << n;
  EXPECT_EQ(sliding[1], 0);
}

// In motion: from one instant at which a pulley comes to rest to the next one, accelerations are constant.
TEST(RopeFriction, TacklesInMotion) {
  for (unsigned seed = 1; seed <= size_of_test(60u, 20u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(1000 + seed);
    Tackle tackle{.ma = random(0.5, 3), .mb = random(0.5, 3), .mc = random(1, 6), .mu = {}};
    for (double& mu : tackle.mu) mu = random(0.02, 0.3);
    tackle.v = {random(-1, 1), random(-1, 1), 0};
    tackle.v[2] = -(tackle.v[0] + tackle.v[1]) / 2;
    const std::string text = tackle.text(0.5);
    double left = 0.5, dissipated = 0;
    std::optional<Tackle::Motion> motion;
    while (left > 0) {
      motion = tackle.find();
      ASSERT_TRUE(motion);
      const std::array<double, 3> pass = Tackle::passes(tackle.v), more = Tackle::passes(motion->a);
      double step = left;
      std::size_t stops = 3;
      for (std::size_t k = 0; k < 3; ++k) {
        if (pass[k] * more[k] < 0 && -pass[k] / more[k] < step) {
          step = -pass[k] / more[k];
          stops = k;
        }
      }
      for (std::size_t k = 0; k < 3 && !std::isnan(motion->tension[1]); ++k)
        dissipated -= (motion->tension[k + 1] - motion->tension[k]) * (pass[k] * step + more[k] * step * step / 2);
      const auto go = [&](double& y, std::size_t c) {
        y += tackle.v[c] * step + motion->a[c] * step * step / 2;
        tackle.v[c] += motion->a[c] * step;
      };
      go(tackle.ya, 0);
      go(tackle.yb, 1);
      go(tackle.yc, 2);
      // What came to rest, or stays at rest, is so exactly.
      if (stops == 0 || (pass[0] == 0 && std::abs(more[0]) < 1e-9)) tackle.v[0] = 0;
      if (stops == 2 || (pass[2] == 0 && std::abs(more[2]) < 1e-9)) tackle.v[1] = 0;
      if (stops == 1 || (pass[1] == 0 && std::abs(more[1]) < 1e-9)) tackle.v[2] = -tackle.v[0];
      if (tackle.v[0] == 0 && tackle.v[1] == 0) tackle.v[2] = 0;
      left = stops == 3 ? 0 : left - step;
    }
    const TextRun run = good_run(text);
    EXPECT_NEAR(run.last("a.y"), tackle.ya, 1e-8);
    EXPECT_NEAR(run.last("b.y"), tackle.yb, 1e-8);
    EXPECT_NEAR(run.last("c.y"), tackle.yc, 1e-8);
    EXPECT_NEAR(run.last("c.vy"), tackle.v[2], 1e-8);
    EXPECT_NEAR(run.last("rope.force_j"), motion->tension[3], 1e-6);
    EXPECT_NEAR(run.last("energy.dissipated"), dissipated, 1e-7);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
}

// Two pulleys share, as little as they can of each.
TEST(RopeFriction, WhatTacklesHold) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Tackle tackle{.ma = random(0.5, 3), .mb = random(0.5, 3), .mc = random(1, 6), .mu = {}};
    for (double& mu : tackle.mu) mu = random(0.02, 0.3);
    std::string text = tackle.text(1);
    text.replace(text.find(R"("outputs")"), std::string::npos,
                 R"("outputs": ["a.y"], "analyses": [{"type": "equilibrium", "friction": "hold"}]})");
    const TextRun run = good_run(text);
    // T_0 = ma g, T_3 = mb g, T_1 + T_2 = mc g: the least u for some T_1.
    const auto used = [&](double t1) {
      const double t[] = {tackle.ma, t1, tackle.mc - t1, tackle.mb};
      double most = 0;
      for (std::size_t k = 0; k < 3; ++k)
        most = std::max(most, std::abs(std::log(t[k + 1] / t[k])) / (tackle.mu[k] * pi));
      return most;
    };
    // Each term is convex in ln or falls and rises once: golden section.
    double low = 1e-9 * tackle.mc, high = tackle.mc - low;
    const double golden = (std::sqrt(5.0) - 1) / 2;
    for (int n = 0; n < 200; ++n) {
      const double a = high - golden * (high - low), b = low + golden * (high - low);
      (used(a) < used(b) ? high : low) = used(a) < used(b) ? b : a;
    }
    EXPECT_NEAR(field<double>(run, "utilisation"), used((low + high) / 2), 1e-7);
  }
}

}  // namespace
}  // namespace catena::testing
