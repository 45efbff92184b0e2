// Random designs of a mechanism in lanes beside each of them by itself.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {

/// A scene with parameters and measures, and the ranges of its designs.
struct Family {
  std::string mechanism;
  std::vector<std::string> names, measures;
  std::vector<std::array<double, 2>> ranges;
  std::string analysis = "kinematics";
  double size = 1;  // of what is measured, or of what it is made of
  bool some_fail = true;
  std::string keys = {};       // of an equilibrium, each after a comma
  double part_in_lanes = 0.8;  // of the good designs, at least
};

inline const std::string four_bar = R"json( "bodies": {
  "crank": {"rod": {"from": [0, 0], "to": ["a", 0]}},
  "coupler": {"rod": {"from": ["a", 0], "to": ["=a + b*cos(0.9)", "=b*sin(0.9)"]}, "points": {"pen": [0.1, 0.2]}},
  "rocker": {"rod": {"from": ["d", 0], "to": ["=d + c*cos(1.8)", "=c*sin(1.8)"]}}},
 "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
  {"type": "revolute", "i": "crank.to", "j": "coupler.from"}, {"type": "revolute", "i": "coupler.to", "j": "rocker.to"},
  {"type": "revolute", "i": ["ground", ["d", 0]], "j": "rocker.from"})json";
inline const std::string drive =
    R"json( "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0, "w"]}}],)json";

/// Every rod has the mass 1.
inline void give_masses(Family& family) {
  const std::string rod = "{\"rod\"";
  for (std::size_t at = family.mechanism.find(rod); at != std::string::npos; at = family.mechanism.find(rod, at + 9))
    family.mechanism.insert(at + 1, R"json("mass": 1, )json");
}

inline std::string scene_of(const Family& family, const std::vector<double>& values, const std::string& analysis) {
  std::string text = R"json({"catena": 1, "parameters": {)json";
  for (std::size_t p = 0; p < family.names.size(); ++p)
    text += fmt::format("{}\"{}\": {:.17g}", p ? ", " : "", family.names[p], values[p]);
  return text + "}," + family.mechanism + R"json("outputs": [], "analyses": [)json" + analysis + "]}";
}

inline std::string analysis_of(const Family& family) {
  const bool moves = family.analysis != "equilibrium";
  std::string text = fmt::format(R"json({{"type": "{}"{}, "measures": {{)json", family.analysis,
                                 moves ? R"json(, "until": "=6/w", "every": "=6/w/48")json" : family.keys);
  for (std::size_t m = 0; m < family.measures.size(); ++m)
    text += fmt::format("{}\"m{}\": {}", m ? ", " : "", m, family.measures[m]);
  return text + "}}";
}

/// Statuses and measures of a sweep in lanes are those of single runs; most good designs stay in their lanes.
inline void expect_same_as_alone(const Family& family) {
  constexpr int designs = size_of_test(40, 8);
  constexpr std::size_t one_in = size_of_test<std::size_t>(1, 8);  // is run alone
  std::mt19937 random(7);
  std::vector<std::vector<double>> values;
  for (int k = 0; k < designs; ++k) {
    values.emplace_back();
    for (const auto& [low, high] : family.ranges)
      values.back().push_back(std::uniform_real_distribution(low, high)(random));
  }
  std::string over;
  for (std::size_t p = 0; p < family.names.size(); ++p) {
    over += fmt::format("{}\"{}\": [", p ? ", " : "", family.names[p]);
    for (int k = 0; k < designs; ++k)
      over += fmt::format("{}{:.17g}", k ? ", " : "", values[static_cast<std::size_t>(k)][p]);
    over += "]";
  }
  const TextRun sweep = run_text(scene_of(family, values[0],
                                          R"json({"type": "sweep", "design": "together", "of": )json" +
                                              analysis_of(family) + R"json(, "over": {)json" + over + "}}"));
  ASSERT_EQ(sweep.outcome.exit_code, 0) << sweep.outcome.error_text << sweep.analysis().report.message;
  int good = 0;
  for (std::size_t k = 0; k < designs; ++k) {
    SCOPED_TRACE(k);
    good += sweep.column("status")[k] == static_cast<double>(Status::ok);
    if (k % one_in != 0) continue;
    const TextRun alone = run_text(scene_of(family, values[k], analysis_of(family)));
    ASSERT_EQ(alone.outcome.analyses.size(), 1u) << alone.outcome.error_text;
    const AnalysisResult& result = alone.analysis();
    EXPECT_EQ(sweep.column("status")[k], static_cast<double>(result.report.status)) << result.report.message;
    for (std::size_t m = 0; m < family.measures.size(); ++m) {
      const double value = sweep.column(fmt::format("m{}", m))[k];
      if (!result.report.ok()) {
        EXPECT_TRUE(std::isnan(value));
        continue;
      }
      ASSERT_TRUE(result.measures[m].value);
      // Lengths, angles and rates are about one; loads are as large as the others of the mechanism.
      EXPECT_NEAR(value, *result.measures[m].value, 1e-12 * std::max(family.size, std::abs(value))) << m;
    }
  }
  EXPECT_GT(good, designs / 4);
  EXPECT_TRUE(is_sanitized || (good < designs) == family.some_fail);
  // Those that move stay in their lanes, but for a few that come near to where they lock.
  const auto in_lanes = field<std::int64_t>(sweep, "in_lanes");
  EXPECT_LE(in_lanes, good);
  EXPECT_GE(static_cast<double>(in_lanes), std::floor(family.part_in_lanes * good));
}

}  // namespace catena::testing
