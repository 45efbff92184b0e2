// Runs scenes of data/scenes, as they are or changed, and compares their columns with independent reference values.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "oracles/static_reference.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {

// Allowed errors, relative to the largest magnitude in the column.
constexpr double position_error = 1e-11;
constexpr double velocity_error = 1e-10;
constexpr double acceleration_error = 1e-9;
constexpr double load_error = 1e-9;

inline TextRun run_data_scene(const std::string& name, const RunOptions& options = {}) {
  TextRun run;
  run.outcome = run_scene(std::string(CATENA_DATA_DIR) + "/scenes/" + name + ".json", options, run.sink);
  EXPECT_EQ(run.outcome.exit_code, 0) << name << ": " << run.outcome.error_text;
  return run;
}

/// The text of a scene, to be changed and run with run_text(scene.dump()).
inline nlohmann::json data_scene(const std::string& name) {
  std::ifstream file(std::string(CATENA_DATA_DIR) + "/scenes/" + name + ".json");
  return nlohmann::json::parse(file, nullptr, true, true);
}

/// Collects pairs of computed and reference values by quantity, and judges each quantity by its largest magnitude.
class Comparison {
 public:
  void add(const std::string& quantity, double allowed, double computed, double reference) {
    Quantity& q = quantities_[quantity];
    q.allowed = allowed;
    q.largest = std::max(q.largest, std::abs(reference));
    // Not a number counts as the worst.
    if (!(std::abs(computed - reference) <= q.worst)) q.worst = std::abs(computed - reference);
    ++q.values;
  }

  /// Every quantity has `values` values, each within its allowed error.
  void expect(int values) const {
    for (const auto& [name, q] : quantities_) EXPECT_EQ(q.values, values) << name;
    expect();
  }
  /// Every value of every quantity is within its allowed error.
  void expect() const {
    EXPECT_FALSE(quantities_.empty());
    for (const auto& [name, q] : quantities_) {
      EXPECT_LE(q.worst, q.allowed * q.largest) << name << ": " << q.worst / q.largest << " of its largest magnitude";
    }
  }

 private:
  struct Quantity {
    double allowed = 0, largest = 0, worst = 0;
    int values = 0;
  };
  std::map<std::string, Quantity> quantities_;
};

/// Rows every 5 degrees of a full turn, reference values every 30: "crank_0deg" ... "crank_330deg".
inline std::string crank_key(int k) { return "crank_" + std::to_string(30 * k) + "deg"; }
constexpr std::size_t crank_row(int k) { return static_cast<std::size_t>(6 * k); }

}  // namespace catena::testing
