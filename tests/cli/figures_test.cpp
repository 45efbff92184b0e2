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

TEST_F(Figures, WrongWordsAreExitCodeTwo) {
  EXPECT_EQ(run_catena({"draw", scene_, "--trace", "crank.nowhere"}).exit_code, 2);
  EXPECT_EQ(run_catena({"draw", scene_, "--analysis", "7"}).exit_code, 2);
  EXPECT_EQ(run_catena({"draw", scene_, "--poses", "0"}).exit_code, 2);
  EXPECT_EQ(run_catena({"plot", scene_, "--log", "z"}).exit_code, 2);
  EXPECT_EQ(run_catena({"plot", scene_, "--set", "speed"}).exit_code, 2);
}

TEST_F(Figures, WrongScenesAndPlacesGetNoFile) {
  const std::string wrong = write_scene(folder_ / "wrong.json", R"({"catena": 1, "bodies": {"a": {"mas": 1}}})");
  for (const char* command : {"draw", "plot", "view"}) {
    const ProgramResult result = run_catena({command, wrong});
    EXPECT_EQ(result.exit_code, has_viewer() || command != std::string("view") ? 3 : 2) << command << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(run_catena({command, folder_ / "none.json"}).out, "");
  }
  EXPECT_EQ(run_catena({"draw", scene_, "--svg", "/nowhere/a.svg"}).exit_code, 4);
}

TEST_F(Figures, ViewWritesAPageAndSaysWhere) {
  if (!has_viewer()) GTEST_SKIP() << "built without the viewer";
  const ProgramResult viewed = run_catena({"view", scene_, "-o", folder_ / "page.html"});
  EXPECT_EQ(viewed.exit_code, 0) << viewed.err;
  EXPECT_NE(viewed.err.find("wrote " + (folder_ / "page.html")), std::string::npos);
  EXPECT_EQ(content_of(folder_ / "page.html").substr(0, 15), "<!doctype html>");
  const ProgramResult run = run_catena({"run", scene_, "-q", "--view", folder_ / "run.html"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "run.html"));
  EXPECT_EQ(run_catena({"view", scene_, "-o", "/nowhere/page.html"}).exit_code, 4);
}

}  // namespace
}  // namespace catena::testing
