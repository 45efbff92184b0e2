// Runs a scene from the command line: chooses the sinks of results, and turns the outcome into messages and an exit
// code.
#pragma once

#include <string>

#include "catena/scene/numbers/output_units.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena::cli {

struct RunCommand {
  std::string scene;           ///< path
  std::string directory;       ///< of -o, or empty
  std::string page;            ///< of --view, or empty
  std::string format = "csv";  ///< of the files in it
  OutputUnits::Wishes units;   ///< of --units
  bool json = false, csv = false, stats = false, quiet = false, verbose = false;
  RunOptions options;
};

/// The exit code. Results on the standard output, messages on the standard error.
int execute(const RunCommand& command);

}  // namespace catena::cli
