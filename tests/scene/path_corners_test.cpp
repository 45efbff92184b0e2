// path where a stiffness jumps: the equilibrium goes on with another tangent.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

bool has_row_near(const std::vector<double>& values, double wanted, double within) {
  return std::any_of(values.begin(), values.end(), [&](double v) { return std::abs(v - wanted) <= within; });
}

// A particle on two springs and an elastic cable; a foot moves. The places are those of a solver of nonlinear equations
// of its own, to 8 digits.
std::string netted(const std::string& analyses) {
  return R"({"catena": 1, "parameters": {"b": 1}, "gravity": [0, -9.81],
    "bodies": {"n": {"particle": true, "mass": 1, "position": [0.5, -1]}},
    "forces": [{"type": "spring_damper", "i": "ground", "j": "n", "k": 50, "length": 1},
               {"type": "spring_damper", "i": ["ground", ["b", 0]], "j": "n", "k": 80, "length": 0.8},
               {"type": "cable", "name": "q", "i": ["ground", [-1, 0]], "j": "n", "k": 100, "length": 1.6}],
    "outputs": ["n.x", "n.y", "q.force"], "analyses": [)" +
         analyses + "]}";
}

TEST(PathCorners, GoOnWhereACableBecomesSlack) {
  for (const auto& [to, x, y] :
       {std::array{0.26, 0.28739994, -0.93520462}, std::array{0.1, 0.12178434, -0.94912742},
        std::array{-0.5, -0.45656547, -0.91106509}, std::array{-2.0, -1.15309588, -0.43859673}}) {
    const TextRun run = run_text(netted(R"({"type": "path", "parameter": "b", "to": )" + std::to_string(to) + "}"));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    EXPECT_NEAR(run.last("n.x"), x, 1e-8) << to;
    EXPECT_NEAR(run.last("n.y"), y, 1e-8) << to;
    EXPECT_EQ(run.last("q.force"), 0) << to;
    EXPECT_TRUE(has_row_near(run.column("b"), 0.27346694, 1e-7)) << to;
    EXPECT_LT(run.column("b").size(), 200u);
  }
}

TEST(PathCorners, GoOnWhereACableBecomesTaut) {
  const TextRun run = run_text(netted(R"({"type": "path", "parameter": "b", "to": -0.5},
    {"type": "path", "parameter": "b", "to": 1}, {"type": "equilibrium", "set": {"b": 1}, "from": "initial"})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis(1).report.message;
  EXPECT_NEAR(run.last("n.x", 1), run.last("n.x", 2), 1e-9);
  EXPECT_NEAR(run.last("n.y", 1), run.last("n.y", 2), 1e-9);
  EXPECT_NEAR(run.last("q.force", 1), run.last("q.force", 2), 1e-7);
  EXPECT_GT(run.last("q.force", 1), 1);
}

// Two springs of 1000 N/m over a span of 2 m, 0.3 m high, loaded by P at the apex: past the limit point the load falls
// to zero at y = 0, where an elastic cable becomes taut and the path turns back.
TEST(PathCorners, TurnBackWhereACableCatchesWhatFalls) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"P": 0, "down": "=-P"},
    "bodies": {"apex": {"mass": 1, "position": [0, 0.3], "particle": true}},
    "constraints": [{"type": "absolute_x", "i": "apex", "value": 0}],
    "forces": [{"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "apex", "k": 1000},
               {"type": "spring_damper", "i": ["ground", [1, 0]], "j": "apex", "k": 1000},
               {"type": "cable", "i": ["ground", [0, 2]], "j": "apex", "k": 1000, "length": 2},
               {"type": "point_force", "i": "apex", "force": [0, "down"]}],
    "outputs": ["apex.y"], "analyses": [{"type": "path", "parameter": "P", "to": 12}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message << run.outcome.error_text;
  const std::vector<double> y = run.column("apex.y"), P = run.column("P");
  const double length = std::sqrt(1 + 0.3 * 0.3);
  for (std::size_t k = 0; k < y.size(); ++k) {
    const double load = 2000 * (length / std::sqrt(1 + y[k] * y[k]) - 1) * y[k] + 1000 * std::max(-y[k], 0.0);
    EXPECT_NEAR(P[k], load, 1e-9) << y[k];
    if (k > 0) {
      EXPECT_LT(y[k], y[k - 1]);
    }
  }
  EXPECT_LT(y.back(), 0);
  EXPECT_TRUE(has_row_near(y, 0, 1e-5));
}

}  // namespace
}  // namespace catena::testing
