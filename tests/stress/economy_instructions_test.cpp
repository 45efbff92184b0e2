// What a scene does not need costs no instructions: pairs of runs of `catena bench economy` under callgrind, whose
// answers the suite itself holds against each other. Instructions of one binary differ by less than a thousandth from
// run to run; bounds between two kinds of work are half of what was measured.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

#ifdef CATENA_EXECUTABLE

/// Of "feature: variant"; empty without valgrind.
std::map<std::string, double> counted_instructions() {
  const TemporaryFolder folder;
  const std::string document = folder / "economy.json";
  const std::string command = "'" CATENA_EXECUTABLE "' bench economy -q --budget 0.001 --json '" + document + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << "an answer is not that of the full run";
  std::map<std::string, double> counted;
  const nlohmann::json written = nlohmann::json::parse(std::ifstream(document));
  for (const auto& row : written.at("rows")) {
    if (!row.at("counts").contains("instructions")) continue;
    counted[row.at("problem").get<std::string>() + ": " + row.at("method").get<std::string>()] =
        row.at("counts").at("instructions").get<double>();
  }
  return counted;
}

TEST(EconomyInstructions, AreThoseOfWhatIsAskedFor) {
  if (std::system("command -v valgrind >/dev/null 2>&1") != 0) GTEST_SKIP() << "valgrind is not installed";
  std::map<std::string, double> of = counted_instructions();
  const auto ratio = [&](const std::string& feature, const char* lean, const char* full) {
    const double a = of[feature + ": " + lean], b = of[feature + ": " + full];
    EXPECT_GT(a, 1e6) << feature;
    EXPECT_GT(b, 1e6) << feature;
    std::printf("%s: %.4g for %s, %.4g for %s\n", feature.c_str(), a, lean, b, full);
    return b / a;
  };
  // Gravity and ten springs in driven motion without loads: their plan, and nothing at a step.
  EXPECT_LT(ratio("forces where none are asked for", "none", "gravity and 10 springs"), 1.001);
  EXPECT_GT(ratio("columns that are not asked for", "positions alone", "all columns"), 6);
  // A thousand rows are interpolated, and projected once each, in 15 steps or so.
  EXPECT_LT(ratio("rows do not shorten steps", "1 row", "1001 rows"), 4);
  EXPECT_GT(ratio("equations with constant derivatives", "constant", "may vary"), 1.05);
  EXPECT_GT(ratio("mechanisms of different pace", "apart", "together"), 1.7);
  EXPECT_GT(ratio("a parameter changes", "goes on from the last solution", "anew"), 1.4);
  // 400 bodies that do not move beside 11 that do: to solve for all would take 37 times as much.
  EXPECT_LT(ratio("bodies that do not move", "none", "200 fixed, 200 welded"), 4);
}

#endif

}  // namespace
}  // namespace catena::testing
