#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "commands.hpp"

namespace catena::cli {
namespace {

int explain_command(const std::string& name) {
  const std::vector<std::string> known = explained_names();
  if (name.empty()) {
    std::string text = "catena explain NAME, where NAME is one of\n";
    for (const std::string& entry : known) text += "  " + entry + "\n";
    return print(text);
  }
  if (const std::optional<std::string> text = explain(name)) return print(*text);
  complain(fmt::format("catena: nothing is called {}{} (catena explain lists all names)\n", in_quotes(name),
                       NearMiss(name).consider_all(known).hint()));
  return usage;
}

}  // namespace

void add_explain_command(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("explain", "Print equation, fields, units and an example of an element or analysis");
  const auto name = std::make_shared<std::string>();
  command->add_option("NAME", *name, "revolute, kinematics, ...; without it, all names are listed");
  command->callback([name, &chosen] { chosen = [name] { return explain_command(*name); }; });
}

}  // namespace catena::cli
