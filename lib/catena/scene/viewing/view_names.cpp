// Names of bodies, elements and points in the data of pages.
#include <map>

#include "catena/scene/viewing/view_document.hpp"
#include "catena/scene/viewing/view_json.hpp"

namespace catena {
namespace {

void append_body_and_element_names(ViewJson& json, const Model& model) {
  json.key("bodies").open('[');
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) json.text(model.body_name(b));
  json.close(']');
  std::vector<std::string> types;
  std::map<std::string, std::int64_t, std::less<>> number;
  json.key("elements").open('{').key("type").open('[');
  const auto elements = static_cast<int>(model.elements.size());
  for (int e = 0; e < elements; ++e) {
    const auto [place, is_new] =
        number.try_emplace(std::string(model.element_type(e)), static_cast<std::int64_t>(types.size()));
    if (is_new) types.push_back(place->first);
    json.value(place->second);
  }
  json.close(']').key("types").open('[');
  for (const std::string& type : types) json.text(type);
  json.close(']').key("name").open('[');
  for (int e = 0; e < elements; ++e) json.text(model.element_name(e));
  json.close(']').close('}');
}

/// Points with a name, at most so many: the page lists them.
void append_points(ViewJson& json, const Model& model) {
  constexpr std::size_t most = 2000;
  std::vector<std::pair<int, int>> points;  // body, number
  for (int b = 0; b < static_cast<int>(model.bodies.size()) && points.size() < most; ++b) {
    for (int k = model.bodies[static_cast<std::size_t>(b)].first_point; k >= 0;
         k = model.points[static_cast<std::size_t>(k)].next)
      points.emplace_back(b, k);
  }
  json.key("points").open('{').key("body").open('[');
  for (const auto& [body, k] : points) json.value(std::int64_t{body});
  json.close(']').key("name").open('[');
  for (const auto& [body, k] : points) json.text(model.point_names[model.points[static_cast<std::size_t>(k)].name]);
  json.close(']').key("at").open('[');
  for (const auto& [body, k] : points) {
    const Vec2<double>& local = model.points[static_cast<std::size_t>(k)].local;
    json.rounded(local.x).rounded(local.y);
  }
  json.close(']').close('}');
}

}  // namespace

void append_names(ViewJson& json, const Model& model) {
  append_body_and_element_names(json, model);
  append_points(json, model);
}

}  // namespace catena
