// Runs of motions with contact: the instants of their changes, and the words that scenes of closed forms share.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "oracles/scene_text.hpp"
#include "scene/event_entries.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {

inline constexpr double earth_gravity = 9.81;

inline std::vector<double> instants(const TextRun& run, const std::string& kind) {
  std::vector<double> t;
  for (const EventEntry& event : events_of(run)) {
    if (event.kind == kind) t.push_back(event.t);
  }
  return t;
}

/// A line through the origin that falls to the right by `slope`; free above.
inline std::string ground_line(double slope) {
  return R"("curve": {"line": {"point": [0,0], "axis": )" + pair_of(std::cos(slope), -std::sin(slope)) + "}}";
}
inline std::string dynamics(const std::vector<double>& at, double tolerance = 1e-11) {
  std::string list;
  for (double t : at) list += (list.empty() ? "" : ",") + text_of(t);
  return R"("analyses": [{"type": "dynamics", "at": [)" + list + R"(], "tolerance": )" + text_of(tolerance) + "}]}";
}

}  // namespace catena::testing
