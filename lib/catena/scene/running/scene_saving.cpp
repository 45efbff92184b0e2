#include "catena/scene/running/scene_saving.hpp"

#include <algorithm>

#include "catena/scene/json/json_text.hpp"

namespace catena {
namespace {

/// Bytes of the JSON number or string that begins at `from`.
std::size_t length_of_value(std::string_view text, std::size_t from) {
  if (text[from] != '"') {
    const std::size_t end = text.find_first_not_of("+-.0123456789eE", from);
    return (end == std::string_view::npos ? text.size() : end) - from;
  }
  std::size_t end = from + 1;
  while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  return end + 1 - from;
}

}  // namespace

std::string text_with_values(const SceneTemplate& scene, const ParameterSeeds& seeds) {
  struct Change {
    std::size_t offset;
    double value;
  };
  std::vector<Change> changes;
  for (const ParameterSeed<double>& seed : seeds)
    changes.push_back({scene.parameters.definition(seed.index).offset(), seed.value});
  std::sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.offset < b.offset; });
  const std::string_view text = scene.source->text();
  std::string out;
  std::size_t at = 0;
  for (const Change& change : changes) {
    out += text.substr(at, change.offset - at);
    append_json(out, change.value);
    at = change.offset + length_of_value(text, change.offset);
  }
  return out + std::string(text.substr(at));
}

}  // namespace catena
