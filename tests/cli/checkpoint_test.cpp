// A run that is killed or interrupted on the way and taken up from its checkpoint ends like one that was left alone.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "cli/program.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n");
  return text.substr(text.rfind('\n', end) + 1);
}

class Interrupted : public ::testing::TestWithParam<int> {};

TEST_P(Interrupted, EndsAsIfNothingHadHappened) {
  TemporaryFolder folder;
  const std::string file = folder / "saved";
  const std::string scene = write_scene(folder / "pendulum.json", R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"a": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1},
               "b": {"rod": {"from": [1, 0], "to": [2, 0]}, "mass": 1}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"},
                    {"type": "revolute", "i": "a.to", "j": "b.from"}],
    "analyses": [{"type": "dynamics", "until": 300, "every": 0.5, "tolerance": 1e-12}],
    "outputs": ["a.angle", "b.omega"]})");
  const std::vector<std::string> run = {"run", scene, "--checkpoint", file, "--checkpoint-every", "5", "-o"};
  const auto with = [](std::vector<std::string> words, const std::string& word) {
    words.push_back(word);
    return words;
  };
  const ProgramResult whole = run_catena(with(run, folder / "whole"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  ASSERT_TRUE(std::filesystem::remove(file));
  const ProgramResult killed =
      run_catena(with(run, folder / "killed"),
                 {.standard_output = {}, .during = [&](int process) {
                    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
                    while (!std::filesystem::exists(file) && std::chrono::steady_clock::now() < until)
                      std::this_thread::sleep_for(std::chrono::milliseconds(1));
                    ::kill(process, GetParam());
                  }});
  ASSERT_NE(killed.exit_code, 0) << "it was too quick";
  ASSERT_TRUE(std::filesystem::exists(file));
  const ProgramResult rest = run_catena({"run", scene, "--restart", file, "-o", folder / "rest"});
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  const std::string end = last_line(read_file(folder / "rest/dynamics.csv"));
  EXPECT_TRUE(end.starts_with("300,")) << end;
  EXPECT_EQ(end, last_line(read_file(folder / "whole/dynamics.csv")));
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupted, ::testing::Values(SIGKILL, SIGINT));

}  // namespace
}  // namespace catena::testing
