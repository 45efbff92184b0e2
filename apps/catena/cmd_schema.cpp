#include <CLI/CLI.hpp>

#include "catena/scene/running/scene_runner.hpp"
#include "commands.hpp"

namespace catena::cli {

void add_schema_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("schema", "Print the JSON Schema of scenes");
  command->callback([&chosen] { chosen = [] { return print(schema_json()); }; });
}

}  // namespace catena::cli
