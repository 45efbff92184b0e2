#include "fuzz/entry_points.hpp"

#include <unistd.h>

#include <array>
#include <cmath>

#include "catena/results/checkpoint.hpp"
#include "catena/scene/building/build_model.hpp"
#include "catena/scene/json/utf8.hpp"
#include "catena/scene/judging/scene_checks.hpp"
#include "catena/scene/numbers/output_units.hpp"
#include "catena/scene/numbers/quantity.hpp"
#include "catena/scene/reading/analysis_reader.hpp"
#include "catena/scene/reading/scene_reader.hpp"

namespace catena::testing {
namespace {

void check_words(const std::string& message) {
  require(!message.empty(), "an error without a message");
  for (std::size_t at = 0; at < message.size();) {
    const CodePoint c = next_code_point(message, at);
    require(c.valid, "a message that is not UTF-8: " + message);
    at += static_cast<std::size_t>(c.bytes);
  }
}

void check_error(const TextError& error, std::string_view text) {
  check_words(error.message);
  require(error.position <= text.size(), "an error beyond the end of the text: " + error.message);
}

void check_diagnostics(const Diagnostics& diagnostics) {
  for (const Diagnostic& error : diagnostics.items()) {
    check_words(error.message);
    check_words(error.file);
    require(error.line >= 1 && error.column >= 1, "an error without a place: " + error.message);
    require(error.caret >= 0, "a caret before the line: " + error.message);
  }
  require(diagnostics.ok() || !diagnostics.text().empty(), "errors without a text");
}

/// A folder of this process, for readers of files.
const std::filesystem::path& own_folder() {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path memory = "/dev/shm";
    auto made = (std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) /
                ("catena_fuzz_" + std::to_string(::getpid()));
    std::filesystem::create_directories(made);
    std::atexit([] { std::filesystem::remove_all(own_folder()); });
    return made;
  }();
  return folder;
}

std::string own_file(const char* name, std::string_view text) {
  const std::string path = own_folder() / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// Reads, evaluates and builds as check_scene() does; whether there was nothing to complain of.
bool read_scene_text(std::string_view text, const std::string& name) {
  // As many as there are before a scene of 10^7 parts is refused: replicate blocks are not to take a minute each.
  constexpr std::int64_t most_elements = 2000;
  Diagnostics diagnostics;
  const std::unique_ptr<SceneTemplate> scene = read_scene(SourceText(name, text), diagnostics);
  if (scene) {
    const std::vector<double> values = scene->parameters.evaluate<double>(scene->expressions, diagnostics);
    const bool sound = diagnostics.ok();
    if (scene->outputs) read_outputs(scene->outputs, *scene, values, diagnostics);
    std::vector<AnalysisTask> tasks;
    if (scene->analyses) tasks = read_analyses(scene->analyses, scene->outputs, *scene, scene->parameters, diagnostics);
    const Model model = build_model<double>(*scene, values, {most_elements}, diagnostics);
    if (sound && diagnostics.ok()) {
      SceneChecks checks(*scene, model, diagnostics);
      checks.check_own_columns();
      for (const AnalysisTask& task : tasks) checks.check_task(task);
    }
    if (diagnostics.ok()) {
      for (const double value : values) require(std::isfinite(value), "a parameter that is not finite");
      for (const auto& body : model.bodies)
        require(std::isfinite(body.position.x + body.position.y + body.angle), "a place that is not finite");
    }
  }
  check_diagnostics(diagnostics);
  require(scene || !diagnostics.ok(), "no scene, and no error");
  return diagnostics.ok();
}

}  // namespace

void read_any_scene(std::string_view text) { read_scene_text(text, own_folder() / "none/scene.json"); }

void read_any_expression(std::string_view text) {
  ParameterNames names;
  for (const char* name : {"a", "b", "rod", "l\xc3\xa4nge"}) names.add(name);
  names.add_table("p");
  const std::array<std::string, 2> loops{"j", "k"};
  const std::array<double, 4> parameters{0.3, -2, 7, 0};
  const std::array<double, 2> loop_values{3, 4};
  const std::array<double, 3> x{0, 1, 2}, y{0, 3, 1};
  const std::array<Formula<double>::Table, 1> tables{std::make_shared<const NamedTable<double>>(
      NamedTable<double>{"p", Spline<double>(x, y, SplineEnd::natural, Beyond::hold)})};
  std::vector<NamedInput> columns;
  for (std::vector<NamedInput>* taken : {static_cast<std::vector<NamedInput>*>(nullptr), &columns}) {
    const Parsed<Expression> read = Expression::parse(text, {&names, loops, taken});
    if (!read) {
      check_error(read.error, text);
      continue;
    }
    for (const NamedInput& input : columns) require(input.position <= text.size(), "a column beyond the text");
    const auto formula = read->formula<double>(parameters, loop_values, tables);
    const double by_formula = formula.evaluate([](std::uint32_t k) { return 0.5 + k; });
    if (taken && !columns.empty()) continue;  // has no value without columns
    try {
      const double value = read->evaluate<double>(parameters, loop_values, tables);
      require(std::isfinite(value), "a value that is not finite");
      require(value == by_formula, "an expression and its formula differ");
      std::array<Dual<double, 4>, 4> dual;
      for (std::size_t k = 0; k < 4; ++k) dual[k] = Dual<double, 4>::variable(parameters[k], static_cast<int>(k));
      const auto carried = read->formula<Dual<double, 4>>(dual, loop_values, {});
      require(!carried.empty(), "a formula without a step");
    } catch (const ExpressionError& error) {
      check_error({error.position, error.what()}, text);
    }
  }
  const Parsed<NameTemplate> name = NameTemplate::parse(text, {&names, loops});
  if (!name) return check_error(name.error, text);
  name->sample();
  try {
    std::string made;
    name->append_to(made, parameters, loop_values);
  } catch (const ExpressionError& error) {
    check_error({error.position, error.what()}, text);
  }
}

void read_any_quantity(std::string_view text) {
  const std::size_t line = text.find('\n');
  if (line != text.npos) {
    const std::string unit(text.substr(0, line));
    text.remove_prefix(line + 1);
    for (const std::string_view kind : OutputUnits::kinds) {
      if (const auto problem = OutputUnits::problem(kind, unit)) {
        check_words(*problem);
        continue;
      }
      OutputUnits units;
      units.ask({{std::string(kind), unit}});
      const OutputUnits::Conversion shown = units.of(text);
      require(std::isfinite(shown.factor) && shown.factor > 0, "a factor that is none");
    }
  }
  const Parsed<Quantity> read = parse_quantity(text);
  if (!read) return check_error(read.error, text);
  require(std::isfinite(read->value), "a quantity that is not finite");
  // The unit of its dimension, as messages and files have it, is one that is read.
  describe(read->dimension);
  example(read->dimension);
  const std::string unit = si_unit(read->dimension);
  const auto largest = [](const Dimension& d) {
    return std::max({std::abs(d.length), std::abs(d.mass), std::abs(d.time), std::abs(d.angle)});
  };
  if (unit == "1" || largest(read->dimension) > 9) return;
  const Parsed<Quantity> again = parse_quantity("1 " + unit);
  require(again && again->value == 1 && again->dimension == read->dimension, "a unit that does not read back: " + unit);
}

void read_any_checkpoint(std::string_view text) {
  const auto read = [](const std::string& bytes) -> std::optional<Checkpoint> {
    try {
      return read_checkpoint(own_file("checkpoint", bytes));
    } catch (const CheckpointError& error) {
      check_words(error.what());
      return {};
    }
  };
  read(std::string(text));
  // FNV-1a over the lines, written down here a second time.
  static const std::string first_line = [] {
    const std::string path = own_folder() / "empty";
    write_checkpoint(path, {});
    std::string line;
    std::getline(std::ifstream(path), line);
    return line;
  }();
  const std::string whole = first_line + '\n' + std::string(text);
  std::uint64_t sum = 14695981039346656037u;
  for (const char c : whole) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211u;
  std::array<char, 20> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx\n", static_cast<unsigned long long>(sum));
  const auto checkpoint = read(whole + digits.data());
  if (!checkpoint) return;
  const std::string path = own_folder() / "again", third = own_folder() / "third";
  write_checkpoint(path, *checkpoint);
  write_checkpoint(third, read_checkpoint(path));
  require(SourceText::read(path).text() == SourceText::read(third).text(), "a checkpoint that does not read back");
}

void read_any_table(std::string_view text) {
  own_file("table.csv", text);
  const char* const uses[] = {
      R"({"spline": {"points": {"file": "table.csv"}}})",
      R"({"spline": {"points": {"file": "table.csv", "columns": ["x", "y"], "unit": ["ms", "mm"]}, "beyond": "hold"}})",
      R"({"spline": {"points": {"file": "table.csv", "columns": [2, 1], "smooth": 0.01}, "end": "periodic"}})",
      R"({"spline": {"t": {"file": "table.csv"}, "value": {"file": "table.csv", "columns": [3]}, "end": "clamped"}})"};
  for (const char* use : uses) {
    const std::string scene = std::string(R"({"catena": 1, "bodies": {"b": {}}, "tables": {"p": {"points":
      {"file": "table.csv", "columns": [1, 2], "smooth": 1}, "beyond": "line"}}, "drivers": [
      {"type": "absolute_x", "i": "b", "value": )") +
                              use + "}]}";
    read_scene_text(scene, own_folder() / "scene.json");
  }
}

}  // namespace catena::testing
