// Runs the catena program as a user does, and keeps what it printed.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace catena::testing {

struct ProgramResult {
  int exit_code = -1;  ///< -n if signal n ended it
  std::string out, err;
};

struct ProgramOptions {
  std::string standard_output;              ///< a file that takes the standard output instead of keeping it
  std::function<void(int process)> during;  ///< called while it runs
  std::vector<std::string> launcher{};      ///< words before the program: mpirun -n 3
};

/// Runs `catena arguments...` and waits for it; after 60 s it is killed.
ProgramResult run_catena(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

/// Waits until a process handles a signal, at most 30 s: a program that is slow to start is not signalled before.
void wait_for_handler(int process, int signal);

/// Writes a scene into `path` and returns the path.
std::string write_scene(const std::string& path, const std::string& text);

/// A crank turned by 2 rad/s with the rows asked for: the smallest driven mechanism.
std::string crank_scene(const std::string& analysis);

}  // namespace catena::testing
