#include "cases/reference_file.hpp"

#include <charconv>
#include <stdexcept>

#include "catena/scene/json/json_document.hpp"

namespace bench {

using namespace catena;

namespace {

/// The member or the element that a part of the path names; absent where there is none.
JsonValue child(const JsonValue& value, std::string_view part) {
  if (value.is(JsonKind::object)) return value.find(part);
  std::size_t number = 0;
  const auto read = std::from_chars(part.data(), part.data() + part.size(), number);
  if (!value.is(JsonKind::array) || read.ec != std::errc() || number >= value.size()) return {};
  for (const JsonValue& element : value.elements()) {
    if (number-- == 0) return element;
  }
  return {};
}

}  // namespace

double reference_value(const std::string& folder, const std::string& name, std::string_view path) {
  const std::string file = (folder.empty() ? CATENA_DATA_DIR "/reference" : folder) + "/" + name + ".json";
  const SourceText source = SourceText::read(file);
  Diagnostics diagnostics;
  const auto document = JsonDocument::parse(source, diagnostics);
  if (!document) throw std::runtime_error(diagnostics.text());
  JsonValue value = document->root().is(JsonKind::object) ? document->root().find("values") : JsonValue();
  for (std::string_view rest = path; value && !rest.empty();) {
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    value = child(value, rest.substr(0, slash));
    rest.remove_prefix(std::min(slash + 1, rest.size()));
  }
  if (!value || !value.is(JsonKind::number)) throw std::runtime_error(file + " has no value " + std::string(path));
  return value.number();
}

}  // namespace bench
