// Tables from files: the same as if their numbers stood in the scene.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A slide driven along a table, with a file beside the scene.
TextRun run_with(const std::string& value, const std::string& file) {
  TemporaryFolder folder;
  std::ofstream(folder / "lift.csv", std::ios::binary) << file;
  const std::string path = folder / "scene.json";
  std::ofstream(path, std::ios::binary) << R"({"catena": 1, "bodies": {"b": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "absolute_y", "i": "b", "value": 0}, {"type": "absolute_angle", "i": "b", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "lift", "i": "b", "value": )" +
                                               value + R"(}],
    "outputs": ["b.x"], "analyses": [{"type": "kinematics", "at": [0.25, 0.6, 1]}]})";
  TextRun run;
  run.outcome = run_scene(path, {}, run.sink);
  return run;
}

const std::vector<double>& written_out() {
  static const std::vector<double> x =
      run_with(R"({"spline": {"t": [0, 0.5, 1], "value": [0, 0.02, 0.01]}})", "").column("b.x");
  return x;
}

void expect_as_written_out(const std::string& value, const std::string& file) {
  SCOPED_TRACE(value + "\n" + file);
  const TextRun run = run_with(value, file);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> x = run.column("b.x");
  ASSERT_EQ(x.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(x[k], written_out()[k], 1e-17);
}

TEST(DataFiles, GiveListsOfNumbersAndPairs) {
  expect_as_written_out(R"({"spline": {"points": [[0, 0], [0.5, 0.02], [1, 0.01]]}})", "");
  expect_as_written_out(R"({"spline": {"points": {"file": "lift.csv"}}})", "0,0\n0.5,0.02\n1,0.01\n");
  expect_as_written_out(R"({"spline": {"t": {"file": "lift.csv"}, "value": {"file": "lift.csv", "columns": [2]}}})",
                        "0,0\n0.5,0.02\n1,0.01");
  expect_as_written_out(R"({"spline": {"points": {"file": "lift.csv", "columns": [3, 1], "unit": ["s", "mm"]}}})",
                        "# measured\r\n0; 9; 0\r\n\r\n20; 9; +0.5\r\n10; 9; 1\r\n");
  expect_as_written_out(
      R"({"spline": {"points": {"file": "lift.csv", "columns": ["time", "lift"], "unit": ["ms", "mm"]}}})",
      "lift,time\n0,0\n20,500\n10,1000\n");
  expect_as_written_out(R"({"spline": {"points": {"file": "lift.csv"}}})", "  0   0\n0.5\t0.02\n1 0.01\n");
  // In place of both lists, beside what else a table has; one text for one column.
  expect_as_written_out(R"({"spline": {"file": "lift.csv", "unit": ["s", "mm"], "end": "natural", "beyond": "hold"}})",
                        "0,0\n0.5,20\n1,10\n");
  expect_as_written_out(
      R"({"spline": {"t": {"file": "lift.csv", "unit": "ms"}, "value": {"file": "lift.csv", "columns": 2, "unit": "mm"}}})",
      "0,0\n500,20\n1000,10\n");
}

// A file in place of the lists of a table, and of the angles and radii of a cam that lifts a point.
TEST(DataFiles, GiveTablesAndPolarCurves) {
  const auto run_cam = [](const std::string& polar, const std::string& table) {
    TemporaryFolder folder;
    std::ofstream(folder / "cam.csv", std::ios::binary) << "0,50\n90,60\n180,50\n270,40\n";
    const std::string path = folder / "scene.json";
    std::ofstream(path, std::ios::binary)
        << R"({"catena": 1, "bodies": {"f": {"particle": true, "position": [0, 0.06]}},
      "tables": {"p": )" +
               table + R"(}, "columns": {"lift": "=p(1.5 + 0*f.y) + 0"},
      "constraints": [{"type": "absolute_x", "i": "f", "value": 0.025},
        {"type": "point_on_curve", "i": "ground", "j": "f", "curve": {"polar": )" +
               polar + R"(}}],
      "outputs": ["f.y", "lift"], "analyses": [{"type": "kinematics"}]})";
    TextRun run;
    run.outcome = run_scene(path, {}, run.sink);
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    return std::pair(run.last("f.y"), run.last("lift"));
  };
  const std::string angles = R"("angle": [0, "90 deg", "180 deg", "270 deg"], "radius": [0.05, 0.06, 0.05, 0.04])";
  const std::string table = R"({"x": [0, "90 deg", "180 deg", "270 deg"], "y": [0.05, 0.06, 0.05, 0.04]})";
  const auto expected = run_cam("{" + angles + "}", table);
  const std::string keys = R"("file": "cam.csv", "columns": [1, 2], "unit": ["deg", "mm"])";
  for (const std::string& polar : {"{" + keys + "}", R"({"points": {)" + keys + "}}"}) {
    const auto got = run_cam(polar, "{" + keys + R"(, "beyond": "hold"})");
    EXPECT_NEAR(got.first, expected.first, 1e-16);
    EXPECT_NEAR(got.second, expected.second, 1e-16);
  }
}

// Rises by 1 mm a second with a zigzag of 0.1 mm on it: what may be moved by more than that is the line itself.
TEST(DataFiles, AreSmoothedAsFarAsAsked) {
  std::string file = "t,lift\n";
  for (int k = 0; k <= 10; ++k)
    file += std::to_string(k / 10.0) + "," + std::to_string(k / 10.0 + (k % 2 ? 0.1 : -0.1)) + "\n";
  const auto lift = [&](const std::string& smooth) {
    return run_with(R"({"spline": {"points": {"file": "lift.csv", "unit": ["s", "mm"], "smooth": )" + smooth + "}}}",
                    file);
  };
  for (const std::string smooth : {"0.2", "\"0.0002 m\""}) {
    const TextRun run = lift(smooth);
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    // The line of least squares through a zigzag of eleven points lies 0.1/11 mm below the middle.
    const std::vector<double> t{0.25, 0.6, 1};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(run.column("b.x")[k], 1e-3 * (t[k] - 0.1 / 11), 1e-12);
    ASSERT_FALSE(run.analysis().report.warnings.empty());
    EXPECT_NE(run.analysis().report.warnings.front().find("smoothed by 9.9"), std::string::npos)
        << run.analysis().report.warnings.front();
  }
  const double zigzag = lift("0").column("b.x")[1], less = lift("0.05").column("b.x")[1];
  EXPECT_NEAR(zigzag, 0.5e-3, 1e-15);
  EXPECT_GT(less, zigzag + 1e-5);
  EXPECT_LT(less, 0.6e-3);
  EXPECT_EQ(lift("-1").outcome.exit_code, 3);
  EXPECT_NE(lift("\"3 s\"").outcome.error_text.find("\"smooth\" must be"), std::string::npos);
  const TextRun list = run_with(
      R"({"spline": {"t": [0, 1], "value": {"file": "lift.csv", "columns": [2], "smooth": 1}}})", "0,0\n1,1\n");
  EXPECT_NE(list.outcome.error_text.find("give both columns of the file as \"points\""), std::string::npos)
      << list.outcome.error_text;
  const TextRun backwards = run_with(R"({"spline": {"points": {"file": "lift.csv", "smooth": 1}}})", "0,0\n2,1\n1,3\n");
  EXPECT_NE(backwards.outcome.error_text.find("places that increase"), std::string::npos)
      << backwards.outcome.error_text;
}

TEST(DataFiles, GivePointsOfAPath) {
  TemporaryFolder folder;
  std::ofstream(folder / "wanted.csv") << "x,y\n0,1500\n-2000,0\n";
  const auto near = [&](const std::string& to) {
    const std::string path = folder / "scene.json";
    std::ofstream(path) << R"({"catena": 1, "bodies": {"crank": {"rod": {"from": [0, 0], "to": [1, 0]}}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"}],
      "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0, 1]}}],
      "analyses": [{"type": "kinematics", "until": 5, "every": 1,
        "measures": {"near": {"path": ["crank.to.x", "crank.to.y"], "to": )" +
                               to + "}}}]}";
    TextRun run;
    run.outcome = run_scene(path, {}, run.sink);
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    return run.analysis().measures.front().value.value_or(std::nan(""));
  };
  EXPECT_NEAR(near(R"({"file": "wanted.csv", "unit": ["mm", "mm"]})"), std::sqrt((0.25 + 1) / 2), 1e-12);
  EXPECT_NEAR(near(R"([[0, 1.5], ["-2 m", 0]])"), std::sqrt((0.25 + 1) / 2), 1e-12);
}

TEST(DataFiles, GiveCurvesAndSprings) {
  TemporaryFolder folder;
  std::ofstream(folder / "spring.csv") << "elongation,tension\n0,0\n10,5\n20,20\n";
  const auto length = [&](const std::string& curve) {
    const std::string path = folder / "scene.json";
    std::ofstream(path) << R"({"catena": 1, "gravity": [0, -10], "bodies": {"b": {"particle": true, "mass": 1.2,
      "position": [0, -1.01]}}, "forces": [{"type": "spring_damper", "name": "s", "i": "ground", "j": "b", "length": 1,
      "curve": )" << curve
                        << R"(}], "outputs": ["s.length"], "analyses": [{"type": "equilibrium"}]})";
    TextRun run;
    run.outcome = run_scene(path, {}, run.sink);
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    return run.last("s.length");
  };
  const double expected = length("[[0, 0], [0.01, 5], [0.02, 20]]");
  EXPECT_GT(expected, 1.01);
  EXPECT_NEAR(length(R"({"file": "spring.csv", "unit": ["mm", "N"]})"), expected, 1e-15);
  EXPECT_NEAR(length(R"({"points": {"file": "spring.csv", "unit": ["mm", "N"]}, "beyond": "line"})"), expected, 1e-12);
}

TEST(DataFiles, SayWhatIsWrongAndWhere) {
  const struct {
    const char *value, *file, *error;
  } cases[] = {
      {R"({"file": "lost.csv"})", "", "lost.csv"},
      {R"({"file": "lift.csv"})", "", "holds no numbers"},
      {R"({"file": "lift.csv"})", "t,x\n0,0\n0.5,wet\n", "lift.csv:3:5: error: \"wet\" is not a number"},
      {R"({"file": "lift.csv"})", "0,0\n0.5\n", "lift.csv:2:1: error: this line has 1 numbers, those before have 2"},
      {R"({"file": "lift.csv"})", "0\n1\n", "must be 2; the file has 1"},
      {R"({"file": "lift.csv", "columns": [0, 1]})", "0,0\n1,1\n", "are numbers from 1, or names"},
      {R"({"file": "lift.csv", "columns": [1, 3]})", "0,0\n1,1\n", "beyond the 2 columns of the file"},
      {R"({"file": "lift.csv", "columns": [1]})", "0,0\n1,1\n", "must be a list of 2"},
      {R"({"file": "lift.csv", "columns": ["time", "lfit"]})", "time,lift\n0,0\n1,1\n", "did you mean \"lift\""},
      {R"({"file": "lift.csv", "unit": ["s", "N"]})", "0,0\n1,1\n", "\"N\" is not a unit of a length"},
      {R"({"file": "lift.csv", "colums": [1, 2]})", "0,0\n1,1\n", "unknown key \"colums\""},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.value);
    const TextRun run = run_with(std::string(R"({"spline": {"points": )") + c.value + "}}", c.file);
    EXPECT_EQ(run.outcome.exit_code, 3);
    EXPECT_NE(run.outcome.error_text.find(c.error), std::string::npos) << run.outcome.error_text;
  }
}

}  // namespace
}  // namespace catena::testing
