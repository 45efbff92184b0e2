// Ropes that meet and leave pulleys of their list: pendulums on round pegs, involutes, ends that swing off a pulley and
// round it, in motion, at rest and driven. Against closed forms, and Runge and Kutta's method of order four on
// equations of the tests' own, which land on the instants at which the rope meets or leaves the peg.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81, pi = std::numbers::pi;

/// A particle b on a rope from (0, 0) over a peg of radius r at (px, py).
std::string hung(double x, double y, double vx, double vy, double px, double py, double r, int side,
                 const std::string& more, const std::string& analysis, double gravity = g) {
  return fmt::format(R"({{"catena": 1, "gravity": [0, {:.17g}], "bodies": {{"b": {{"particle": true, "mass": 1,
    "position": [{:.17g}, {:.17g}], "velocity": [{:.17g}, {:.17g}]}}}}, "forces": [{{"type": "rope", "name": "rope",
    "i": "ground", "over": [{{"at": ["ground", [{:.17g}, {:.17g}]], "radius": {:.17g}, "side": {}}}], "j": "b"{}}}],
    "outputs": ["b.x", "b.y", "rope.length", "rope.gap", "rope.force"], "analyses": [{}]}})",
                     -gravity, x, y, vx, vy, px, py, r, side, more, analysis);
}
std::string dynamics(double t, const std::string& more = "") {
  return fmt::format(R"({{"type": "dynamics", "at": [0, {:.17g}], "tolerance": 1e-11{}}})", t, more);
}
std::vector<double> instants(const TextRun& run, const std::string& kind) {
  std::vector<double> times;
  for (const auto& [key, value] : run.analysis().fields) {
    if (key != "events") continue;
    for (const FieldRecord& record : std::get<std::vector<FieldRecord>>(value)) {
      bool is = false;
      double t = 0;
      for (const auto& [name, field] : record) {
        if (name == "kind") is = std::get<std::string>(field) == kind;
        if (name == "t") t = std::get<double>(field);
      }
      if (is) times.push_back(t);
    }
  }
  return times;
}

/// Galileo's pendulum with a round peg (0, -h): phi from the vertical, on the peg from sin phi = -r / h on.
///
///   l phi'' = -(g sin phi + l' phi'^2)      l = L, l' = 0 off the peg; on it l = L - sqrt(h^2 - r^2) - r (phi - phi*)
struct PegPendulum {
  double L, h, r;
  std::array<double, 2> s;  // phi, phi'
  double t = 0;
  std::vector<double> met{}, left{};
  bool on_peg = false;

  double meeting() const { return -std::asin(r / h); }
  double length(double phi) const { return on_peg ? L - std::sqrt(h * h - r * r) - r * (phi - meeting()) : L; }
  std::array<double, 2> rates(const std::array<double, 2>& at) const {
    return {at[1], -(g * std::sin(at[0]) + (on_peg ? -r : 0) * at[1] * at[1]) / length(at[0])};
  }
  std::array<double, 2> stepped(double step) const {
    const auto plus = [&](double f, const std::array<double, 2>& d) {
      return std::array{s[0] + f * d[0], s[1] + f * d[1]};
    };
    const auto a = rates(s), b = rates(plus(step / 2, a)), c = rates(plus(step / 2, b)), d = rates(plus(step, c));
    return {s[0] + step / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]),
            s[1] + step / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])};
  }
  void advance(double end) {
    while (t < end) {
      double step = std::min(2e-4, end - t);
      if ((stepped(step)[0] > meeting()) != on_peg) {
        double low = 0;
        for (int n = 0; n < 60; ++n) {
          const double middle = (low + step) / 2;
          ((stepped(middle)[0] > meeting()) != on_peg ? step : low) = middle;
        }
        s = stepped(step);
        t += step;
        const double before = length(s[0]);
        on_peg = !on_peg;
        s[1] *= before / length(s[0]);  // the velocity is continuous, the free length is not
        (on_peg ? met : left).push_back(t);
        continue;
      }
      s = stepped(step);
      t += step;
    }
  }
  std::array<double, 2> place() const {
    const double c = std::cos(s[0]), n = std::sin(s[0]), l = length(s[0]);
    return on_peg ? std::array{-r * c + l * n, -h - r * n - l * c} : std::array{L * n, -L * c};
  }
  double tension() const { return length(s[0]) * s[1] * s[1] + g * std::cos(s[0]); }
};

TEST(RopeWays, PendulumOnARoundPeg) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    // It stays below the level of the peg, and the rope taut.
    PegPendulum swing{1, random(0.3, 0.5), random(0.02, 0.15), {-random(0.4, 0.6), random(-0.5, 0)}};
    const double t = random(3, 4), mirrored = seed % 2 == 0 ? -1 : 1;
    const double c = std::cos(swing.s[0]), n = std::sin(swing.s[0]), v = swing.s[1];
    const TextRun run = run_text(hung(mirrored * n, -c, mirrored * v * c, v * n, 0, -swing.h, swing.r,
                                      static_cast<int>(mirrored), "", dynamics(t)));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    swing.advance(t);
    EXPECT_NEAR(run.last("b.x"), mirrored * swing.place()[0], 1e-8);
    EXPECT_NEAR(run.last("b.y"), swing.place()[1], 1e-8);
    EXPECT_NEAR(run.last("rope.force"), swing.tension(), 1e-7);
    EXPECT_NEAR(run.last("rope.length"), 1, 1e-10);
    const std::vector<double> met = instants(run, "wrap"), left = instants(run, "unwrap");
    ASSERT_EQ(met.size(), swing.met.size());
    ASSERT_EQ(left.size(), swing.left.size());
    ASSERT_GE(met.size(), 2u);
    for (std::size_t k = 0; k < met.size(); ++k) EXPECT_NEAR(met[k], swing.met[k], 1e-9);
    for (std::size_t k = 0; k < left.size(); ++k) EXPECT_NEAR(left[k], swing.left[k], 1e-9);
  }
}

/// The same with a stiffness: V = k max(way - L, 0)^2 / 2, the force along the last straight part.
struct ElasticOnPeg {
  double L, h, r, k;
  std::array<double, 4> s;  // x, y, x', y'

  /// The way to (x, y) and its direction there, past the peg's left side.
  std::array<double, 3> way(double x, double y) const {
    const double d = std::hypot(x, y + h), l = std::sqrt(d * d - r * r), first = std::sqrt(h * h - r * r);
    // Directions of the tangents, from the vertical: in at the peg, out at the end.
    const double in = -std::asin(r / h), out = std::atan2(x, -(y + h)) + std::asin(r / d);
    if (out <= in) return {std::hypot(x, y), x / std::hypot(x, y), y / std::hypot(x, y)};
    return {first + r * (out - in) + l, std::sin(out), -std::cos(out)};
  }
  std::array<double, 4> rates(const std::array<double, 4>& a) const {
    const auto [length, ux, uy] = way(a[0], a[1]);
    const double pull = k * std::max(length - L, 0.0);
    return {a[2], a[3], -pull * ux, -pull * uy - g};
  }
  void advance(double t, int steps) {
    const double step = t / steps;
    const auto plus = [&](double f, const std::array<double, 4>& d) {
      std::array<double, 4> c = s;
      for (std::size_t n = 0; n < 4; ++n) c[n] += f * d[n];
      return c;
    };
    for (int n = 0; n < steps; ++n) {
      const auto a = rates(s), b = rates(plus(step / 2, a)), c = rates(plus(step / 2, b)), d = rates(plus(step, c));
      for (std::size_t m = 0; m < 4; ++m) s[m] += step / 6 * (a[m] + 2 * b[m] + 2 * c[m] + d[m]);
    }
  }
};

TEST(RopeWays, ElasticPendulumOnARoundPeg) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double phi = -random(0.4, 0.8), t = random(1.5, 2);
    ElasticOnPeg swing{1, random(0.3, 0.6), random(0.02, 0.1), random(200, 800), {std::sin(phi), -std::cos(phi), 0, 0}};
    const TextRun run = run_text(hung(swing.s[0], swing.s[1], 0, 0, 0, -swing.h, swing.r, 1,
                                      fmt::format(R"(, "k": {:.17g})", swing.k), dynamics(t)));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    swing.advance(t, 200000);
    EXPECT_NEAR(run.last("b.x"), swing.s[0], 1e-8);
    EXPECT_NEAR(run.last("b.y"), swing.s[1], 1e-8);
    EXPECT_GE(instants(run, "wrap").size(), 1u);
    EXPECT_GE(instants(run, "unwrap").size(), 1u);
  }
}

// Without gravity: wound up along the involute, l^2 = l0^2 - 2 r v t, and more than twice round.
TEST(RopeWays, WindsUpManyTimes) {
  const double r = 0.1, h = 0.4, v = 3, first = std::sqrt(h * h - r * r), in = -std::asin(r / h);
  // It starts where the straight rope touches the peg.
  const double l0 = 2, L = first + l0, x = L * std::sin(in), y = -L * std::cos(in);
  const double t = 0.95 * l0 * l0 / (2 * r * v), l = std::sqrt(l0 * l0 - 2 * r * v * t), phi = in + (l0 - l) / r;
  ASSERT_GT(phi, 4 * pi);
  for (const double before : {0.0, 0.1}) {  // or a moment earlier, on the circle about the other end
    const double a = in - before, c = std::cos(a), n = std::sin(a);
    const TextRun run = run_text(hung(L * n, -L * c, v * c, v * n, 0, -h, r, 1, "", dynamics(t + before * L / v), 0));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(run.last("b.x"), -r * std::cos(phi) + l * std::sin(phi), 1e-7) << x << y;
    EXPECT_NEAR(run.last("b.y"), -h - r * std::sin(phi) - l * std::cos(phi), 1e-7);
    EXPECT_NEAR(run.last("rope.gap"), 0, 1e-9);
  }
}

// A rope slack beside its pulley is as long as the straight line: it becomes taut where its ends are L apart.
TEST(RopeWays, SlackBesideAPulleyBecomesTautLater) {
  int beside = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double vx = random(0.3, 2), vy = random(6, 8), L = 2, x0 = 1.5, y0 = -0.2;
    const TextRun run = run_text(hung(x0, y0, vx, vy, 1, 0, 0.3, -1, R"(, "length": 2)", dynamics(0.5)));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double> impact = instants(run, "impact"), left = instants(run, "unwrap");
    if (impact.empty() || left.empty() || left[0] > impact[0]) continue;
    ++beside;
    const auto apart = [&](double t) { return std::hypot(x0 + vx * t, y0 + vy * t - g / 2 * t * t) - L; };
    EXPECT_NEAR(apart(impact[0]), 0, 1e-9);
    EXPECT_LT(apart(impact[0] * 0.999), 0);
  }
  EXPECT_GE(beside, 6);
}

// Given beside its peg, a weight comes to rest below it; and the other way round.
TEST(RopeWays, PlacesOfRest) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const std::string stiffness : {"", R"(, "k": 1e4)"}) {
      SCOPED_TRACE(fmt::format("{} {}", seed, stiffness));
      RandomNumbers random(seed);
      const double r = random(0.05, 0.2), a = random(0.5, 1), x = random(1.2, 1.8), y = random(0.3, 0.8);
      const TextRun run =
          run_text(hung(x, y, 0, 0, a, 0, r, -1, stiffness, R"({"type": "equilibrium"}, {"type": "equilibrium"})"));
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
      EXPECT_NEAR(run.first("rope.length"), std::hypot(x, y) + (stiffness.empty() ? 0 : g / 1e4), 1e-9);
      const double l = run.first("rope.length") - std::sqrt(a * a - r * r) - r * (pi / 2 + std::asin(r / a));
      EXPECT_NEAR(run.first("b.x"), a + r, 1e-7);
      EXPECT_NEAR(run.first("b.y"), -l, 1e-7);
      EXPECT_NEAR(run.last("b.y", 1), -l, 1e-7);
      EXPECT_NEAR(run.first("rope.force"), g, 1e-7);
      // Given round the peg, it comes to hang freely beside it.
      const TextRun free = run_text(hung(0.8, -0.6, 0, 0, 0.1, -0.5, 0.04, 1, stiffness, R"({"type": "equilibrium"})"));
      ASSERT_EQ(free.outcome.exit_code, 0) << free.outcome.error_text << free.analysis().report.message;
      EXPECT_NEAR(free.first("b.x"), 0, 1e-7);
      EXPECT_NEAR(free.first("b.y"), -free.first("rope.length"), 1e-7);
    }
  }
}

// Given beside its peg and come to rest below it, l under the peg: omega^2 = g / l across the rope, k / m along it.
TEST(RopeWays, ModesWhereItHasMetAPulley) {
  const TextRun run =
      run_text(hung(1.5, 0.5, 0, 0, 0.7, 0, 0.1, -1, R"(, "k": 1e4)", R"({"type": "equilibrium"}, {"type": "modes"})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> squares = run.column("omega2", 1);
  ASSERT_EQ(squares.size(), 2u);
  EXPECT_NEAR(squares[0], g / -run.first("b.y"), 1e-8);
  EXPECT_NEAR(squares[1], 1e4, 1e-5);
}

// Driven round a peg twice and back: the way is that of the tangents and the arc, turn by turn.
TEST(RopeWays, InDrivenMotions) {
  const double r = 0.1, a = 0.5, l = 2;
  const TextRun run = run_text(fmt::format(R"({{"catena": 1, "bodies": {{"arm": {{"position": [{0}, 0],
    "points": {{"p": [{1}, 0]}}}}}}, "constraints": [{{"type": "revolute", "i": ["ground", [{0}, 0]], "j": "arm"}}],
    "drivers": [{{"type": "absolute_angle", "i": "arm", "value": {{"harmonic": {{"amplitude": 14, "omega": 1}}}}}}],
    "forces": [{{"type": "rope", "name": "rope", "i": "ground", "over": [{{"at": ["ground", [{0}, 0]], "radius": {2},
    "side": 1}}], "j": "arm.p", "length": 9}}],
    "outputs": ["arm.angle", "rope.length"], "analyses": [{{"type": "kinematics", "until": 3, "every": 0.005}}]}})",
                                           a, l, r));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<double> angle = run.column("arm.angle"), length = run.column("rope.length");
  for (std::size_t k = 0; k < angle.size(); ++k) {
    // The tangents touch at -90 deg + asin(r / a) from the left and at the arm's angle - acos(r / l).
    const double in = -std::asin(r / a), out = angle[k] + std::asin(r / l), contact = out - in;
    const double straight = std::hypot(a + l * std::cos(angle[k]), l * std::sin(angle[k]));
    const double over = std::sqrt(a * a - r * r) + std::sqrt(l * l - r * r) + r * contact;
    EXPECT_NEAR(length[k], contact > 0 ? over : straight, 1e-9) << angle[k];
  }
  EXPECT_GT(*std::max_element(angle.begin(), angle.end()), 4 * pi);
}

}  // namespace
}  // namespace catena::testing
