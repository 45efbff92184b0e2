// Scenes of one absolute constraint each: what it takes away and what it leaves.
#include "scene/data_facts.hpp"

namespace catena::testing {
namespace {

void stays(const TextRun& run, const std::string& column, double value) {
  const std::vector<double> values = run.column(column, kinematic);
  ASSERT_GT(values.size(), 5u);
  for (const double v : values) EXPECT_NEAR(v, value, 1e-12);
}

}  // namespace

SceneFacts absolute_facts() {
  return {
      {"absolute_x.json",
       [](const TextRun& run) {
         expect_mobility(run, 2);
         stays(run, "ladder.from.x", 0);
         EXPECT_NEAR(run.last("ladder.from.y", 1), 1.2, 1e-12);
       }},
      {"absolute_y.json",
       [](const TextRun& run) {
         expect_mobility(run, 2);
         stays(run, "ladder.to.y", 0);
         EXPECT_NEAR(run.last("ladder.to.x", 1), 1.5, 1e-12);
       }},
      {"absolute_angle.json",
       [](const TextRun& run) {
         expect_mobility(run, 2);
         stays(run, "tray.angle", 0);
         EXPECT_NEAR(std::hypot(run.last("tray.x", 1), run.last("tray.y", 1)), 0.5, 1e-12);
       }},
      {"absolute_distance.json",
       [](const TextRun& run) {
         expect_mobility(run, 2);
         stays(run, "string.value", 0.5);
         EXPECT_NEAR(run.last("plate.ring.x", 1), 0.3 * std::sin(6.0), 1e-12);
         EXPECT_NEAR(run.last("plate.angle", 1), 3, 1e-12);
       }},
  };
}

}  // namespace catena::testing
