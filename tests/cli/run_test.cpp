// What `catena run` and the single verbs print, write and return.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/program.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

const std::string one_second = R"({"type": "kinematics", "until": 1, "every": 0.25})";

class Run : public ::testing::Test {
 protected:
  std::string scene(const std::string& analysis = one_second) {
    return write_scene(folder_ / "crank.json", crank_scene(analysis));
  }
  TemporaryFolder folder_;
};

TEST_F(Run, PrintsATable) {
  const ProgramResult result = run_catena({"run", scene()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("one crank: 1 body"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("kinematics: ok, 5 rows\n"
                            "     t  crank.tip.x  crank.tip.y  crank.angle\n"
                            "     s            m            m          rad\n"
                            "  0.00     0.500000     0.000000          0.0\n"
                            "  0.25     0.438791     0.239713          0.5\n"
                            "  0.50     0.270151     0.420735          1.0\n"),
            std::string::npos)
      << result.out;
}

TEST_F(Run, PrintsJsonWithEveryDigit) {
  const ProgramResult result = run_catena({"run", scene(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json document = json::parse(result.out);
  EXPECT_EQ(document["catena"], 1);
  EXPECT_EQ(document["scene"], "one crank");
  const json& analysis = document["analyses"].at(0);
  EXPECT_EQ(analysis["type"], "kinematics");
  EXPECT_EQ(analysis["status"], "ok");
  EXPECT_EQ(analysis["dof"], 0);
  EXPECT_EQ(analysis["mobility"], 1);
  EXPECT_EQ(analysis["columns"], json({"t", "crank.tip.x", "crank.tip.y", "crank.angle"}));
  EXPECT_EQ(analysis["units"], json({"s", "m", "m", "rad"}));
  ASSERT_EQ(analysis["rows"].size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    const json& row = analysis["rows"][k];
    const double t = 0.25 * static_cast<double>(k);
    EXPECT_EQ(row[0].get<double>(), t);
    EXPECT_NEAR(row[1].get<double>(), 0.5 * std::cos(2 * t), 1e-15);
    EXPECT_NEAR(row[3].get<double>(), 2 * t, 1e-15);
  }
  EXPECT_EQ(analysis["counters"]["gammas"], 0);
}

TEST_F(Run, WritesOneCsvAnAnalysisAndTheReport) {
  const std::string target = folder_ / "results";
  const ProgramResult result = run_catena(
      {"run", scene(R"({"type": "check"},)" + one_second + R"(, {"type": "kinematics", "at": 2})"), "-o", target});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("wrote " + target + "/kinematics-2.csv"), std::string::npos) << result.err;
  const std::string csv = read_file(target + "/kinematics.csv");
  EXPECT_TRUE(csv.starts_with("t,crank.tip.x,crank.tip.y,crank.angle\r\n0,0.5,0,0\r\n")) << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  const json report = json::parse(read_file(target + "/report.json"));
  EXPECT_EQ(report["analyses"].size(), 3u);
  EXPECT_EQ(report["analyses"][0]["type"], "check");
  EXPECT_EQ(report["analyses"][1]["units"], json({"s", "m", "m", "rad"}));
  EXPECT_FALSE(report["analyses"][1].contains("rows"));
  EXPECT_FALSE(std::filesystem::exists(target + "/check.csv"));
}

TEST_F(Run, WritesRowsInTheFormatAndUnitsAskedFor) {
  const std::string target = folder_ / "results", path = scene(one_second);
  const json rows = json::parse(run_catena({"run", path, "--json"}).out)["analyses"][0]["rows"];
  EXPECT_EQ(run_catena({"run", path, "-o", target, "--format", "json", "-q"}).exit_code, 0);
  const json file = json::parse(read_file(target + "/kinematics.json"));
  EXPECT_EQ(file["rows"], rows);
  EXPECT_EQ(file["columns"][3], "crank.angle");
  EXPECT_EQ(run_catena({"run", path, "-o", target, "--format", "npz", "-q"}).exit_code, 0);
  EXPECT_TRUE(read_file(target + "/kinematics.npz").starts_with("PK"));

  const ProgramResult csv = run_catena({"run", path, "--csv", "--units", "length=mm"});
  EXPECT_TRUE(csv.out.starts_with("t,crank.tip.x,crank.tip.y,crank.angle\r\n0,500,0,0\r\n")) << csv.out;
  // Rows alone have no place for warnings.
  const ProgramResult noted = run_catena({"run", path, "--csv", "--outputs", "crank.angle,A.fx"});
  EXPECT_NE(noted.err.find("kinematics: warning: left out A.fx"), std::string::npos) << noted.err;
  EXPECT_EQ(run_catena({"run", path, "--csv", "-q", "--outputs", "crank.angle,A.fx"}).err, "");
  const ProgramResult table = run_catena({"run", path, "--units", "length=mm,angle=deg"});
  EXPECT_NE(table.out.find("deg"), std::string::npos) << table.out;

  // What machines read is in SI unless the command asks, and tells its units.
  const json shown = json::parse(run_catena({"run", path, "--json", "--units", "length=mm"}).out)["analyses"][0];
  EXPECT_EQ(shown["units"], json({"s", "mm", "mm", "rad"}));
  for (std::size_t k = 0; k < rows.size(); ++k)
    EXPECT_NEAR(shown["rows"][k][1].get<double>(), 1000 * rows[k][1].get<double>(), 1e-12);

  // Report and files of one folder speak the same units.
  EXPECT_EQ(run_catena({"run", path, "-o", target, "--format", "csv", "-q", "--units", "length=mm"}).exit_code, 0);
  const json units = json::parse(read_file(target + "/report.json"))["analyses"][0]["units"];
  EXPECT_EQ(units, json({"s", "mm", "mm", "rad"}));
  EXPECT_NE(read_file(target + "/kinematics.csv").find("\n0,500,0,0\r\n"), std::string::npos)
      << read_file(target + "/kinematics.csv");
  EXPECT_EQ(run_catena({"run", path, "-o", target, "--format", "xls"}).exit_code, 2);
  EXPECT_EQ(run_catena({"run", path, "--format", "npz"}).exit_code, 2);
  EXPECT_EQ(run_catena({"run", path, "--csv", "--json"}).exit_code, 2);
  const ProgramResult wrong = run_catena({"run", path, "--units", "length=deg"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("\"deg\" is not a unit of length"), std::string::npos) << wrong.err;
}

TEST_F(Run, SaysWhatCannotBeWrittenBeforeTheRun) {
  const std::string in_the_way = write_scene(folder_ / "file", "");
  const ProgramResult result = run_catena({"run", scene(), "-o", in_the_way});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find(in_the_way), std::string::npos) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(run_catena({"run", scene(), "-o", in_the_way + "/below"}).exit_code, 4);
}

TEST_F(Run, AFullDiskIsAnError) {
  const ProgramResult result = run_catena({"run", scene(), "--json"}, {.standard_output = "/dev/full", .during = {}});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("No space left"), std::string::npos) << result.err;
}

TEST_F(Run, CountersAreMessagesNotResults) {
  const ProgramResult result = run_catena({"run", scene(), "--stats", "--json"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("factorizations"), std::string::npos) << result.err;
  EXPECT_TRUE(json::accept(result.out));
}

TEST_F(Run, QuietPrintsNothing) {
  const ProgramResult result = run_catena({"run", scene(), "-q"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Run, ParametersCanBeSet) {
  const ProgramResult result = run_catena({"run", scene(), "--json", "--set", "speed=4"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(json::parse(result.out)["analyses"][0]["rows"][4][3].get<double>(), 4, 1e-15);
  EXPECT_EQ(run_catena({"run", scene(), "--set", "sped=4"}).exit_code, 2);
}

TEST_F(Run, AVerbRunsOneAnalysisWithItsKeysAsOptions) {
  ProgramResult result = run_catena({"kinematics", scene(R"({"type": "check"})"), "--json", "--at", "0.5,1.5",
                                     "--outputs", "crank.angle,crank.omega"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json analyses = json::parse(result.out)["analyses"];
  ASSERT_EQ(analyses.size(), 1u);
  EXPECT_EQ(analyses[0]["columns"], json({"t", "crank.angle", "crank.omega"}));
  EXPECT_NEAR(analyses[0]["rows"][1][1].get<double>(), 3, 1e-15);

  // Lists may be written as in a scene.
  result =
      run_catena({"kinematics", scene(), "--json", "--at", "[0.5, 1.5]", "--outputs", "[crank.angle, crank.omega]"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out)["analyses"][0]["rows"], analyses[0]["rows"]);

  result = run_catena({"check", scene()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("mobility 1"), std::string::npos) << result.out;
  EXPECT_EQ(run_catena({"assemble", scene()}).exit_code, 0);
  EXPECT_EQ(run_catena({"kinematics", scene(), "--until", "soon"}).exit_code, 2);
}

TEST_F(Run, AnAnalysisThatFailsIsExitCodeOne) {
  // The tip cannot be 2 m from the pivot.
  std::string text = crank_scene(R"({"type": "assemble"})");
  const std::string driver = R"("type": "absolute_angle", "name": "drive", "i": "crank")";
  text.replace(text.find(driver), driver.size(), R"("type": "absolute_x", "name": "drive", "i": "crank.tip")");
  text.replace(text.find("[0, \"speed\"]"), 12, "[2]");
  const ProgramResult result = run_catena({"run", write_scene(folder_ / "far.json", text), "--json"});
  EXPECT_EQ(result.exit_code, 1);
  const json analysis = json::parse(result.out)["analyses"][0];
  EXPECT_EQ(analysis["status"], "not_assembled");
  EXPECT_NE(analysis["message"], "");
  EXPECT_NE(result.err.find("not_assembled"), std::string::npos) << result.err;
}

TEST_F(Run, CtrlCKeepsTheRowsSoFar) {
  const std::string path = scene(R"({"type": "kinematics", "until": 1e6, "every": 0.001})");
  const std::string target = folder_ / "results";
  const ProgramResult result =
      run_catena({"run", path, "-o", target, "-q"}, {.standard_output = {}, .during = [](int process) {
                                                       wait_for_handler(process, SIGINT);
                                                       std::this_thread::sleep_for(std::chrono::milliseconds(700));
                                                       ::kill(process, SIGINT);
                                                     }});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const json analysis = json::parse(read_file(target + "/report.json"))["analyses"][0];
  EXPECT_EQ(analysis["status"], "cancelled");
  const std::string csv = read_file(target + "/kinematics.csv");
  EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 10);
  EXPECT_TRUE(csv.ends_with("\r\n"));
}

// Rows may be far apart: the signal is noticed between the steps that lead to them.
TEST_F(Run, CtrlCIsNoticedBetweenRows) {
  for (const std::string type : {"kinematics", "dynamics"}) {
    std::string text = crank_scene(R"({"type": ")" + type + R"(", "until": 1e6, "every": 1e6})");
    text.replace(text.find(R"("points")"), 0, R"("mass": 1, "inertia": 1, )");
    const std::string steady = R"({"polynomial": [0, "speed"]})";
    text.replace(text.find(steady), steady.size(), R"({"harmonic": {"amplitude": 100, "omega": "speed"}})");
    const std::string path = write_scene(folder_ / "crank.json", text);
    std::chrono::steady_clock::time_point signalled;
    const ProgramResult result =
        run_catena({"run", path, "--json"}, {.standard_output = {}, .during = [&](int process) {
                                               wait_for_handler(process, SIGINT);
                                               std::this_thread::sleep_for(std::chrono::milliseconds(400));
                                               signalled = std::chrono::steady_clock::now();
                                               ::kill(process, SIGINT);
                                             }});
    EXPECT_LT(std::chrono::steady_clock::now() - signalled, std::chrono::seconds(2)) << type;
    EXPECT_EQ(result.exit_code, 1) << type << result.err;
    const json analysis = json::parse(result.out)["analyses"][0];
    EXPECT_EQ(analysis["status"], "cancelled") << type;
    EXPECT_EQ(analysis["rows"].size(), 1u) << type;
  }
}

// Nothing is lost by ending there, and the reading of a pipe may never end by itself.
TEST_F(Run, CtrlCEndsTheReadingOfAScene) {
  const std::string pipe = folder_ / "scene.json";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::ofstream writer;  // open to the end: a program that goes on reading is killed
  const ProgramResult result = run_catena({"run", pipe}, {.standard_output = {}, .during = [&](int process) {
                                                            writer.open(pipe);  // returns when it is read
                                                            writer << "{" << std::flush;
                                                            ::kill(process, SIGINT);
                                                          }});
  EXPECT_EQ(result.exit_code, -SIGINT) << result.err;
}

TEST_F(Run, AReaderThatGoesAwayEndsTheProgram) {
  const std::string path = scene(R"({"type": "kinematics", "until": 1e6, "every": 0.001})");
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const ProgramResult result = run_catena({"run", path, "--json"}, {.standard_output = pipe, .during = [&](int) {
                                                                      std::ifstream reader(pipe);
                                                                      char some[100];
                                                                      reader.read(some, sizeof some);
                                                                    }});
  EXPECT_EQ(result.exit_code, -SIGPIPE);
  EXPECT_EQ(result.err, "");
}

}  // namespace
}  // namespace catena::testing
