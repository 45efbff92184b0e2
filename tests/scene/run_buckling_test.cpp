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

// A clamped chain of n rods and springs of 1000 N m/rad, the load along it: 4 c sin^2(pi / (4 n + 2)). Of 700 its
// softest motion is told from rounding; of a thousand, 1e-12 of the stiffest, it is not, which is said in place of
// other loads.
TEST(RunBuckling, OfLongChainsGivesTheLowestLoadOrNone) {
  const auto chain = [](int n) {
    return run_text(R"({"catena": 1, "parameters": {"P": 0}, "bodies": {"b0": {"rod": {"from": [0, 0], "to": [1, 0]}}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "b0.from"}],
      "forces": [{"type": "torsion_spring", "i": "ground", "j": "b0", "k": 1000},
                 {"type": "point_force", "i": "b)" +
                    std::to_string(n - 1) + R"(.to", "force": ["=-P", 0]}],
      "replicate": [{"count": )" +
                    std::to_string(n - 1) + R"(, "first": 1,
        "bodies": {"b{k}": {"rod": {"from": ["=k", 0], "to": ["=k+1", 0]}}},
        "constraints": [{"type": "revolute", "i": "b{k-1}.to", "j": "b{k}.from"}],
        "forces": [{"type": "torsion_spring", "i": "b{k-1}", "j": "b{k}", "k": 1000}]}],
      "analyses": [{"type": "buckling", "parameter": "P", "count": 2, "outputs": []}]})");
  };
  const TextRun told = chain(700), lost = chain(1000);
  ASSERT_EQ(told.outcome.exit_code, 0) << told.outcome.error_text;
  const auto loads = testing::field<std::vector<double>>(told, "loads");
  ASSERT_EQ(loads.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    const double sine = std::sin((2 * k + 1) * std::acos(-1.0) / (4 * 700 + 2)), right = 4000 * sine * sine;
    EXPECT_NEAR(loads[static_cast<std::size_t>(k)], right, 1e-8 * right);
  }
  EXPECT_EQ(lost.analysis().report.status, Status::refused);
  EXPECT_NE(lost.analysis().report.message.find("neutral"), std::string::npos) << lost.analysis().report.message;
}

}  // namespace
}  // namespace catena
