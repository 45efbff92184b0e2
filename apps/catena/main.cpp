// catena: planar multibody systems from the command line. See `catena --help`, and SCENE files in data/scenes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>

#include "catena/results/text_output.hpp"
#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "commands.hpp"

namespace catena::cli {

int print(const std::string& text) {
  TextOutput output = TextOutput::standard_output();
  output.write(text);
  if (output.flush()) return solved;
  if (!output.reader_gone()) complain(fmt::format("catena: {}\n", output.error()));
  return no_file;
}

int write_file(const std::string& path, std::string_view content, bool quiet) {
  TextOutput output = TextOutput::file(path);
  output.write(content);
  if (!output.commit()) {
    complain(fmt::format("catena: {}\n", output.error()));
    return no_file;
  }
  const auto bytes = static_cast<double>(content.size());
  if (!quiet)
    complain(fmt::format("wrote {} ({:.3g} {})\n", path, bytes < 1e6 ? bytes / 1e3 : bytes / 1e6,
                         bytes < 1e6 ? "kB" : "MB"));
  return solved;
}

void complain(std::string_view message) { std::fwrite(message.data(), 1, message.size(), stderr); }

namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// The first word is no command: suggests the nearest one.
int unknown_command(const CLI::App& app, const std::string& word) {
  std::string hint = NearMiss(word).consider_all(command_names(app)).hint();
  std::error_code ignored;
  if (hint.empty() && std::filesystem::exists(word, ignored)) hint = "; did you mean \"catena run " + word + "\"?";
  complain(fmt::format("catena: unknown command {}{} (catena --help lists them)\n", in_quotes(word), hint));
  return usage;
}

/// Reports arguments that no option accepted; false if there are none. After an unknown option plain words may be its
/// values, so they are not mentioned.
bool report_unexpected(const CLI::App& app) {
  std::vector<std::string> options, words;
  for (const std::string& argument : app.remaining(true))
    (argument.starts_with('-') ? options : words).push_back(argument);
  if (options.empty() && words.empty()) return false;

  const CLI::App* command = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
  const std::string name = command == &app ? "catena" : "catena " + command->get_name();
  if (options.empty()) {
    complain(fmt::format("catena: unexpected argument {} ({} --help lists what it takes)\n", in_quotes(words.front()),
                         name));
    return true;
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& long_name : option->get_lnames()) known.push_back("--" + long_name);
  }
  for (const std::string& option : options) {
    const std::string word = option.substr(0, option.find('='));
    complain(fmt::format("catena: unknown option {}{} ({} --help lists what it takes)\n", in_quotes(word),
                         NearMiss(word).consider_all(known).hint(), name));
  }
  return true;
}

int run(int argc, char** argv) {
  CLI::App app("Analyses planar multibody systems: kinematics, dynamics, equilibrium", "catena");
  app.set_version_flag("--version", "catena " CATENA_VERSION);
  app.require_subcommand(1);
  Action chosen;
  add_run_commands(app, chosen);
  add_explain_command(app, chosen);
  add_schema_command(app, chosen);
  add_draw_command(app, chosen);
  add_plot_command(app, chosen);
  add_view_command(app, chosen);
  add_bench_command(app, chosen);

  const std::string first = argc > 1 ? argv[1] : "-";
  const std::vector<std::string> known = command_names(app);
  if (!first.starts_with('-') && std::find(known.begin(), known.end(), first) == known.end())
    return unknown_command(app, first);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for) {  // --help, --version
    return app.exit(asked_for);
  } catch (const CLI::ParseError& error) {
    // Unknown arguments are reported rather than missing ones that follow from them.
    if (argc == 1) {
      complain(app.help());
    } else if (!report_unexpected(app)) {
      complain(fmt::format("catena: {} (catena --help lists what there is)\n", error.what()));
    }
    return usage;
  }
  return chosen();
}

}  // namespace
}  // namespace catena::cli

int main(int argc, char** argv) {
  // The parent process may have had SIGPIPE ignored; output to a closed pipe would then never end.
  std::signal(SIGPIPE, SIG_DFL);
  try {
    return catena::cli::run(argc, argv);
  } catch (const std::bad_alloc&) {
    catena::cli::complain("catena: not enough memory\n");
  } catch (const std::exception& error) {
    catena::cli::complain("catena: ");
    catena::cli::complain(error.what());
    catena::cli::complain("\n");
  }
  return catena::cli::not_solved;
}
