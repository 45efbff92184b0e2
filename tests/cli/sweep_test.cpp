// Sweeps that are interrupted and go on from their record, and sweeps that several processes share.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "cli/program.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

/// A slider-crank that locks where its rod is shorter than its crank: 6 of 60 designs.
std::string slider(const TemporaryFolder& folder, const std::string& every = "0.003") {
  return write_scene(folder / "slider.json", R"({"catena": 1, "parameters": {"a": 0.1, "b": 0.3},
  "bodies": {"crank": {"rod": {"from": [0,0], "to": ["a", 0]}}, "rod": {"rod": {"from": ["a", 0], "to": ["=a+b", 0]}},
             "slide": {"position": ["=a+b", 0]}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"}, {"type": "revolute", "i": "crank.to", "j": "rod.from"},
    {"type": "revolute", "i": "rod.to", "j": "slide"},
    {"type": "translational", "i": "ground", "j": "slide", "axis_i": [1, 0]}],
  "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0.1, 1]}}],
  "outputs": ["slide.x"], "analyses": [{"type": "sweep", "over": {"a": {"from": 0.05, "to": 0.2, "count": 5},
    "b": {"from": 0.12, "to": 0.43, "count": 12}}, "of": {"type": "kinematics", "until": 7, "every": )" +
                                                 every + R"(,
    "measures": {"stroke": {"range": "slide.x"}, "mean": {"mean": "slide.x"}}}}]})");
}

using Words = std::vector<std::string>;

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::size_t lines_of(const std::string& path) {
  std::ifstream file(path);
  std::size_t lines = 0;
  for (std::string line; std::getline(file, line);) ++lines;
  return lines;
}

/// Waits until the record has so many lines.
void wait_for_lines(const std::string& record, std::size_t lines) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (lines_of(record) < lines && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// Its list of failures.
std::string failures_of(const std::string& report) {
  const std::size_t begin = report.find("\"failures\": ");
  return begin == std::string::npos ? "none" : report.substr(begin, report.find(']', begin) - begin);
}

TEST(Sweep, HasNoOtherColumnsThanItsOwn) {
  TemporaryFolder folder;
  const std::string scene = slider(folder, "0.5");
  const ProgramResult other = run_catena({"run", scene, "--outputs", "slide.x"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err.find("catena: --outputs: sweep gives no column \"slide.x\""), 0u) << other.err;
  const ProgramResult own = run_catena({"run", scene, "--outputs", "a,stroke", "--csv"});
  EXPECT_EQ(own.exit_code, 0) << own.err;
  EXPECT_EQ(own.out.find("design,a,b,stroke,mean,status"), 0u) << own.out;
}

TEST(Sweep, MeasuresAreInTheUnitsAskedFor) {
  TemporaryFolder folder;
  const std::string scene = slider(folder, "0.5");
  const ProgramResult metres = run_catena({"sweep", scene, "--csv"});
  const ProgramResult result = run_catena({"sweep", scene, "--units", "length=mm", "-o", folder / "mm"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(read_file(folder / "mm/report.json").find(R"("units": ["1", "", "", "mm", "mm", "1"])"), std::string::npos);
  std::istringstream si(metres.out), converted(read_file(folder / "mm/sweep.csv"));
  int rows = 0;
  for (std::string a, b; std::getline(si, a) && std::getline(converted, b); ++rows) {
    double numbers[2][5] = {};
    const auto read = [](const std::string& line, double* out) {
      return std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", out, out + 1, out + 2, out + 3, out + 4);
    };
    if (read(a, numbers[0]) != 5) continue;
    ASSERT_EQ(read(b, numbers[1]), 5) << b;
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(numbers[1][k], (k > 2 ? 1000 : 1) * numbers[0][k], 1e-11) << a;
  }
  EXPECT_EQ(rows, 61);
}

class SweptAgain : public ::testing::TestWithParam<int> {};

TEST_P(SweptAgain, GoesOnFromItsRecord) {
  TemporaryFolder folder;
  const std::string scene = slider(folder), record = folder / "record";
  const ProgramResult whole = run_catena({"sweep", scene, "-o", folder / "whole"});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const ProgramResult stopped = run_catena({"sweep", scene, "--record", record, "-j", "2", "-o", folder / "stopped"},
                                           {.standard_output = {}, .during = [&](int process) {
                                              wait_for_lines(record, 12);
                                              ::kill(process, GetParam());
                                            }});
  ASSERT_NE(stopped.exit_code, 0) << "it was too quick";
  if (GetParam() != SIGKILL) {
    EXPECT_EQ(stopped.exit_code, 1);
    EXPECT_NE(stopped.err.find("--resume goes on"), std::string::npos) << stopped.err;
    EXPECT_NE(stopped.err.find("Designs without rows: "), std::string::npos) << stopped.err;
  }
  const std::size_t before = lines_of(record);
  ASSERT_LT(before, 61u);
  std::ofstream(record, std::ios::app) << "[1, 7, \"o";  // a line that was torn
  const ProgramResult rest = run_catena({"sweep", scene, "--record", record, "--resume", "-o", folder / "rest"});
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(read_file(folder / "rest/sweep.csv"), read_file(folder / "whole/sweep.csv"));
  const std::string failures = failures_of(read_file(folder / "whole/report.json"));
  EXPECT_EQ(failures_of(read_file(folder / "rest/report.json")), failures);
  EXPECT_NE(failures.find("{\"design\": 25, \"a\": 0.125, \"b\": 0.12, \"status\": "), std::string::npos) << failures;
  // Every design once.
  EXPECT_EQ(lines_of(record), 61u);
  EXPECT_EQ(read_file(record).find("cancelled"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Signals, SweptAgain, ::testing::Values(SIGKILL, SIGINT, SIGTERM));

TEST(SweepRecord, IsRefusedWhereItDoesNotBelong) {
  TemporaryFolder folder;
  const std::string scene = slider(folder, "0.5"), record = folder / "record";
  const Words sweep = {"sweep", scene, "--csv", "--record", record};
  const auto refused = [&](const Words& words, int code, const std::string& why) {
    const ProgramResult result = run_catena(words);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
  };
  refused(sweep + Words{"--resume"}, 4, "record\" cannot be resumed: No such file");
  refused({"sweep", scene, "--record", folder / "none/x"}, 4, "cannot be written: No such file");
  ASSERT_EQ(run_catena(sweep).exit_code, 0);
  refused(sweep, 4, "exists already");
  refused(sweep + Words{"--resume", "--set", "a=0.2"}, 4, "belongs to another scene (\"slider\")");
  refused({"sweep", scene, "--resume"}, 2, "--record");
  const std::string text = read_file(record);
  std::ofstream(record) << text.substr(0, text.find('\n')) << "\n[1, 1, \"ok\", 0.1, x]\n[1, 2, \"ok\", 0.1, 0.2]\n";
  refused(sweep + Words{"--resume"}, 4, "is damaged in line 2");
  std::ofstream(record) << "{}\n";
  refused(sweep + Words{"--resume"}, 4, "is no record of a sweep");
  const std::string crank = write_scene(folder / "crank.json", crank_scene(R"({"type": "kinematics", "at": [0]})"));
  refused({"run", crank, "--record", folder / "other"}, 2, "--record: the scene has no sweep");
}

#ifdef CATENA_MPIRUN

Words mpirun(int processes, const Words& more = {}) {
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  ::setenv("OMPI_MCA_btl_base_warn_component_unused", "0", 1);
  return Words{CATENA_MPIRUN, "--oversubscribe", "-n", std::to_string(processes)} + more;
}

/// Kills the process of this rank that mpirun started.
void kill_rank(int launcher, int rank) {
  std::ifstream children("/proc/" + std::to_string(launcher) + "/task/" + std::to_string(launcher) + "/children");
  for (int process = 0; children >> process;) {
    std::ifstream environment("/proc/" + std::to_string(process) + "/environ");
    for (std::string entry; std::getline(environment, entry, '\0');) {
      if (entry == "OMPI_COMM_WORLD_RANK=" + std::to_string(rank)) ::kill(process, SIGKILL);
    }
  }
}

TEST(SharedSweep, GivesTheSameRowsForAnyNumberOfProcesses) {
  TemporaryFolder folder;
  const std::string scene = slider(folder, "0.05");
  const ProgramResult alone = run_catena({"sweep", scene, "--csv"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  for (int processes = 1; processes <= 3; ++processes) {
    SCOPED_TRACE(processes);
    const ProgramResult shared = run_catena({"sweep", scene, "--csv", "-j", processes == 2 ? "2" : "1"},
                                            {.standard_output = {}, .during = {}, .launcher = mpirun(processes)});
    EXPECT_EQ(shared.exit_code, 0) << shared.err;
    EXPECT_EQ(shared.out, alone.out) << shared.err;
  }
  const ProgramResult wrong =
      run_catena({"sweep", scene, "--set", "c=1"}, {.standard_output = {}, .during = {}, .launcher = mpirun(2)});
  EXPECT_EQ(wrong.exit_code, 2) << wrong.err;
  const std::size_t first = wrong.err.find("unknown parameter");
  EXPECT_NE(first, std::string::npos) << wrong.err;
  EXPECT_EQ(wrong.err.find("unknown parameter", first + 1), std::string::npos) << "once is enough\n" << wrong.err;
}

/// Kills process 1 of a job when its record has a dozen lines.
std::function<void(int)> kill_one_of(const std::string& record) {
  return [record](int launcher) {
    wait_for_lines(record, 12);
    kill_rank(launcher, 1);
  };
}

TEST(SharedSweep, AKilledProcessEndsTheJobAndItsRecordGoesOn) {
  TemporaryFolder folder;
  const std::string scene = slider(folder, "0.001"), record = folder / "record";
  const ProgramResult whole = run_catena({"sweep", scene, "--csv", "-j", "2"});
  const ProgramResult killed =
      run_catena({"sweep", scene, "--csv", "--record", record},
                 {.standard_output = {}, .during = kill_one_of(record), .launcher = mpirun(3)});
  EXPECT_NE(killed.exit_code, 0);
  ASSERT_LT(lines_of(record), 61u) << "it was too quick";
  // What was given is a part of the whole. (mpirun may end the leader before it has named what was not.)
  EXPECT_TRUE(whole.out.starts_with(killed.out)) << killed.out;
  const ProgramResult rest = run_catena({"sweep", scene, "--csv", "--record", record, "--resume"},
                                        {.standard_output = {}, .during = {}, .launcher = mpirun(2)});
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(rest.out, whole.out);
}

TEST(SharedSweep, OthersDoWhatAKilledProcessHad) {
  TemporaryFolder folder;
  const std::string scene = slider(folder, "0.001"), record = folder / "record";
  const ProgramResult whole = run_catena({"sweep", scene, "--csv", "-j", "2"});
  const ProgramResult shared =
      run_catena({"sweep", scene, "-o", folder / "shared", "--record", record, "--patience", "2"},
                 {.standard_output = {}, .during = kill_one_of(record), .launcher = mpirun(3, {"--enable-recovery"})});
  EXPECT_EQ(shared.exit_code, 0) << shared.err;
  EXPECT_EQ(read_file(folder / "shared/sweep.csv"), whole.out);
  EXPECT_NE(shared.out.find("process 1 was lost"), std::string::npos) << shared.out << shared.err;
}

#endif

}  // namespace
}  // namespace catena::testing
