// What every command that runs a scene takes: the scene, --set, --max-elements; and --units of those that show numbers.
#pragma once

#include <string>
#include <vector>

#include "catena/scene/numbers/output_units.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace CLI {
class App;
}

namespace catena::cli {

struct SceneArguments {
  std::string scene;  ///< path
  std::vector<std::string> set;
  std::int64_t max_elements = RunOptions{}.max_elements;

  /// As the runner wants them. Throws CLI::ValidationError for a --set that assigns nothing.
  RunOptions options() const;
};

/// `arguments` must live until the command line was read.
void add_scene_arguments(CLI::App& command, SceneArguments& arguments);

/// --units of a command, as texts. `what`: whose units they are; `texts` must live until the command line was read.
void add_units(CLI::App& command, std::vector<std::string>& texts, const std::string& what);
/// Units that the command line asks for, as {"angle=deg", "length=mm"}. Throws CLI::ValidationError that says what is
/// wrong with them.
OutputUnits::Wishes read_units(const std::vector<std::string>& texts);

/// The entries of a list that may be written as in a scene: [0.1, 0.2] for 0.1,0.2.
std::vector<std::string> without_brackets(std::vector<std::string> values);

/// What is wrong with the text of a count; empty if nothing is.
std::string whole_number(const std::string& text);

}  // namespace catena::cli
