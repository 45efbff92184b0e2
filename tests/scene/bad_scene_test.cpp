// Wrong scenes: texts, bodies and parameters, blocks that are repeated.
#include <gtest/gtest.h>

#include "scene/wrong_scenes.hpp"

namespace catena::testing {
namespace {

using namespace wrong_scenes;

class WrongScene : public ::testing::TestWithParam<BadScene> {};
TEST_P(WrongScene, IsReportedAtItsPlace) { expect_report_of(GetParam()); }

const BadScene texts[] = {
    {"EmptyFile", "§", "empty"},
    {"BlankFile", "  \n §", "empty"},
    {"TruncatedFile", "{\"catena\": 1, \"bodies\": {\"a\": {§", "the text ends here"},
    {"NotAnObject", "§[1, 2]", "must be an object"},
    {"NaN", "{\"catena\": 1, \"gravity\": [0, §NaN]}", "NaN"},
    {"TooLarge", "{\"catena\": 1, \"gravity\": [0, §1e400]}", "1e400"},
    {"InvalidUtf8", "{\"catena\": 1, \"name\": \"a§\xff\"}", "UTF-8"},
    {"KeyTwice", "{\"catena\": 1, \"name\": \"a\", §\"name\": \"b\"}", "name"},
    {"BodyTwice", "{\"catena\": 1, \"bodies\": {\"a\": {}, §\"a\": {}}}", "duplicate key \"a\""},
    {"DrawNoList", R"({"catena": 1, "bodies": {"a": {"draw": §{"disc": {"radius": 1}}}}})", "must be a list of shapes"},
    {"DrawNothing", R"({"catena": 1, "bodies": {"a": {"draw": [§{}]}}})", "must be one of"},
    {"DrawTwo", R"({"catena": 1, "bodies": {"a": {"draw": [§{"disc": {"radius": 1}, "line": [[0, 0], [1, 0]]}]}}})",
     "must be one of"},
    {"DrawnDot", R"({"catena": 1, "bodies": {"ground": {"draw": [{"line": §[[0, 0]]}]}}})", "at least two corners"},
    {"DrawnMass", R"({"catena": 1, "bodies": {"a": {"draw": [{§"mass": 1, "disc": {"radius": 1}}]}}})", "mass"},
    {"DrawnNoArea", R"({"catena": 1, "bodies": {"a": {"draw": [§{"disc": {"radius": 0}}]}}})", "disc without area"},
    {"DrawnInKilograms", R"({"catena": 1, "bodies": {"a": {"draw": [{"disc": {"radius": §"1 kg"}}]}}})", "kg"},
};

const BadScene scenes[] = {
    {"NoVersion", "§{\"name\": \"x\"}", "\"catena\": 1"},
    {"Version2", "{\"catena\": §2}", "must be 1; this is version 2"},
    {"VersionText", "{\"catena\": §\"1\"}", "must be 1"},
    {"UnknownKey", "{\"catena\": 1, §\"bodeis\": {}}", "unknown key \"bodeis\" in the scene; did you mean \"bodies\"?"},
    {"BodiesAList", "{\"catena\": 1, \"bodies\": §[]}", "must be an object"},
    {"ConstraintsAnObject", "{\"catena\": 1, \"constraints\": §{}}", "must be a list"},
    {"GravityOne", "{\"catena\": 1, \"gravity\": §[1]}", "two numbers"},
    {"GravityUnit", "{\"catena\": 1, \"gravity\": [0, §\"9.81 m/s\"]}", "must be an acceleration"},
    {"BareNumberInQuotes", "{\"catena\": 1, \"gravity\": [0, §\"9.81\"]}", "number in quotes"},
    {"ParameterCycle", "{\"catena\": 1, \"parameters\": {\"a\": §\"=b\", \"b\": \"=a\"}}", "a -> b -> a"},
    {"ParameterLimit", "{\"catena\": 1, \"parameters\": {\"a\": {\"value\": §3, \"max\": 2}}}", "more than its max"},
    {"DivisionByZero", "{\"catena\": 1, \"parameters\": {\"a\": 0, \"b\": \"=1§/a\"}}", "division by zero"},
    {"BodyKey", "{\"catena\": 1, \"bodies\": {\"crank\": {§\"lenght\": 1}}}",
     "unknown key \"lenght\" in body \"crank\""},
    {"BodyKeyNear", "{\"catena\": 1, \"bodies\": {\"crank\": {§\"mas\": 1}}}", "did you mean \"mass\"?"},
    {"BodyMassUnit", "{\"catena\": 1, \"bodies\": {\"crank\": {\"mass\": §\"3 m\"}}}", "must be a mass"},
    {"BodyMassNegative", "{\"catena\": 1, \"bodies\": {\"crank\": {\"mass\": §-3}}}", "may not be negative"},
    {"BodyName", "{\"catena\": 1, \"bodies\": {§\"a.b\": {}}}", "may not have a ."},
    {"BodyNameTaken", "{\"catena\": 1, \"bodies\": {§\"energy\": {}}}", "is taken"},
    {"PointName", "{\"catena\": 1, \"bodies\": {\"a\": {\"points\": {§\"vx\": [0, 0]}}}}", "column of every body"},
    {"FixedNumber", "{\"catena\": 1, \"bodies\": {\"a\": {\"fixed\": §1}}}", "must be true or false"},
    {"RodAndAngle",
     "{\"catena\": 1, \"bodies\": {\"a\": {\"rod\": {\"from\": [0, 0], \"to\": [1, 0]}, \"angle\": §1}}}",
     "follows from its rod"},
    {"RodWithoutLength", "{\"catena\": 1, \"bodies\": {\"a\": {\"rod\": {\"from\": [§1, 0], \"to\": [1, 0]}}}}",
     "has no length"},
    {"RodOneEnd", "{\"catena\": 1, \"bodies\": {\"a\": {\"rod\": §{\"from\": [1, 0]}}}}", "needs \"to\""},
    {"RodPointAgain",
     "{\"catena\": 1, \"bodies\": {\"a\": {\"rod\": {\"from\": [0, 0], \"to\": [1, 0]}, \"points\": {§\"to\": [0, "
     "0]}}}}",
     "given twice"},
    {"HoldWord", "{\"catena\": 1, \"bodies\": {\"a\": {\"hold\": [§\"z\"]}}}", "\"x\", \"y\" or \"angle\""},
    {"PartAndMass", "{\"catena\": 1, \"bodies\": {\"a\": {\"mass\": §1, \"parts\": [{\"mass\": 1}]}}}",
     "follow from its parts"},
    {"GroundMass", "{\"catena\": 1, \"bodies\": {\"ground\": {§\"mass\": 1}}}", "unknown key \"mass\" in the ground"},
};

const BadScene replicated[] = {
    {"IndexOutOfRange", R"({"catena": 1, "replicate": [{"count": 3, "bodies": {"link{k}": {}},
       "constraints": [{"type": "revolute", "i": §"link{k-1}", "j": "link{k}"}]}]})",
     "there is no body \"link0\""},
    {"ShowsK", R"({"catena": 1, "replicate": [{"count": 3, "bodies": {"link{k}": {}},
       "constraints": [{"type": "revolute", "i": "link{k}", "j": §"link{k+1}"}]}]})",
     "at k = 3"},
    {"OncePerPlace", R"({"catena": 1, "replicate": [{"count": 1000, "bodies": {"link{k}": {"mass": §"=-k"}}}]})",
     "it is -1 (at k = 1)"},
    {"NoCount", R"({"catena": 1, "replicate": [§{"bodies": {}}]})", "needs \"count\""},
    {"CountFraction", R"({"catena": 1, "replicate": [{"count": §2.5, "bodies": {"b{k}": {}}}]})", "whole number"},
    {"CountNegative", R"({"catena": 1, "replicate": [{"count": §-2, "bodies": {"b{k}": {}}}]})", "-2"},
    {"SameNames", R"({"catena": 1, "replicate": [{"count": 3, "bodies": {§"link": {}}}]})", "is used twice"},
    {"NameFraction", R"({"catena": 1, "replicate": [{"count": 3, "bodies": {"link{§k/2}": {}}}]})", "integer"},
    {"NameUnclosed", R"({"catena": 1, "bodies": {"link§{k": {}}})", "not closed"},
    {"KOutside", R"({"catena": 1, "bodies": {"link{§k}": {}}})", "k"},
    {"TooMany", R"({"catena": 1, "replicate": [{"count": §1e9, "bodies": {"b{k}": {}}}]})", "--max-elements"},
    {"TooManyNested",
     R"({"catena": 1, "replicate": [{"count": 1e6, "replicate": [{"count": §1e6, "bodies": {"b{k}": {}}}]}]})",
     "--max-elements"},
};

INSTANTIATE_TEST_SUITE_P(Text, WrongScene, ::testing::ValuesIn(texts), name_of);
INSTANTIATE_TEST_SUITE_P(Scene, WrongScene, ::testing::ValuesIn(scenes), name_of);
INSTANTIATE_TEST_SUITE_P(Replicate, WrongScene, ::testing::ValuesIn(replicated), name_of);

TEST(WrongScenes, AllErrorsAtOnceInTheOrderOfTheText) {
  const TextRun run = run_text(R"({"catena": 2, "gravity": [0, "9.81 m"],
  "bodies": {"a": {"mas": 1}, "b": {"mass": "l"}},
  "constraints": [{"type": "revolute", "i": "a", "j": "c"}, {"type": "weld", "i": "a", "j": "a"}],
  "analyses": [{"type": "kinematics", "until": 0}]})");
  ASSERT_EQ(run.outcome.errors.size(), 7u) << run.outcome.error_text;
  const int lines[] = {1, 1, 2, 2, 3, 3, 4};
  for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(run.outcome.errors[k].line, lines[k]) << k;
}

TEST(WrongScenes, FilesThatCannotBeReadAreExitCodeFour) {
  TemporaryFolder folder;
  StoringSink sink;
  const SceneOutcome missing = run_scene(folder / "none.json", {}, sink);
  EXPECT_EQ(missing.exit_code, 4);
  EXPECT_NE(missing.error_text.find("none.json"), std::string::npos) << missing.error_text;
  EXPECT_EQ(run_scene(folder.path().string(), {}, sink).exit_code, 4);
  EXPECT_EQ(sink.runs, 0);
}

TEST(WrongScenes, AHundredMegabytesOfBracketsEndSoon) {
  const TextRun run = run_text(std::string(100'000'000, '['));
  EXPECT_EQ(run.outcome.exit_code, 3);
  ASSERT_EQ(run.outcome.errors.size(), 1u);
  EXPECT_LT(run.outcome.error_text.size(), 1000u);
}

TEST(WrongScenes, ManyMistakesAreCountedNotPrinted) {
  std::string text = "{\"catena\": 1, \"bodies\": {";
  for (int k = 0; k < 1000; ++k) text += (k ? ",\n\"b" : "\n\"b") + std::to_string(k) + "\": {\"mass\": -1}";
  const TextRun run = run_text(text + "}}");
  EXPECT_EQ(run.outcome.exit_code, 3);
  EXPECT_LE(run.outcome.errors.size(), 50u);
  EXPECT_NE(run.outcome.error_text.find("more error"), std::string::npos);
}

TEST(WrongScenes, ErrorsAsJson) {
  const TextRun run = run_text("{\"catena\": 2}");
  const std::string json = invalid_json(run.outcome);
  EXPECT_NE(json.find("\"status\": \"invalid\""), std::string::npos);
  EXPECT_NE(json.find("\"line\": 1, \"column\": 12"), std::string::npos) << json;
}

}  // namespace
}  // namespace catena::testing
