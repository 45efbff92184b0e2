#include "catena/scene/models/command_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "catena/scene/describing/analysis_description.hpp"
#include "catena/scene/json/json_text.hpp"

namespace catena {
namespace {

/// A value as a scene would have it: a number where the text is one, else a string in the syntax of scenes.
void append_value(std::string& out, std::string_view text) {
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double number = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (code == std::errc() && end == digits.data() + digits.size() && std::isfinite(number)) {
    append_json(out, number);
  } else {
    append_json(out, text);
  }
}

/// The name of the text that a verb and its options make.
constexpr std::string_view verb_source = "--verb";

bool is_text(KeyKind kind) { return kind == KeyKind::word || kind == KeyKind::columns || kind == KeyKind::parameter; }

}  // namespace

bool CommandText::parse(std::string name, std::string text, std::size_t& number, Diagnostics& diagnostics) {
  sources_.emplace_back(std::move(name), text);
  std::optional<JsonDocument> document = JsonDocument::parse(sources_.back(), diagnostics);
  if (!document) return false;
  number = documents_.size();
  documents_.push_back(std::move(*document));
  return true;
}

bool CommandText::read_set(const Pairs& pairs, Diagnostics& diagnostics) {
  if (pairs.empty()) return false;
  std::string text = "{";
  for (const auto& [name, value] : pairs) {
    if (text.size() > 1) text += ", ";
    append_json(text, name);
    text += ": ";
    append_value(text, value);
  }
  return parse("--set", text + "}", set_, diagnostics);
}

bool CommandText::read_outputs(const std::vector<std::string>& names, Diagnostics& diagnostics) {
  if (names.empty()) return false;
  std::string text = "[";
  for (const std::string& name : names) {
    if (text.size() > 1) text += ", ";
    append_json(text, std::string_view(name));
  }
  return parse("--outputs", text + "]", outputs_, diagnostics);
}

std::string CommandText::option_of(const Diagnostic& error) const {
  const auto line = static_cast<std::size_t>(error.line);
  if (error.file != verb_source) return error.file;
  return line >= 2 && line - 2 < options_.size() ? options_[line - 2] : command_;
}

bool CommandText::read_verb(std::string_view verb, const Pairs& options, Diagnostics& diagnostics) {
  const AnalysisDescription* description = find_analysis_type(verb);
  std::string text = "{\"type\": ";
  append_json(text, verb);
  command_ = verb;
  for (std::size_t k = 0; k < options.size(); ++k) {
    const std::string& key = options[k].first;
    if (k > 0 && key == options[k - 1].first) continue;  // written with the first of its list
    options_.push_back("--" + key);
    std::replace(options_.back().begin(), options_.back().end(), '_', '-');
    const AnalysisKey* known = description ? description->find(key) : nullptr;
    const KeyKind kind = known ? known->kind : KeyKind::number;
    const bool list = kind == KeyKind::columns || kind == KeyKind::times;
    text += ",\n";
    append_json(text, key);
    text += list ? ": [" : ": ";
    for (std::size_t n = k; n < options.size() && options[n].first == key; ++n) {
      const std::string& value = options[n].second;
      if (n > k) text += ", ";
      if (kind == KeyKind::flag && (value == "true" || value == "false")) {
        text += value;
      } else if (is_text(kind)) {
        append_json(text, std::string_view(value));
      } else {
        append_value(text, value);
      }
    }
    if (list) text += ']';
  }
  return parse(std::string(verb_source), text + "}", verb_, diagnostics);
}

}  // namespace catena
