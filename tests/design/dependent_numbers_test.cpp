// Numbers of an analysis that are expressions of parameters follow them: in sweeps, optimisations, after paths. The
// motion is a crank that turns at w: angle w t.
#include <gtest/gtest.h>

#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

std::string turning(const std::string& analyses) {
  return R"({"catena": 1, "parameters": {"T": 1, "w": 2, "a": 0.25},
  "bodies": {"crank": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"}],
  "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0, "w"]}}],
  "outputs": ["crank.angle"], "analyses": [)" +
         analyses + "]}";
}

constexpr auto measured = R"(, "measures": {"end": {"final": "crank.angle"}, "area": {"integral": "crank.angle"},
    "then": {"at": "=a*T", "of": "crank.angle"}, "off": {"path": ["crank.to.x", "crank.to.y"], "to": [["=2*a", 0]]}}})";

TEST(DependentNumbers, FollowTheDesignsOfASweep) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const auto both = [&](double low, double high) {
      const double y = random(low, high), x = random(low, high);
      return pair_of(x, y);
    };
    const TextRun run =
        run_text(turning(R"({"type": "sweep", "design": "grid", "over": {"T": )" + both(0.5, 3) + R"(, "w": )" +
                         both(-2, 2) + R"(, "a": )" + both(0.1, 0.9) +
                         R"(}, "of": {"type": "kinematics", "until": "=T", "every": "=T/8")" + measured + "}"));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double> T = run.column("T"), w = run.column("w"), a = run.column("a");
    ASSERT_EQ(T.size(), 8u);
    for (std::size_t k = 0; k < T.size(); ++k) {
      EXPECT_NEAR(run.column("end")[k], w[k] * T[k], 1e-10);
      EXPECT_NEAR(run.column("area")[k], w[k] * T[k] * T[k] / 2, 1e-9);
      EXPECT_NEAR(run.column("then")[k], w[k] * a[k] * T[k], 1e-9);
    }
  }
}

TEST(DependentNumbers, GivenPointsOfAPathToo) {
  const TextRun run = run_text(turning(R"({"type": "sweep", "over": {"a": [0.1, 0.4, 0.5]},
    "of": {"type": "kinematics", "until": 1, "every": 0.1)" +
                                       std::string(measured) + "}"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  // From (2 a, 0) the circle of radius 1, on which the crank starts at (1, 0), is 1 - 2 a away.
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(run.column("off")[k], std::abs(1 - 2 * run.column("a")[k]), 1e-7) << k;
}

// The distance of given points that move, from the circle (cos w t, sin w t): timed ones in closed form, and one
// outside from the nearest place.
TEST(DependentNumbers, GivenPointsThatMoveHaveDerivatives) {
  const TextRun run = run_text(turning(R"({"type": "sensitivity", "parameters": ["a", "w"], "of": {
    "type": "kinematics", "until": 1, "every": 0.1, "measures": {
      "timed": {"path": ["crank.to.x", "crank.to.y"], "timed": true, "to": [["a", 0.1], [0.3, "=a^2"], ["=2*a", "=-a"]]},
      "near": {"path": ["crank.to.x", "crank.to.y"], "to": [["=6*a", "=8*a"]]}}}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const auto timed = [](double a, double w) {
    const double px[] = {a, 0.3, 2 * a}, py[] = {0.1, a * a, -a};
    double sum = 0;
    for (int k = 0; k < 3; ++k)
      sum += std::pow(std::cos(w * k / 2) - px[k], 2) + std::pow(std::sin(w * k / 2) - py[k], 2);
    return std::sqrt(sum / 3);
  };
  const auto slope = [](auto&& f) {
    const double h = 1e-3;
    return (f(-2 * h) - 8 * f(-h) + 8 * f(h) - f(2 * h)) / (12 * h);
  };
  EXPECT_NEAR(value(run, "timed"), timed(0.25, 2), 1e-10);
  EXPECT_NEAR(gradient(run, "timed", 0), slope([&](double h) { return timed(0.25 + h, 2); }), 1e-10);
  EXPECT_NEAR(gradient(run, "timed", 1), slope([&](double h) { return timed(0.25, 2 + h); }), 1e-10);
  EXPECT_NEAR(value(run, "near"), 1.5, 1e-9);  // 10 a - 1
  EXPECT_NEAR(gradient(run, "near", 0), 10, 1e-7);
  EXPECT_NEAR(gradient(run, "near", 1), 0, 1e-7);
}

// The last of listed instants is where the run ends; others leave the motion alone.
TEST(DependentNumbers, ListedInstantsThatMoveHaveDerivatives) {
  const TextRun run = run_text(turning(R"({"type": "sensitivity", "parameters": ["T", "a", "w"], "of": {
    "type": "kinematics", "at": [0.1, "=a", "=1.5*T"], "measures": {"end": {"final": "crank.angle"},
      "area": {"integral": "crank.angle"}, "most": {"max": "crank.angle"}, "mean": {"mean": "crank.angle"},
      "first": {"first": "crank.angle"}}}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  for (const char* name : {"end", "most"}) {
    EXPECT_NEAR(gradient(run, name, 0), 2 * 1.5, 1e-9) << name;
    EXPECT_NEAR(gradient(run, name, 1), 0, 1e-9) << name;
    EXPECT_NEAR(gradient(run, name, 2), 1.5, 1e-9) << name;
  }
  EXPECT_NEAR(gradient(run, "area", 0), 2 * 1.5 * 1.5, 1e-9);
  EXPECT_NEAR(gradient(run, "mean", 0), 2 * 1.5 / 2, 1e-9);
  EXPECT_NEAR(gradient(run, "first", 1), 0, 1e-9);
  EXPECT_NEAR(gradient(run, "first", 2), 0.1, 1e-9);
  // The first of them: what is measured there is not followed.
  const TextRun first = run_text(turning(R"({"type": "sensitivity", "parameters": ["a"], "of": {
    "type": "kinematics", "at": ["=a", 1], "measures": {"first": {"first": "crank.angle"}}}})"));
  ASSERT_EQ(first.outcome.exit_code, 0) << first.outcome.error_text;
  EXPECT_TRUE(std::isnan(gradient(first, "first", 0)));
  EXPECT_TRUE(warns(first, "\"at\""));
}

TEST(DependentNumbers, ThatAreNoneFailTheDesign) {
  const TextRun run = run_text(turning(R"--({"type": "sweep", "over": {"T": [-1, 0.5, 1e12]},
    "of": {"type": "kinematics", "until": "=sqrt(T)", "every": 0.0005)--" +
                                       std::string(measured) + "}"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> status = run.column("status");
  EXPECT_EQ(status[0], static_cast<double>(Status::refused));
  EXPECT_EQ(status[1], static_cast<double>(Status::ok));
  EXPECT_EQ(status[2], static_cast<double>(Status::refused));
}

TEST(DependentNumbers, FollowAPath) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"M": 1},
  "bodies": {"bar": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}}},
  "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "bar.from"}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "bar", "k": 10, "angle": 0},
             {"type": "torque", "i": "bar", "torque": "M"}],
  "outputs": ["bar.angle"],
  "analyses": [{"type": "path", "parameter": "M", "to": 4}, {"type": "dynamics", "until": "=M/8", "every": 0.125}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("t", 1), 0.5, 1e-15);
  EXPECT_NEAR(run.last("bar.angle", 1), 0.4, 1e-8);
}

// An angle w t until T: integral w T^2 / 2, mean w T / 2, rms w T / sqrt 3. Rows stay at fixed instants.
TEST(DependentNumbers, HaveTheirPartInDerivatives) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double T = random(0.5, 3), w = random(0.3, 2);
    std::string scene = turning(R"--({"type": "sensitivity", "parameters": ["T", "w"],
      "of": {"type": "kinematics", "until": "=T^2", "every": "=T/8", "measures": {
        "area": {"integral": "crank.angle"}, "mean": {"mean": "crank.angle"}, "size": {"rms": "crank.angle"},
        "least": {"min": "crank.angle"}, "top": {"max": "=sin(pi*t)"}, "start": {"first": "crank.omega"}}}})--");
    for (const auto& [name, number] : {std::pair("\"T\": 1", T), {"\"w\": 2", w}}) {
      const std::string given = name;
      scene.replace(scene.find(given), given.size(), given.substr(0, 5) + text_of(number));
    }
    const TextRun run = run_text(scene);
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const double end = T * T, by_T = 2 * T;
    EXPECT_NEAR(gradient(run, "area", 0), w * end * by_T, 1e-9 * w * end * by_T);
    EXPECT_NEAR(gradient(run, "mean", 0), w / 2 * by_T, 1e-9);
    EXPECT_NEAR(gradient(run, "size", 0), w / std::sqrt(3) * by_T, 1e-9);
    EXPECT_NEAR(gradient(run, "size", 1), end / std::sqrt(3), 1e-9);
    EXPECT_NEAR(gradient(run, "least", 0), 0, 1e-12);
    EXPECT_NEAR(gradient(run, "start", 1), 1, 1e-12);
    if (end > 0.6) {
      EXPECT_NEAR(gradient(run, "top", 0), 0, 1e-9);
    }
    EXPECT_NEAR(run.last("d(crank.angle)/d(T)"), 0, 1e-12);
    EXPECT_NEAR(run.last("d(crank.angle)/d(w)"), end, 1e-12);
  }
}

// Values at moving instants: w T at the end, w a T at a T. The point (2 a, 0) is nearest to where the crank starts.
TEST(DependentNumbers, OfInstantsAndPointsAreFollowed) {
  const TextRun run = run_text(turning(R"--({"type": "sensitivity", "parameters": ["T", "w", "a"],
    "of": {"type": "kinematics", "until": "=T", "every": "=T/8")--" +
                                       std::string(measured) + "}"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double T = 1, w = 2, a = 0.25;
  EXPECT_NEAR(gradient(run, "end", 0), w, 1e-9);
  EXPECT_NEAR(gradient(run, "end", 1), T, 1e-12);
  EXPECT_NEAR(gradient(run, "end", 2), 0, 1e-12);
  EXPECT_NEAR(gradient(run, "then", 0), w * a, 1e-9);
  EXPECT_NEAR(gradient(run, "then", 1), a * T, 1e-12);
  EXPECT_NEAR(gradient(run, "then", 2), w * T, 1e-9);
  EXPECT_NEAR(gradient(run, "area", 1), 0.5, 1e-9);
  EXPECT_NEAR(gradient(run, "off", 2), -2, 1e-7);
}

// Two motions, the second from where the first ends: the particle is at 2 v in the end.
TEST(DependentNumbers, AMotionThatGoesOnFromAnotherHasNoDerivativeEither) {
  const auto search = [](const char* solver, const char* from) {
    return run_text(R"({"catena": 1, "parameters": {"v": 1},
    "bodies": {"a": {"particle": true, "mass": 2, "velocity": ["v", 0]}}, "outputs": ["a.x"],
    "analyses": [{"type": "optimise", "variables": {"v": {"min": 0, "max": 5}}, "solver": ")" +
                    std::string(solver) + R"(", "minimise": "=(e - 3)^2", "of": [{"type": "dynamics", "until": 1},
      {"type": "dynamics", "from": ")" +
                    from + R"(", "until": 2, "measures": {"e": {"final": "a.x"}}}]}]})");
  };
  const TextRun refused = search("slsqp", "previous");
  EXPECT_EQ(refused.outcome.exit_code, 1);
  EXPECT_NE(refused.analysis().report.message.find("goes on from the end of dynamics"), std::string::npos)
      << refused.analysis().report.message;
  EXPECT_NEAR(search("bobyqa", "previous").last("v"), 1.5, 1e-4);
  EXPECT_NEAR(search("slsqp", "initial").last("v"), 1.5, 1e-8);
}

// The run ends where the crank has turned by r, at r/w: area r^2 / (2 w).
TEST(DependentNumbers, ARunThatAnEventEndsHasTheDerivativesOfItsEnd) {
  const TextRun run = run_text(turning(R"--({"type": "sensitivity", "parameters": ["w"], "of": {"type": "kinematics",
    "until": 1, "every": 0.1, "events": [{"when": "crank.angle", "value": 0.4, "action": "stop"}], "measures": {
    "area": {"integral": "crank.angle"}, "most": {"max": "crank.angle"}, "start": {"first": "crank.omega"}}}})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(value(run, "area"), 0.04, 1e-10);
  EXPECT_NEAR(gradient(run, "area", 0), -0.02, 1e-9);
  EXPECT_NEAR(gradient(run, "most", 0), 0, 1e-9);
  EXPECT_NEAR(gradient(run, "start", 0), 1, 1e-12);
}

// An analysis inside that starts from the scene does so: x = F t^2 / 2 from t = 0.
TEST(DependentNumbers, SensitivityStartsWhereItsAnalysisSays) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"F": 3},
  "bodies": {"b": {"mass": 1, "particle": true}}, "forces": [{"type": "point_force", "i": "b", "force": ["F", 0]}],
  "outputs": ["b.x"], "analyses": [{"type": "dynamics", "until": 1}, {"type": "sensitivity", "parameters": ["F"],
    "of": {"type": "dynamics", "from": "initial", "until": 2, "every": 1}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(run.first("t", 1), 0);
  EXPECT_NEAR(run.last("d(b.x)/d(F)", 1), 2, 1e-9);
}

TEST(DependentNumbers, AreOptimisedWithDerivativesAndWithout) {
  const auto search = [](const char* solver) {
    return run_text(turning(R"({"type": "optimise", "variables": {"T": {"min": 0.5, "max": 3}}, "solver": ")" +
                            std::string(solver) + R"(", "minimise": "=(end - 3)^2",
      "of": {"type": "kinematics", "until": "=T", "every": 0.1, "measures": {"end": {"final": "crank.angle"}}}})"));
  };
  const TextRun found = search("bobyqa");
  EXPECT_EQ(found.outcome.exit_code, 0) << found.outcome.error_text << found.analysis().report.message;
  EXPECT_NEAR(found.last("T"), 1.5, 1e-4);
  const TextRun exact = search("slsqp");
  EXPECT_EQ(exact.outcome.exit_code, 0) << exact.outcome.error_text << exact.analysis().report.message;
  EXPECT_NEAR(exact.last("T"), 1.5, 1e-7);
}

}  // namespace
}  // namespace catena::testing
