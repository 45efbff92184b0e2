// Gears, racks and cams through scenes, against reference solutions (data/reference).
#include <numbers>

#include "oracles/kinematic_reference.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;
constexpr double pi = std::numbers::pi;

// The planetary set with the speeds of the sun and of one other member given.
TextRun planetary(double sun, const std::string& member, double speed) {
  json scene = data_scene("planetary_gear");
  scene["parameters"]["sun_speed"] = sun;
  scene["parameters"]["ring_speed"] = speed;
  scene["drivers"][1]["i"] = member;
  const TextRun run = run_text(scene.dump());
  EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  return run;
}

TEST(KinematicReference, PlanetaryGear) {
  const json values = reference_values("planetary_gear_willis");
  Comparison comparison;
  // Many turns: the speeds at the last row, 20 s on, and the mean speeds up to it.
  const auto add = [&](const TextRun& run, const std::string& column, double speed) {
    comparison.add("speed", velocity_error, run.last(column + ".omega", 1), speed);
    return run.last(column + ".omega", 1);
  };
  const json& fixed_ring = values.at("ring_fixed_ws_100");
  const TextRun ring = planetary(100, "ring", 0);
  const double carrier = add(ring, "carrier", fixed_ring.at("omega_carrier"));
  comparison.add("ratio", velocity_error, 100 / carrier, fixed_ring.at("ratio_ws_over_wc"));
  add(ring, "planet1", fixed_ring.at("omega_planet"));
  comparison.add("angle", position_error, ring.last("planet1.angle", 1) / 20, fixed_ring.at("omega_planet"));
  add(planetary(0, "ring", 30), "carrier", values.at("sun_fixed_wr_30").at("omega_carrier"));
  const TextRun fixed_carrier = planetary(10, "carrier", 0);
  add(fixed_carrier, "ring", values.at("carrier_fixed_ws_10").at("omega_ring"));
  add(fixed_carrier, "planet1", values.at("carrier_fixed_ws_10").at("omega_planet"));
  const TextRun free = planetary(12, "carrier", -5);
  add(free, "ring", values.at("free_ws_12_wc_-5").at("omega_ring"));
  add(free, "planet1", values.at("free_ws_12_wc_-5").at("omega_planet"));
  comparison.expect();
}

TEST(KinematicReference, RackAndPinion) {
  const json values = reference_values("rack_pinion_kinematics");
  json scene = data_scene("rolling_pinion");
  scene["analyses"] = {{{"type", "kinematics"}, {"at", {0.5, 1, 2, 5}}}};
  const TextRun run = run_text(scene.dump());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  Comparison comparison;
  const char* const keys[] = {"t=0.5", "t=1", "t=2", "t=5"};
  for (std::size_t k = 0; k < 4; ++k) {
    const json& at = values.at(keys[k]);
    comparison.add("x", position_error, run.column("pinion.x").at(k), at.at("x"));
    comparison.add("v", velocity_error, run.column("pinion.vx").at(k), at.at("v"));
    comparison.add("a", acceleration_error, run.column("pinion.ax").at(k), at.at("a"));
    comparison.add("rim x", position_error, run.column("pinion.tooth.x").at(k), at.at("rim").at(0));
    comparison.add("rim y", position_error, run.column("pinion.tooth.y").at(k), at.at("rim").at(1));
  }
  comparison.expect(4);
}

struct CamCase {
  double degrees;
  const char* key;
};
constexpr CamCase cam_cases[] = {{10, "th_10deg"}, {30, "th_30deg"}, {45, "th_45deg"},
                                 {60, "th_60deg"}, {90, "th_90deg"}, {110, "th_110deg"}};
constexpr double base_circle = 0.05, cam_speed = 15;

json cam_scene() {
  json scene = data_scene("cam_harmonic_lift");
  json times = json::array();
  for (const CamCase& c : cam_cases) times.push_back(c.degrees * pi / 180 / cam_speed);
  scene["analyses"] = {{{"type", "kinematics"}, {"at", times}}};
  return scene;
}

void compare_lift(Comparison& comparison, const TextRun& run, const std::string& follower, double rest,
                  double acceleration_allowed) {
  const json values = reference_values("cam_harmonic_lift");
  for (std::size_t k = 0; k < std::size(cam_cases); ++k) {
    const json& at = values.at(cam_cases[k].key);
    const double lift = run.column(follower + ".x").at(k) - rest, rate = run.column(follower + ".vx").at(k);
    const double radius = base_circle + lift, angle = -run.column("cam.angle").at(k);
    comparison.add("lift", position_error, lift, at.at("s"));
    comparison.add("velocity", velocity_error, rate, at.at("v"));
    comparison.add("acceleration", acceleration_allowed, run.column(follower + ".ax").at(k), at.at("a"));
    comparison.add("pressure angle", velocity_error, std::atan(rate / cam_speed / radius), at.at("pressure_angle"));
    comparison.add("pitch x", position_error, radius * std::cos(angle), at.at("pitch").at(0));
    comparison.add("pitch y", position_error, radius * std::sin(angle), at.at("pitch").at(1));
  }
}

// The geared yoke makes harmonic lift exactly.
TEST(KinematicReference, HarmonicLiftByAGearedYoke) {
  const TextRun run = run_text(cam_scene().dump());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  Comparison comparison;
  compare_lift(comparison, run, "yoke", -0.015, acceleration_error);
  comparison.expect(6);
}

// A cam given by a table is a cubic spline: with n points a turn its lift and, at the points, its velocity are of
// fourth order, its second derivative is off by h^2/12 times the fourth. With a point every 0.1 degrees the first two
// meet their limits; the acceleration, relative to its largest, must come out (1.5 h)^2/12 wrong, neither more nor much
// less.
TEST(KinematicReference, HarmonicLiftByACamFromATable) {
  json scene = cam_scene();
  constexpr int points = 3600;
  json angle = json::array(), radius = json::array();
  for (int k = 0; k < points; ++k) {
    const double a = 2 * pi * k / points;
    angle.push_back(a);
    radius.push_back(base_circle + (a < 4 * pi / 3 ? 0.015 * (1 - std::cos(1.5 * a)) : 0));
  }
  scene["constraints"][2]["curve"]["polar"] = {{"angle", angle}, {"radius", radius}};
  const TextRun run = run_text(scene.dump());
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double h = 2 * pi / points, spline_error = 2.25 * h * h / 12;
  Comparison comparison;
  compare_lift(comparison, run, "follower", base_circle, 1.05 * spline_error);
  comparison.expect(6);
  const double first = run.column("follower.ax").at(0), exact = 7.3349992433826126;
  EXPECT_GT(std::abs(first - exact), 0.9 * spline_error * exact);
}

}  // namespace
}  // namespace catena::testing
