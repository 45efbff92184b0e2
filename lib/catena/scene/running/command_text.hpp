// The options of the command line that concern a scene, as JSON texts: the same readers check them, with messages that
// name the option. An error in it is a wrong command, not a wrong scene.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/scene/json/json_document.hpp"

namespace catena {

class CommandText {
 public:
  using Pairs = std::vector<std::pair<std::string, std::string>>;

  /// Reads --set NAME=VALUE; false if there are none, or what there is cannot be read.
  bool read_set(const Pairs& pairs, Diagnostics& diagnostics);
  /// Reads a verb and its options as an analysis.
  bool read_verb(std::string_view verb, const Pairs& options, Diagnostics& diagnostics);

  /// Reads --outputs of a whole run; false if there are none.
  bool read_outputs(const std::vector<std::string>& names, Diagnostics& diagnostics);

  JsonValue outputs() const { return documents_.at(outputs_).root(); }
  JsonValue set() const { return documents_.at(set_).root(); }
  JsonValue verb() const { return documents_.at(verb_).root(); }

  /// Whether an error is one of the command line; then the option, or the command, that it is about.
  static bool is_command(const Diagnostic& error) { return error.file.starts_with("--"); }
  std::string option_of(const Diagnostic& error) const;

 private:
  bool parse(std::string name, std::string text, std::size_t& number, Diagnostics& diagnostics);

  // Documents point into the sources; every option has a line of its own there.
  std::deque<SourceText> sources_;
  std::deque<JsonDocument> documents_;
  std::string command_;               // the verb
  std::vector<std::string> options_;  // of the verb, by line from the second
  std::size_t set_ = 0, verb_ = 0, outputs_ = 0;
};

}  // namespace catena
