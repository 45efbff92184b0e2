// A slider-crank whose rod is longer than its crank by d of it: branches pass each other at sqrt(2 d) rad where the
// crank stands across, z = pi/2, and the slider turns back there. M: mass of crank and all, so that M z'^2 / 2 is the
// energy.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/run_text.hpp"

namespace catena::testing::near_branches {

using Json = nlohmann::ordered_json;

inline constexpr double start = 0.5, rate = 4, until = 0.6, inertia = 0.1;

inline Json slider_crank(double d, double tolerance, const std::string& method, bool doubled = false) {
  const double rod = 1 + d, y = std::sin(start), x = std::cos(start), theta = -std::asin(y / rod);
  const double end = x + rod * std::cos(theta), turning = -rate * x / (rod * std::cos(theta));
  const auto body = [](double px, double py, double angle, double vx, double vy, double omega) {
    return Json{{"mass", 1},      {"inertia", inertia},   {"position", {px, py}},
                {"angle", angle}, {"velocity", {vx, vy}}, {"angular_velocity", omega}};
  };
  Json scene = {
      {"catena", 1},
      {"gravity", {0, 0}},
      {"bodies",
       {{"crank", body(x / 2, y / 2, start, -rate * y / 2, rate * x / 2, rate)},
        {"rod", body((x + end) / 2, y / 2, theta, -rate * y - rod / 2 * std::sin(theta) * turning,
                     rate * x + rod / 2 * std::cos(theta) * turning, turning)},
        {"slider", body(end, 0, 0, -rate * y - rod * std::sin(theta) * turning, 0, 0)}}},
      {"constraints",
       {{{"type", "revolute"}, {"name", "a"}, {"i", {"ground", {0, 0}}}, {"j", {"crank", {-0.5, 0}}}},
        {{"type", "revolute"}, {"name", "b"}, {"i", {"crank", {0.5, 0}}}, {"j", {"rod", {-rod / 2, 0}}}},
        {{"type", "revolute"}, {"name", "c"}, {"i", {"rod", {rod / 2, 0}}}, {"j", {"slider", {0, 0}}}},
        {{"type", "translational"},
         {"name", "guide"},
         {"i", {"ground", {0, 0}}},
         {"j", {"slider", {0, 0}}},
         {"axis_i", {1, 0}}}}},
      {"analyses",
       {{{"type", "dynamics"}, {"until", until}, {"every", until}, {"method", method}, {"tolerance", tolerance}}}},
      {"outputs", {"crank.angle", "rod.angle", "slider.x"}}};
  for (std::size_t k = 0; doubled && k < 3; k += 2) {
    Json again = scene["constraints"][k];
    again["name"] = again["name"].get<std::string>() + " again";
    scene["constraints"].push_back(again);
  }
  return scene;
}

/// M, by the angle of the crank.
inline double mass_at(double z, double d) {
  const double rod = 1 + d, sine = -std::sin(z) / rod;
  const double cosine = std::sqrt((rod - std::sin(z)) * (rod + std::sin(z))) / rod;
  const double turning = -std::cos(z) / (rod * cosine);
  const double vx = -std::sin(z) - rod / 2 * sine * turning, vy = std::cos(z) + rod / 2 * cosine * turning;
  const double slider = -std::sin(z) - rod * sine * turning;
  return 0.25 + inertia + vx * vx + vy * vy + inertia * turning * turning + slider * slider;
}

inline bool tells(const TextRun& run, const char* words) {
  const std::vector<std::string>& warnings = run.analysis().report.warnings;
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}

/// Whether it is said that the motion went straight on where its branch turns.
inline bool tells_straight_passage(const TextRun& run) {
  return tells(run, "went straight on where two branches pass");
}

}  // namespace catena::testing::near_branches
