// --no-digits, of a whole scene and of one analysis.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

TEST(DigitsOption, LeavesThemOutOfTableAndDocument) {
  const TemporaryFolder folder;
  const std::string scene =
      write_scene(folder / "crank.json", crank_scene(R"({"type": "kinematics", "until": 1, "every": 0.25})"));
  const auto first_analysis = [](const ProgramResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out)["analyses"][0];
  };
  const json with = first_analysis(run_catena({"run", scene, "--json"}));
  EXPECT_TRUE(with.contains("digits"));
  EXPECT_FALSE(with.contains("digits_note"));
  for (const json& without : {first_analysis(run_catena({"run", scene, "--json", "--no-digits"})),
                              first_analysis(run_catena({"kinematics", scene, "--json", "--no-digits"}))}) {
    EXPECT_FALSE(without.contains("digits"));
    EXPECT_EQ(without["digits_note"], "no digits are claimed: they were not asked for");
  }
  EXPECT_NE(run_catena({"run", scene}).out.find("digits right"), std::string::npos);
  EXPECT_EQ(run_catena({"run", scene, "--no-digits"}).out.find("digits right"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
