// Gradients of measures by adjoints in scenes, against derivatives carried forward and against differences of runs:
// random mechanisms, every kind of measure, columns of all sorts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "analysis/sanitized.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A chain of rods with springs at random places, or one that is driven: numbers of all kinds are parameters.
struct RandomChain {
  std::mt19937_64 random;
  int rods;
  std::string parameters, bodies, constraints, forces;

  double any(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

  RandomChain(unsigned seed, bool driven) : random(seed), rods(driven ? 1 : 2 + static_cast<int>(seed % 2)) {
    // Drawn one by one: compilers evaluate arguments in different orders.
    const double g = any(5, 12), k = any(20, 60), c = any(0.5, 2), x = any(1, 2);
    parameters = fmt::format("\"g\": {}, \"k\": {}, \"c\": {}, \"x\": {}", g, k, c, x);
    for (int b = 0; b < rods; ++b) {
      const std::string before = b == 0 ? "[0, 0]" : fmt::format("[\"=x{}\", \"=y{}\"]", b - 1, b - 1);
      const double angle = any(-1, 0.5), length = any(0.4, 0.8), mass = any(0.5, 2);
      const std::string last = b == 0 ? "" : fmt::format("x{}+", b - 1),
                        last_y = b == 0 ? "" : fmt::format("y{}+", b - 1);
      parameters += fmt::format(
          ", \"l{0}\": {1}, \"m{0}\": {2}, \"x{0}\": \"={3}l{0}*cos({5})\", \"y{0}\": \"={4}l{0}*sin({5})\"", b, length,
          mass, last, last_y, angle);
      bodies += fmt::format("{}\"b{}\": {{\"rod\": {{\"from\": {}, \"to\": [\"=x{}\", \"=y{}\"]}}, \"mass\": \"m{}\"}}",
                            b == 0 ? "" : ",", b, before, b, b, b);
      constraints += fmt::format(R"({}{{"type": "revolute", "name": "J{}", "i": "{}", "j": "b{}.from"}})",
                                 b == 0 ? "" : ",", b, b == 0 ? "ground" : fmt::format("b{}.to", b - 1), b);
    }
    if (driven) {
      // A four-bar that closes for any of these numbers.
      bodies += R"(, "rocker": {"rod": {"from": ["x", 0.1], "to": ["x", 1]}, "mass": 1.5},
        "coupler": {"rod": {"from": ["=x0", "=y0"], "to": ["x", 1]}, "mass": "=m0+1", "points": {"pen": [0.1, "c"]}})";
      constraints += R"(, {"type": "revolute", "name": "R", "i": ["ground", ["x", 0.1]], "j": "rocker.from"},
        {"type": "revolute", "i": "b0.to", "j": "coupler.from"}, {"type": "revolute", "name": "C", "i": "coupler.to", "j": "rocker.to"})";
    }
    forces = R"({"type": "spring_damper", "name": "S", "i": ["ground", ["x", 0.2]], "j": "b)" +
             std::to_string(rods - 1) + R"(.to", "k": "k", "c": "c", "length": "=x/2"})";
  }

  std::string text(const std::string& analysis, const std::string& drivers = "") const {
    return R"({"catena": 1, "gravity": [0, "=-g"], "parameters": {)" + parameters +
           R"(}, "columns": {"own": "=b0.to.x^2*k + b0.angle"},
      "bodies": {)" +
           bodies + R"(}, "constraints": [)" + constraints + "], \"drivers\": [" + drivers + "], \"forces\": [" +
           forces + "], \"analyses\": [" + analysis + "]}";
  }
  std::string names() const {
    std::string list = R"("g", "k", "c", "x")";
    for (int b = 0; b < rods; ++b) list += fmt::format(R"(, "l{0}", "m{0}")", b);
    return list;
  }
};

/// All gradients of a run; what was used stands in the field `mode`.
TextRun sensitivity(const RandomChain& chain, const std::string& inner, const std::string& mode,
                    const std::string& drivers, bool verify = false) {
  return run_text(chain.text(R"({"type": "sensitivity", "mode": ")" + mode + R"(", "parameters": [)" + chain.names() +
                                 "], \"verify\": " + (verify ? "true" : "false") + ", \"of\": " + inner + "}",
                             drivers));
}

void expect_same(const RandomChain& chain, const std::string& inner, const std::string& drivers, double allowed,
                 double verified, unsigned seed) {
  const TextRun forward = sensitivity(chain, inner, "forward", drivers);
  const TextRun back = sensitivity(chain, inner, "adjoint", drivers, true);
  ASSERT_EQ(forward.outcome.exit_code, 0)
      << seed << ": " << forward.outcome.error_text
      << (forward.outcome.analyses.empty() ? "" : forward.analysis().report.message);
  ASSERT_EQ(back.outcome.exit_code, 0) << seed << ": " << back.outcome.error_text << back.analysis().report.message;
  EXPECT_EQ(field<std::string>(forward, "mode"), "forward");
  ASSERT_EQ(field<std::string>(back, "mode"), "adjoint")
      << seed << ": " << (back.analysis().report.warnings.empty() ? "" : back.analysis().report.warnings.front());
  ASSERT_EQ(forward.analysis().measures.size(), back.analysis().measures.size());
  for (std::size_t m = 0; m < forward.analysis().measures.size(); ++m) {
    const MeasureResult &a = forward.analysis().measures[m], &b = back.analysis().measures[m];
    ASSERT_TRUE(a.value && b.value) << seed << " " << a.name << ": " << a.trouble << b.trouble;
    EXPECT_NEAR(*a.value, *b.value, 1e-12 * (1 + std::abs(*a.value))) << seed << " " << a.name;
    double size = std::abs(*a.value);
    for (const double d : a.gradient) size = std::max(size, std::abs(d));
    for (std::size_t p = 0; p < a.gradient.size(); ++p)
      EXPECT_NEAR(a.gradient[p], b.gradient[p], allowed * size) << seed << " " << a.name << ", parameter " << p;
  }
  EXPECT_LT(field<double>(back, "deviation"), verified) << seed << chain.text(inner, drivers);
}

// Integrals look inside of steps, extremes at instants of their own; "at" is not an end of a step.
TEST(AdjointInScenes, OfAMotionIsTheForwardOne) {
  for (unsigned seed = 1; seed <= size_of_test(6u, 1u); ++seed) {
    const RandomChain chain(seed, false);
    const std::string last = std::to_string(chain.rods - 1);
    const std::string inner =
        R"({"type": "dynamics", "until": 0.7, "every": 0.35, "method": "rk8", "tolerance": 1e-10, "outputs": ["b0"], "measures": {
          "end": {"final": "b)" +
        last + R"(.to.y"}, "start": {"first": "J0.fx"}, "rate": {"at": 0.3137, "of": "b)" + last +
        R"(.omega"}, "highest": {"max": "b)" + last +
        R"(.to.y"}, "lowest": {"min": "b0.omega"}, "span": {"range": "b0.to.x"},
          "sum": {"integral": "b)" +
        last + R"(.vx"}, "mean": {"mean": "own"}, "rms": {"rms": "S.force"},
          "reaction": {"at": 0.5021, "of": "J0.fy"}, "acceleration": {"final": "b)" +
        last + R"(.alpha"},
          "energy": {"at": 0.61, "of": "energy.kinetic"}, "pull": {"mean": "J0.fx"},
          "path": {"path": ["b0.to.x", "b0.to.y"], "to": [[0.4, 0.1], [0.3, -0.3]], "timed": )" +
        (seed % 2 ? "true" : "false") + "}}}";
    expect_same(chain, inner, "", 1e-9, 1e-5, seed);
  }
}

TEST(AdjointInScenes, OfAnEquilibriumIsTheForwardOne) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const RandomChain chain(seed, false);
    const std::string inner = R"({"type": "equilibrium", "outputs": ["b0"], "measures": {"place": {"final": "b0.to.x"},
      "angle": {"max": "b1.angle"}, "pull": {"final": "J0.fx"}, "own": {"final": "own"}, "force": {"final": "S.force"},
      "energy": {"field": "energy"}, "potential": {"final": "energy.potential"}}})";
    expect_same(chain, inner, "", 1e-10, 1e-5, seed);
  }
}

TEST(AdjointInScenes, OfDrivenMotionsIsTheForwardOne) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const RandomChain chain(seed, true);
    const std::string drive =
        R"--({"type": "absolute_angle", "name": "D", "i": "b0", "value": {"polynomial": ["=atan2(y0, x0)", "=c/5", "=k/300"]
  }
})--";
    const std::string type = seed % 2 ? "inverse_dynamics" : "kinematics";
    const std::string loads =
        seed % 2 ? R"(, "load": {"max": "D.load"}, "torque": {"rms": "D.load"}, "joint": {"at": 0.1234, "of": "C.fx"})"
                 : "";
    const std::string inner = R"({"type": ")" + type +
                              R"(", "until": 0.3, "every": 0.05, "outputs": ["b0"], "measures": {
      "end": {"final": "coupler.pen.y"}, "fast": {"max": "rocker.omega"}, "bend": {"at": 0.2222, "of": "coupler.pen.ax"},
      "mean": {"mean": "coupler.pen.vx"}, "path": {"path": ["coupler.pen.x", "coupler.pen.y"], "to": [[0.8, 0.7], [0.9, 0.9]]})" +
                              loads + "}}";
    // Differences of `verify` are of 1e-4 of a parameter: beside a dead point, as for seed 1, they miss by 1.5e-5, and
    // by a hundredth of that with steps a tenth as long.
    expect_same(chain, inner, drive, 1e-9, 5e-5, seed);
  }
}

// Adams' steps are gone back over several at once, and a run that an event stops ends where the parameters move it.
TEST(AdjointInScenes, PassesOtherMethodsAndEndsByEvents) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const RandomChain chain(seed, false);
    const std::string inner =
        R"({"type": "dynamics", "until": 0.9, "every": 0.1, "method": "adams", "tolerance": 1e-11, "outputs": ["b0"],
      "events": [{"name": "there", "when": "b0.omega", "value": -0.5, "action": "stop"}],
      "measures": {"end": {"final": "b1.to.y"}, "last": {"final": "t"}, "highest": {"max": "b1.to.x"}, "sum": {"integral": "b0.angle"}}})";
    expect_same(chain, inner, "", 1e-7, 1e-4, seed);
  }
}

// What the adjoint does not pass is carried forward, with a word why where it was asked for.
TEST(AdjointInScenes, GoesForwardWhereItMustAndSaysWhy) {
  const std::string scene =
      R"({"catena": 1, "parameters": {"k": 2, "w": 3}, "bodies": {"b": {"mass": 1, "inertia": 1, "angle": 0.3}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "b"}],
    "forces": [{"type": "torque", "i": "b", "torque": LAW}],
    "analyses": [{"type": "sensitivity", "mode": "adjoint", "parameters": ["k", "w"], "of": {"type": "dynamics", "until": 1,
      "outputs": ["b"], MORE"measures": {"end": {"final": "b.angle"}}}}]})";
  const auto with = [&](const std::string& law, const std::string& more) {
    std::string text = scene;
    text.replace(text.find("LAW"), 3, law);
    return run_text(text.replace(text.find("MORE"), 4, more));
  };
  const std::array<std::array<std::string, 3>, 3> cases{{
      {R"("=-k*b.angle")", "", "laws of state"},
      {R"("=k")",
       R"("events": [{"name": "then", "when": "b.angle", "value": "=w/5", "impulse": {"i": "b", "value": [0, "k"]}},
        {"name": "both", "when": "b.angle", "value": "=w/5", "impulse": {"i": "b", "value": ["k", 0]}}], )",
       "several events"},
      {R"("=k")",
       R"("events": [{"name": "on", "when": "b.angle", "value": "=w/5", "action": "engage", "element": "pin"}], )",
       "begins to hold"},
  }};
  for (const auto& [law, more, why] : cases) {
    const TextRun run = with(law, more);
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_EQ(field<std::string>(run, "mode"), "forward");
    EXPECT_TRUE(std::isfinite(run.analysis().measures.front().gradient[0]));
    bool told = false;
    for (const std::string& warning : run.analysis().report.warnings)
      told = told || (warning.find("carried forward") != std::string::npos && warning.find(why) != std::string::npos);
    EXPECT_TRUE(told) << law;
  }
}

// A law that is nothing takes the mechanism out of those whose derivatives are carried as tangents for all parameters
// at once: in dual numbers, step by step, they are the same.
TEST(ForwardInMotions, ByTangentsIsThatInDualNumbers) {
  for (unsigned seed = 1; seed <= size_of_test(4u, 1u); ++seed) {
    RandomChain chain(seed, false);
    const auto rows = [&] {
      return sensitivity(
          chain,
          R"({"type": "dynamics", "until": 0.5, "every": 0.06, "method": "rk8", "tolerance": 1e-10, "outputs":
            ["b0.to.x", "b1.to.y", "b1.omega", "b0.alpha", "J0.fx", "J1.fy", "S.force", "energy.kinetic", "own"],
            "measures": {"sum": {"integral": "b1.vx"}, "top": {"max": "b1.to.y"}}})",
          "forward", "");
    };
    const TextRun tangents = rows();
    chain.forces += R"(, {"type": "torque", "i": "b0", "torque": "=0*b0.angle"})";
    const TextRun dual = rows();
    ASSERT_EQ(tangents.outcome.exit_code, 0) << tangents.outcome.error_text;
    ASSERT_EQ(dual.outcome.exit_code, 0) << dual.outcome.error_text;
    const ResultStorage &a = tangents.sink.rows.front(), &b = dual.sink.rows.front();
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.columns().size(), b.columns().size());
    for (std::size_t c = 0; c < a.columns().size(); ++c) {
      double size = 1e-3;
      for (std::size_t r = 0; r < a.rows(); ++r) size = std::max(size, std::abs(b.at(r, c)));
      for (std::size_t r = 0; r < a.rows(); ++r)
        EXPECT_NEAR(a.at(r, c), b.at(r, c), 1e-9 * size) << seed << ", row " << r << ": " << a.columns()[c].name;
    }
    for (std::size_t m = 0; m < 2; ++m) {
      for (std::size_t p = 0; p < tangents.analysis().measures[m].gradient.size(); ++p) {
        const double expected = dual.analysis().measures[m].gradient[p];
        EXPECT_NEAR(tangents.analysis().measures[m].gradient[p], expected, 1e-9 * (1 + std::abs(expected))) << seed;
      }
    }
  }
}

// x(T) = a1 + 2 a2 + ... of a body that constant forces k a_k push for T = sqrt(2 m) = 2: the nearest point of the
// plane a1 + 2 a2 + ... + 6 a6 = 9.1 to the origin is a_k = k / 10. Six variables and one measure: by the adjoint.
TEST(AdjointInScenes, LeadsOptimiseToTheKnownOptimum) {
  std::string parameters, forces, variables, sum, squares;
  for (int k = 1; k <= 6; ++k) {
    const std::string comma = k == 1 ? "" : ", ", a = "a" + std::to_string(k);
    parameters += comma + "\"" + a + "\": 0.5";
    forces += comma + R"({"type": "point_force", "i": "b", "force": ["=)" + std::to_string(k) + "*" + a + R"(", 0]})";
    variables += comma + "\"" + a + R"(": {"min": -2, "max": 2})";
    squares += (k == 1 ? "=" : "+") + a + "^2";
  }
  const TextRun run = run_text(R"({"catena": 1, "parameters": {)" + parameters + R"(},
    "bodies": {"b": {"mass": 2, "inertia": 1}}, "forces": [)" +
                               forces + R"(],
    "analyses": [{"type": "optimise", "variables": {)" +
                               variables + R"(}, "minimise": ")" + squares +
                               R"(", "subject_to": ["=way == 9.1"], "of": {"type": "dynamics", "until": 2,
      "tolerance": 1e-10, "measures": {"way": {"final": "b.x"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  for (int k = 1; k <= 6; ++k) EXPECT_NEAR(run.last("a" + std::to_string(k)), k / 10.0, 1e-6) << k;
}

// Columns d() of rows are wanted unless the mode is adjoint: auto carries them forward.
TEST(AdjointInScenes, AutoGivesColumns) {
  const RandomChain chain(3, false);
  const std::string inner =
      R"({"type": "dynamics", "until": 0.1, "outputs": ["b0"], "measures": {"end": {"final": "b0.x"}}})";
  const TextRun run = sensitivity(chain, inner, "auto", "");
  EXPECT_EQ(field<std::string>(run, "mode"), "forward");
  EXPECT_FALSE(run.column("d(b0.x)/d(k)").empty());
  EXPECT_TRUE(sensitivity(chain, inner, "adjoint", "").column("d(b0.x)/d(k)").empty());
}

// A rise of order 3 over T = t1 - t0: the load of its driver is m (6 - 12 tau) / T^2, whose square has the integral
// 12 m^2 / T^3; it jumps where the rise ends, which t1 moves.
TEST(AdjointInScenes, LoadsThatJumpAtAnInstantThatMoves) {
  for (const std::string mode : {"adjoint", "forward", "auto"}) {
    SCOPED_TRACE(mode);
    const TextRun run = run_text(R"({"catena": 1, "parameters": {"t1": 2.2, "m": 2},
      "bodies": {"b": {"mass": "m", "inertia": 1}},
      "constraints": [{"type": "translational", "i": "ground", "j": "b", "axis_i": [1, 0], "axis_j": [1, 0]}],
      "drivers": [{"type": "absolute_x", "name": "d", "i": "b",
                   "value": {"step": {"t0": 0.3, "t1": "t1", "from": 0, "to": 1, "order": 3}}}],
      "analyses": [{"type": "sensitivity", "parameters": ["t1", "m"], "mode": ")" +
                                 mode + R"(", "of": {"type": "inverse_dynamics", "until": 3.1, "every": 0.1,
      "outputs": [], "measures": {"I": {"integral": "d.load"}, "J": {"integral": "=d.load^2"}}}}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const MeasureResult &push = run.analysis().measures[0], &square = run.analysis().measures[1];
    EXPECT_NEAR(push.gradient[0], 0, 1e-10);
    EXPECT_NEAR(push.gradient[1], 0, 1e-10);
    EXPECT_NEAR(square.gradient[0], -36 * 4 / std::pow(1.9, 4), 1e-9);
    EXPECT_NEAR(square.gradient[1], 24 * 2 / std::pow(1.9, 3), 1e-9);
  }
}

// A ball that the first impact stops in its slide, x = u sqrt(2 h / g), and an event that only looks on.
TEST(AdjointInScenes, EventsBesideFriction) {
  for (const std::string mode : {"adjoint", "forward"}) {
    SCOPED_TRACE(mode);
    const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"h": 0.3},
      "bodies": {"b": {"particle": true, "mass": 1, "position": [0, "h"], "velocity": [0.2, 0]}},
      "forces": [{"type": "contact", "name": "C", "i": "ground", "j": "b", "restitution": 0.5, "mu": 0.1,
                  "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
      "analyses": [{"type": "sensitivity", "parameters": ["h"], "mode": ")" +
                                 mode + R"(", "of": {"type": "dynamics", "until": 0.5, "tolerance": 1e-11,
      "outputs": [], "measures": {"end": {"final": "b.x"}},
      "events": [{"name": "e", "when": "b.vy", "value": -1}]}}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_EQ(run.analysis().measures[0].gradient.size(), 1u);
    EXPECT_NEAR(run.analysis().measures[0].gradient[0], 0.1 * std::sqrt(2 / (9.81 * 0.3)), 1e-8);
  }
}

}  // namespace
}  // namespace catena::testing
