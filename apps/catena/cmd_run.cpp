// catena run, and the verbs that run a single analysis with its keys as options.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "catena/analysis/dynamics/dynamics_options.hpp"
#include "commands.hpp"
#include "result_folder.hpp"
#include "run_command.hpp"
#include "scene_arguments.hpp"
#include "shared_run.hpp"

namespace catena::cli {
namespace {

struct Key {
  std::string_view name;  ///< in the scene
  std::string_view description;
  bool list = false;
};

constexpr Key outputs{"outputs", "columns, separated by commas", true};
constexpr Key until{"until", "last time"};
constexpr Key every{"every", "time between rows"};
constexpr Key at{"at", "time, or times separated by commas", true};
constexpr Key free_motions{"free", "refuse, or minimum_norm: what to do with motions that nothing drives"};
constexpr Key branch{"branch", "which of the branches that were listed"};
constexpr Key tolerance{"tolerance", "accuracy asked for"};

struct Verb {
  const char* command;
  const char* analysis;  ///< its type in scenes
  const char* description;
  std::vector<Key> keys;
};

const std::vector<Verb>& verbs() {
  static const std::string methods = fmt::format("integrator: {}", fmt::join(integration_methods, ", "));
  static const std::vector<Verb> all = {
      {"check", "check", "Count bodies, equations, degrees of freedom; find redundant constraints", {}},
      {"assemble", "assemble", "Find the configuration nearest to the given one that meets all constraints", {outputs}},
      {"kinematics",
       "kinematics",
       "Positions, velocities, accelerations of a driven mechanism",
       {until, every, at, free_motions, branch, outputs}},
      {"inverse",
       "inverse_dynamics",
       "Loads of the drivers and reactions in a driven mechanism",
       {until, every, at, free_motions, branch, outputs}},
      {"dynamics",
       "dynamics",
       "Motion under forces",
       {until,
        every,
        tolerance,
        {"method", methods},
        {"step", "fixed step"},
        {"max_steps", "largest number of steps"},
        outputs}},
      {"equilibrium",
       "equilibrium",
       "Static equilibrium",
       {at,
        tolerance,
        {"solver", "auto, newton, ipopt or nlopt"},
        {"accept", "stable or stationary"},
        {"find", "how many equilibria"},
        outputs}},
      {"path",
       "path",
       "Equilibria as a parameter changes",
       {at,
        {"parameter", "the parameter that changes"},
        {"to", "its last value"},
        {"max_steps", "largest number of steps"},
        {"arc", "length of a step"},
        branch,
        outputs}},
      {"buckling",
       "buckling",
       "Values of a load parameter at which the equilibrium loses its stability",
       {at, {"parameter", "the parameter that changes"}, {"count", "how many loads"}, outputs}},
      {"modes",
       "modes",
       "Small oscillations about the configuration",
       {at, {"count", "how many modes"}, {"shapes", "whether to give the shapes"}, outputs}},
  };
  return all;
}

/// An option of the verb: on the command line max_steps may be written --max-steps.
std::string option_name(std::string_view key) {
  std::string name = "--" + std::string(key);
  std::string dashed = name;
  std::replace(dashed.begin(), dashed.end(), '_', '-');
  return dashed == name ? name : dashed + "," + name;
}

/// A verb that runs those analyses of the scene's own list that have its type.
struct ListVerb {
  const char* command;
  const char* description;
};
constexpr ListVerb list_verbs[] = {
    {"sensitivity", "Derivatives of rows and measures: the scene's sensitivity analyses"},
    {"optimise", "Search for the best parameters: the scene's optimise analyses"},
    {"sweep", "Designs over values of parameters: the scene's sweep analyses"}};

struct Parsed {
  RunCommand run;
  std::vector<std::string> outputs;  // of a whole scene
  std::vector<std::string> units;
  SceneArguments scene;
  std::vector<std::pair<std::string, std::vector<std::string>>> keys;
};

void add_common_options(CLI::App& command, Parsed& parsed) {
  RunCommand& run = parsed.run;
  add_scene_arguments(command, parsed.scene);
  CLI::Option* json = command.add_flag("--json", run.json, "print results as JSON, every digit");
  command.add_flag("--csv", run.csv, "print rows as CSV, every digit, an empty line between analyses")->excludes(json);
  command
      .add_option("-o,--output-dir,--output", run.directory,
                  "also write the rows of each analysis to a file, all other results to report.json, in this folder")
      ->type_name("DIR")
      ->check([](const std::string& folder) { return folder.empty() ? "the folder has no name" : ""; });
  command.add_option("--format", run.format, "of the files with rows: csv, npz (NumPy) or json")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(ResultFolder::formats.begin(), ResultFolder::formats.end())))
      ->type_name("FORMAT")
      ->needs("--output-dir");
  add_units(command, parsed.units, "the table, of --json and --csv, of files and pages");
  command.add_option("--view", run.page, "also write a page with the moving mechanism and its plots")
      ->type_name("FILE");
  command
      .add_option("-j,--threads", run.options.threads,
                  "threads that sweeps and starts of optimisations use; results are the same for any number")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command.add_flag("!--no-digits", run.options.digits,
                   "do not tell how many digits of each column are right, which costs a second run of some motions");
  command.add_flag("--stats", run.stats, "print what was computed how often");
  command.add_flag("-q,--quiet", run.quiet, "print no table, report or progress");
  command.add_flag("-v,--verbose", run.verbose,
                   "print all rows and columns, the iterations of Newton's method, and the logs of solvers");
}

/// Of `run` and `sweep`.
void add_sweep_options(CLI::App& command, RunOptions& options) {
  CLI::Option* record =
      command.add_option("--record", options.record, "keep every finished design of sweeps in this file");
  record->type_name("FILE");
  command.add_flag("--resume", options.resume, "go on from the record: the designs that it has are not analysed again")
      ->needs(record);
}

/// Of `run` and `dynamics`.
void add_dynamics_options(CLI::App& command, RunOptions& options) {
  command.add_flag("--estimate-error", options.estimate_error,
                   "run every dynamics analysis a second time, at a tenth of the tolerance or half the step: "
                   "estimated_error is the largest difference of the two, and the rows are those of the finer run");
  CLI::Option* checkpoint = command.add_option("--checkpoint", options.checkpoint,
                                               "save the state of a dynamics analysis to this file at intervals");
  checkpoint->type_name("FILE");
  CLI::Option* interval =
      command.add_option("--checkpoint-every", options.checkpoint_every,
                         "seconds of simulated time between checkpoints: a twentieth of the analysis "
                         "unless given");
  interval->type_name("S")->check(CLI::PositiveNumber)->needs(checkpoint);
  command
      .add_option("--restart", options.restart,
                  "continue from a checkpoint: the remaining rows, equal bit for bit to those of the run that made it")
      ->type_name("FILE")
      ->excludes(interval);
}

/// What was read, as the scene runner wants it. Throws CLI::ValidationError.
RunCommand complete(const Parsed& parsed, const std::string& analysis) {
  RunCommand run = parsed.run;
  const RunOptions common = parsed.scene.options();
  run.scene = parsed.scene.scene;
  run.units = read_units(parsed.units);
  run.options.set = common.set;
  run.options.max_elements = common.max_elements;
  run.options.verb = analysis;
  run.options.outputs = without_brackets(parsed.outputs);
  for (const auto& [key, values] : parsed.keys) {
    for (const std::string& value : without_brackets(values)) run.options.verb_options.emplace_back(key, value);
  }
  return run;
}

void add_list_command(CLI::App& app, Action& chosen, const ListVerb& verb) {
  CLI::App* command = app.add_subcommand(verb.command, verb.description);
  const auto parsed = std::make_shared<Parsed>();
  add_common_options(*command, *parsed);
  parsed->run.options.only = verb.command;
  if (std::string_view(verb.command) == "optimise") {
    command
        ->add_option("--save", parsed->run.options.save,
                     "write the scene with the values found to this file, comments and layout kept")
        ->type_name("FILE");
  }
  const bool is_sweep = std::string_view(verb.command) == "sweep";
  if (is_sweep) {
    add_sweep_options(*command, parsed->run.options);
    command
        ->add_option("--patience", parsed->run.options.patience,
                     "under mpirun: seconds of silence after which a process counts as lost")
        ->capture_default_str()
        ->type_name("S")
        ->check([](const std::string& text) {
          double seconds = 0;
          return CLI::detail::lexical_cast(text, seconds) && seconds > 0 ? "" : "wants seconds above zero, not " + text;
        });
  }
  command->callback([parsed, &chosen, is_sweep] {
    chosen = [run = complete(*parsed, ""), is_sweep] { return is_sweep ? execute_together(run) : execute(run); };
  });
}

void add_command(CLI::App& app, Action& chosen, const Verb& verb) {
  CLI::App* command = app.add_subcommand(verb.command, verb.description);
  const auto parsed = std::make_shared<Parsed>();
  add_common_options(*command, *parsed);
  const bool whole_scene = verb.analysis[0] == '\0';
  if (whole_scene || std::string_view(verb.analysis) == "dynamics") add_dynamics_options(*command, parsed->run.options);
  if (whole_scene) {
    add_sweep_options(*command, parsed->run.options);
    command
        ->add_option("--outputs", parsed->outputs,
                     "columns, separated by commas, in place of those that the scene and its analyses name")
        ->allow_extra_args(false)
        ->type_name("VALUE")
        ->delimiter(',');
  }
  parsed->keys.reserve(verb.keys.size());  // options hold references
  for (const Key& key : verb.keys) {
    auto& values = parsed->keys.emplace_back(std::string(key.name), std::vector<std::string>()).second;
    CLI::Option* option = command->add_option(option_name(key.name), values, std::string(key.description));
    option->allow_extra_args(false)->type_name("VALUE");
    if (key.list) {
      option->delimiter(',');
    } else {
      option->expected(1);
    }
  }
  command->callback([parsed, &chosen, analysis = std::string(verb.analysis)] {
    chosen = [run = complete(*parsed, analysis)] { return execute(run); };
  });
}

}  // namespace

void add_run_commands(CLI::App& app, Action& chosen) {
  add_command(app, chosen, {"run", "", "Run the analyses of a scene, in order", {}});
  for (const Verb& verb : verbs()) add_command(app, chosen, verb);
  for (const ListVerb& verb : list_verbs) add_list_command(app, chosen, verb);
}

}  // namespace catena::cli
