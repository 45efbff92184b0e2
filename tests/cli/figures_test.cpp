// draw, plot and view as a user calls them: files, messages, exit codes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/program.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Whether this program can write pages.
bool has_viewer() {
  TemporaryFolder folder;
  const std::string scene = write_scene(folder / "crank.json", crank_scene(R"({"type": "check"})"));
  return run_catena({"view", scene, "-o", folder / "page.html"}).err.find("built without the viewer") ==
         std::string::npos;
}

class Figures : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string scene_ =
      write_scene(folder_ / "crank.json", crank_scene(R"({"type": "kinematics", "until": 1, "every": 0.1})"));
};

TEST_F(Figures, DrawWritesFilesOrPrints) {
  const ProgramResult files =
      run_catena({"draw", scene_, "--poses", "3", "--svg", folder_ / "a.svg", "--pdf", folder_ / "a.pdf"});
  EXPECT_EQ(files.exit_code, 0) << files.err;
  EXPECT_EQ(files.out, "");
  EXPECT_NE(files.err.find("wrote " + (folder_ / "a.svg")), std::string::npos);
  EXPECT_EQ(content_of(folder_ / "a.svg").substr(0, 4), "<svg");
  EXPECT_EQ(content_of(folder_ / "a.pdf").substr(0, 8), "%PDF-1.4");
  const ProgramResult printed = run_catena({"draw", scene_, "--at", "0.5"});
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_EQ(printed.out.substr(0, 4), "<svg");
}

TEST_F(Figures, DrawRefusesWhatIsNoInstant) {
  for (const char* instant : {"nan", "inf", "0,nan"}) {
    const ProgramResult refused = run_catena({"draw", scene_, "--at", instant});
    EXPECT_EQ(refused.exit_code, 2) << instant;
    EXPECT_EQ(refused.out, "");
    EXPECT_NE(refused.err.find("is no instant"), std::string::npos) << refused.err;
  }
}

TEST_F(Figures, PlotPrintsWritesAndKnowsColumns) {
  const ProgramResult printed = run_catena({"plot", scene_, "--x", "t", "--y", "crank.omega,crank.angle"});
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  for (const char* said : {"crank.omega [rad/s]", "crank.angle [rad]", "over t [s]", "\u2502"})
    EXPECT_NE(printed.out.find(said), std::string::npos) << printed.out;
  EXPECT_EQ(printed.out.find('\x1b'), std::string::npos) << "no colours in a pipe";
  const ProgramResult files = run_catena({"plot", scene_, "--svg", folder_ / "p.svg", "--pdf", folder_ / "p.pdf"});
  EXPECT_EQ(files.exit_code, 0) << files.err;
  EXPECT_NE(content_of(folder_ / "p.svg").find("crank.angle"), std::string::npos);
  const ProgramResult unknown = run_catena({"plot", scene_, "--y", "crank.omegaa"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("did you mean \"crank.omega\"?"), std::string::npos) << unknown.err;
}

// Axes and values are in the units of the scene, or in those of the command line; poses are places in any case.
TEST_F(Figures, AreInTheUnitsAskedFor) {
  const std::string text = crank_scene(R"({"type": "kinematics", "until": 1, "every": 0.1})");
  const std::string wished = write_scene(
      folder_ / "wished.json", R"({"units": {"angle": "deg", "time": "ms"}, )" + text.substr(text.find('{') + 1));
  const std::vector<std::string> asked{"plot", scene_, "--y", "crank.angle", "--units", "angle=deg, time=ms"};
  const std::vector<std::string> said{"plot", wished, "--y", "crank.angle"};
  for (const auto& command : {asked, said}) {
    const ProgramResult plotted = run_catena(command);
    EXPECT_EQ(plotted.exit_code, 0) << plotted.err;
    EXPECT_NE(plotted.out.find("crank.angle [deg]"), std::string::npos) << plotted.out;
    EXPECT_NE(plotted.out.find("over t [ms]"), std::string::npos) << plotted.out;
    EXPECT_NE(plotted.out.find("1000"), std::string::npos) << plotted.out;
  }
  const ProgramResult files = run_catena({"plot", wished, "--y", "crank.angle", "--units", "angle=rev", "--svg",
                                          folder_ / "u.svg", "--pdf", folder_ / "u.pdf"});
  EXPECT_EQ(files.exit_code, 0) << files.err;
  EXPECT_NE(content_of(folder_ / "u.svg").find("[rev]"), std::string::npos) << "the command line comes first";
  EXPECT_NE(content_of(folder_ / "u.svg").find("t [ms]"), std::string::npos);
  EXPECT_NE(content_of(folder_ / "u.pdf").find("[rev]"), std::string::npos);
  EXPECT_EQ(run_catena({"draw", wished, "--at", "0.5"}).out, run_catena({"draw", scene_, "--at", "0.5"}).out);
  for (const std::string command : {"plot", "view", "run"}) {
    const ProgramResult wrong = run_catena({command, scene_, "--units", "length=deg"});
    EXPECT_EQ(wrong.exit_code, 2) << command;
    EXPECT_NE(wrong.err.find("\"deg\" is not a unit of length"), std::string::npos) << wrong.err;
    EXPECT_EQ(run_catena({command, scene_, "--units", "deg"}).exit_code, 2) << command;
  }
  if (!has_viewer()) return;
  const ProgramResult viewed = run_catena({"view", scene_, "--units", "angle=deg", "-o", folder_ / "units.html"});
  EXPECT_EQ(viewed.exit_code, 0) << viewed.err;
  EXPECT_NE(content_of(folder_ / "units.html").find("\"rad\":{\"unit\":\"deg\""), std::string::npos);
}

TEST_F(Figures, WrongWordsAreExitCodeTwo) {
  EXPECT_EQ(run_catena({"draw", scene_, "--trace", "crank.nowhere"}).exit_code, 2);
  EXPECT_EQ(run_catena({"draw", scene_, "--analysis", "7"}).exit_code, 2);
  EXPECT_EQ(run_catena({"draw", scene_, "--poses", "0"}).exit_code, 2);
  EXPECT_EQ(run_catena({"plot", scene_, "--log", "z"}).exit_code, 2);
  EXPECT_EQ(run_catena({"plot", scene_, "--set", "speed"}).exit_code, 2);
}

TEST_F(Figures, WrongScenesAndPlacesGetNoFile) {
  const std::string wrong = write_scene(folder_ / "wrong.json", R"({"catena": 1, "bodies": {"a": {"mas": 1}}})");
  const std::string file = folder_ / "figure";
  for (const std::string command : {"draw", "plot", "view"}) {
    if (command == "view" && !has_viewer()) continue;
    const std::string option = command == "view" ? "-o" : "--svg";
    const ProgramResult result = run_catena({command, wrong, option, file});
    EXPECT_EQ(result.exit_code, 3) << command << result.err;
    EXPECT_NE(result.err.find("did you mean \"mass\"?"), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
    const ProgramResult none = run_catena({command, folder_ / "none.json", option, file});
    EXPECT_EQ(none.exit_code, 4) << command << none.err;
    EXPECT_EQ(none.out, "");
    EXPECT_FALSE(std::filesystem::exists(file)) << command;
    EXPECT_EQ(run_catena({command, scene_, option, "/nowhere/figure"}).exit_code, 4) << command;
  }
}

// A crank that is too long for its rod, whose end keeps its height: the driver gets stuck on the way.
TEST_F(Figures, OfARunThatEndedEarlyAreMadeWithItsExitCode) {
  const std::string stuck = write_scene(folder_ / "stuck.json", R"({"catena": 1,
    "bodies": {"crank": {"rod": {"from": [0, 0], "to": [1, 0]}}, "rod": {"rod": {"from": [1, 0], "to": [1.5, 0.5]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
                    {"type": "revolute", "i": "crank.to", "j": "rod.from"},
                    {"type": "absolute_y", "i": "rod.to", "value": 0.5}],
    "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0, 1]}}],
    "analyses": [{"type": "kinematics", "until": 6, "every": 0.05}]})");
  const ProgramResult printed = run_catena({"draw", stuck, "--at", "0.12"});
  EXPECT_EQ(printed.exit_code, 1) << printed.err;
  EXPECT_EQ(printed.out.substr(0, 4), "<svg");
  EXPECT_NE(printed.err.find("no row at t = 0.12 s"), std::string::npos) << printed.err;
  const ProgramResult written =
      run_catena({"draw", stuck, "--at", "0.12", "--svg", folder_ / "s.svg", "--pdf", folder_ / "s.pdf"});
  EXPECT_EQ(written.exit_code, 1) << written.err;
  const std::size_t note = written.err.find("no row at");
  EXPECT_EQ(written.err.find("no row at", note + 1), std::string::npos) << "said once for all files\n" << written.err;
  EXPECT_EQ(run_catena({"plot", stuck}).exit_code, 1);
}

// Columns that an analysis has by itself are as good as any other; the analyses before it are not asked for them.
TEST_F(Figures, PlotKnowsTheColumnsThatAnalysesHaveByThemselves) {
  const std::string truss = write_scene(folder_ / "truss.json", R"({"catena": 1, "parameters": {"P": 0, "k": 1000},
    "bodies": {"apex": {"mass": 1, "position": [0, 0.3], "particle": true}},
    "constraints": [{"type": "absolute_x", "i": "apex", "value": 0}],
    "forces": [{"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "apex", "k": "k"},
               {"type": "spring_damper", "i": ["ground", [1, 0]], "j": "apex", "k": "k"},
               {"type": "point_force", "i": "apex", "force": [0, "=-P"]}],
    "analyses": [{"type": "equilibrium"}, {"type": "modes"}, {"type": "path", "parameter": "P", "to": 5},
      {"type": "sweep", "from": "initial", "over": {"k": [900, 1000, 1100]},
       "of": {"type": "equilibrium", "measures": {"height": {"final": "apex.y"}}}}]})");
  const auto plotted = [&](const std::string& x, const std::string& y) {
    return run_catena({"plot", truss, "--x", x, "--y", y});
  };
  for (const auto& [x, y] : {std::pair("P", "apex.y"), std::pair("apex.y", "P"), std::pair("mode", "omega,omega2"),
                             std::pair("k", "height"), std::pair("design", "height")}) {
    const ProgramResult result = plotted(x, y);
    EXPECT_EQ(result.exit_code, 0) << x << ' ' << y << '\n' << result.err;
    EXPECT_NE(result.out.find(std::string("over ") + x), std::string::npos) << result.out;
  }
  const ProgramResult words = plotted("k", "status");
  EXPECT_EQ(words.exit_code, 2);
  EXPECT_NE(words.err.find("holds words"), std::string::npos) << words.err;
  EXPECT_EQ(plotted("P", "apex.z").exit_code, 2);
}

TEST_F(Figures, ViewWritesAPageAndSaysWhere) {
  if (!has_viewer()) GTEST_SKIP() << "built without the viewer";
  const ProgramResult viewed = run_catena({"view", scene_, "-o", folder_ / "page.html"});
  EXPECT_EQ(viewed.exit_code, 0) << viewed.err;
  EXPECT_NE(viewed.err.find("wrote " + (folder_ / "page.html")), std::string::npos);
  EXPECT_EQ(content_of(folder_ / "page.html").substr(0, 15), "<!doctype html>");
  const ProgramResult run = run_catena({"run", scene_, "-q", "--view", folder_ / "run.html"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err + run.out, "") << "it was asked to be quiet";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "run.html"));
  EXPECT_EQ(run_catena({"view", scene_, "-o", "/nowhere/page.html"}).exit_code, 4);
}

}  // namespace
}  // namespace catena::testing
