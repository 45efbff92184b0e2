// Nothing is evaluated outside a run: functions of time before its start or after its end, tables and curves beyond
// their ends. What is right is closed forms, or a scalar equation integrated here.
#include <cmath>
#include <numbers>
#include <random>
#include <regex>

#include "trials/trial.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// The number after "t = " in a message.
double instant_in(const std::string& message) {
  std::smatch found;
  return std::regex_search(message, found, std::regex("t = ([-+0-9.e]+)")) ? std::stod(found[1]) : std::nan("");
}

// Three parallel cranks of 1 m and 1 kg and the bar of 1 kg that they carry: 2 kg m^2 about any of the pins, and a
// weight of 2.5 g cos(angle). The torque is the natural spline through (0, 0), (0.5, 5), (1, 0): 15 t - 20 t^3, and the
// same backwards.
TEST(TableFromZero, DrivesThreeCranksFromItsStartToItsEnd) {
  const auto torque = [](double t) {
    const double u = t <= 0.5 ? t : 1 - t;
    return 15 * u - 20 * u * u * u;
  };
  const auto acceleration = [&](double t, double angle) { return (torque(t) - 2.5 * 9.81 * std::cos(angle)) / 2; };
  const int steps = 20000;
  const double h = 1.0 / steps;
  double angle = 2, rate = 0;
  for (int k = 0; k < steps; ++k) {
    const double t = k * h;
    const double k1 = acceleration(t, angle), k2 = acceleration(t + h / 2, angle + h / 2 * rate);
    const double k3 = acceleration(t + h / 2, angle + h / 2 * rate + h * h / 4 * k1);
    const double k4 = acceleration(t + h, angle + h * rate + h * h / 2 * k2);
    angle += h * rate + h * h / 6 * (k1 + k2 + k3);
    rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  const TextRun run = run_trial("table_from_zero");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_NEAR(run.last("b1.angle"), angle, 1e-6);
}

TEST(BeyondSplineEnd, EndsTheRunWhereTheRailEnds) {
  const TextRun run = run_trial("beyond_spline_end");
  const Report& report = run.analysis().report;
  EXPECT_EQ(report.status, Status::singular);
  EXPECT_NEAR(instant_in(report.message), 1, 1e-8) << report.message;
  EXPECT_NE(report.message.find("(1, 1)"), std::string::npos) << report.message;
  EXPECT_EQ(run.column("t"), (std::vector<double>{0, 0.5, 1}));
  EXPECT_NEAR(run.last("runner.y"), 1, 1e-9);
}

TEST(BeyondSplineEnd, GoesOnStraightWhereItIsAskedTo) {
  std::string text = read_file(std::string(CATENA_DATA_DIR) + "/trials/beyond_spline_end.json");
  text.replace(text.find("\"end\": \"natural\""), 16, "\"end\": \"natural\", \"beyond\": \"line\"");
  const TextRun run = run_text(text);
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  const std::vector<double> y = run.column("runner.y");
  ASSERT_EQ(y.size(), 11u);
  for (std::size_t k = 3; k < y.size(); ++k) EXPECT_NEAR(y[k] - y[k - 1], y[10] - y[9], 1e-9);
}

/// A runner on a straight rail from x = 0 to x = 1, and a spring: what is said of them.
std::string rail_scene(const std::string& more, const std::string& beyond = "error") {
  return R"({"catena": 1, "bodies": {"runner": {"mass": 1, "inertia": 1, "position": [0.5, 0]}},
    "constraints": [{"type": "absolute_angle", "i": "runner", "value": 0},
      {"type": "point_on_curve", "name": "rail", "i": "ground", "j": "runner",
       "curve": {"spline": {"points": [[0, 0], [0.3, 0], [1, 0]], "beyond": ")" +
         beyond + R"("}}}], "outputs": ["runner.x"], )" + more + "}";
}

// x = 0.5 + a sin(2 pi t) passes 1 at asin(0.5 / a) / (2 pi), between rows that are all at 0.5.
TEST(CurveEnd, IsNoticedBetweenRows) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> amplitude(0.3, 0.9);
  int left = 0;
  for (int k = 0; k < 40; ++k) {
    const double a = amplitude(random);
    const std::string number = std::to_string(a);
    const std::string motion =
        R"("drivers": [{"type": "absolute_x", "i": "runner", "value": {"harmonic": {"amplitude": )" + number +
        R"(, "omega": "=2*pi", "offset": 0.5}}}], "analyses": [{"type": "kinematics", "until": 2, "every": 0.5}])";
    const TextRun run = run_text(rail_scene(motion));
    const Report& report = run.analysis().report;
    if (std::stod(number) < 0.5) {
      EXPECT_TRUE(report.ok()) << number << ": " << report.message;
      continue;
    }
    ++left;
    EXPECT_EQ(report.status, Status::singular) << number;
    EXPECT_NEAR(instant_in(report.message), std::asin(0.5 / std::stod(number)) / (2 * pi), 1e-7) << report.message;
    EXPECT_TRUE(run_text(rail_scene(motion, "line")).analysis().report.ok());
  }
  EXPECT_GT(left, 5);
}

// On a spring of 100 N/m about x = 0.5 the runner swings with 10 rad/s; 6 m/s carry it to 1.1, past the end at 1.
TEST(CurveEnd, IsNoticedInDynamicsByEveryMethod) {
  for (const char* method : {"auto", "rk8", "rk5", "adams", "baumgarte", "partitioning"}) {
    for (const char* analysis : {R"("until": 3, "every": 3)", R"("until": 3, "every": 0.01)"}) {
      const std::string text = R"("forces": [{"type": "point_force", "i": "runner", "force": [{"sum": [0, 0]}, 0]},
        {"type": "bushing", "i": ["ground", [0.5, 0]], "j": "runner", "kx": 100, "ky": 0, "kt": 0}],
        "analyses": [{"type": "dynamics", "method": ")" +
                               std::string(method) + "\", " + analysis + "}]";
      std::string scene = rail_scene(text);
      scene.replace(scene.find("\"position\""), 10, "\"velocity\": [6, 0], \"position\"");
      const TextRun run = run_text(scene);
      ASSERT_EQ(run.outcome.exit_code, 1) << run.outcome.error_text;
      const Report& report = run.analysis().report;
      EXPECT_EQ(report.status, Status::singular) << method << report.message;
      EXPECT_NEAR(instant_in(report.message), std::asin(5.0 / 6) / 10, 1e-6) << method << report.message;
      for (double x : run.column("runner.x")) EXPECT_LE(x, 1 + 1e-9);
    }
  }
}

/// A mass of 1 kg on a spring whose force is a table of 100 N/m to an elongation of 0.1 m, pushed by 1 m/s.
std::string table_scene(const std::string& beyond, const std::string& analysis, const std::string& velocity = "1") {
  return R"({"catena": 1, "bodies": {"a": {"mass": 1, "inertia": 1, "position": [1, 0], "velocity": [)" + velocity +
         R"(, 0]}}, "constraints": [{"type": "absolute_angle", "i": "a"}, {"type": "absolute_y", "i": "a"}],
    "forces": [{"type": "spring_damper", "name": "s", "i": "ground", "j": "a", "length": 1,
      "curve": {"points": [[-0.1, -10], [0.1, 10]], "beyond": ")" +
         beyond + R"("}}, {"type": "point_force", "name": "P", "i": "a", "force": ["load", 0]}],
    "parameters": {"load": 0}, "outputs": ["a.x"], "analyses": [)" +
         analysis + "]}";
}

TEST(TableEnd, IsNoticedInEveryAnalysis) {
  // x - 1 = 0.1 sin(10 t) reaches the end with 1 m/s, with 2 m/s it passes it at asin(1/2) / 10.
  const std::string swing = R"({"type": "dynamics", "until": 2, "every": 1})";
  EXPECT_TRUE(run_text(table_scene("error", swing, "0.999")).analysis().report.ok());
  const TextRun past = run_text(table_scene("error", swing, "2"));
  EXPECT_EQ(past.analysis().report.status, Status::singular);
  EXPECT_NEAR(instant_in(past.analysis().report.message), pi / 60, 1e-7) << past.analysis().report.message;
  const TextRun line = run_text(table_scene("line", R"({"type": "dynamics", "until": 0.1, "every": 0.05})", "2"));
  ASSERT_TRUE(line.analysis().report.ok());
  EXPECT_NEAR(line.last("a.x"), 1 + 0.2 * std::sin(1.0), 1e-7);

  const std::string rest = R"({"type": "equilibrium", "set": {"load": LOAD}})";
  const auto with_load = [&](const char* load) {
    std::string text = rest;
    return text.replace(text.find("LOAD"), 4, load);
  };
  EXPECT_NEAR(run_text(table_scene("error", with_load("9"), "0")).last("a.x"), 1.09, 1e-9);
  EXPECT_EQ(run_text(table_scene("error", with_load("20"), "0")).analysis().report.status, Status::singular);
  EXPECT_NEAR(run_text(table_scene("line", with_load("20"), "0")).last("a.x"), 1.2, 1e-9);
  EXPECT_FALSE(run_text(table_scene("hold", with_load("20"), "0")).analysis().report.ok());
  const TextRun path = run_text(table_scene("error", R"({"type": "path", "parameter": "load", "to": 20})", "0"));
  EXPECT_EQ(path.analysis().report.status, Status::singular) << path.analysis().report.message;
  for (double x : path.column("a.x")) EXPECT_LE(x, 1.1 + 1e-6);
}

TEST(TimeTable, HoldsOrGoesOnWhereItIsAskedTo) {
  const auto scene = [](const std::string& beyond, const std::string& until) {
    return R"({"catena": 1, "bodies": {"a": {}}, "constraints": [{"type": "absolute_angle", "i": "a"},
      {"type": "absolute_y", "i": "a"}], "drivers": [{"type": "absolute_x", "name": "d", "i": "a", "value":
      {"spline": {"t": [0, 1], "value": [0, 2])" +
           beyond + R"(}}}], "outputs": ["a.x", "a.vx"], "analyses": [{"type": "kinematics", "until": )" + until +
           R"(, "every": 0.5}]})";
  };
  EXPECT_TRUE(run_text(scene("", "1")).analysis().report.ok());
  const TextRun refused = run_text(scene("", "3"));
  EXPECT_EQ(refused.analysis().report.status, Status::refused);
  EXPECT_NE(refused.analysis().report.message.find("\"d\" reaches from 0 to 1 s"), std::string::npos);
  const TextRun held = run_text(scene(", \"beyond\": \"hold\"", "3"));
  EXPECT_NEAR(held.last("a.x"), 2, 1e-12);
  EXPECT_NEAR(held.last("a.vx"), 0, 1e-12);
  EXPECT_NEAR(run_text(scene(", \"beyond\": \"line\"", "3")).last("a.x"), 6, 1e-12);
  EXPECT_EQ(run_text(scene(", \"beyond\": \"line\", \"end\": \"periodic\"", "3")).outcome.exit_code, 3);
}

// A static analysis is made at an instant: tables need not begin before it.
TEST(TimeTable, NeedsOnlyToCoverTheInstantOfAStaticAnalysis) {
  const std::string text = R"({"catena": 1, "bodies": {"a": {"mass": 1, "inertia": 1, "position": [1, 0]}},
    "constraints": [{"type": "absolute_angle", "i": "a"}, {"type": "absolute_y", "i": "a"}],
    "forces": [{"type": "spring_damper", "i": "ground", "j": "a", "k": 100, "length": 1},
      {"type": "point_force", "name": "P", "i": "a",
       "force": [{"spline": {"t": [5, 6, 7], "value": [0, 10, 0]}}, 0]}],
    "outputs": ["a.x"], "analyses": [{"type": "equilibrium", "at": AT}]})";
  const auto at = [&](const char* t) {
    std::string scene = text;
    return run_text(scene.replace(scene.find("AT}"), 2, t));
  };
  EXPECT_NEAR(at("6").last("a.x"), 1.1, 1e-9);
  EXPECT_NEAR(at("5").last("a.x"), 1, 1e-9);
  const TextRun before = at("1");
  EXPECT_EQ(before.analysis().report.status, Status::refused);
  EXPECT_NE(before.analysis().report.message.find("\"P\""), std::string::npos) << before.analysis().report.message;
}

}  // namespace
}  // namespace catena::testing
