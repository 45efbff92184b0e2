// Wheels that roll on each other, belts, cams.
#include "scene/data_facts.hpp"

namespace catena::testing {
namespace {

using std::cos, std::sin, std::sqrt;
constexpr double pi = std::numbers::pi;

}  // namespace

SceneFacts gear_and_cam_facts() {
  return {
      {"planetary_gear.json",
       [](const TextRun& run) {
         expect_mobility(run, 2);
         EXPECT_TRUE(run.analysis(kinematic).report.warnings.empty());
         // Of three planets one would do: each further one has a mesh too many.
         EXPECT_EQ(run.analysis(0).report.redundant, (std::vector<std::string>{"outer2", "outer3"}));
         // Willis, ring at rest: carrier = sun 20/(20 + 70), after 318 turns of the sun.
         EXPECT_NEAR(run.last("sun.angle", kinematic), 2000, 1e-9);
         expect_column(
             run, "carrier.angle", "sun.angle", [](double sun) { return sun / 4.5; }, 1e-9);
         expect_column(
             run, "planet1.angle", "sun.angle", [](double sun) { return -0.4 * sun; }, 1e-9);
         EXPECT_NEAR(run.last("carrier.omega", kinematic), 100 / 4.5, 1e-9);
       }},
      {"rolling_pinion.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         expect_column(
             run, "pinion.x", "pinion.angle", [](double angle) { return -0.04 * angle; }, 1e-15);
         // A cycloid with the clockwise angle as its parameter.
         expect_column(
             run, "pinion.tooth.x", "pinion.angle", [](double angle) { return 0.04 * (-angle - sin(-angle)); }, 1e-15);
         expect_column(
             run, "pinion.tooth.y", "pinion.angle", [](double angle) { return 0.04 * (1 - cos(angle)); }, 1e-15);
       }},
      {"belt_drive.json",
       [](const TextRun& run) {
         expect_mobility(run, 1);
         expect_no_warnings(run);
         expect_column(
             run, "fan.angle", "motor.angle", [](double motor) { return motor * 60 / 150; }, 1e-12);
         expect_column(
             run, "shaft.angle", "motor.angle", [](double motor) { return -motor * 60 / 90; }, 1e-12);
         EXPECT_NEAR(run.last("motor.omega", kinematic) * 30 / pi, 1450, 1e-9);
         EXPECT_NEAR(run.last("fan.omega", kinematic) * 30 / pi, 580, 1e-9);
       }},
      {"cam_followers.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         // The centre of the cam goes round a circle of 15 mm; the foot lies one radius above it, the roller's and the
         // edge's distance from it is constant.
         expect_column(
             run, "foot.y", "cam.angle", [](double a) { return 0.04 + 0.015 * sin(a); }, 1e-13);
         expect_column(
             run, "roller.y", "cam.angle",
             [](double a) { return 0.015 * sin(a) - sqrt(0.052 * 0.052 - 0.015 * 0.015 * cos(a) * cos(a)); }, 1e-13);
         expect_column(
             run, "edge.x", "cam.angle",
             [](double a) { return 0.015 * cos(a) + sqrt(0.04 * 0.04 - 0.015 * 0.015 * sin(a) * sin(a)); }, 1e-13);
       }},
      {"cam_harmonic_lift.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         expect_column(
             run, "yoke.x", "cam.angle", [](double a) { return -0.015 * cos(1.5 * a); }, 1e-14);
         EXPECT_NEAR(range(run, "yoke.x"), 0.03, 1e-14);
         // The cam's table, a point every 5 degrees, gives the same lift at its points, for they are on the profile.
         const std::vector<double> edge = run.column("follower.x", kinematic), yoke = run.column("yoke.x", kinematic);
         for (std::size_t k = 0; k < edge.size(); ++k) EXPECT_NEAR(edge[k] - 0.05, yoke[k] + 0.015, 1e-11);
       }},
  };
}

}  // namespace catena::testing
