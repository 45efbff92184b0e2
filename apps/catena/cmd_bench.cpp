// catena bench: run time against error, growth, economy, in one command (apps/manual/benchmarks.md).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include "cases/economy_cases.hpp"
#include "catena/results/terminal/interrupt.hpp"
#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/json/source_text.hpp"
#include "commands.hpp"
#include "documents/comparison.hpp"
#include "documents/document.hpp"
#include "documents/figures.hpp"
#include "documents/peers.hpp"
#include "documents/table.hpp"
#include "suites/suites.hpp"

namespace catena::cli {
namespace {

struct BenchCommand {
  std::vector<std::string> suites;
  bench::Options options;
  std::string json, html, svg, compare, from, variant;
  bool quiet = false, no_instructions = false;
};

/// Words that name no suite are told with the nearest one; false if there are any.
bool know_suites(const std::vector<std::string>& words) {
  bool known = true;
  for (const std::string& word : words) {
    NearMiss nearest(word);
    bool found = word == "all";
    nearest.consider("all");
    for (const bench::Suite& suite : bench::suites) {
      found = found || word == suite.name;
      nearest.consider(suite.name);
    }
    if (found) continue;
    known = false;
    std::string names;
    for (const bench::Suite& suite : bench::suites) names += std::string(suite.name) + ", ";
    complain(fmt::format("catena: there is no suite {}{} (suites: {}all)\n", in_quotes(word), nearest.hint(), names));
  }
  return known;
}

bench::Document run_suites(const BenchCommand& command) {
  // Threads of the BLAS would count as processor time and gain nothing on matrices of this kind.
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  bench::Options options = command.options;
  options.instructions = !command.no_instructions && !options.brief;
  if (!command.quiet) {
    complain(bench::table_head());
    options.progress = [](const bench::Row& row) { complain(bench::table_line(row)); };
  }
  catch_interrupts();
  // A row may take longer than the patience of other loops; a second signal still ends the program.
  std::signal(SIGALRM, SIG_IGN);
  options.cancelled = [] { return interrupt_flag().load(std::memory_order_relaxed); };
  bench::Bench bench(options);
  const auto wanted = [&](std::string_view name) {
    return std::any_of(command.suites.begin(), command.suites.end(),
                       [&](const std::string& word) { return word == "all" || word == name; });
  };
  for (const bench::Suite& suite : bench::suites) {
    if (wanted(suite.name)) suite.run(bench);
  }
  if (options.cancelled())
    bench.remark("stopped by a signal: the rows so far are kept");
  else
    bench::add_peers(bench, wanted);
  return bench::make_document(bench.rows(), bench.notes(), options.brief);
}

/// Writes what was asked for; the worst exit code.
int write_results(const BenchCommand& command, const bench::Document& document) {
  int exit_code = solved;
  const auto write = [&](const std::string& path, const std::string& content) {
    if (const int written = write_file(path, content, command.quiet); written != solved) exit_code = written;
  };
  if (!command.json.empty()) write(command.json, bench::to_json(document));
  if (!command.html.empty()) write(command.html, bench::page_of(document));
  if (!command.svg.empty()) {
    // A folder that cannot be made shows in the first file.
    std::error_code trouble;
    std::filesystem::create_directories(command.svg, trouble);
    for (const bench::Figure& figure : bench::figures_of(document))
      write(command.svg + "/" + figure.name + ".svg", figure.svg);
  }
  return exit_code;
}

int run_bench(const BenchCommand& command) {
  if (!command.variant.empty()) {
    if (bench::run_economy_variant(command.variant)) return solved;
    complain(fmt::format("catena: the economy suite has no {}\n", in_quotes(command.variant)));
    return usage;
  }
  if (!know_suites(command.suites)) return usage;
  try {
    // Read first, so that ten minutes are not lost at their end.
    std::optional<bench::Document> then;
    if (!command.compare.empty()) then = bench::read_document(command.compare);
    const bench::Document now = command.from.empty() ? run_suites(command) : bench::read_document(command.from);
    int exit_code = write_results(command, now);
    std::string text = bench::growth_lines(now.rows);
    for (const std::string& note : now.notes) text += note + "\n";
    if (then) text += bench::comparison_lines(bench::compare(now, *then));
    const auto failed = std::count_if(now.rows.begin(), now.rows.end(), [](const bench::Row& r) { return r.failed(); });
    text += fmt::format("{}\n{} rows, {} without a right answer\n", bench::describe(now), now.rows.size(), failed);
    if (!command.quiet || then) {
      if (const int printed = print(text); printed != solved) exit_code = printed;
    }
    if (now.rows.empty()) {
      complain("catena: no row has these words in its name\n");
      return usage;
    }
    const bool complete = failed == 0 && !interrupt_flag().load(std::memory_order_relaxed);
    return exit_code == solved && !complete ? static_cast<int>(not_solved) : exit_code;
  } catch (const FileError& error) {
    complain(fmt::format("catena: {}\n", error.what()));
    return no_file;
  } catch (const bench::DocumentError& error) {
    complain(fmt::format("catena: {}\n", error.what()));
    return wrong_scene;
  }
}

}  // namespace

void add_bench_command(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("bench", "Measure run time against error, growth with size, economy: suites of benchmarks");
  const auto parsed = std::make_shared<BenchCommand>();
  command->add_option(
      "SUITE", parsed->suites,
      "kinematics, dynamics, contact, equilibrium, design, kernels, scaling, economy, digits, or all, which is "
      "meant where none is named");
  command->add_option("--json", parsed->json, "write the rows to this file")->type_name("FILE");
  command->add_option("--html", parsed->html, "write a page with the rows and their plots")->type_name("FILE");
  command->add_option("--svg", parsed->svg, "write the plots alone into this folder")->type_name("DIR");
  command->add_option("--compare", parsed->compare, "ratios to the times of an earlier --json")->type_name("OLD.json");
  command->add_option("--from", parsed->from, "measure nothing: take the rows of an earlier --json")->type_name("FILE");
  command
      ->add_option("--peers", parsed->options.peers,
                   "programs peer_NAME of other engines, or a file of their records: run or drawn beside")
      ->type_name("DIR|FILE");
  command->add_option("--references", parsed->options.references, "folder of reference values: data/reference")
      ->type_name("DIR");
  command->add_option("--only", parsed->options.only, "rows whose name holds these words alone")->type_name("WORDS");
  command->add_option("--budget", parsed->options.budget, "processor time a row may spend on repeats, s")
      ->capture_default_str()
      ->type_name("S")
      ->check(CLI::Range(0.001, 1000.0));
  command->add_flag("--brief", parsed->options.brief, "small sizes and single calls: for tests, not for figures");
  command->add_flag("--no-instructions", parsed->no_instructions, "do not count instructions by valgrind");
  command->add_flag("-q,--quiet", parsed->quiet, "no lines while it runs");
  command->add_option("--economy-variant", parsed->variant)->group("");
  command->callback([parsed, &chosen] {
    if (parsed->suites.empty()) parsed->suites = {"all"};
    chosen = [parsed] { return run_bench(*parsed); };
  });
}

}  // namespace catena::cli
