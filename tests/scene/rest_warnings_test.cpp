// What analyses at rest say of masses that are missing and of stiffness that does not count.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

bool warned_of(const TextRun& run, const std::string& text, std::size_t k = 0) {
  const std::vector<std::string>& warnings = run.analysis(k).report.warnings;
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

// A bar of 2 kg on a pin and a torsion spring carries a rod without a mass.
std::string bars(const std::string& gravity, const std::string& mass) {
  return R"({"catena": 1, "parameters": {"k": 100}, )" + gravity + R"("bodies": {
      "bar": {"mass": 2, "rod": {"from": [0, 0], "to": [1, 0]}},
      "light": {)" +
         mass + R"("rod": {"from": [1, 0], "to": [1, -1]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "bar.from"},
                    {"type": "revolute", "i": "bar.to", "j": "light.from"}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "bar", "k": "k"},
               {"type": "torsion_spring", "i": "bar", "j": "light", "k": 10}],
    "outputs": ["bar.angle"],
    "analyses": [{"type": "equilibrium"}, {"type": "path", "parameter": "k", "to": 120},
                 {"type": "buckling", "parameter": "k"}]})";
}

TEST(RestWarnings, NameBodiesWhoseWeightIsLeftOut) {
  const TextRun run = run_text(bars(R"("gravity": [0, -9.81], )", ""));
  for (const std::size_t k : {0u, 1u, 2u}) {
    EXPECT_TRUE(warned_of(run, "\"light\"", k)) << k << run.outcome.error_text;
    EXPECT_FALSE(warned_of(run, "\"bar\"", k)) << k;
  }
  const TextRun floating = run_text(bars("", "")),
                meant = run_text(bars(R"("gravity": [0, -9.81], )", R"("mass": 0, )"));
  for (const std::size_t k : {0u, 1u, 2u}) {
    EXPECT_FALSE(warned_of(floating, "weight", k)) << k;
    EXPECT_FALSE(warned_of(meant, "weight", k)) << k;
  }
  EXPECT_EQ(run.last("bar.angle"), meant.last("bar.angle"));
}

std::string stopped(const std::string& law) {
  return R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"mass": 20, "inertia": 1, "position": [0, 0.1]}},
    "constraints": [{"type": "translational", "i": "ground", "j": "b", "axis_i": [0, 1]}],
    "forces": [{"type": "stop", "name": "floor", "column": "b.y", "min": 0)" +
         law + R"(}], "outputs": ["b.y"], "analyses": [{"type": "equilibrium"}]})";
}

TEST(RestWarnings, NameStiffnessThatCountsInMotionAlone) {
  const TextRun soft = run_text(stopped(R"(, "k": 1000, "c": 100)"));
  ASSERT_EQ(soft.outcome.exit_code, 0) << soft.outcome.error_text;
  EXPECT_NEAR(soft.last("b.y"), 0, 1e-9);
  EXPECT_TRUE(warned_of(soft, "\"floor\""));
  EXPECT_FALSE(warned_of(run_text(stopped("")), "\"floor\""));
}

}  // namespace
}  // namespace catena::testing
