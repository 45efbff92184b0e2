// Scenes that users and random search found to fail once, each with what is right, worked out apart from the library.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "results/temporary_folder.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {

/// Runs data/trials/NAME.json.
inline TextRun run_trial(const std::string& name, const RunOptions& options = {}) {
  return run_text(read_file(std::string(CATENA_DATA_DIR) + "/trials/" + name + ".json"), options);
}

/// The value of a column in the row whose t is nearest to the given instant (s).
inline double at_instant(const TextRun& run, const std::string& column, double t, std::size_t analysis = 0) {
  const std::vector<double> times = run.column("t", analysis), values = run.column(column, analysis);
  double nearest = std::nan(""), distance = 1e300;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::abs(times[k] - t) < distance) {
      distance = std::abs(times[k] - t);
      nearest = values[k];
    }
  }
  return nearest;
}

}  // namespace catena::testing
