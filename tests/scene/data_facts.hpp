// Known facts about the scenes in data/scenes, by file name: closed forms and geometry, written down independently of
// catena.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>

#include "scene/run_text.hpp"

namespace catena::testing {

using SceneFacts = std::map<std::string, std::function<void(const TextRun&)>>;

SceneFacts absolute_facts();      ///< scenes of one constraint each
SceneFacts slider_facts();        ///< slider-cranks, quick returns, yoke, Geneva wheel
SceneFacts four_bar_facts();      ///< four-bars, six-bars and straight lines
SceneFacts leg_facts();           ///< walking legs
SceneFacts machine_facts();       ///< pantograph, excavator, wiper, lift, steering
SceneFacts gear_and_cam_facts();  ///< planetary set, rolling pinion, belts, cams
SceneFacts force_facts();         ///< nonlinear springs, bushings, events
SceneFacts gap_facts();           ///< contacts, stops, cables
SceneFacts design_facts();        ///< optimisations and sensitivities
SceneFacts contact_facts();       ///< motion with contact and friction, motion laws

/// Where the run's kinematics is in the list of analyses: after `check`.
constexpr std::size_t kinematic = 1;

inline double degrees(double angle) { return angle * 180 / std::numbers::pi; }

/// Every row of the kinematics: `expected` gives what the column holds there, from the columns that `given` names.
inline void expect_column(const TextRun& run, const std::string& column, const std::string& given,
                          const std::function<double(double)>& expected, double tolerance) {
  const std::vector<double> values = run.column(column, kinematic), arguments = run.column(given, kinematic);
  ASSERT_GT(values.size(), 10u) << column;
  ASSERT_EQ(values.size(), arguments.size());
  double worst = 0;
  for (std::size_t k = 0; k < values.size(); ++k) worst = std::max(worst, std::abs(values[k] - expected(arguments[k])));
  EXPECT_LE(worst, tolerance) << column;
}

/// The difference of the largest and the smallest value.
inline double range(const TextRun& run, const std::string& column) {
  const std::vector<double> values = run.column(column, kinematic);
  if (values.empty()) return std::nan("");
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

/// After a full turn a mechanism is where it began.
inline void expect_closed(const TextRun& run, const std::string& column, double tolerance = 1e-12) {
  EXPECT_NEAR(run.last(column, kinematic), run.first(column, kinematic), tolerance) << column;
}

inline void expect_mobility(const TextRun& run, int mobility) {
  ASSERT_TRUE(run.analysis(0).report.mobility);
  EXPECT_EQ(*run.analysis(0).report.mobility, mobility);
  EXPECT_EQ(run.analysis(0).report.dof, 0);
}

/// A quiet run: rows to the end, nothing to warn of.
inline void expect_no_warnings(const TextRun& run) {
  for (const AnalysisResult& result : run.outcome.analyses) {
    for (const std::string& warning : result.report.warnings) ADD_FAILURE() << result.type << ": " << warning;
  }
}

}  // namespace catena::testing
