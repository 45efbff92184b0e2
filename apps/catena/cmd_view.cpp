// catena view: a page with the moving mechanism and its plots, one file that opens from disk.
#include <fmt/format.h>
#include <spawn.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "recorded_run.hpp"
#include "view_page.hpp"

extern char** environ;

namespace catena::cli {
namespace {

struct ViewCommand {
  SceneArguments scene;
  std::vector<std::string> units;
  std::string page;
  bool open = false;
};

/// Hands the page to the program that the desktop opens such files with.
int open_page(const std::string& path) {
  std::string program = "xdg-open", file = std::filesystem::absolute(path).string();
  char* arguments[] = {program.data(), file.data(), nullptr};
  pid_t process = 0;
  if (const int error = ::posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments, environ); error != 0) {
    complain(
        fmt::format("catena: --open: cannot run xdg-open: {}; open {} in a browser\n", std::strerror(error), file));
    return no_file;
  }
  return solved;
}

int view(const ViewCommand& command) {
  if (const std::string obstacle = viewer_obstacle(); !obstacle.empty()) {
    complain(obstacle);
    return usage;
  }
  RecordedRun run;
  run_recorded(command.scene, {}, run.recorder, run);
  if (!run.usable()) return run.outcome.exit_code;
  const std::string path =
      command.page.empty() ? std::filesystem::path(command.scene.scene).stem().string() + ".html" : command.page;
  if (const int written = write_page(path, run.recorder.record(), read_units(command.units)); written != solved)
    return written;
  if (command.open) {
    if (const int opened = open_page(path); opened != solved) return opened;
  }
  return run.outcome.exit_code;
}

}  // namespace

void add_view_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("view", "Write a page with the moving mechanism and its plots");
  const auto parsed = std::make_shared<ViewCommand>();
  add_scene_arguments(*command, parsed->scene);
  add_units(*command, parsed->units, "plots, tables and values on the page");
  command
      ->add_option("-o,--page", parsed->page,
                   "the page to write: the scene's name with .html, in the present folder, unless given")
      ->type_name("FILE");
  command->add_flag("--open", parsed->open, "show it in the browser");
  command->callback([parsed, &chosen] {
    static_cast<void>(parsed->scene.options());  // what is wrong with --set and --units is told before anything runs
    static_cast<void>(read_units(parsed->units));
    chosen = [parsed] { return view(*parsed); };
  });
}

}  // namespace catena::cli
