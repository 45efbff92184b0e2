// "digits": false and --no-digits as a user meets them: analyses of every kind that tell how many digits are right tell
// none, say that none were asked for, and have the same rows to the last bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "catena/scene/describing/analysis_description.hpp"
#include "scene/run_text.hpp"

namespace catena {
namespace {

using testing::field;
using testing::run_text;
using testing::TextRun;

// A crank that is driven or not, and a post that a load may buckle.
std::string scene_with(const std::string& analysis) {
  const std::string text = R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"P": 1},
    "bodies": {"a": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1},
               "post": {"rod": {"from": [5, 0], "to": [5, 1]}, "mass": 0.001}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "a.from"},
                    {"type": "revolute", "name": "Q", "i": "ground", "j": "post.from"}],)";
  const bool driven = analysis.find("kinematics") != std::string::npos || analysis.find("inverse") != std::string::npos;
  const std::string drivers = R"("drivers": [
      {"type": "relative_angle", "i": "ground", "j": "a", "value": {"polynomial": [0, 1, 0.5]}},
      {"type": "relative_angle", "i": "ground", "j": "post", "value": {"polynomial": [1.5, 0.1]}}],)";
  return text + (driven ? drivers : "") +
         R"("forces": [{"type": "torsion_spring", "i": "ground", "j": "post", "k": 6, "angle": 1.5707963267948966},
                       {"type": "torsion_spring", "i": "ground", "j": "a", "k": 30, "angle": 0},
                       {"type": "point_force", "i": "post.to", "force": [0, "=-P"]}],
    "outputs": ["a.angle", "a.to.y"], "analyses": [)" +
         analysis + "]}";
}

const std::string analyses[] = {R"({"type": "kinematics", "until": 1, "every": 0.25)",
                                R"({"type": "inverse_dynamics", "until": 1, "every": 0.25)",
                                R"({"type": "dynamics", "until": 1, "every": 0.25)",
                                R"({"type": "dynamics", "until": 1, "every": 0.25, "method": "adams")",
                                R"({"type": "dynamics", "until": 1, "every": 0.25, "estimate_error": true)",
                                R"({"type": "equilibrium")",
                                R"({"type": "path", "parameter": "P", "to": 2)",
                                R"({"type": "buckling", "parameter": "P")",
                                R"({"type": "modes")"};

void expect_none(const TextRun& run, const TextRun& with, const std::string& what) {
  ASSERT_EQ(run.outcome.exit_code, 0) << what << ": " << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(run.analysis().digits.empty()) << what;
  EXPECT_EQ(field<std::string>(run, "digits_note"), "no digits are claimed: they were not asked for") << what;
  ASSERT_EQ(run.analysis().columns.size(), with.analysis().columns.size()) << what;
  for (const ColumnInfo& column : run.analysis().columns)
    EXPECT_EQ(run.column(column.name), with.column(column.name)) << what << ", " << column.name;
}

TEST(DigitsOption, LeavesThemOutAndNothingElse) {
  RunOptions none;
  none.digits = false;
  for (const std::string& analysis : analyses) {
    const TextRun with = run_text(scene_with(analysis + "}"));
    ASSERT_EQ(with.outcome.exit_code, 0) << analysis << with.outcome.error_text << with.analysis().report.message;
    EXPECT_FALSE(with.analysis().digits.empty()) << analysis;
    for (const NamedField& other : with.analysis().fields) EXPECT_NE(other.name, "digits_note") << analysis;
    expect_none(run_text(scene_with(analysis + R"(, "digits": false})")), with, analysis);
    expect_none(run_text(scene_with(analysis + "}"), none), with, analysis + " --no-digits");
    const TextRun asked = run_text(scene_with(analysis + R"(, "digits": true})"));
    EXPECT_EQ(asked.analysis().digits.size(), with.analysis().digits.size()) << analysis;
  }
}

// Every kind of analysis that has the key is one of those above.
TEST(DigitsOption, IsOfAnalysesThatTellThem) {
  int kinds = 0;
  for (const AnalysisDescription& analysis : analysis_descriptions()) {
    for (const AnalysisKey& key : analysis.keys) {
      if (key.name != "digits") continue;
      ++kinds;
      const std::string type = "\"type\": \"" + std::string(analysis.type) + "\"";
      EXPECT_TRUE(std::any_of(std::begin(analyses), std::end(analyses), [&](const std::string& text) {
        return text.find(type) != std::string::npos;
      })) << analysis.type;
    }
  }
  EXPECT_EQ(kinds, 7);
  EXPECT_EQ(run_text(scene_with(R"({"type": "check", "digits": false})")).outcome.exit_code, 3);
}

}  // namespace
}  // namespace catena
