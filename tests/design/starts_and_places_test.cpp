// Derivatives of starts and of assembled places in closed form, and what is said where there are none.
#include <gtest/gtest.h>

#include "catena/analysis/measures/measure_set.hpp"
#include "catena/analysis/sensitivity/motion_derivatives.hpp"
#include "catena/scene/models/scene_models.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

/// Two particles pinned together that move along x: b has the velocity w.
TextRun pinned(const std::string& mass_a, const std::string& mass_b, const std::string& velocity_a = "") {
  return run_text(R"({"catena": 1, "parameters": {"w": 3},
  "bodies": {"a": {"particle": true, "mass": )" +
                  mass_a + velocity_a + R"(}, "b": {"particle": true, "velocity": ["w", 0], "mass": )" + mass_b +
                  R"(}},
  "constraints": [{"type": "absolute_y", "i": "a", "value": 0}, {"type": "revolute", "i": "a", "j": "b"}],
  "outputs": ["a.vx", "a.x"],
  "analyses": [{"type": "sensitivity", "parameters": ["w"], "of": {"type": "dynamics", "until": 0.5, "every": 0.25}}]})");
}

TEST(StartGradients, OfAGivenVelocityOfWhatHasNoMass) {
  const TextRun run = pinned("2", "0");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.first("a.vx"), 3, 1e-12);
  EXPECT_NEAR(run.first("d(a.vx)/d(w)"), 1, 1e-9);
  EXPECT_NEAR(run.last("d(a.x)/d(w)"), 0.5, 1e-9);
}

// Assembly before it leaves places behind, not velocities: they are the model's still.
TEST(StartGradients, OfVelocitiesAfterAnAssembly) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"w": 3},
  "bodies": {"a": {"particle": true, "mass": 2, "velocity": ["w", 0]}}, "outputs": ["a.vx", "a.x"],
  "analyses": [{"type": "assemble"},
    {"type": "sensitivity", "parameters": ["w"], "of": {"type": "dynamics", "until": 0.5, "every": 0.25}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.first("d(a.vx)/d(w)", 1), 1, 1e-9);
  EXPECT_NEAR(run.last("d(a.x)/d(w)", 1), 0.5, 1e-9);
}

// Two levers on one gear train: a velocity that is given determines the other, whatever the masses.
TEST(StartGradients, ByMassesThatChangeNothingAreZero) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const TextRun run = run_text(R"({"catena": 1, "parameters": {"m": )" + text_of(std::pow(10, random(-1, 1))) + R"(},
    "bodies": {"a": {"mass": )" + text_of(std::pow(10, random(-1, 1))) +
                                 R"(, "inertia": 1, "angular_velocity": 2},
               "b": {"mass": "m", "inertia": "m", "position": [3, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a"},
                    {"type": "revolute", "i": ["ground", [3, 0]], "j": "b"},
                    {"type": "gear", "i": "a", "j": "b", "radius_i": 1, "radius_j": )" +
                                 text_of(random(0.3, 3)) + R"(}],
    "outputs": ["b.omega"],
    "analyses": [{"type": "sensitivity", "parameters": ["m"], "of": {"type": "dynamics", "at": [0]}}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(run.first("d(b.omega)/d(m)"), 0, 1e-12);
  }
}

TEST(StartGradients, OfWhatFollowsWithoutMass) {
  const TextRun run = pinned("0", "2");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.first("d(a.vx)/d(w)"), 1, 1e-9);
  EXPECT_NEAR(run.last("d(a.x)/d(w)"), 0.5, 1e-9);
}

TEST(StartGradients, OfGivenVelocitiesThatContradictEachOtherAreRefused) {
  const TextRun run = pinned("2", "1", R"(, "velocity": [1, 0])");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(std::isnan(run.first("d(a.vx)/d(w)")));
  EXPECT_TRUE(warns(run, "do not meet the constraints"));
}

TEST(StartGradients, OfVelocitiesThatDoNotSettleAreRefused) {
  const TextRun run = pinned("1", "1e-12");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(std::isnan(run.first("d(a.vx)/d(w)")));
  EXPECT_TRUE(warns(run, "do not settle"));
}

// A particle given at (a, b) is assembled to the nearest place of the unit circle: x = a/r, y = b/r.
TEST(AssemblyGradients, OfTheNearestPlace) {
  const std::string scene = R"({"catena": 1, "parameters": {"a": 0.9, "b": 1.3},
  "bodies": {"bead": {"particle": true, "mass": 1, "position": ["a", "b"]}},
  "constraints": [{"type": "absolute_distance", "i": "bead", "ground": [0, 0], "value": 1}],
  "outputs": ["bead.x", "bead.y"],
  "analyses": [)";
  const std::string analysis =
      R"({"type": "sensitivity", "parameters": ["a", "b"], "verify": true, "of": {"type": "assemble"}})";
  const TextRun run = run_text(scene + analysis + "]}");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double a = 0.9, b = 1.3, r3 = std::pow(a * a + b * b, 1.5);
  EXPECT_NEAR(run.first("d(bead.x)/d(a)"), b * b / r3, 1e-10);
  EXPECT_NEAR(run.first("d(bead.x)/d(b)"), -a * b / r3, 1e-10);
  EXPECT_NEAR(run.first("d(bead.y)/d(b)"), a * a / r3, 1e-10);
  EXPECT_LT(field<double>(run, "deviation"), 1e-6);
  // Where an earlier analysis ended, the given place has no say.
  const TextRun second = run_text(scene + R"({"type": "assemble"}, )" + analysis + "]}");
  ASSERT_EQ(second.outcome.exit_code, 0) << second.outcome.error_text;
  EXPECT_NEAR(second.first("d(bead.x)/d(a)", 1), 0, 1e-12);
}

/// A pendulum of length L that starts at the angle s from the vertical, where it is not in balance: the frequency of
/// its stiffness there is sqrt(g/L cos s).
std::string pendulum(const std::string& before) {
  return R"--({"catena": 1, "gravity": [0, -9.81], "parameters": {"s": 0.4, "L": 0.7},
  "bodies": {"bob": {"particle": true, "mass": 2, "position": ["=L*sin(s)", "=-L*cos(s)"]}},
  "constraints": [{"type": "absolute_distance", "i": "bob", "ground": [0, 0], "value": "L"}],
  "analyses": [)--" +
         before + R"({"type": "sensitivity", "parameters": ["s"],
    "of": {"type": "modes", "measures": {"square": {"field": "omega2[1]"}}}}]})";
}

TEST(PlaceGradients, OfFrequenciesKnowWhereThePlaceComesFrom) {
  const TextRun given = run_text(pendulum(""));
  ASSERT_EQ(given.outcome.exit_code, 0) << given.outcome.error_text << given.analysis().report.message;
  EXPECT_NEAR(value(given, "square"), 9.81 / 0.7 * std::cos(0.4), 1e-9);
  EXPECT_NEAR(gradient(given, "square", 0), -9.81 / 0.7 * std::sin(0.4), 1e-8);
  // Left there by an earlier analysis, it does not move with s.
  const TextRun left = run_text(pendulum(R"({"type": "assemble"}, )"));
  ASSERT_EQ(left.outcome.exit_code, 0) << left.outcome.error_text;
  ASSERT_EQ(left.analysis(1).measures.size(), 1u);
  EXPECT_NEAR(left.analysis(1).measures[0].gradient.at(0), 0, 1e-10);
}

TEST(MissingDerivatives, NothingToCompareIsNoDeviation) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"s": 0.4},
  "bodies": {"bob": {"mass": 3, "inertia": 0.2, "position": [0, "=-s"], "points": {"pivot": [0, "s"]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "bob.pivot"}],
  "analyses": [{"type": "sensitivity", "parameters": ["s"], "verify": true, "of": {"type": "modes"}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  for (const NamedField& f : run.analysis().fields) EXPECT_NE(f.name, "deviation");
  EXPECT_TRUE(warns(run, "nothing to compare"));
  EXPECT_TRUE(warns(run, "rows of modes have none"));
}

TEST(MissingDerivatives, OfColumnsAlongAPathSaySo) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"k": 9, "P": 0},
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 0}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "rod.from"}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "rod", "k": "k", "angle": 0},
             {"type": "point_force", "i": "rod.to", "force": [0, "P"]}],
  "outputs": ["rod.angle"],
  "analyses": [{"type": "sensitivity", "parameters": ["k"],
    "of": {"type": "path", "parameter": "P", "to": 2, "measures": {"turn": {"final": "rod.angle"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(std::isnan(gradient(run, "turn", 0)));
  EXPECT_TRUE(warns(run, "measure \"turn\": columns along a path have no derivatives"));
  EXPECT_TRUE(warns(run, "rows of path have none"));
}

TEST(MissingDerivatives, OfWorkSaySo) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"r": 0.2}, "gravity": [0, -10],
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": ["r", 0]}, "mass": 2}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "rod.from"}],
  "drivers": [{"type": "absolute_angle", "name": "drive", "i": "rod", "value": {"polynomial": [0, 1]}}],
  "outputs": ["drive.work", "drive.load"],
  "analyses": [{"type": "sensitivity", "parameters": ["r"],
    "of": {"type": "inverse_dynamics", "until": 1, "every": 0.5, "measures": {"lift": {"max": "drive.work"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(std::isnan(run.last("d(drive.work)/d(r)")));
  EXPECT_NEAR(run.first("d(drive.load)/d(r)"), 10, 1e-10);
  EXPECT_TRUE(warns(run, "measure \"lift\": work and dissipated energy"));
  EXPECT_TRUE(warns(run, "derivatives: work and dissipated energy"));
}

/// A particle that falls, whose mass is the parameter.
struct Falling {
  Diagnostics diagnostics{10};
  std::unique_ptr<SceneTemplate> scene =
      read_scene(SourceText("falling", R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"m": 2},
        "bodies": {"bob": {"particle": true, "mass": "m", "position": [0, 1]}}})"),
                 diagnostics);
  SceneModels models{*scene, 1000};
  std::shared_ptr<const Model> model = models.model(scene->parameters, {});
  std::shared_ptr<const Plan> plan = Plan::make(*model);
  EvaluationWork work;
  Evaluator evaluator{plan, *model, work};
};

TEST(MissingDerivatives, OfAMotionThatCannotBeLookedAtAreNotMadeUp) {
  Falling falling;
  const int m = 0;
  MotionDerivatives derivatives(falling.evaluator, falling.models.designs(falling.scene->parameters, {}, {&m, 1}), 1,
                                GivenByModel{true, true});
  derivatives.cover({0, 0.1, [](double) { return std::optional<Snapshot>(); }});
  const std::vector<double> q = falling.evaluator.given_configuration(), qd(q.size(), 0.0);
  EXPECT_FALSE(derivatives.find({.evaluator = falling.evaluator, .t = 0.1, .q = q, .qd = qd}));
  EXPECT_NE(derivatives.why().find("could not be looked at"), std::string::npos) << derivatives.why();
}

TEST(Measures, OfSingleRowsLeaveTheMotionBetweenThemAlone) {
  Falling falling;
  const ColumnSources sources{.analysis = "dynamics", .timed = true, .velocity = true};
  MeasureRequest end;
  end.name = "end";
  end.kind = MeasureKind::final;
  end.columns = {"bob.y"};
  MeasureRequest most = end;
  most.kind = MeasureKind::maximum;
  for (const MeasureRequest& request : {end, most}) {
    MeasureSet measures({request}, *falling.model, *falling.plan, sources, {0, 1});
    int looks = 0;
    measures.cover({0, 1, [&](double) {
                      ++looks;
                      return std::optional<Snapshot>();
                    }});
    EXPECT_EQ(looks, request.kind == MeasureKind::final ? 0 : 1);
  }
}

// A fall through 2000 rows: the stretches that are looked at grow with what they show, whatever the rows.
TEST(Measures, OfManyRowsAreLookedForAsOftenAsTheMotionAsks) {
  Falling falling;
  const ColumnSources sources{.analysis = "dynamics", .timed = true, .velocity = true};
  MeasureRequest area;
  area.name = "area";
  area.kind = MeasureKind::integral;
  area.columns = {"bob.y"};
  MeasureSet measures({area}, *falling.model, *falling.plan, sources, {0, 2});
  std::vector<double> q(static_cast<std::size_t>(falling.plan->coordinates()), 0.0);
  int looks = 0;
  const auto at = [&](double t) {
    ++looks;
    q[1] = std::sin(t);
    falling.evaluator.set_configuration(q);
    return std::optional<Snapshot>(Snapshot{.evaluator = falling.evaluator, .t = t, .q = q});
  };
  double covered = 0;
  for (int k = 0; k <= 2000; ++k) {
    const double t = k * 1e-3;
    if (t > covered && (t - covered >= measures.pace() || k == 2000)) {
      measures.cover({covered, t, at});
      covered = t;
    }
    measures.take_row(*at(t), false);
  }
  // Stretches of 1, 2, 4 ... rows of nine looks, up to some 0.25 s; without that 18,000.
  EXPECT_LT(looks - 2001, 250);
  EXPECT_NEAR(*measures.results().front().value, 2 + 1 - std::cos(2), 1e-12);  // it starts at y = 1
}

// The crank turns by w t: at its first row, which is not where the motion starts, d/dw is t.
TEST(MeasureGradients, OfTheFirstRowWhereverItIs) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"w": 2},
  "bodies": {"crank": {"rod": {"from": [0, 0], "to": [1, 0]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"}],
  "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0, "w"]}}],
  "outputs": ["crank.angle"],
  "analyses": [{"type": "sensitivity", "parameters": ["w"], "of": {"type": "kinematics", "at": [0.75, 1.5],
    "measures": {"first": {"first": "crank.angle"}, "final": {"final": "crank.angle"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(gradient(run, "first", 0), 0.75, 1e-12);
  EXPECT_NEAR(gradient(run, "final", 0), 1.5, 1e-12);
}

// A rod that assembly moves and turns to its pin: how much an angle weighs beside a place follows the arm, which moves.
TEST(StartDerivatives, OfAnAssemblyWhoseWeightsMove) {
  const auto turned = [](double a) {
    const TextRun run = run_text(R"({"catena": 1, "parameters": {"a": )" + std::to_string(a) + R"(},
    "bodies": {"rod": {"mass": 1, "inertia": 0.2, "position": [0.3, 0.4], "angle": 0.5}},
    "constraints": [{"type": "revolute", "i": ["ground", [0, 0]], "j": ["rod", ["=-a", "=a/3"]]}],
    "outputs": ["rod.x", "rod.angle"],
    "analyses": [{"type": "sensitivity", "parameters": ["a"], "of": {"type": "dynamics", "until": 0.1}}]})");
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    return run;
  };
  const double h = 1e-3;
  const TextRun run = turned(0.4), below = turned(0.4 - h), above = turned(0.4 + h);
  for (const std::string column : {"rod.x", "rod.angle"}) {
    const double difference = (above.first(column) - below.first(column)) / (2 * h);
    EXPECT_NEAR(run.first("d(" + column + ")/d(a)"), difference, 1e-5) << column;
  }
}

}  // namespace
}  // namespace catena::testing
