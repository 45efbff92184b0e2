// Scenes of ropes over pulleys with friction, and the changes of state that a run reports.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "oracles/good_run.hpp"
#include "scene/run_text.hpp"

namespace catena::testing::rope_friction {

inline constexpr double g = 9.81, pi = std::numbers::pi;

inline std::string weight(const std::string& name, double mass, double x, double y, double vx, double vy) {
  return fmt::format(R"("{}": {{"particle": true, "mass": {:.17g}, "position": [{:.17g}, {:.17g}], "velocity": [{:.17g},
    {:.17g}]}})",
                     name, mass, x, y, vx, vy);
}
inline std::string scene(const std::string& bodies, const std::string& constraints, const std::string& forces,
                         const std::string& outputs, const std::string& analyses, double gravity = g) {
  return fmt::format(R"({{"catena": 1, "gravity": [0, {:.17g}], "bodies": {{{}}}, "constraints": [{}], "forces": [{}],
    "outputs": [{}], "analyses": [{}]}})",
                     -gravity, bodies, constraints, forces, outputs, analyses);
}
inline std::string dynamics(double t, const std::string& more = "") {
  return fmt::format(R"({{"type": "dynamics", "at": [0, {:.17g}], "tolerance": 1e-11{}}})", t, more);
}
struct Change {
  std::string kind;
  double t;
};
inline std::vector<Change> changes(const TextRun& run) {
  std::vector<Change> all;
  for (const auto& [key, value] : run.analysis().fields) {
    if (key != "events") continue;
    for (const FieldRecord& record : std::get<std::vector<FieldRecord>>(value)) {
      Change change;
      for (const auto& [name, field] : record) {
        if (name == "kind") change.kind = std::get<std::string>(field);
        if (name == "t") change.t = std::get<double>(field);
      }
      all.push_back(change);
    }
  }
  return all;
}

}  // namespace catena::testing::rope_friction
