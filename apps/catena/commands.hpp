// The commands of the program; each adds itself to the command line and leaves its exit code when it was chosen.
//
// Exit codes: 0 all solved, 1 an analysis was not, 2 usage, 3 anything wrong in the scene's text, 4 missing file or
// unwritable output. A reader that goes away ends the program by SIGPIPE, as it ends any other.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace catena::cli {

enum ExitCode : int { solved = 0, not_solved = 1, usage = 2, wrong_scene = 3, no_file = 4 };

/// The action after the command line has been read; returns the exit code.
using Action = std::function<int()>;

void add_run_commands(CLI::App& app, Action& chosen);  ///< run, and the verbs that run one analysis
void add_explain_command(CLI::App& app, Action& chosen);
void add_schema_command(CLI::App& app, Action& chosen);
void add_draw_command(CLI::App& app, Action& chosen);
void add_plot_command(CLI::App& app, Action& chosen);
void add_view_command(CLI::App& app, Action& chosen);
void add_bench_command(CLI::App& app, Action& chosen);

/// Prints text to the standard output; returns the exit code.
int print(const std::string& text);
/// Writes a whole file, and says where and how much unless it is to be quiet; the exit code.
int write_file(const std::string& path, std::string_view content, bool quiet = false);
/// Prints a message to the standard error. A failure to write there is ignored.
void complain(std::string_view message);

}  // namespace catena::cli
