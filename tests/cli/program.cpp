#include "cli/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "results/temporary_folder.hpp"

namespace catena::testing {

ProgramResult run_catena(const std::vector<std::string>& arguments, const ProgramOptions& options) {
  TemporaryFolder folder;
  const std::string out = options.standard_output.empty() ? folder / "out" : options.standard_output;
  const std::string err = folder / "err";
  std::vector<char*> argv;
  for (const std::string& word : options.launcher) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(const_cast<char*>(CATENA_EXECUTABLE));
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  const pid_t process = ::fork();
  if (process == 0) {
    ::dup2(::open("/dev/null", O_RDONLY), 0);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), 1);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), 2);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  if (options.during) options.during(process);
  int state = 0;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (::waitpid(process, &state, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > deadline) ::kill(process, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ProgramResult result;
  result.exit_code = WIFSIGNALED(state) ? -WTERMSIG(state) : WEXITSTATUS(state);
  if (options.standard_output.empty()) result.out = read_file(out);
  result.err = read_file(err);
  return result;
}

void wait_for_handler(int process, int signal) {
  const std::string path = "/proc/" + std::to_string(process) + "/status", word = "SigCgt:";
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::chrono::steady_clock::now() < deadline) {
    std::ifstream status(path);
    std::string line;
    while (std::getline(status, line) && !line.starts_with(word)) {
    }
    if (!line.starts_with(word)) return;
    const unsigned long long caught = std::stoull(line.substr(word.size()), nullptr, 16);
    if (caught >> (signal - 1) & 1) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

std::string write_scene(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string crank_scene(const std::string& analysis) {
  return R"({
  "catena": 1,
  "name": "one crank",
  "parameters": {"speed": 2},
  "bodies": {"crank": {"points": {"tip": [0.5, 0]}}},
  "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "crank"}],
  "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank",
               "value": {"polynomial": [0, "speed"]}}],
  "outputs": ["crank.tip.x", "crank.tip.y", "crank.angle"],
  "analyses": [)" +
         analysis + "]\n}\n";
}

}  // namespace catena::testing
