// Exit codes and messages for what a person types or names wrongly.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

TEST(Usage, MistakesAreExitCodeTwoAndSayWhatWasMeant) {
  TemporaryFolder folder;
  const std::string scene = write_scene(folder / "crank.json", crank_scene(R"({"type": "check"})"));
  const struct {
    std::vector<std::string> arguments;
    std::string said;
  } mistakes[] = {
      {{}, "Usage"},
      {{"runn", scene}, "unknown command \"runn\"; did you mean \"run\"?"},
      {{scene}, "did you mean \"catena run "},
      {{"run"}, "SCENE is required"},
      {{"run", scene, "--jsno"}, "unknown option \"--jsno\"; did you mean \"--json\"?"},
      {{"kinematics", scene, "--utnil=2"}, "unknown option \"--utnil\"; did you mean \"--until\"?"},
      {{"run", scene, "--until", "2"}, "unknown option \"--until\""},
      {{"run", scene, "second.json"}, "unexpected argument \"second.json\""},
      {{"--frobnicate"}, "unknown option \"--frobnicate\""},
      {{"run", scene, "-o"}, "--output"},
      {{"run", scene, "-o", ""}, "the folder has no name"},
      {{"run", scene, "--set", "speed"}, "wants NAME=VALUE, not \"speed\""},
      {{"run", scene, "--max-elements", "-3"}, "--max-elements"},
      {{"run", scene, "--max-elements", "many"}, "wants a whole number above 0, not many"},
      {{"explain", "revolut"}, "did you mean \"revolute\"?"},
  };
  for (const auto& mistake : mistakes) {
    const ProgramResult result = run_catena(mistake.arguments);
    EXPECT_EQ(result.exit_code, 2) << mistake.said;
    EXPECT_NE(result.err.find(mistake.said), std::string::npos) << mistake.said << "\n" << result.err;
    EXPECT_EQ(result.out, "");
  }
}

TEST(Usage, HelpAndVersionAreNoMistakes) {
  EXPECT_EQ(run_catena({"--version"}).out, "catena " CATENA_VERSION "\n");
  const ProgramResult help = run_catena({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"run", "check", "assemble", "kinematics", "inverse", "dynamics", "equilibrium", "path",
                              "modes", "explain", "schema", "draw", "plot", "view"}) {
    EXPECT_NE(help.out.find(std::string("\n  ") + command), std::string::npos) << command;
    EXPECT_EQ(run_catena({command, "--help"}).exit_code, 0) << command;
  }
}

TEST(Usage, ExplainAndSchemaPrintWhatTheyPromise) {
  const ProgramResult revolute = run_catena({"explain", "revolute"});
  EXPECT_EQ(revolute.exit_code, 0);
  EXPECT_NE(revolute.out.find("r_Pj - r_Pi = 0"), std::string::npos) << revolute.out;
  EXPECT_NE(run_catena({"explain"}).out.find("absolute_distance"), std::string::npos);
  const ProgramResult schema = run_catena({"schema"});
  EXPECT_EQ(schema.exit_code, 0);
  EXPECT_TRUE(json::parse(schema.out).contains("$schema"));
}

TEST(Usage, FilesThatAreNoneAreExitCodeFour) {
  TemporaryFolder folder;
  for (const std::string& path : {folder / "missing.json", folder.path().string()}) {
    const ProgramResult result = run_catena({"run", path, "--json"});
    EXPECT_EQ(result.exit_code, 4) << path;
    EXPECT_NE(result.err.find(path), std::string::npos) << result.err;
  }
}

TEST(Usage, AWrongSceneIsExitCodeThreeWithItsPlace) {
  TemporaryFolder folder;
  const std::string path = write_scene(folder / "wrong.json", "{\"catena\": 1,\n  \"bodeis\": {}}\n");
  ProgramResult result = run_catena({"run", path});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find(path + ":2:3: error: "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("did you mean \"bodies\"?"), std::string::npos) << result.err;

  result = run_catena({"run", path, "--json", "-o", folder / "results"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find(path + ":2:3: error: "), std::string::npos) << result.err;
  const json document = json::parse(result.out);
  EXPECT_EQ(document["catena"], 1);
  EXPECT_EQ(document["status"], "invalid");
  ASSERT_GE(document["errors"].size(), 1u);
  EXPECT_EQ(document["errors"][0]["file"], path);
  EXPECT_EQ(document["errors"][0]["line"], 2);
  EXPECT_EQ(document["errors"][0]["column"], 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST(Usage, OtherWrongTextsAreExitCodeThreeToo) {
  TemporaryFolder folder;
  for (const std::string text :
       {"", "{", "[]", "{\"catena\": 2}", "{\"catena\": 1, \"bodies\": {\"a\": {\"mass\": NaN}}}", "\xff\xfe",
        "{\"catena\": 1} trailing"}) {
    const std::string path = write_scene(folder / "wrong.json", text);
    const ProgramResult result = run_catena({"check", path});
    EXPECT_EQ(result.exit_code, 3) << text << '\n' << result.out << result.err;
    EXPECT_NE(result.err.find(path + ":"), std::string::npos) << result.err;
  }
  const std::string column = crank_scene(R"({"type": "kinematics", "at": 0, "outputs": ["crank.tip.z"]})");
  const ProgramResult result = run_catena({"run", write_scene(folder / "column.json", column)});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("crank.tip.z"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace catena::testing
