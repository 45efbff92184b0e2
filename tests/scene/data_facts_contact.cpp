// Motion with contact and friction, and motion laws.
#include <cmath>

#include "scene/data_facts.hpp"

namespace catena::testing {
namespace {

std::vector<double> instants(const TextRun& run, const std::string& kind) {
  std::vector<double> found;
  for (const FieldRecord& record : field<std::vector<FieldRecord>>(run, "events")) {
    double t = 0;
    bool of_kind = false;
    for (const auto& [key, value] : record) {
      if (key == "t") t = std::get<double>(value);
      if (key == "kind") of_kind = std::get<std::string>(value) == kind;
    }
    if (of_kind) found.push_back(t);
  }
  return found;
}

void check_ball(const TextRun& run) {
  const double fall = std::sqrt(2 * 0.95 / 9.81);
  const std::vector<double> impacts = instants(run, "impact");
  ASSERT_GE(impacts.size(), 8u);
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(impacts[static_cast<std::size_t>(k)], fall * (3 - 2 * std::pow(0.5, k)), 1e-10);
  EXPECT_NEAR(instants(run, "contact").back(), 3 * fall, 1e-3);
  EXPECT_NEAR(run.last("ball.x"), 0.6, 1e-10);
  EXPECT_NEAR(run.last("floor.force"), 2 * 9.81, 1e-9);
  EXPECT_NEAR(run.last("energy.dissipated"), 2 * 9.81 * 0.95, 1e-8);
}

// It sticks until 50 x = 0.35 g; while it slips x swings about 0.2 g / 50, to where its speed is that of the belt
// again.
void check_belt(const TextRun& run) {
  const double loose = 0.35 * 9.81 / 50, centre = 0.2 * 9.81 / 50, omega = std::sqrt(50.0);
  const double slip = loose / 0.2, amplitude_part = (loose - centre) * omega / 0.2;
  const double stick = slip + (2 * std::numbers::pi - 2 * std::atan(amplitude_part)) / omega;
  ASSERT_GE(instants(run, "slip").size(), 2u);
  EXPECT_NEAR(instants(run, "slip")[0], slip, 1e-9);
  EXPECT_NEAR(instants(run, "stick")[0], stick, 1e-8);
  const std::vector<double> t = run.column("t"), load = run.column("motor.load");
  for (std::size_t k = 0; k < t.size() && t[k] < slip - 1e-6; ++k) EXPECT_NEAR(load[k], 50 * 0.2 * t[k], 1e-7);
}

void check_flywheel(const TextRun& run) {
  const double slowing = 0.1 * 10 * 9.81 * 0.02 / 0.5;
  EXPECT_NEAR(instants(run, "stick").at(0), 30 / slowing, 1e-7);
  EXPECT_NEAR(run.last("wheel.angle"), 30 * 30 / (2 * slowing), 1e-5);
  EXPECT_NEAR(run.last("wheel.omega"), 0, 1e-10);
  EXPECT_NEAR(run.last("energy.dissipated"), 225, 1e-5);
}

// Peak accelerations: 4 pi^2 / (4 + pi) of the rise over time^2 for modified sine, 2 pi for cycloidal.
void check_law(const TextRun& run) {
  const double rise = std::numbers::pi / 2 / (0.2 * 0.2);
  const std::vector<double> t = run.column("t"), alpha = run.column("table.alpha"), load = run.column("index.load");
  double first = 0, second = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    (t[k] < 0.45 ? first : second) = std::max(t[k] < 0.45 ? first : second, std::abs(alpha[k]));
    EXPECT_NEAR(load[k], 0.02 * alpha[k], 1e-12 * rise);
  }
  EXPECT_LE(first, rise * 4 * std::pow(std::numbers::pi, 2) / (4 + std::numbers::pi) * (1 + 1e-12));
  EXPECT_GE(first, 0.97 * rise * 4 * std::pow(std::numbers::pi, 2) / (4 + std::numbers::pi));
  EXPECT_NEAR(second, rise * 2 * std::numbers::pi, 1e-9 * rise);
  EXPECT_NEAR(run.last("table.angle"), 0, 1e-14);
}

}  // namespace

SceneFacts contact_facts() {
  return {{"bouncing_ball.json", check_ball},
          {"belt_stick_slip.json", check_belt},
          {"flywheel_brake.json", check_flywheel},
          {"cam_law.json", check_law}};
}

}  // namespace catena::testing
