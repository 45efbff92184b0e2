// Where an element holds a body: "body", "body.point" or ["body", [x', y']], from JSON to a template.
#include <fmt/format.h>

#include <algorithm>

#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

/// Where the body's name ends and the point's begins: the first dot outside of braces.
std::size_t find_dot(std::string_view text) {
  int depth = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '{') ++depth;
    if (text[k] == '}') --depth;
    if (text[k] == '.' && depth <= 0) return k;
  }
  return std::string_view::npos;
}

}  // namespace

void SceneReading::attachment(const JsonValue& value, std::string_view key, std::string_view owner, bool has_at,
                              AttachmentTemplate& attachment, NumberValue* local) {
  using Form = AttachmentTemplate::Form;
  const FieldName field{key, owner};
  if (value.is(JsonKind::string)) {
    const std::size_t dot = find_dot(value.text());
    attachment.body = name(value, 0, dot);
    attachment.form = Form::origin;
    if (dot == std::string_view::npos) return;
    attachment.form = Form::point;
    attachment.point = name(value, dot + 1);
    if (has_at) error(value, field.text() + " may not name a point where \"at\" gives the place");
    return;
  }
  const bool list = value.is(JsonKind::array) && value.size() == 2 && value.elements().begin()->is(JsonKind::string);
  if (!list) {
    error(value, fmt::format("{} must be \"body\", \"body.point\" or [\"body\", [x', y']]; this is {}", field.text(),
                             describe(value.kind())));
    return;
  }
  auto element = value.elements().begin();
  const std::string_view text = element->text();
  if (find_dot(text) != std::string_view::npos) {
    error(*element, field.text() + " must name a body without a point, since a place in its frame follows");
  } else {
    attachment.body = name(*element);
    attachment.form = Form::local;
  }
  ++element;
  const auto place = numbers.read_pair(*element, dimension_of(UnitKind::length), field);
  if (local) std::copy(place.begin(), place.end(), local);
  if (has_at) error(value, field.text() + " may not give a place where \"at\" gives it");
}

}  // namespace catena
