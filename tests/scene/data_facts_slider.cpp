// Mechanisms with a slide, and the same ones modelled in four ways.
#include "scene/data_facts.hpp"

namespace catena::testing {
namespace {

using std::cos, std::sin, std::sqrt;
constexpr double pi = std::numbers::pi;

// Crank 0.1, rod 0.3: the slider's place and, from its derivative by the angle, its velocity at 100 rad/s.
double slider(double crank) { return 0.1 * cos(crank) + sqrt(0.09 - 0.01 * sin(crank) * sin(crank)); }
double slider_velocity(double crank) {
  return -100 * 0.1 * sin(crank) * (1 + 0.1 * cos(crank) / sqrt(0.09 - 0.01 * sin(crank) * sin(crank)));
}

void expect_slider(const TextRun& run, const std::string& slide) {
  expect_no_warnings(run);
  const auto angle = [](double t) { return 100 * t; };
  expect_column(
      run, slide + ".x", "t", [&](double t) { return slider(angle(t)); }, 1e-13);
  expect_column(
      run, slide + ".vx", "t", [&](double t) { return slider_velocity(angle(t)); }, 1e-11);
  EXPECT_NEAR(range(run, slide + ".x"), 2 * 0.1, 1e-13);
}

// Crank 0.1 about (0, 0.25) at 6 rad/s, lever about the origin.
void expect_lever(const TextRun& run, const std::string& ram) {
  expect_no_warnings(run);
  const auto pin_x = [](double t) { return 0.1 * cos(6 * t); };
  const auto pin_y = [](double t) { return 0.25 + 0.1 * sin(6 * t); };
  const auto lever = [&](double t) { return std::atan2(pin_y(t), pin_x(t)); };
  expect_column(run, "lever.angle", "t", lever, 1e-13);
  expect_column(
      run, "slot.slide", "t", [&](double t) { return std::hypot(pin_x(t), pin_y(t)); }, 1e-13);
  expect_column(
      run, ram + ".x", "t",
      [&](double t) {
        const double height = 0.48 - 0.5 * sin(lever(t));
        return 0.5 * cos(lever(t)) + sqrt(0.04 - height * height);
      },
      1e-13);
}

// The lever turns back where it is tangent to the crank circle; the way there takes 1.71 times as long as the way back.
void expect_quick_return(const TextRun& run) {
  const std::vector<double> crank = run.column("crank.angle", 2), lever = run.column("lever.angle", 2),
                            omega = run.column("lever.omega", 2);
  ASSERT_EQ(crank.size(), 2u);
  const double half_swing = std::asin(0.1 / 0.25);
  EXPECT_NEAR(lever[0], pi / 2 + half_swing, 1e-12);
  EXPECT_NEAR(lever[1], pi / 2 - half_swing, 1e-12);
  for (double rate : omega) EXPECT_NEAR(rate, 0, 1e-12);
  const double back = crank[1] - crank[0];
  EXPECT_NEAR((2 * pi - back) / back, 1.7099527817214104, 1e-12);
}

}  // namespace

SceneFacts slider_facts() {
  return {
      {"slider_crank_joints.json", [](const TextRun& run) { expect_slider(run, "slider"); }},
      {"slider_crank_slot.json", [](const TextRun& run) { expect_slider(run, "rod.to"); }},
      {"slider_crank_coupler.json", [](const TextRun& run) { expect_slider(run, "slider"); }},
      {"slider_crank_drivers.json", [](const TextRun& run) { expect_slider(run, "rod.to"); }},
      {"quick_return_joints.json",
       [](const TextRun& run) {
         expect_lever(run, "ram");
         expect_quick_return(run);
       }},
      {"quick_return_slot.json", [](const TextRun& run) { expect_lever(run, "link.end"); }},
      {"quick_return_coupler.json", [](const TextRun& run) { expect_lever(run, "ram"); }},
      {"quick_return_drivers.json", [](const TextRun& run) { expect_lever(run, "link.end"); }},
      {"scotch_yoke.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         expect_column(
             run, "yoke.x", "crank.angle", [](double a) { return 0.08 * cos(a); }, 1e-14);
         expect_column(
             run, "slot.slide", "crank.angle", [](double a) { return 0.08 * sin(a); }, 1e-14);
       }},
      {"geneva.json",
       [](const TextRun& run) {
         expect_no_warnings(run);
         // The pin enters and leaves along the slot: the wheel starts and stops at rest, a quarter turn apart.
         EXPECT_NEAR(run.first("wheel.omega", kinematic), 0, 1e-12);
         EXPECT_NEAR(run.last("wheel.omega", kinematic), 0, 1e-12);
         EXPECT_NEAR(run.first("wheel.angle", kinematic) - run.last("wheel.angle", kinematic), pi / 2, 1e-12);
         // In the middle it turns 1/(sqrt 2 - 1) times as fast as the crank, the other way.
         const std::vector<double> omega = run.column("wheel.omega", kinematic);
         EXPECT_NEAR(*std::min_element(omega.begin(), omega.end()), -10 / (sqrt(2) - 1), 1e-11);
       }},
  };
}

}  // namespace catena::testing
