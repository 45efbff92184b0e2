// Closed pipes, signals and options: how the program ends.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "cli/program.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

using namespace std::string_literals;

/// Runs `command` in sh, where catena is the program and its own exit code goes to `folder`/code; returns that code.
int code_of(const std::string& command, const TemporaryFolder& folder) {
  const std::string script =
      "catena() { '"s + CATENA_EXECUTABLE + "' \"$@\"; echo $? > '" + (folder / "code") + "'; }\n" + command;
  EXPECT_EQ(std::system(("sh '" + write_scene(folder / "script", script) + "'").c_str()), 0);
  return std::atoi(read_file(folder / "code").c_str());
}

std::string long_run(const TemporaryFolder& folder) {
  return write_scene(folder / "scene.json", crank_scene(R"({"type": "kinematics", "until": 100, "every": 0.001})"));
}

constexpr int ended_by_sigpipe = 128 + SIGPIPE;

TEST(ClosedPipe, EndsTheProgramAsAnyOther) {
  TemporaryFolder folder;
  const std::string scene = long_run(folder), errors = " 2> '" + (folder / "errors") + "'";
  EXPECT_EQ(code_of("catena run '" + scene + "' --json" + errors + " | head -1 > /dev/null", folder), ended_by_sigpipe);
  EXPECT_EQ(read_file(folder / "errors"), "");
  EXPECT_EQ(code_of("catena run '" + scene + "' -v 2>&1 | head -1 > /dev/null", folder), ended_by_sigpipe);
}

TEST(ClosedPipe, FilesAreCompletedBefore) {
  TemporaryFolder folder;
  const std::string scene = long_run(folder), results = folder / "results";
  EXPECT_EQ(code_of("catena run '" + scene + "' --json --output-dir '" + results + "' -q 2> '" + (folder / "errors") +
                        "' | head -1 > /dev/null",
                    folder),
            ended_by_sigpipe);
  EXPECT_EQ(read_file(folder / "errors"), "");
  EXPECT_NE(read_file(results + "/report.json").find("\"status\": \"ok\""), std::string::npos);
}

TEST(ClosedPipe, NothingIsThrownWhereErrorsCannotBePrinted) {
  TemporaryFolder folder;
  const std::string wrong = write_scene(folder / "wrong.json", "{\"catena\": 2}");
  EXPECT_EQ(code_of("catena run '" + wrong + "' 2>&-", folder), 3);
  EXPECT_EQ(code_of("catena run '" + wrong + "' > /dev/full 2>&1", folder), 3);
  EXPECT_EQ(code_of("catena run nowhere.json 2> /dev/full", folder), 4);
  EXPECT_EQ(code_of("catena rnu 2> /dev/full", folder), 2);
  EXPECT_EQ(code_of("catena run x.json --untl 2 2>&-", folder), 2);
}

/// How many seconds after a signal the program is gone.
double seconds_to_end(const std::vector<std::string>& arguments, int signal, int after_ms, ProgramResult& result) {
  std::chrono::steady_clock::time_point sent;
  ProgramOptions options;
  options.during = [&](int process) {
    wait_for_handler(process, signal);
    std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
    ::kill(process, signal);
    sent = std::chrono::steady_clock::now();
  };
  result = run_catena(arguments, options);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - sent).count();
}

TEST(Signals, EndEveryAnalysisSoon) {
  TemporaryFolder folder;
  const std::string until = "1e5", scene = write_scene(folder / "scene.json", R"({"catena": 1,
    "gravity": [0, -9.81], "bodies": {"a": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}},
      "b": {"mass": 1, "rod": {"from": [1, 0], "to": [2, 0.1]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"}, {"type": "revolute", "i": "a.to", "j": "b.from"}]})");
  for (const int signal : {SIGTERM, SIGINT}) {
    ProgramResult result;
    EXPECT_LT(seconds_to_end({"dynamics", scene, "--until", until, "--every", "1e5", "--json"}, signal, 300, result),
              5);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.out.find("\"cancelled\""), std::string::npos) << result.out;
  }
  const std::string driven = write_scene(folder / "driven.json", crank_scene(R"({"type": "kinematics", "until": 1})"));
  ProgramResult result;
  EXPECT_LT(seconds_to_end({"kinematics", driven, "--until", "1e9", "--every", "1e9", "-q"}, SIGTERM, 300, result), 5);
  EXPECT_EQ(result.exit_code, 1) << result.err;
}

TEST(Options, OutputsOfARunReplaceThoseOfTheScene) {
  TemporaryFolder folder;
  const std::string scene =
      write_scene(folder / "scene.json",
                  crank_scene(R"({"type": "kinematics", "until": 1, "every": 0.5, "outputs": ["crank.x"]})"));
  const ProgramResult result = run_catena({"run", scene, "--json", "--outputs", "crank.omega,crank.tip.y"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find(R"("columns": ["t", "crank.omega", "crank.tip.y"])"), std::string::npos) << result.out;
  const ProgramResult wrong = run_catena({"run", scene, "--outputs", "crank.omeg"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.err.find("catena: --outputs: unknown column \"crank.omeg\""), 0u) << wrong.err;
}

TEST(Options, ErrorsNameTheOneThatIsWrong) {
  TemporaryFolder folder;
  const std::string scene = write_scene(folder / "scene.json", crank_scene(""));
  const auto says = [&](std::vector<std::string> arguments, const std::string& option) {
    arguments.insert(arguments.begin() + 1, scene);
    const ProgramResult result = run_catena(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.err.find("catena: " + option + ":"), 0u) << result.err;
  };
  says({"kinematics", "--until", "2", "--every", "-1", "--outputs", "crank.x"}, "--every");
  says({"kinematics", "--until", "two", "--every", "1"}, "--until");
  says({"kinematics", "--until", "1", "--free", "never"}, "--free");
  says({"kinematics", "--until", "1", "--outputs", "crank.z"}, "--outputs");
  says({"dynamics", "--until", "1", "--max-steps", "0"}, "--max-steps");
  says({"dynamics", "--method", "euler", "--until", "1"}, "--method");
  says({"modes", "--count", "1.5"}, "--count");
  says({"kinematics", "--until", "1", "--set", "speeed=3"}, "--set");
  says({"path", "--to", "1"}, "path");
  says({"path", "--to", "1", "--parameter", "sped"}, "--parameter");
}

TEST(Reports, SayWithWhatTheyWereMade) {
  TemporaryFolder folder;
  const std::string scene = write_scene(
      folder / "scene.json",
      crank_scene(R"({"type": "kinematics", "until": 1, "every": 0.5, "set": {"speed": "=3+1"}}, {"type": "check"})"));
  const ProgramResult json = run_catena({"run", scene, "--json", "--set", "speed=5 rad/s"});
  const auto has = [](const ProgramResult& result, const std::string& text) {
    EXPECT_NE(result.out.find(text), std::string::npos) << text << " in\n" << result.out;
  };
  has(json, "\"version\": \"" CATENA_VERSION "\"");
  has(json, R"("parameters": {"speed": 5})");
  has(json, R"("set": {"speed": "5 rad/s"})");
  has(json, R"("set": {"speed": 4})");
  const ProgramResult text = run_catena({"run", scene, "--set", "speed=5"});
  has(text, "(catena " CATENA_VERSION ")");
  has(text, "parameters: speed = 5\n");
  has(text, "set: speed = 4\n");
}

TEST(Reports, ShowNewtonsIterationsIfAsked) {
  TemporaryFolder folder;
  const std::string scene = write_scene(folder / "scene.json", R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"a": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0.1]}}, "b": {"mass": 1, "rod": {"from": [1, 0], "to": [2, 0.2]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"}, {"type": "revolute", "i": "a.to", "j": "b.from"}],
    "analyses": [{"type": "assemble"}, {"type": "equilibrium"}]})");
  const ProgramResult quiet = run_catena({"run", scene}), told = run_catena({"run", scene, "-v"});
  EXPECT_EQ(quiet.err, "");
  EXPECT_NE(told.err.find("assembly 1: residual"), std::string::npos) << told.err;
  EXPECT_NE(told.err.find("downhill 2: residual"), std::string::npos) << told.err;
}

}  // namespace
}  // namespace catena::testing
