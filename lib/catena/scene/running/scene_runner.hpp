// A scene from its file to its results: read, checked, analysed; the entry points of the command line.
//
// Rows and results go to a ResultSink as they come; what is returned is the outcome: the exit code, the errors in the
// scene's text, and the report of every analysis. Nothing is thrown but std::bad_alloc.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/results/analysis_result.hpp"
#include "catena/results/result_sink.hpp"
#include "catena/results/row_writer.hpp"
#include "catena/results/text_output.hpp"
#include "catena/scene/json/diagnostic.hpp"

namespace catena {

class PoseSink;
class ProcessLink;

/// How far a run has come.
struct Progress {
  std::string_view analysis;  ///< its type
  int number = 0;             ///< from 0
  int analyses = 1;
  double fraction = 0;  ///< of this analysis, 0 ... 1
};

/// A table of designs, one a row: values of these parameters, SI.
struct GivenDesigns {
  std::vector<std::string> names;
  std::span<const double> values;  ///< row after row
};

struct RunOptions {
  /// The scene's text in place of the file's, which then need not exist: its path stands for it in messages, and files
  /// that the scene names are sought beside it.
  std::optional<std::string> text;
  /// Run this analysis alone instead of the scene's list: the `type` of an analysis, or empty.
  std::string verb;
  /// Keys of that analysis as text, as on the command line; a list is the same key several times.
  std::vector<std::pair<std::string, std::string>> verb_options;
  /// Run only those analyses of the scene's list that have this type; empty: all.
  std::string only;
  /// In place of its own list, the measured analyses of the scene are repeated for these designs, as by a sweep.
  std::optional<GivenDesigns> designs;
  /// File to which the scene is written with the values that its optimisations found; empty: none.
  std::string save;
  /// Parameters to change: name, and a value in the syntax of scenes (a number, "30 deg", "=2*a").
  std::vector<std::pair<std::string, std::string>> set;
  /// Columns in place of all that the scene names; empty: the scene's. Those that analyses have anyway may be named.
  std::vector<std::string> outputs;
  std::int64_t max_elements = 10'000'000;  ///< a larger scene is refused
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const Progress&)> progress;  ///< called often; may be empty
  bool verbose = false;         ///< iterations for a configuration, and solvers' own logs, to standard error
  bool estimate_error = false;  ///< of every dynamics analysis; an error if there is none
  bool digits = true;           ///< whether analyses tell how many digits are right, unless their key says no
  /// File to which dynamics analyses save where they are, every so many seconds of their time, s; empty: none. 0 s: a
  /// twentieth of the analysis.
  std::string checkpoint;
  double checkpoint_every = 0;
  int threads = 1;  ///< that a sweep, or the starts of an optimisation, may use
  /// File that keeps every finished design of the scene's sweeps (models/sweep_record.hpp), or empty; `resume`: it is
  /// there, and the run goes on from it.
  std::string record;
  bool resume = false;
  ProcessLink* link = nullptr;  ///< to other processes that share the work of sweeps, if there are any
  double patience = 10;         ///< s of silence after which such a process counts as lost
  PoseSink* poses = nullptr;    ///< takes the places of the bodies (results/pose_sink.hpp); nullptr: nothing is drawn
  std::string restart;  ///< file from which a run is taken up again, or empty; checkpoint_every is then the file's
};

struct SceneOutcome {
  /// 0 all solved; 1 an analysis was not; 2 an option wrong; 3 the scene's text wrong; 4 a file missing or unusable
  int exit_code = 0;
  std::string scene;               ///< its name
  std::vector<Diagnostic> errors;  ///< the first ones, in the order of the text
  std::string error_text;          ///< what to print: the errors as a compiler prints them, or one sentence
  std::vector<AnalysisResult> analyses;
  std::vector<std::pair<std::string, double>> parameters;  ///< all of the scene's, with their values
};

/// Reads the scene and runs its analyses. `sink` sees nothing at all if the scene is wrong.
SceneOutcome run_scene(const std::string& path, const RunOptions& options, ResultSink& sink);

/// Reads and checks the scene, and runs nothing: the outcome that run_scene() would have for errors.
SceneOutcome check_scene(const std::string& path, const RunOptions& options);

/// The document that replaces the results of a wrong scene: {"catena":1,"status":"invalid","errors":[...]} and newline.
std::string invalid_json(const SceneOutcome& outcome);

/// Writes the result document, row by row, to `output`, which must outlive it. A failure to write shows there and stops
/// no analysis: other sinks may still want its rows.
enum class JsonRows { written, left_out };
std::unique_ptr<ResultSink> json_result_sink(TextOutput& output, JsonRows rows = JsonRows::written);

/// Writes the rows of one analysis alone: {"catena": 1, "columns": [...], "units": [...], "rows": [[...], ...]}.
std::unique_ptr<RowWriter> json_row_writer(TextOutput& output);

/// The JSON Schema of scenes.
std::string schema_json();

/// What `catena explain NAME` prints: of an element, an analysis, a function of time, a column. Nothing if unknown.
std::optional<std::string> explain(std::string_view name);

/// Everything explain() knows, in the order in which it should be listed.
std::vector<std::string> explained_names();

}  // namespace catena
