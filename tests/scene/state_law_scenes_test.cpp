// Tables and laws of state in scenes: values of tables, and what is said of wrong ones, where it stands.
#include <gtest/gtest.h>

#include "oracles/scene_text.hpp"
#include "oracles/state_law_references.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A driven crank and a mass, with what is given.
std::string scene(const std::string& tables, const std::string& force,
                  const std::string& outputs = R"--("crank.angle")--", const std::string& more = "") {
  return R"--({"catena": 1, "parameters": {"top": 4, "c": 0.3)--" + more + R"--(},
  "tables": )--" +
         tables + R"--(,
  "columns": {"lag": "=crank.angle - 0.2", "pull": "=2*O.fx"},
  "bodies": {"crank": {"mass": 1, "inertia": 1}, "mass": {"mass": 2, "inertia": 1, "points": {"tip": [1, 0]}}},
  "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "crank"},
                  {"type": "absolute_x", "i": "mass"}, {"type": "absolute_y", "i": "mass"},
                  {"type": "absolute_angle", "i": "mass"}],
  "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [-2, 1]}}],
  "forces": [{"type": "spring_damper", "name": "s", "i": ["ground", [0, -3]], "j": "mass.tip", "k": 5, "force": 0},
             )--" +
         force + R"--(],
  "outputs": [)--" +
         outputs + R"--(], "analyses": [{"type": "inverse_dynamics", "until": 6, "every": 0.25}]})--";
}

std::string torque(const std::string& expression) {
  return R"--({"type": "torque", "name": "motor", "i": "crank", "torque": ")--" + expression + "\"}";
}

TEST(Tables, AreSplinesInEveryExpression) {
  const std::vector<double> x{-3, -1, 0.5, 1, 5}, y{2, 4, -1, 0, 2};
  for (const std::string end : {"natural", "clamped", "periodic"}) {
    const std::string more = R"--(, "p1": "=tab(0.25)", "p2": "=top + p1")--";
    const TextRun run = run_text(scene(
        R"--({"tab": {"x": [-3, -1, "500 mm", 1, 5], "y": [2, "top", -1, 0, "=c + 1.7"], "end": ")--" + end + "\"}}",
        torque("=tab(crank.angle)*p2"), R"--("crank.angle", "motor.torque", "=tab(lag)", "drive.load")--", more));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const ReferenceSpline spline(x, y, end);
    const std::vector<double> angle = run.column("crank.angle");
    ASSERT_EQ(angle.size(), 25u);
    for (std::size_t k = 0; k < angle.size(); ++k) {
      const double law = spline(angle[k]) * (4 + spline(0.25));
      EXPECT_NEAR(run.column("motor.torque")[k], law, 1e-12) << end;
      EXPECT_NEAR(run.column("drive.load")[k], -law, 1e-12) << end;
      EXPECT_NEAR(run.column("=tab(lag)")[k], spline(angle[k] - 0.2), 1e-12) << end;
    }
  }
}

TEST(Tables, GoOnBeyondTheirEndsAsTheySay) {
  const std::vector<double> x{-1, 0, 1.5}, y{1, 3, 2};
  const auto run_with = [&](const std::string& beyond) {
    return run_text(scene(R"--({"tab": {"points": [[-1, 1], [0, 3], [1.5, 2]])--" + beyond + "}}",
                          torque("=tab(crank.angle)"), R"--("crank.angle", "motor.torque", "=tab(crank.angle)")--"));
  };
  const TextRun hold = run_with(R"--(, "beyond": "hold")--"), line = run_with(R"--(, "beyond": "line")--"),
                error = run_with("");
  ASSERT_EQ(hold.outcome.exit_code, 0) << hold.outcome.error_text;
  ASSERT_EQ(line.outcome.exit_code, 0) << line.outcome.error_text;
  const ReferenceSpline spline(x, y, "natural");
  const std::vector<double> angle = line.column("crank.angle");
  for (std::size_t k = 0; k < angle.size(); ++k) {
    EXPECT_NEAR(line.column("motor.torque")[k], spline(angle[k]), 1e-12);
    EXPECT_NEAR(hold.column("motor.torque")[k], spline(std::clamp(angle[k], -1.0, 1.5)), 1e-12);
  }
  EXPECT_EQ(error.outcome.exit_code, 1);
  EXPECT_EQ(error.analysis().report.status, Status::singular);
  EXPECT_NE(error.analysis().report.message.find("\"torque\" of torque \"motor\" is undefined at t = 0 s"),
            std::string::npos)
      << error.analysis().report.message;
}

TEST(Tables, HaveNoValueInColumnsWhereTheyEnd) {
  const TextRun run = run_text(scene(R"--({"tab": {"points": [[-1, 1], [0, 3], [1.5, 2]]}})--", torque("=lag"),
                                     R"--("crank.angle", "=tab(crank.angle)")--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(std::isnan(run.first("=tab(crank.angle)")));
  EXPECT_EQ(run.column("=tab(crank.angle)")[8], 3);  // t = 2 s, at 0 rad
}

TEST(Tables, EntriesHaveDerivatives) {
  std::string text = scene(R"--({"tab": {"x": [-3, -1, 0.5, 1, 5], "y": [2, "top", -1, 0, 2]}})--",
                           torque("=c*tab(crank.angle)"), R"--("motor.torque")--");
  const std::string analysis = R"--({"type": "inverse_dynamics", "until": 6, "every": 0.25})--";
  text.replace(
      text.find(analysis), analysis.size(),
      R"--({"type": "sensitivity", "parameters": ["top", "c"], "of": {"type": "inverse_dynamics", "at": [1.3]}})--");
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  // Splines are linear in their values.
  const ReferenceSpline unit({-3, -1, 0.5, 1, 5}, {0, 1, 0, 0, 0}, "natural"),
      all({-3, -1, 0.5, 1, 5}, {2, 4, -1, 0, 2}, "natural");
  EXPECT_NEAR(run.last("d(motor.torque)/d(top)"), 0.3 * unit(-0.7), 1e-13);
  EXPECT_NEAR(run.last("d(motor.torque)/d(c)"), all(-0.7), 1e-13);
}

void expect_error(const std::string& marked, const std::string& part) {
  const MarkedText mark = take_mark(marked);
  const TextRun run = run_text(mark.text);
  EXPECT_EQ(run.outcome.exit_code, 3) << marked;
  ASSERT_FALSE(run.outcome.errors.empty()) << marked;
  const Diagnostic& error = run.outcome.errors.front();
  EXPECT_EQ(error.line, mark.line) << error.message;
  EXPECT_EQ(error.column, mark.column) << error.message;
  EXPECT_NE(error.message.find(part), std::string::npos) << error.message;
}

TEST(Tables, WrongOnesAreReportedWhereTheyStand) {
  const std::string law = torque("=lag");
  expect_error(scene(R"--({"p": §{"x": [0, 1, 1], "y": [1, 2, 3]}})--", law), "table \"p\" is no curve");
  expect_error(scene(R"--({"p": §{"x": [0], "y": [1]}})--", law), "table \"p\" is no curve");
  expect_error(scene(R"--({"p": {"x": [0, 1, 2], "y": §[1, 2]}})--", law), "3 places x, but 2 values y");
  expect_error(scene(R"--({"p": §{"x": [0, 1, 2]}})--", law), "table \"p\" needs \"y\"");
  expect_error(scene(R"--({"p": {"x": [0, 1, 2], "y": [1, 2, 3], "end": §"round"}})--", law), "\"end\" of table \"p\"");
  expect_error(scene(R"--({"p": {"x": [0, 1], "y": [1, 1], "end": "periodic", "beyond": §"hold"}})--", law),
               "periodic");
  expect_error(scene(R"--({"p": {"x": [0, 1], "y": [1, 2], §"ends": "natural"}})--", law), "ends");
  expect_error(scene(R"--({§"sin": {"x": [0, 1], "y": [1, 2]}})--", law), "taken by expressions");
  expect_error(scene(R"--({§"top": {"x": [0, 1], "y": [1, 2]}})--", law), "a parameter is called \"top\" already");
  expect_error(scene(R"--({"p": {"x": [0, 1], "y": [1, §"=p(0)"]}})--", law), "may not use tables");
  expect_error(scene(R"--({"p": {"x": [0, 1], "y": [1, "=§tpo"]}})--", law), "did you mean \"top\"?");
  expect_error(scene(R"--({"p": §[[0, 1], [1, 2]]})--", law), "table \"p\"");
  expect_error(scene("§[]", law), "\"tables\" must be an object");
  expect_error(scene(R"--({"p": {"x": [0, 1], "y": [1, 2]}})--", law, R"--("=2*§p")--"), "write p(...)");
  expect_error(scene(R"--({"gas": {"x": [0, 1], "y": [1, 2]}})--", law, R"--("=§gsa(crank.x)")--"),
               "did you mean \"gas\"?");
  expect_error(scene(R"--({"p": {"x": [0, 1], "y": [1, 2]}})--", law, R"--("=§p(crank.x, 2)")--"), "takes one value");
  const std::string table = R"--({"p": {"x": [0, 1], "y": [1, 2]}})--", crank = R"--("crank.angle")--";
  expect_error(scene(table, law, crank, R"--(, "a": "=1 + §p(3)")--"),
               "the table reaches from 0 to 1, and 3 is asked for");
  expect_error(scene(R"--({"p": {"x": [0, 1], "y": [1, "=a"]}})--", law, crank, R"--(, "a": §"=1 + p(0.5)")--"),
               "in a circle: a -> a");
}

TEST(StateLaws, AlgebraicLoopsAreRefusedByTheirNames) {
  const std::string none = "{}";
  const std::string who = "\"torque\" of torque \"motor\"";
  expect_error(scene(none, torque("=c*§O.fx")), "an algebraic loop: " + who + " -> O.fx -> " + who);
  expect_error(scene(none, torque("=c*§crank.alpha")), "an algebraic loop: " + who + " -> crank.alpha -> " + who);
  expect_error(scene(none, torque("=§drive.load + 1")), "an algebraic loop: " + who + " -> drive.load -> " + who);
  expect_error(scene(none, torque("=§motor.torque")), "an algebraic loop: " + who + " -> motor.torque -> " + who);
  std::string chain = scene(none, torque("=s.force*crank.x"));
  chain.replace(chain.find(R"--("force": 0)--"), 10, R"--("force": "=0.1*§motor.torque")--");
  expect_error(chain, "\"force\" of spring_damper \"s\" -> motor.torque");
}

TEST(StateLaws, WrongOnesAreReportedWhereTheyStand) {
  const std::string none = "{}";
  expect_error(scene(none, torque("=c*§crnk.x")), "unknown column \"crnk.x\"");
  expect_error(scene(none, torque("=c*§crank.z")), "crank.z");
  expect_error(scene(none, torque("=crank.x + §d")), "there is no column or parameter \"d\"");
  expect_error(scene(none, torque("=2*§tpo")), "did you mean \"top\"?");
  expect_error(scene(none, torque("=2*§energy.kinetic")), "a force cannot read energy.kinetic");
  expect_error(scene(none, torque("=2*§motor.power")), "a force cannot read motor.power");
  expect_error(scene(none, torque("=crank.x + +§*2")), "unexpected");
  expect_error(scene(none, torque("=crank.x + sin(§")), "incomplete");
  // Through a column of one's own the place is the law's.
  const std::string law = torque("=pull");
  expect_error(scene(none, law.substr(0, law.find("\"=pull")) + "§" + law.substr(law.find("\"=pull"))),
               "an algebraic loop");
}

}  // namespace
}  // namespace catena::testing
