#include "scene_arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace catena::cli {

std::string whole_number(const std::string& text) {
  const bool digits = !text.empty() && text.size() < 19 && text.find_first_not_of("0123456789") == std::string::npos;
  return digits && text.find_first_not_of('0') != std::string::npos ? "" : "wants a whole number above 0, not " + text;
}

std::vector<std::string> without_brackets(std::vector<std::string> values) {
  if (values.empty() || !values.front().starts_with('[') || !values.back().ends_with(']')) return values;
  values.front().erase(0, 1);
  values.back().pop_back();
  for (std::string& value : values) {
    value.erase(0, value.find_first_not_of(' '));
    value.erase(value.find_last_not_of(' ') + 1);
  }
  return values;
}

void add_scene_arguments(CLI::App& command, SceneArguments& arguments) {
  command.add_option("SCENE", arguments.scene, "the scene file")->required()->type_name("FILE");
  command.add_option("--set", arguments.set, "change a parameter: NAME=VALUE, in the syntax of scenes")
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
  command.add_option("--max-elements", arguments.max_elements, "refuse larger scenes")
      ->capture_default_str()
      ->type_name("N")
      ->check(whole_number);
}

void add_units(CLI::App& command, std::vector<std::string>& texts, const std::string& what) {
  command
      .add_option("--units", texts, "units of " + what + ", as angle=deg,length=mm: length, time, angle, force, mass")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->type_name("KIND=UNIT");
}

OutputUnits::Wishes read_units(const std::vector<std::string>& texts) {
  OutputUnits::Wishes wishes;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw CLI::ValidationError("--units", fmt::format("wants KIND=UNIT, as angle=deg, not \"{}\"", text));
    // Blanks about a word come with the comma before it.
    const auto trimmed = [](std::string word) {
      word.erase(0, word.find_first_not_of(' '));
      word.erase(word.find_last_not_of(' ') + 1);
      return word;
    };
    const std::string kind = trimmed(text.substr(0, equals)), unit = trimmed(text.substr(equals + 1));
    if (const auto problem = OutputUnits::problem(kind, unit)) throw CLI::ValidationError("--units", *problem);
    wishes.emplace_back(kind, unit);
  }
  return wishes;
}

RunOptions SceneArguments::options() const {
  RunOptions options;
  options.max_elements = max_elements;
  for (const std::string& assignment : set) {
    const std::size_t equals = assignment.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw CLI::ValidationError("--set", "wants NAME=VALUE, not \"" + assignment + "\"");
    options.set.emplace_back(assignment.substr(0, equals), assignment.substr(equals + 1));
  }
  return options;
}

}  // namespace catena::cli
