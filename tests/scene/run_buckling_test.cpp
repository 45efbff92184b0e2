// buckling in scenes: a row a load, the parameter as column, shapes where outputs are named.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/run_text.hpp"

namespace catena {
namespace {

using testing::run_text;
using testing::TextRun;

// Two rods of 1 m standing on each other, springs of 6 N m/rad at the foot and between them, a load P on top.
std::string tower(const std::string& analyses) {
  return R"({"catena": 1, "parameters": {"P": 0},
    "bodies": {"low": {"rod": {"from": [0, 0], "to": [0, 1]}}, "high": {"rod": {"from": [0, 1], "to": [0, 2]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "low.from"},
                    {"type": "revolute", "i": "low.to", "j": "high.from"}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "low", "k": 6},
               {"type": "torsion_spring", "i": "low", "j": "high", "k": 6},
               {"type": "point_force", "i": "high.to", "force": [0, "=-P"]}],
    "analyses": [)" +
         analyses + "]}";
}

TEST(RunBuckling, GivesTheLoads) {
  const TextRun run = run_text(tower(R"({"type": "buckling", "parameter": "P", "count": 2})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const AnalysisResult& result = run.analysis();
  ASSERT_EQ(result.fields.size(), 1u);
  EXPECT_EQ(result.fields[0].name, "loads");
  const auto& loads = std::get<std::vector<double>>(result.fields[0].value);
  ASSERT_EQ(loads.size(), 2u);
  // [2 -1; -1 1] - p/6: (3 -+ sqrt 5) / 2 times 6.
  EXPECT_NEAR(loads[0], 3 * (3 - std::sqrt(5.0)), 1e-10);
  EXPECT_NEAR(loads[1], 3 * (3 + std::sqrt(5.0)), 1e-10);
  ASSERT_EQ(result.columns.size(), 1u);
  EXPECT_EQ(result.columns[0].name, "P");
  EXPECT_EQ(run.column("P"), loads);
}

TEST(RunBuckling, GivesShapesOfNamedOutputs) {
  const TextRun run =
      run_text(tower(R"({"type": "buckling", "parameter": "P", "outputs": ["low.angle", "high.angle"]})"));
  ASSERT_EQ(run.analysis().rows, 1);
  EXPECT_NEAR(run.first("high.angle"), 1, 1e-10);
  EXPECT_NEAR(run.first("low.angle"), 2 / (1 + std::sqrt(5.0)), 1e-10);
}

}  // namespace
}  // namespace catena
