// Searches without derivatives, whose designs are computed in lanes: they end as those whose designs are analysed one
// by one, as they are where another analysis belongs to a design.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string_view>

#include "design/lane_families.hpp"

namespace catena::testing {
namespace {

/// A four-bar whose rocker is to swing by 0.8 rad, and whose pen is to rise to 0.5 m: not quite both; some designs
/// lock. Bobyqa comes to where the objective changes by rounding alone below a tolerance of 1e-6.
std::string swing_of_a_rocker(const char* solver, const char* before) {
  const Family family{four_bar + "]," + drive, {"a", "b", "c", "d", "w"}, {}, {}};
  const std::string search = fmt::format(
      R"json({{"type": "optimise", "of": [{}{{"type": "kinematics", "from": "initial", "until": "=2*pi/w", "every": "=2*pi/w/48",
        "measures": {{"swing": {{"range": "rocker.angle"}}, "reach": {{"max": "coupler.pen.y"}}}}}}],
      "variables": {{"a": {{"min": 0.25, "max": 0.6, "start": 0.35}}, "c": {{"min": 0.7, "max": 1.2, "start": 1}}}},
      "minimise": "=(swing - 0.8)^2 + 0.1*(reach - 0.5)^2", "solver": "{}", "max_evaluations": 500, "tolerance": {}}})json",
      before, solver, std::string_view(solver) == "bobyqa" ? "1e-5" : "1e-7");
  return scene_of(family, {0.35, 1.1, 1, 1.2, 2}, search);
}

class SearchByValues : public ::testing::TestWithParam<const char*> {};

TEST_P(SearchByValues, EndsInLanesAsWithoutThem) {
  const TextRun lanes = run_text(swing_of_a_rocker(GetParam(), ""));
  const TextRun alone = run_text(swing_of_a_rocker(GetParam(), R"json({"type": "kinematics", "at": 0}, )json"));
  ASSERT_EQ(lanes.outcome.analyses.size(), 1u) << lanes.outcome.error_text;
  ASSERT_EQ(alone.outcome.analyses.size(), 1u) << alone.outcome.error_text;
  EXPECT_EQ(lanes.analysis().report.status, alone.analysis().report.status);
  // The simplex of cobyla, with which isres ends too, turns on differences of rounding.
  if (const std::string_view method = GetParam(); method != "cobyla" && method != "isres") {
    EXPECT_EQ(field<std::int64_t>(lanes, "evaluations"), field<std::int64_t>(alone, "evaluations"));
  }
  EXPECT_NEAR(field<double>(lanes, "objective"), field<double>(alone, "objective"), 1e-9);
  // The steps of a search carry differences of rounding on: its designs agree to what its tolerance allows.
  for (const char* name : {"a", "c"}) EXPECT_NEAR(lanes.last(name), alone.last(name), 1e-6) << name;
}

INSTANTIATE_TEST_SUITE_P(Lanes, SearchByValues, ::testing::Values("bobyqa", "cobyla", "crs2", "isres", "direct"));

}  // namespace
}  // namespace catena::testing
