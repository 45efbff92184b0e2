// Every scene in data/scenes: runs to its end, says what it is, and shows a fact that is known about it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

namespace fs = std::filesystem;

TextRun run_file(const std::string& path) {
  TextRun run;
  run.outcome = run_scene(path, {}, run.sink);
  return run;
}

// A point of a body that keeps two degrees of freedom: `check` says so, and the constrained column stays.
void keeps_two(const TextRun& run) {
  ASSERT_TRUE(run.analysis(0).report.mobility);
  EXPECT_EQ(*run.analysis(0).report.mobility, 2);
  EXPECT_EQ(run.analysis(0).report.dof, 0);
}
void stays(const TextRun& run, const std::string& column, double value) {
  const std::vector<double> values = run.column(column, 1);
  ASSERT_GT(values.size(), 5u);
  for (const double v : values) EXPECT_NEAR(v, value, 1e-12);
}

const std::map<std::string, std::function<void(const TextRun&)>>& facts() {
  static const std::map<std::string, std::function<void(const TextRun&)>> all{
      {"crank_rocker.json",
       [](const TextRun& run) {
         EXPECT_EQ(run.sink.header.gravity[1], -9.81);
         // The crank turns fully: everything is where it began. Instant centres give the ratio of speeds at 0 degrees:
         // crank and base in line, omega_4 = -omega_2 a / (d - a).
         EXPECT_NEAR(run.last("rocker.angle", 1), run.first("rocker.angle", 1), 1e-11);
         EXPECT_NEAR(run.last("coupler.pen.x", 1), run.first("coupler.pen.x", 1), 1e-11);
         EXPECT_NEAR(run.first("rocker.omega", 1), -10 * 0.1 / (0.3 - 0.1), 1e-11);
         // Loop closure: the triangle A, B, O4 with sides 0.25, 0.2, 0.2 m.
         EXPECT_NEAR(run.first("rocker.angle", 1), std::numbers::pi - std::acos((0.04 + 0.04 - 0.0625) / 0.08), 1e-12);
         // Over a cycle without losses the drive does no work.
         const std::vector<double> load = run.column("drive.load", 2);
         double sum = 0;
         for (std::size_t k = 0; k + 1 < load.size(); ++k) sum += load[k];
         EXPECT_NEAR(sum / static_cast<double>(load.size() - 1), 0, 1e-9);
       }},
      {"six_bar.json",
       [](const TextRun& run) {
         EXPECT_EQ(run.analysis(0).report.mobility, 1);
         EXPECT_EQ(run.analysis(0).report.rows, 15);
         EXPECT_NEAR(run.last("swing.angle", 1), run.first("swing.angle", 1), 1e-11);
         const std::vector<double> swing = run.column("swing.angle", 1);
         const auto [least, most] = std::minmax_element(swing.begin(), swing.end());
         EXPECT_NEAR((*most - *least) * 180 / std::numbers::pi, 38, 0.5);
       }},
      {"linkage_100000.json",
       [](const TextRun& run) {
         EXPECT_EQ(run.sink.header.bodies, 100001);
         EXPECT_NEAR(run.last("crank50000.angle"), std::numbers::pi / 2 + 0.5, 1e-12);
         EXPECT_NEAR(run.last("crank50000.omega"), 1, 1e-9);
         EXPECT_NEAR(run.last("bar50000.angle"), 0, 1e-12);
         EXPECT_NEAR(run.last("bar25000.ay"), -std::cos(0.5), 1e-8);
       }},
      {"absolute_x.json",
       [](const TextRun& run) {
         keeps_two(run);
         stays(run, "ladder.from.x", 0);
         EXPECT_NEAR(run.last("ladder.from.y", 1), 1.2, 1e-12);
       }},
      {"absolute_y.json",
       [](const TextRun& run) {
         keeps_two(run);
         stays(run, "ladder.to.y", 0);
         EXPECT_NEAR(run.last("ladder.to.x", 1), 1.5, 1e-12);
       }},
      {"absolute_angle.json",
       [](const TextRun& run) {
         keeps_two(run);
         stays(run, "tray.angle", 0);
         EXPECT_NEAR(std::hypot(run.last("tray.x", 1), run.last("tray.y", 1)), 0.5, 1e-12);
       }},
      {"absolute_distance.json",
       [](const TextRun& run) {
         keeps_two(run);
         stays(run, "string.value", 0.5);
         EXPECT_NEAR(run.last("plate.ring.x", 1), 0.3 * std::sin(6.0), 1e-12);
         EXPECT_NEAR(run.last("plate.angle", 1), 3, 1e-12);
       }},
  };
  return all;
}

TEST(DataScenes, EveryOneRunsAndShowsItsFact) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(CATENA_DATA_DIR "/scenes")) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    ++scenes;
    const TextRun run = run_file(entry.path().string());
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text
                                        << (run.outcome.analyses.empty() ? ""
                                                                         : run.outcome.analyses.back().report.message);
    EXPECT_FALSE(run.sink.header.description.empty());
    EXPECT_FALSE(run.outcome.scene.empty());
    const auto fact = facts().find(name);
    if (fact == facts().end()) {
      ADD_FAILURE() << "no fact is tested about this scene";
    } else {
      fact->second(run);
    }
  }
  EXPECT_EQ(scenes, static_cast<int>(facts().size()));
}

}  // namespace
}  // namespace catena::testing
