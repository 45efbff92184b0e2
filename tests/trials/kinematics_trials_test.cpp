// Trials of assembly, kinematics, inverse dynamics, and of the state that analyses hand on.
#include <cmath>
#include <numbers>

#include "analysis/sanitized.hpp"
#include "oracles/scene_text.hpp"
#include "trials/trial.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

void expect_ok(const TextRun& run) {
  EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  for (const AnalysisResult& result : run.outcome.analyses) {
    EXPECT_EQ(result.report.status, Status::ok) << result.type << ": " << result.report.message;
  }
}

/// The record under "singular" of an analysis.
const FieldRecord& singular(const AnalysisResult& result, std::size_t k) {
  for (const NamedField& field : result.fields) {
    if (field.name == "singular") return std::get<std::vector<FieldRecord>>(field.value).at(k);
  }
  throw std::runtime_error("no singular entries");
}
template <class T>
T value_of(const FieldRecord& record, const std::string& name) {
  for (const auto& [key, value] : record) {
    if (key == name) return std::get<T>(value);
  }
  throw std::runtime_error("no " + name);
}

// A cam of radius r(a) = m + b cos 2 (a - pi / 2) that turns under a flat foot; spline through so many points.
std::string hollow_cam(double m, double b, double rate, double until, int points) {
  std::string angles, radii;
  for (int k = 0; k <= points; ++k) {
    const double a = 2 * pi * k / points;
    angles += (k > 0 ? "," : "") + text_of(a);
    radii += (k > 0 ? "," : "") + text_of(m + b * std::cos(2 * ((k < points ? a : 0) - pi / 2)));
  }
  std::string analyses;
  for (const char* type : {"kinematics", "inverse_dynamics", "dynamics"}) {
    analyses += std::string(analyses.empty() ? "" : ",") + R"({"type": ")" + type +
                R"(", "from": "initial", "until": )" + text_of(until) + R"(, "every": )" + text_of(until / 20) + "}";
  }
  return R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"cam": {"mass": 1, "inertia": 0.1, "position": [0, 0]},
    "foot": {"mass": 1, "inertia": 0.1, "position": [0, )" +
         text_of(m + b) + R"(]}}, "constraints": [{"type": "revolute", "i": "ground", "j": "cam"},
    {"type": "translational", "i": "ground", "j": "foot", "axis_i": [0, 1], "axis_j": [0, 1]},
    {"type": "cam_flat", "name": "E", "i": "cam", "j": "foot", "axis_j": [1, 0],
     "curve": {"polar": {"angle": [)" +
         angles + R"(], "radius": [)" + radii + R"(]}}}],
    "drivers": [{"type": "absolute_angle", "i": "cam", "value": {"polynomial": [0, )" +
         text_of(rate) + R"(]}}], "outputs": ["foot.y"], "analyses": [)" + analyses + "]}";
}

// The foot touches where the cam's tangent lies along it: at angle a in the cam, once this has turned by
// pi - psi(a), psi = a + atan2(r, r'). Where the cam is hollow, psi turns back at r^2 + 2 r'^2 - r r'' = 0: there the
// place that was followed ends, and every analysis with it.
TEST(KinematicTrials, AnalysesEndWhereThePlaceOnAHollowCamEnds) {
  for (unsigned seed = 1; seed <= 10; seed += size_of_test(1u, 6u)) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    // It is hollow from b = m / 5 on: of the last ones by so little that the place jumps by 1/100 ... 1/200 of it.
    const bool shallow = seed > 6;
    const int points = shallow ? 720 : 72;
    const double m = random(0.3, 0.6),
                 hollow = shallow ? 0.2 * (1 + std::pow(10, random(-3.3, -2.8))) : random(0.24, 0.34);
    const double b = m * hollow, rate = random(0.5, 2) * (seed % 2 ? 1 : -1);
    const auto turned_back = [&](double a) {
      const double r = m + b * std::cos(2 * a - pi), r1 = -2 * b * std::sin(2 * a - pi),
                   r2 = -4 * b * std::cos(2 * a - pi);
      return std::pair(r * r + 2 * r1 * r1 - r * r2 > 0, pi - (a + std::atan2(r, r1)));
    };
    double low = 0, high = pi / 2;
    for (int k = 0; k < 60; ++k) (turned_back((low + high) / 2).first ? high : low) = (low + high) / 2;
    const double end = turned_back(high).second / std::abs(rate);
    const TextRun run = run_text(hollow_cam(m, b, rate, 2 * end, points));
    ASSERT_EQ(run.outcome.analyses.size(), 3u) << run.outcome.error_text;
    std::vector<double> instants;
    for (std::size_t k = 0; k < 3; ++k) {
      const AnalysisReport& report = run.analysis(k).report;
      EXPECT_EQ(report.status, Status::step_too_small) << run.analysis(k).type << ": " << report.message;
      const std::size_t at = report.message.find("t = ");
      ASSERT_NE(at, std::string::npos) << report.message;
      instants.push_back(std::stod(report.message.substr(at + 4)));
      // The spline is another curve by some 1e-4.
      EXPECT_NEAR(instants.back(), end, 1e-3 * end) << run.analysis(k).type;
      EXPECT_NEAR(instants.back(), instants.front(), 1e-6 * end) << run.analysis(k).type;
    }
    EXPECT_NE(run.analysis(0).report.message.find("\"E\""), std::string::npos) << run.analysis(0).report.message;
  }
}

// Cranks of 1 kg and 1 m that turn alike: each carries its own centripetal force, and a third of the bar's.
TEST(KinematicTrials, LoadsOfThreeCranksGoOnPastFlatPositions) {
  const TextRun run = run_trial("three_cranks_inverse");
  expect_ok(run);
  ASSERT_EQ(run.column("t", 1).size(), 21u);
  const double force = 4 * pi * pi * (0.5 + 1.0 / 3);
  for (const std::string joint : {"A.fx", "B.fx", "C.fx"}) {
    for (const double t : run.column("t", 1)) {
      // In the flat position the difference between the cranks is a limit, known to some 1e-9 of the force.
      EXPECT_NEAR(at_instant(run, joint, t, 1), force * std::sin(2 * pi * t), 1e-9 * force) << joint << " " << t;
    }
  }
  for (const double load : run.column("drive.load", 1)) EXPECT_NEAR(load, 0, 1e-8);
  for (const std::size_t k : {0u, 1u}) {
    const FieldRecord& record = singular(run.analysis(1), k);
    EXPECT_NEAR(value_of<double>(record, "t"), 0.25 + 0.5 * static_cast<double>(k), 1e-9);
    EXPECT_FALSE(value_of<std::vector<std::string>>(record, "bodies").empty());
    EXPECT_FALSE(value_of<std::vector<std::string>>(record, "branches").empty());
    EXPECT_EQ(value_of<std::string>(record, "driver"), "drive");
    EXPECT_NEAR(value_of<double>(record, "value"), pi + pi * static_cast<double>(k), 1e-8);
  }
}

// The driver alone does work: its load is the rate of the potential energy by the angle. Reactions have no limit in the
// flat position, and none is given.
TEST(KinematicTrials, LoadOnAFlatRowIsTheLimitOfTheMotion) {
  TextRun run = run_trial("inverse_on_flat_row");
  expect_ok(run);
  const double moment = 9.81 * (3 * 0.5 + 1);
  for (const double t : run.column("t")) {
    EXPECT_NEAR(at_instant(run, "d.load", t), moment * std::cos(pi / 2 + 2 * pi * t), 1e-8) << t;
  }
  std::string scene = read_file(std::string(CATENA_DATA_DIR) + "/trials/inverse_on_flat_row.json");
  scene.replace(scene.find("\"d.load\""), 8, "\"d.load\", \"c1.fx\"");
  run = run_text(scene);
  expect_ok(run);
  EXPECT_TRUE(std::isnan(at_instant(run, "c1.fx", 0.25)));
  EXPECT_TRUE(std::isfinite(at_instant(run, "c1.fx", 0.2)));
  bool said = false;
  for (const std::string& warning : run.analysis().report.warnings) {
    said = said || warning.find("grow without bound") != std::string::npos;
  }
  EXPECT_TRUE(said);
}

// Nor is what presses a joint there, its friction, its slip and what it takes: rows beside have them.
TEST(KinematicTrials, FrictionOnAFlatRowIsNotKnown) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"crank": {"mass": 1, "rod": {"from": [0, 0], "to": [0, 1]}},
               "coupler": {"mass": 1, "rod": {"from": [0, 1], "to": [2, 1]}},
               "rocker": {"mass": 1, "rod": {"from": [2, 0], "to": [2, 1]}}},
    "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "crank.from"},
                    {"type": "revolute", "name": "B", "i": "crank.to", "j": "coupler.from"},
                    {"type": "revolute", "name": "C", "i": "coupler.to", "j": "rocker.to"},
                    {"type": "revolute", "name": "D", "i": ["ground", [2, 0]], "j": "rocker.from"}],
    "drivers": [{"type": "absolute_angle", "name": "d", "i": "crank", "value": {"polynomial": ["=pi/2", "=2*pi"]}}],
    "forces": [{"type": "friction", "name": "rub", "joint": "A", "mu": 0.2, "radius": 0.05}],
    "outputs": ["d.load", "rub.force", "rub.friction", "rub.slip"],
    "analyses": [{"type": "inverse_dynamics", "at": [0, 0.125, 0.25, 0.375, 0.5, 0.75]}]})");
  expect_ok(run);
  for (const double t : run.column("t")) {
    const bool flat = t == 0.25 || t == 0.75;
    for (const char* column : {"d.load", "rub.force", "rub.friction", "rub.slip"})
      EXPECT_EQ(std::isnan(at_instant(run, column, t)), flat) << column << " " << t;
    if (flat) continue;
    EXPECT_NEAR(at_instant(run, "rub.slip", t), 2 * pi, 1e-9);
    EXPECT_GT(at_instant(run, "rub.force", t), 0);
    EXPECT_NEAR(at_instant(run, "rub.friction", t), -0.2 * 0.05 * at_instant(run, "rub.force", t), 1e-10);
  }
}

// However far apart rows are: the distance that is driven, and the one end that may go through it.
TEST(KinematicTrials, WhatIsNotSingularIsPassed) {
  const TextRun run = run_trial("not_singular_at_a_quarter");
  expect_ok(run);
  EXPECT_EQ(run.column("t").size(), 5u);
  std::string fine = read_file(std::string(CATENA_DATA_DIR) + "/trials/not_singular_at_a_quarter.json");
  fine.replace(fine.find("\"every\": 0.25"), 13, "\"every\": 0.05");
  const TextRun other = run_text(fine);
  expect_ok(other);
  for (const double t : {0.25, 0.5, 0.75, 1.0}) {
    EXPECT_NEAR(at_instant(run, "b1.angle", t), at_instant(other, "b1.angle", t), 1e-10) << t;
  }
}

TEST(KinematicTrials, AStartInADeadCentreIsLockUp) {
  const TextRun run = run_trial("dead_centre_start");
  EXPECT_EQ(run.analysis(0).report.status, Status::ok);
  EXPECT_EQ(run.analysis(1).report.status, Status::lock_up) << run.analysis(1).report.message;
  const FieldRecord& record = singular(run.analysis(1), 0);
  EXPECT_EQ(value_of<double>(record, "t"), 0);
  EXPECT_EQ(value_of<std::string>(record, "kind"), "lock_up");
  EXPECT_EQ(value_of<std::string>(record, "driver"), "piston");
  EXPECT_EQ(value_of<double>(record, "value"), 4);
  EXPECT_FALSE(value_of<std::vector<std::string>>(record, "bodies").empty());
  EXPECT_FALSE(value_of<std::vector<std::string>>(record, "branches").empty());
  ASSERT_EQ(run.column("t", 1).size(), 1u);
  EXPECT_NEAR(run.last("rod.to.x", 1), 4, 1e-12);
}

// The piston reaches its dead centre at the last row, where the crank's speed is no number.
TEST(KinematicTrials, ADeadCentreOnARowIsLockUp) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"crank": {"angle": 1.26, "points": {"b": [1, 0]}}, "rod": {"position": [0.3, 0.95], "angle": -0.32, "points": {"b": [3, 0]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "crank"}, {"type": "revolute", "i": "crank.b", "j": "rod"},
                    {"type": "absolute_y", "i": "rod.b", "value": 0}],
    "drivers": [{"type": "absolute_x", "i": "rod.b", "value": {"polynomial": [3.5, 0.5]}}],
    "outputs": ["crank.angle", "crank.omega"], "analyses": [{"type": "kinematics", "until": 1, "every": 0.25}]})");
  EXPECT_EQ(run.analysis().report.status, Status::lock_up) << run.analysis().report.message;
  ASSERT_EQ(run.column("t").size(), 5u);
  EXPECT_NEAR(run.last("t"), 1, 1e-9);
  EXPECT_NEAR(run.last("crank.angle"), 0, 1e-5);
  EXPECT_TRUE(std::isnan(run.last("crank.omega")));
}

TEST(KinematicTrials, AFlatSketchIsAssembled) {
  const TextRun run = run_trial("flat_sketch");
  expect_ok(run);
  const std::vector<double> t = run.column("t"), coupler = run.column("coupler.angle"),
                            rocker = run.column("rocker.angle");
  ASSERT_EQ(t.size(), 5u);
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double crank = 10 * t[k];
    EXPECT_NEAR(0.1 * std::cos(crank) + 0.25 * std::cos(coupler[k]) - 0.3 - 0.2 * std::cos(rocker[k]), 0, 1e-12);
    EXPECT_NEAR(0.1 * std::sin(crank) + 0.25 * std::sin(coupler[k]) - 0.2 * std::sin(rocker[k]), 0, 1e-12);
  }
}

TEST(KinematicTrials, AStraightChainIsAssembled) {
  const TextRun run = run_trial("straight_chain");
  expect_ok(run);
  EXPECT_EQ(run.analysis(0).report.dof.value_or(-1), 998);
}

TEST(KinematicTrials, ModesAndAssemblyLeaveTheMotionAlone) {
  for (const std::string between : {"modes", "assemble", "check"}) {
    std::string scene = read_file(std::string(CATENA_DATA_DIR) + "/trials/modes_between_motions.json");
    scene.replace(scene.find("\"modes\""), 7, "\"" + between + "\"");
    const TextRun run = run_text(scene);
    expect_ok(run);
    EXPECT_NEAR(run.first("a.omega", 2), run.last("a.omega", 0), 1e-12) << between;
    EXPECT_EQ(run.first("t", 2), 0.5) << between;
    EXPECT_NEAR(run.last("a.angle", 2), 30 * std::sin(1.0), 1e-6) << between;  // omega2 = 0.1 / 0.1
  }
}

TEST(KinematicTrials, WorkOfAStepIsSummedUpHoweverFarApartRowsAre) {
  const double arm = 0.5, weight = 9.81;
  std::string scene = read_file(std::string(CATENA_DATA_DIR) + "/trials/work_of_a_step.json");
  for (const std::string every : {"0.4", "0.25", "2"}) {
    std::string other = scene;
    other.replace(other.find("\"every\": 0.4"), 12, "\"every\": " + every);
    const TextRun run = run_text(other);
    expect_ok(run);
    EXPECT_NEAR(run.last("drive.work"), weight * arm * std::sin(3.0), 1e-8) << every;
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8) << every;
  }
}

TEST(KinematicTrials, NoReactionsAreNamedWithoutAName) {
  const TextRun run = run_trial("blank_names");
  for (const AnalysisResult& result : run.outcome.analyses) {
    for (const std::string& warning : result.report.warnings) {
      EXPECT_EQ(warning.find("reactions of  are"), std::string::npos) << warning;
    }
  }
}

// A path ends at P = 2; what comes after it begins there, unless it sets P itself or starts anew.
TEST(KinematicTrials, APathHandsOnItsParameter) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"P": 1, "Q": "=2*P"},
    "bodies": {"a": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "absolute_y", "i": "a", "value": 0}, {"type": "absolute_angle", "i": "a", "value": 0}],
    "forces": [{"type": "spring_damper", "i": "ground", "j": ["a", [1, 0]], "k": 1, "length": 1},
               {"type": "point_force", "i": "a", "force": ["Q", 0]}],
    "outputs": ["a.x"],
    "analyses": [{"type": "path", "parameter": "P", "to": 2}, {"type": "equilibrium"},
                 {"type": "equilibrium", "set": {"P": 3}}, {"type": "equilibrium"}, {"type": "equilibrium", "from": "initial"}]})");
  expect_ok(run);
  EXPECT_NEAR(run.last("a.x", 0), 4, 1e-9);
  EXPECT_NEAR(run.last("a.x", 1), 4, 1e-9);
  EXPECT_NEAR(run.last("a.x", 2), 6, 1e-9);
  EXPECT_NEAR(run.last("a.x", 3), 4, 1e-9);
  EXPECT_NEAR(run.last("a.x", 4), 2, 1e-9);
}

}  // namespace
}  // namespace catena::testing
