// Wrong analyses of a scene, and options of a run.
#include <gtest/gtest.h>

#include "scene/wrong_scenes.hpp"

namespace catena::testing {
namespace {

using namespace wrong_scenes;

class WrongAnalysis : public ::testing::TestWithParam<BadScene> {};
TEST_P(WrongAnalysis, IsReportedAtItsPlace) { expect_report_of(GetParam()); }

const BadScene analyses[] = {
    {"UnknownAnalysis", analysis(R"({"type": §"kinematic"})"), "did you mean \"kinematics\"?"},
    {"NoType", analysis("§{}"), "needs a \"type\""},
    {"AnalysisKey", analysis(R"({"type": "kinematics", §"evry": 1})"), "did you mean \"every\"?"},
    {"KeyOfAnother", analysis(R"({"type": "check", §"until": 1})"), "unknown key \"until\" in check"},
    {"UntilZero", analysis(R"({"type": "kinematics", "until": §0})"), "must be above zero; it is 0"},
    {"ToleranceOfOne", analysis(R"({"type": "dynamics", "until": 1, "tolerance": §1})"), "must be below 1; it is 1"},
    {"ToleranceTooLarge", analysis(R"({"type": "dynamics", "until": 1, "tolerance": §10})"),
     "must be below 1; it is 10"},
    {"ToleranceTooSmall", analysis(R"({"type": "dynamics", "until": 1, "tolerance": §1e-20})"),
     "must be 1e-14 or more"},
    {"UntilUnit", analysis(R"({"type": "kinematics", "until": §"3 m"})"), "must be a time"},
    {"EveryNegative", analysis(R"({"type": "kinematics", "until": 1, "every": §-1})"), "must be above zero"},
    {"EveryZero", analysis(R"({"type": "kinematics", "until": 1, "every": §0})"), "must be above zero"},
    {"EveryAlone", analysis(R"({"type": "kinematics", "every": §1})"), "needs \"until\""},
    {"AtAndUntil", analysis(R"({"type": "kinematics", "until": 1, "at": §1})"), "together"},
    {"TooManyRows", analysis(R"({"type": "kinematics", "until": 1, "every": §1e-12})"), "rows"},
    {"Word", analysis(R"({"type": "equilibrium", "accept": §"unstable"})"), "\"stable\" or \"stationary\""},
    {"Whole", analysis(R"({"type": "modes", "count": §0})"), "whole number"},
    {"SetUnknown", analysis(R"({"type": "check", "set": {§"q": 1}})"), "unknown parameter \"q\""},
    {"SetUnit", analysis(R"({"type": "check", "set": {"l": §"3 kg"}})"), "must be a length"},
    {"SetMakesItWrong", R"({"catena": 1, "parameters": {"d": 1}, "bodies": {"a": {"position": [1, 0]}},
       "constraints": [{"type": "absolute_distance", "i": "a", "ground": [0, 0], "value": §"d"}],
       "analyses": [{"type": "check", "set": {"d": 0}}]})",
     "a revolute joint"},
    {"UnknownColumn", analysis(R"({"type": "kinematics", "outputs": ["crank.x", §"crank.z"]})"),
     "unknown column \"crank.z\""},
    {"UnknownColumnNear", analysis(R"({"type": "assemble", "outputs": [§"crnk.x"]})"), "did you mean \"crank.x\"?"},
    {"UnknownColumnOfScene", two_bodies(R"("outputs": [§"crank.anlge"])"), "did you mean \"crank.angle\"?"},
    {"UnknownColumnOfSceneOnce",
     two_bodies(R"("outputs": [§"rod.tip.x"], "analyses": [{"type": "assemble"}, {"type": "kinematics"}])"), "rod"},
    {"PathParameter", analysis(R"({"type": "path", "parameter": §"m", "to": 1})"), "unknown parameter"},
    {"PathWithout", analysis(R"(§{"type": "path", "to": 1})"), "needs \"parameter\""},
    {"PathToUnit", analysis(R"({"type": "path", "parameter": "l", "to": §"3 N"})"), "must be a length"},
    {"EventValueUnit", analysis(R"({"type": "dynamics", "events": [{"when": "crank.angle", "value": §"3 mm"}]})"),
     "must be an angle"},
    {"EventValueUnitOfParameter", analysis(R"({"type": "kinematics", "events": [{"when": "rod.vx", "value": §"l"}]})"),
     "must be a velocity"},
    {"EventBlockCountUnit", analysis(R"({"type": "dynamics", "replicate": [
       {"count": §"3 mm", "events": [{"when": "crank.angle"}]}]})"),
     "must be a"},
    {"EventWithout", analysis(R"({"type": "dynamics", "events": [§{"name": "a"}]})"), "needs \"when\""},
    {"RattleWithoutAStep", analysis(R"({"type": "dynamics", "until": 1, "method": §"rattle"})"), "give \"step\""},
    {"RhoAboveOne", analysis(R"({"type": "dynamics", "until": 1, "method": "alpha", "rho": §1.5})"),
     "0 ... 1; it is 1.5"},
    {"EventColumn", analysis(R"({"type": "dynamics", "events": [{"when": §"crank.q"}]})"), "unknown column"},
};

INSTANTIATE_TEST_SUITE_P(All, WrongAnalysis, ::testing::ValuesIn(analyses), name_of);

TEST(CommandLine, MistakesInOptionsAreExitCodeTwo) {
  const std::string scene = analysis(R"({"type": "check"})");
  const auto run = [&](RunOptions options) { return run_text(scene, options).outcome; };
  RunOptions unknown;
  unknown.set = {{"nn", "3"}};
  EXPECT_EQ(run(unknown).exit_code, 2);
  EXPECT_NE(run(unknown).error_text.find("--set: unknown parameter \"nn\"; did you mean \"n\"?"), std::string::npos)
      << run(unknown).error_text;
  RunOptions unit;
  unit.set = {{"l", "3 kg"}};
  EXPECT_EQ(run(unit).exit_code, 2);
  RunOptions until;
  until.verb = "kinematics";
  until.verb_options = {{"until", "0"}};
  EXPECT_EQ(run(until).exit_code, 2);
  EXPECT_NE(run(until).error_text.find("--until: \"until\" of kinematics must be above zero"), std::string::npos)
      << run(until).error_text;
  RunOptions column;
  column.verb = "assemble";
  column.verb_options = {{"outputs", "crank.x"}, {"outputs", "crank.z"}};
  EXPECT_EQ(run(column).exit_code, 2);
}

}  // namespace
}  // namespace catena::testing
