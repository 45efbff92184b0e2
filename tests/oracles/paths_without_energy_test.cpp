// Paths and equilibria under laws without a potential, of two bars, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// Two bars on pins of their own under torques that are laws.
std::string two_bars(const std::string& on_a, const std::string& on_b, const std::string& analyses) {
  return R"({"catena": 1, "parameters": {"P": 0}, "bodies": {"a": {"mass": 1, "inertia": 1},
    "b": {"mass": 2, "inertia": 3, "position": [5, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a"}, {"type": "revolute", "i": ["ground", [5, 0]], "j": "b"}],
    "forces": [{"type": "torque", "i": "a", "torque": "=)" +
         on_a + R"("}, {"type": "torque", "i": "b", "torque": "=)" + on_b +
         R"("}], "outputs": ["a.angle", "b.angle"], "analyses": [)" + analyses + "]}";
}

// The load enters by b alone, and K v = 0 moves a alone: only the vector on the left sees the limit point.
TEST(PathsWithoutEnergy, TellLimitPointsByTheVectorOnTheLeft) {
  const TextRun run = run_text(two_bars("b.angle - sin(2*a.angle)", "P - b.angle",
                                        R"({"type": "path", "parameter": "P", "to": -0.5, "max_steps": 400})"));
  const AnalysisResult& path = run.analysis();
  ASSERT_TRUE(path.report.ok() || path.report.status == Status::not_converged) << path.report.message;
  const std::vector<double> p = run.column("P"), a = run.column("a.angle"), b = run.column("b.angle");
  for (std::size_t k = 0; k < p.size(); ++k) {
    EXPECT_NEAR(std::sin(2 * a[k]), p[k], 1e-10);
    EXPECT_NEAR(b[k], p[k], 1e-10);
  }
}

TEST(PathsWithoutEnergy, FindLimitAndBranchPoints) {
  const TextRun limit = run_text(two_bars("b.angle - sin(2*a.angle)", "P - b.angle",
                                          R"({"type": "path", "parameter": "P", "to": 2, "max_steps": 60})"));
  const auto critical_of = [](const TextRun& run) {
    for (const NamedField& f : run.analysis().fields) {
      if (f.name == "critical") return std::get<std::vector<FieldRecord>>(f.value);
    }
    return std::vector<FieldRecord>{};
  };
  const auto turning = critical_of(limit);
  ASSERT_GE(turning.size(), 1u) << limit.analysis().report.message;
  EXPECT_EQ(std::get<std::string>(turning[0][0].second), "limit");
  EXPECT_NEAR(std::get<double>(turning[0][1].second), 1, 1e-9);
  // a alone has a pitchfork at P = 1; b reads it.
  const TextRun fork = run_text(two_bars("(P - 1)*a.angle - a.angle^3", "a.angle - 2*b.angle",
                                         R"({"type": "path", "parameter": "P", "to": 2, "branch": 2})"));
  ASSERT_EQ(fork.outcome.exit_code, 0) << fork.analysis().report.message << fork.outcome.error_text;
  const auto crossing = critical_of(fork);
  ASSERT_EQ(crossing.size(), 1u);
  EXPECT_EQ(std::get<std::string>(crossing[0][0].second), "branch");
  EXPECT_NEAR(std::get<double>(crossing[0][1].second), 1, 1e-9);
  EXPECT_NEAR(std::abs(fork.last("a.angle")), 1, 1e-9);
  EXPECT_NEAR(fork.last("b.angle"), 0.5 * fork.last("a.angle"), 1e-9);
}

// A stable place beside one that diverges is taken, unless stationary ones are asked for.
TEST(EquilibriaWithoutEnergy, LeaveThoseThatDiverge) {
  const std::string scene = two_bars("a.angle - a.angle^3", "a.angle - 2*b.angle", R"({"type": "equilibrium"},
      {"type": "equilibrium", "accept": "stationary", "from": "initial"})");
  const TextRun run = run_text(scene);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message << run.outcome.error_text;
  EXPECT_NEAR(std::abs(run.first("a.angle")), 1, 1e-9);
  EXPECT_TRUE(field<bool>(run, "stable"));
  EXPECT_NEAR(run.first("a.angle", 1), 0, 1e-12);
}

}  // namespace
}  // namespace catena::testing
