#include "run_command.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <optional>

#include "catena/analysis/design/process_link.hpp"
#include "catena/results/csv_writer.hpp"
#include "catena/results/terminal/interrupt.hpp"
#include "catena/results/terminal/text_sink.hpp"
#include "catena/scene/viewing/run_recorder.hpp"
#include "catena/scene/writing/units_sink.hpp"
#include "commands.hpp"
#include "result_folder.hpp"
#include "run_messages.hpp"
#include "view_page.hpp"

namespace catena::cli {
namespace {

/// Goes before the other sinks. Wipes the progress bar away before results appear on the same terminal, and catches
/// Ctrl-C from the moment there are results to keep: before that, as while a scene is read from a pipe, it ends the
/// program as it ends any other.
class BeforeResults final : public ResultSink, private RowSink {
 public:
  explicit BeforeResults(ProgressBar& bar) : bar_(bar) {}
  void begin_run(const RunHeader&) override {
    catch_interrupts();
    bar_.clear();
  }
  RowSink& begin_analysis(std::string_view) override { return *this; }
  void end_analysis(const AnalysisResult&) override {
    interrupt_was_noticed();
    bar_.clear();
  }
  void end_run() override { bar_.clear(); }

 private:
  void begin(std::span<const ColumnInfo>) override {}
  bool row(std::span<const double>) override { return true; }
  ProgressBar& bar_;
};

/// The rows of all analyses as CSV, an empty line between two of them.
class CsvSink final : public ResultSink, private RowSink {
 public:
  explicit CsvSink(TextOutput& output) : output_(output), writer_(output) {}
  void begin_run(const RunHeader&) override {}
  RowSink& begin_analysis(std::string_view) override { return *this; }
  void end_analysis(const AnalysisResult&) override {}
  void end_run() override {}

 private:
  void begin(std::span<const ColumnInfo> columns) override {
    if (any_) output_.write("\r\n");
    any_ = true;
    writer_.begin(columns);
  }
  bool row(std::span<const double> values) override { return writer_.row(values); }
  TextOutput& output_;
  CsvWriter writer_;
  bool any_ = false;
};

TableLimits table_limits(bool verbose) {
  if (verbose) return TableLimits::none();
  TableLimits limits;
  winsize window{};
  if (::isatty(STDOUT_FILENO) == 1 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0)
    limits.width = window.ws_col;
  return limits;
}

void print_messages(const RunCommand& command, const SceneOutcome& outcome) {
  // What is wrong in the scene, or with the command, is the same for all processes that share it: the first one says
  // so.
  const bool follows = command.options.link && command.options.link->rank() > 0;
  if (!follows || outcome.exit_code == no_file) std::fputs(outcome.error_text.c_str(), stderr);
  // A table on a terminal has said already which analysis failed and why.
  const bool told = !command.json && !command.csv && !command.quiet && ::isatty(STDOUT_FILENO) == 1;
  if (!told) complain_of_failures(command.scene, outcome);
  for (const AnalysisResult& result : outcome.analyses) {
    // Tables, reports and JSON have the warnings; rows alone have not.
    for (const std::string& warning : result.report.warnings) {
      if (command.csv && !command.quiet)
        complain(fmt::format("{}: {}: warning: {}\n", command.scene, result.type, warning));
    }
    if (command.stats) std::fputs(counters_text(result).c_str(), stderr);
  }
}

/// Checked first, so that hours of results are not lost at their end: the exit code of what stands in their way.
int find_obstacle(const RunCommand& command) {
  if (!command.directory.empty()) {
    if (const std::string obstacle = ResultFolder::obstacle(command.directory); !obstacle.empty()) {
      complain(fmt::format("catena: {}\n", obstacle));
      return no_file;
    }
  }
  if (!command.page.empty()) {
    if (const std::string obstacle = viewer_obstacle(); !obstacle.empty()) {
      complain(obstacle);
      return usage;
    }
  }
  return solved;
}

/// Whether everything could be written; says so if not.
bool finish_output(const TextOutput& output, const ResultFolder* folder, bool quiet) {
  if (!output.ok() && !output.reader_gone()) complain(fmt::format("catena: {}\n", output.error()));
  if (folder) {
    if (!folder->error().empty()) complain(fmt::format("catena: {}\n", folder->error()));
    for (const std::string& file : folder->files()) {
      if (!quiet) complain(fmt::format("wrote {}\n", file));
    }
  }
  return output.ok() && (!folder || folder->error().empty());
}

}  // namespace

int execute(const RunCommand& command) {
  if (const int obstacle = find_obstacle(command); obstacle != solved) return obstacle;
  // A reader that closes the pipe ends the program, as it ends any other; files are completed before.
  if (!command.directory.empty()) std::signal(SIGPIPE, SIG_IGN);

  ProgressBar bar(!command.quiet);
  BeforeResults before(bar);
  TextOutput output = TextOutput::standard_output();
  TextSink table(output, table_limits(command.verbose),
                 "-v shows everything, -o DIR writes files, --json and --csv print every digit");
  std::unique_ptr<ResultSink> json = command.json ? json_result_sink(output) : nullptr;
  std::optional<ResultFolder> folder;
  TeeSink sinks;
  sinks.add(before);
  CsvSink csv(output);
  // What is in the units that were asked for; pages convert by themselves. JSON on the standard output, which machines
  // read, is in SI whatever the scene wants to be shown, unless the command asks for other units.
  TeeSink converted;
  UnitsSink shown(converted, command.units);
  sinks.add(shown);
  std::optional<UnitsSink> asked;
  if (command.json) {
    sinks.add(asked.emplace(*json, command.units, UnitsSink::Scene::is_passed_over));
  } else if (command.csv) {
    converted.add(csv);
  } else if (!command.quiet) {
    converted.add(table);
  }
  if (!command.directory.empty()) converted.add(folder.emplace(command.directory, command.format));
  std::optional<RunRecorder> recorder;
  if (!command.page.empty()) sinks.add(recorder.emplace());

  RunOptions options = command.options;
  options.poses = recorder ? &*recorder : nullptr;
  options.cancel = &interrupt_flag();
  options.verbose = command.verbose;
  show_progress(bar, options);

  const SceneOutcome outcome = run_scene(command.scene, options, sinks);
  bar.clear();
  if (outcome.exit_code == wrong_scene && command.json) output.write(invalid_json(outcome));
  output.flush();
  print_messages(command, outcome);
  bool written = finish_output(output, folder ? &*folder : nullptr, command.quiet);
  if (recorder && recorder->record().model)
    written = write_page(command.page, recorder->record(), command.units, command.quiet) == solved && written;
  if (output.reader_gone()) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  // A failure to write results takes precedence over a failed analysis, but not over errors of a scene that was never
  // run.
  return written || outcome.exit_code >= usage ? outcome.exit_code : static_cast<int>(no_file);
}

}  // namespace catena::cli
