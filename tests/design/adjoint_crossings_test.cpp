// Adjoints across instants at which a motion goes on in another way: blows of events whose instants depend on the
// state, drivers whose velocities jump, loads that begin and end. Against closed forms, whose derivatives are formed by
// complex steps, and of random mechanisms against derivatives carried forward.
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <functional>

#include "analysis/sanitized.hpp"
#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Complex = std::complex<double>;
using Numbers = std::vector<Complex>;
using Formula = std::function<Complex(const Numbers&)>;

/// Gradients of the measures of a motion, `scene` being all before its analyses.
TextRun gradients_of(const std::string& scene, const std::string& parameters, const std::string& motion,
                     const std::string& mode) {
  return run_text(scene + R"(, "outputs": [], "analyses": [{"type": "sensitivity", "mode": ")" + mode +
                  R"(", "parameters": [)" + parameters + R"(], "of": {"type": "dynamics", )" + motion + "}}]}");
}

void expect_adjoint(const TextRun& run) {
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  ASSERT_EQ(field<std::string>(run, "mode"), "adjoint")
      << (run.analysis().report.warnings.empty() ? "" : run.analysis().report.warnings.front());
}

void expect_formula(const TextRun& run, const std::string& name, const std::vector<double>& at, const Formula& f) {
  SCOPED_TRACE(name);
  const Numbers x(at.begin(), at.end());
  EXPECT_NEAR(value(run, name), f(x).real(), 1e-9);
  for (std::size_t p = 0; p < at.size(); ++p) {
    Numbers moved = x;
    moved[p] += Complex(0, 1e-30);
    const double slope = f(moved).imag() / 1e-30;
    EXPECT_NEAR(gradient(run, name, p), slope, 1e-8 * std::max(1.0, std::abs(slope))) << "parameter " << p;
  }
}

// A body of mass m under a force F, with the velocity u: at x = d it is struck by J, at t with (u + F t / (2 m)) t = d.
TEST(AdjointOfBlows, OfABodyThatIsPushedOn) {
  const TextRun run = gradients_of(
      R"({"catena": 1, "parameters": {"m": 2, "F": 1.5, "u": 0.8, "d": 0.6, "J": 1.1}, "bodies": {"b": {"mass": "m",
      "inertia": 1, "velocity": ["u", 0]}}, "forces": [{"type": "point_force", "i": "b", "force": ["F", 0]}])",
      R"("m", "F", "u", "d", "J")", R"("until": 1.7, "every": 0.5, "tolerance": 1e-12, "events": [{"name": "push",
      "when": "b.x", "value": "=d", "direction": "up", "impulse": {"i": "b", "value": ["J", "=J/2"]}}], "measures": {
      "end": {"final": "b.x"}, "side": {"final": "b.y"}, "speed": {"final": "b.vx"}, "then": {"at": 1.3, "of": "b.x"},
      "early": {"at": 0.2, "of": "b.x"}, "way": {"integral": "b.vx"}, "square": {"integral": "=b.vx^2"},
      "mean": {"mean": "b.vy"}, "rms": {"rms": "b.vy"}})",
      "adjoint");
  expect_adjoint(run);
  const std::vector<double> at{2, 1.5, 0.8, 0.6, 1.1};
  const double T = 1.7;
  struct Motion {
    Complex a, t, after, side;
    explicit Motion(const Numbers& p) : a(p[1] / p[0]) {
      t = (std::sqrt(p[2] * p[2] + 2.0 * a * p[3]) - p[2]) / a;
      after = p[2] + a * t + p[4] / p[0];
      side = p[4] / 2.0 / p[0];
    }
    Complex place(const Numbers& p, double end) const {
      return p[3] + after * (end - t) + a / 2.0 * (end - t) * (end - t);
    }
  };
  expect_formula(run, "end", at, [=](const Numbers& p) { return Motion(p).place(p, T); });
  expect_formula(run, "way", at, [=](const Numbers& p) { return Motion(p).place(p, T); });
  expect_formula(run, "then", at, [=](const Numbers& p) { return Motion(p).place(p, 1.3); });
  expect_formula(run, "early", at, [=](const Numbers& p) { return p[2] * 0.2 + p[1] / p[0] * 0.02; });
  expect_formula(run, "speed", at, [=](const Numbers& p) {
    const Motion motion(p);
    return motion.after + motion.a * (T - motion.t);
  });
  expect_formula(run, "side", at, [=](const Numbers& p) { return Motion(p).side * (T - Motion(p).t); });
  expect_formula(run, "mean", at, [=](const Numbers& p) { return Motion(p).side * (T - Motion(p).t) / T; });
  expect_formula(run, "rms", at, [=](const Numbers& p) {
    const Motion motion(p);
    return std::sqrt(motion.side * motion.side * (T - motion.t) / T);
  });
  expect_formula(run, "square", at, [=](const Numbers& p) {
    const Motion motion(p);
    const Complex before = p[2] + motion.a * motion.t, last = motion.after + motion.a * (T - motion.t);
    return (before * before * before - p[2] * p[2] * p[2] + last * last * last -
            motion.after * motion.after * motion.after) /
           (3.0 * motion.a);
  });
}

// A rod of length l and mass m about its end, turning at w, which J strikes at a part s of it where it has the angle q.
TEST(AdjointOfBlows, OfARodThatIsStruckAsItTurns) {
  const TextRun run = gradients_of(
      R"({"catena": 1, "parameters": {"m": 2, "l": 0.7, "w": 3, "q": 0.9, "J": 0.4, "s": 0.6}, "bodies": {"rod": {"mass": "m",
      "rod": {"from": [0, 0], "to": ["l", 0]}, "angular_velocity": "w"}}, "constraints": [{"type": "revolute",
      "name": "pin", "i": "ground", "j": "rod.from"}])",
      R"("m", "l", "w", "q", "J", "s")", R"--("until": 0.8, "every": 0.2, "tolerance": 1e-12, "events": [{"name": "hit",
      "when": "rod.angle", "value": "=q", "direction": "up", "impulse": {"i": ["rod", ["=l*(s-0.5)", 0]], "value":
      ["=-J/3", "=J"]}}], "measures": {"end": {"final": "rod.angle"}, "speed": {"final": "rod.omega"},
      "pull": {"final": "pin.fx"}, "energy": {"integral": "energy.kinetic"}})--",
      "adjoint");
  expect_adjoint(run);
  const std::vector<double> at{2, 0.7, 3, 0.9, 0.4, 0.6};
  const auto inertia = [](const Numbers& p) { return p[0] * p[1] * p[1] / 3.0; };
  const auto after = [=](const Numbers& p) {
    return p[2] + p[5] * p[1] * (std::cos(p[3]) * p[4] + std::sin(p[3]) * p[4] / 3.0) / inertia(p);
  };
  const auto end = [=](const Numbers& p) { return p[3] + after(p) * (0.8 - p[3] / p[2]); };
  expect_formula(run, "speed", at, after);
  expect_formula(run, "end", at, end);
  expect_formula(run, "energy", at, [=](const Numbers& p) {
    const Complex t = p[3] / p[2], w = after(p);
    return inertia(p) / 2.0 * (p[2] * p[2] * t + w * w * (0.8 - t));
  });
  // The sign of a reaction is that of the columns: a rod that turns is held by m w^2 l / 2.
  const double sign = value(run, "pull") * -std::cos(end(Numbers(at.begin(), at.end())).real()) > 0 ? 1 : -1;
  expect_formula(run, "pull", at, [=](const Numbers& p) {
    const Complex w = after(p);
    return -sign * p[0] * w * w * p[1] / 2.0 * std::cos(end(p));
  });
}

// A cart that starts at t0 with the velocity v, and a rod that hangs on it: w = m v (l / 2) sin(q) / (m l^2 / 3).
TEST(AdjointOfJumps, OfADriverThatStartsAtOnce) {
  const TextRun run = gradients_of(
      R"--({"catena": 1, "parameters": {"m": 2, "l": 0.7, "v": 1.5, "t0": 0.3, "q": 1.1}, "bodies": {"cart": {"mass": 3,
      "particle": true}, "rod": {"mass": "m", "rod": {"from": [0, 0], "to": ["=l*cos(q)", "=l*sin(q)"]}}},
      "constraints": [{"type": "absolute_y", "i": "cart", "value": 0}, {"type": "revolute", "i": "cart", "j": "rod.from"}],
      "drivers": [{"type": "absolute_x", "name": "go", "i": "cart", "value":
      {"spline": {"t": ["=t0", 5], "value": [0, "=v*(5-t0)"], "beyond": "hold"}}}])--",
      R"("m", "l", "v", "t0", "q")", R"("until": 1.1, "every": 0.5, "tolerance": 1e-12, "measures": {
      "end": {"final": "rod.angle"}, "speed": {"final": "rod.omega"}, "cart": {"final": "cart.x"},
      "turns": {"integral": "rod.omega"}, "square": {"integral": "=rod.omega^2"}})",
      "adjoint");
  expect_adjoint(run);
  const std::vector<double> at{2, 0.7, 1.5, 0.3, 1.1};
  const auto rate = [](const Numbers& p) { return 1.5 * p[2] * std::sin(p[4]) / p[1]; };
  expect_formula(run, "speed", at, rate);
  expect_formula(run, "cart", at, [](const Numbers& p) { return p[2] * (1.1 - p[3]); });
  expect_formula(run, "turns", at, [=](const Numbers& p) { return rate(p) * (1.1 - p[3]); });
  expect_formula(run, "square", at, [=](const Numbers& p) { return rate(p) * rate(p) * (1.1 - p[3]); });
  expect_formula(run, "end", at, [=](const Numbers& p) { return p[4] + rate(p) * (1.1 - p[3]); });
}

/// A chain of rods on a cart, which is driven by a law with jumps or free; a torque that begins and ends; blows.
struct RandomCrossings {
  std::string scene, names, motion;

  explicit RandomCrossings(unsigned seed) {
    RandomNumbers random(seed);
    const int rods = 1 + static_cast<int>(seed % 3);
    const bool driven = seed % 2 == 0;
    std::string parameters, bodies, constraints;
    const auto parameter = [&](const std::string& name, double number) {
      parameters += (parameters.empty() ? "\"" : ", \"") + name + "\": " + text_of(number);
      names += (names.empty() ? "\"" : ", \"") + name + "\"";
    };
    for (const auto& [name, low, high] : {std::tuple{"g", 7.0, 11.0},
                                          {"T", 0.15, 0.3},
                                          {"w", 0.2, 0.4},
                                          {"M", 1.0, 4.0},
                                          {"p", 0.1, 0.4},
                                          {"s", -0.2, 0.2},
                                          {"v", -0.6, 0.6}})
      parameter(name, random(low, high));
    std::string first_angle;
    double x = 0, y = 0;
    std::string from = R"("cart")";
    for (int k = 0; k < rods; ++k) {
      const std::string body = "b" + std::to_string(k);
      const double angle = random(-2.2, -0.9), length = random(0.3, 0.7);
      if (k == 0) first_angle = text_of(angle);  // which is negative
      parameter("l" + std::to_string(k), length);
      parameter("m" + std::to_string(k), random(0.5, 2));
      // Ends beside the given ones are met by assembly.
      const double to_x = x + length * std::cos(angle), to_y = y + length * std::sin(angle);
      bodies += ", \"" + body + R"(": {"mass": "m)" + std::to_string(k) + R"(", "rod": {"from": )" + pair_of(x, y) +
                R"(, "to": )" + pair_of(to_x, to_y) + R"(}, "angular_velocity": )" + text_of(random(-2, 2)) + "}";
      constraints += R"(, {"type": "revolute", "name": "J)" + std::to_string(k) + R"(", "i": )" + from +
                     R"(, "j": [")" + body + R"(", ["=-l)" + std::to_string(k) + R"(/2", 0]]})";
      from = "[\"" + body + R"(", ["=l)" + std::to_string(k) + R"(/2", 0]])";
      x = to_x, y = to_y;
    }
    const std::string tip = "b" + std::to_string(rods - 1);
    scene = R"({"catena": 1, "gravity": [0, "=-g"], "parameters": {)" + parameters +
            R"(}, "bodies": {"cart": {"mass": "M", "particle": true})" + bodies +
            R"(}, "constraints": [{"type": "absolute_y", "i": "cart", "value": 0})" + constraints + "]";
    const std::string law =
        R"({"spline": {"t": ["=T", "=T+w/2", "=T+w"], "value": [0, "=v/3", "v"], "beyond": "hold"}})";
    if (driven) scene += R"(, "drivers": [{"type": "absolute_x", "name": "go", "i": "cart", "value": )" + law + "}]";
    scene += R"(, "forces": [{"type": "torque", "i": ")" + tip +
             R"(", "torque": {"spline": {"t": ["=T/2", "=T*1.5+w"], "value": [0, "=3*v"], "beyond": "hold"}}},
        {"type": "spring_damper", "i": ["ground", [0.3, 0.4]], "j": "cart", "k": 40, "c": 1, "length": 0.2}])";
    // A blow along x never takes t + tip.vx / 50 back below the value: it strikes once.
    const std::array<std::array<std::string, 2>, 3> columns{{{tip + ".x", "=s"},
                                                             {"=t + " + tip + ".vx/50", "=0.4 + s/4"},
                                                             {"=b0.angle + 2*t", "=0.7 + s/4" + first_angle}}};
    const auto& [when, value] = columns[seed / 2 % 3];
    motion = R"("until": 0.65, "every": 0.35, "tolerance": 1e-10, "method": ")" +
             std::string(seed % 4 ? "rk8" : "rk5") + R"(", "events": [{"name": "knock", "when": ")" + when +
             R"(", "value": ")" + value + R"(", "impulse": {"i": [")" + tip +
             R"(", ["=s/3", 0.05]], "value": ["=p", 0.2]}}], "measures": {"end": {"final": ")" + tip +
             R"(.x"}, "speed": {"final": ")" + tip +
             R"(.omega"}, "cart": {"integral": "cart.vx"}, "then": {"at": 0.6123,
        "of": "b0.angle"}, "pull": {"at": 0.5011, "of": "J0.fx"}, "bend": {"final": "b0.alpha"},
        "square": {"integral": "=b0.omega^2"}, "rms": {"rms": "b0.omega"}, "mean": {"mean": "b0.vy"},
        "energy": {"final": "energy.kinetic"}})";
  }
};

/// How many blows there were, and how many gradients were compared.
struct Compared {
  int blows = 0, gradients = 0;
};

void expect_both_ways(unsigned seed, Compared& compared) {
  SCOPED_TRACE(seed);
  const RandomCrossings random(seed);
  const TextRun back = gradients_of(random.scene, random.names, random.motion, "adjoint");
  const TextRun forward = gradients_of(random.scene, random.names, random.motion, "forward");
  SCOPED_TRACE(random.scene + random.motion);
  expect_adjoint(back);
  ASSERT_EQ(forward.outcome.exit_code, 0) << forward.outcome.error_text;
  ASSERT_EQ(field<std::string>(forward, "mode"), "forward");
  for (const NamedField& one : back.analysis().fields) {
    if (one.name == "events") compared.blows += static_cast<int>(std::get<std::vector<FieldRecord>>(one.value).size());
  }
  for (const MeasureResult& m : back.analysis().measures) {
    const MeasureResult& other = measure(forward, m.name);
    ASSERT_TRUE(m.value && other.value) << m.name << m.trouble << other.trouble;
    double size = std::abs(*m.value);
    for (const double d : other.gradient) size = std::max(size, std::abs(d));
    for (std::size_t p = 0; p < m.gradient.size(); ++p) {
      ++compared.gradients;
      EXPECT_NEAR(m.gradient[p], other.gradient[p], 1e-9 * size) << m.name << ", parameter " << p;
    }
  }
}

TEST(RandomAdjoints, AcrossBlowsAndJumpsAreTheForwardOnes) {
  Compared compared;
  const unsigned last = size_of_test(4u, 1u);
  for (unsigned seed = 1; seed <= last; ++seed) expect_both_ways(seed, compared);
  EXPECT_GE(compared.blows, size_of_test(4, 1));
  EXPECT_GT(compared.gradients, size_of_test(300, 50));
}

}  // namespace
}  // namespace catena::testing
