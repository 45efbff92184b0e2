// What the command line says about a scene, as JSON texts of its own: the same readers check it, with messages that
// name the option. An error in it is a wrong command, not a wrong scene.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/scene/json_document.hpp"

namespace catena {

class CommandText {
 public:
  using Pairs = std::vector<std::pair<std::string, std::string>>;

  /// Reads --set NAME=VALUE; false if there are none, or what there is cannot be read.
  bool read_set(const Pairs& pairs, Diagnostics& diagnostics);
  /// Reads a verb and its options as an analysis.
  bool read_verb(std::string_view verb, const Pairs& options, Diagnostics& diagnostics);

  JsonValue set() const { return documents_.at(set_).root(); }
  JsonValue verb() const { return documents_.at(verb_).root(); }

  /// Whether the "file" of an error is a part of the command line.
  static bool is_command(std::string_view file) { return file.starts_with("--"); }

 private:
  bool parse(std::string name, std::string text, std::size_t& number, Diagnostics& diagnostics);

  std::deque<SourceText> sources_;  // documents point into them
  std::deque<JsonDocument> documents_;
  std::size_t set_ = 0, verb_ = 0;
};

}  // namespace catena
