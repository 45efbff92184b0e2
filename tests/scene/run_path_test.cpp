// path in scenes: the parameter as first column, critical points as records, derived parameters, limits, branches.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/run_text.hpp"

namespace catena {
namespace {

using testing::run_text;
using testing::TextRun;

// Two springs of 1000 N/m over a span of 2 m, 0.3 m high, loaded by P at the apex.
std::string truss(const std::string& analyses) {
  return R"({"catena": 1, "parameters": {"P": 0, "down": "=-P", "Q": {"value": 1, "max": 5}},
    "bodies": {"apex": {"mass": 1, "position": [0, 0.3], "particle": true}},
    "constraints": [{"type": "absolute_x", "i": "apex", "value": 0}],
    "forces": [{"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "apex", "k": 1000},
               {"type": "spring_damper", "i": ["ground", [1, 0]], "j": "apex", "k": 1000},
               {"type": "point_force", "i": "apex", "force": ["=0*Q", "down"]}],
    "outputs": ["apex.y"], "analyses": [)" +
         analyses + "]}";
}

const FieldValue& field(const AnalysisResult& result, const std::string& name) {
  for (const NamedField& field : result.fields) {
    if (field.name == name) return field.value;
  }
  throw std::out_of_range(name);
}

TEST(RunPath, GivesTheParameterFirstAndCriticalPoints) {
  const TextRun run =
      run_text(truss(R"({"type": "path", "parameter": "P", "to": 12}, {"type": "equilibrium", "set": {"P": 12}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message << run.outcome.error_text;
  const AnalysisResult& result = run.analysis();
  ASSERT_EQ(result.columns.size(), 2u);
  EXPECT_EQ(result.columns[0].name, "P");
  const std::vector<double> load = run.column("P"), y = run.column("apex.y");
  ASSERT_EQ(load.size(), static_cast<std::size_t>(result.rows));
  const double length = std::sqrt(1 + 0.3 * 0.3);
  for (std::size_t k = 0; k < load.size(); ++k)
    EXPECT_NEAR(load[k], 2000 * (length / std::sqrt(1 + y[k] * y[k]) - 1) * y[k], 1e-9);
  const auto& critical = std::get<std::vector<FieldRecord>>(field(result, "critical"));
  ASSERT_EQ(critical.size(), 2u);
  EXPECT_EQ(critical[0][0].first, "kind");
  EXPECT_EQ(std::get<std::string>(critical[0][0].second), "limit");
  EXPECT_EQ(critical[0][1].first, "value");
  EXPECT_NEAR(std::get<double>(critical[0][1].second), 9.949916957744563, 1e-10);
  const auto row = static_cast<std::size_t>(std::get<std::int64_t>(critical[0][2].second));
  EXPECT_EQ(load.at(row), std::get<double>(critical[0][1].second));
  // The next analysis goes on where the path ended.
  EXPECT_NEAR(run.first("apex.y", 1), y.back(), 1e-10);
}

// Whatever comes after a path has its last value, until an analysis starts from the given configuration.
TEST(RunPath, LeavesItsParameterToTheNextAnalyses) {
  const TextRun run = run_text(truss(R"({"type": "path", "parameter": "P", "to": 12}, {"type": "equilibrium"},
    {"type": "path", "parameter": "P", "to": 14}, {"type": "equilibrium"},
    {"type": "equilibrium", "from": "initial"})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.first("apex.y", 1), run.last("apex.y", 0), 1e-10);
  EXPECT_NEAR(run.first("P", 2), 12, 1e-12) << "a second path begins where the first ended";
  EXPECT_NEAR(run.first("apex.y", 3), run.last("apex.y", 2), 1e-10);
  EXPECT_NEAR(run.first("apex.y", 4), 0.3, 1e-10);
}

// Where next to nothing moves, a step is a given part of the parameter's range: the end is met after a whole number of
// them.
TEST(RunPath, EndsAfterAWholeNumberOfSteps) {
  for (const char* arc : {"0.05", "0.04", "0.1", "0.025", "0.2"}) {
    SCOPED_TRACE(arc);
    const TextRun run = run_text(R"({"catena": 1, "parameters": {"w": 10},
      "bodies": {"b": {"mass": 1, "particle": true, "position": [0, -1]}},
      "constraints": [{"type": "absolute_x", "i": "b", "value": 0}],
      "forces": [{"type": "spring_damper", "i": "ground", "j": "b", "k": 100, "length": 1},
                 {"type": "point_force", "i": "b", "force": [0, "=-w*1e-6"]}],
      "outputs": ["b.y"], "analyses": [{"type": "path", "parameter": "w", "to": 12, "arc": )" +
                                 std::string(arc) + "}]}");
    ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
    const std::vector<double> w = run.column("w");
    ASSERT_GE(w.size(), 2U);
    EXPECT_EQ(w.back(), 12);
    EXPECT_LE(w[w.size() - 2], 12 - 1e-3);
    EXPECT_NEAR(run.last("b.y"), -1 - 12e-8, 1e-14);
  }
}

TEST(RunPath, StopsAtTheLimitOfAParameter) {
  EXPECT_EQ(run_text(truss(R"({"type": "path", "parameter": "Q", "to": 5})")).outcome.exit_code, 0);
  const TextRun run = run_text(truss(R"({"type": "path", "parameter": "Q", "to": 7})"));
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::refused);
}

TEST(RunPath, TakesTheBranchAskedFor) {
  const std::string scene = R"({"catena": 1, "gravity": [0, -10], "parameters": {"m": 0.05},
    "bodies": {"bar": {"mass": "m", "inertia": 0, "position": [0, 1]}},
    "constraints": [{"name": "A", "type": "revolute", "i": "ground", "j": ["bar", [0, -1]]}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "bar", "k": 1}],
    "outputs": ["bar.angle"],
    "analyses": [{"type": "path", "parameter": "m", "to": 0.2, "branch": )";
  for (const char* branch : {"1", "2", "3"}) {
    const TextRun run = run_text(scene + branch + "}]}");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    const auto& critical = std::get<std::vector<FieldRecord>>(field(run.analysis(), "critical"));
    ASSERT_EQ(critical.size(), 1u);
    EXPECT_EQ(std::get<std::string>(critical[0][0].second), "branch");
    EXPECT_NEAR(std::get<double>(critical[0][1].second), 0.1, 1e-9);
    const double theta = run.last("bar.angle");
    EXPECT_NEAR(std::abs(theta), *branch == '1' ? 0 : 1.895494267033981, 1e-9);
    if (*branch != '1') {
      EXPECT_EQ(theta > 0, *branch == '2');
    }
  }
  EXPECT_EQ(run_text(scene + "4}]}").analysis().report.status, Status::refused);
}

}  // namespace
}  // namespace catena
