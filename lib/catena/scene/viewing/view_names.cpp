// Names of bodies, elements and points in the data of pages.
#include <algorithm>
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

/// Points with a name, at most so many: the page lists them. Body and number of each.
std::vector<std::pair<int, int>> listed_points(const Model& model) {
  constexpr std::size_t most = 2000;
  std::vector<std::pair<int, int>> points;
  for (int b = 0; b < static_cast<int>(model.bodies.size()) && points.size() < most; ++b) {
    for (int k = model.bodies[static_cast<std::size_t>(b)].first_point; k >= 0;
         k = model.points[static_cast<std::size_t>(k)].next)
      points.emplace_back(b, k);
  }
  return points;
}

std::string_view point_name(const Model& model, int k) {
  return model.point_names[model.points[static_cast<std::size_t>(k)].name];
}

void append_points(ViewJson& json, const Model& model) {
  const std::vector<std::pair<int, int>> points = listed_points(model);
  json.key("points").open('{').key("body").open('[');
  for (const auto& [body, k] : points) json.value(std::int64_t{body});
  json.close(']').key("name").open('[');
  for (const auto& [body, k] : points) json.text(point_name(model, k));
  json.close(']').key("at").open('[');
  for (const auto& [body, k] : points) {
    const Vec2<double>& local = model.points[static_cast<std::size_t>(k)].local;
    json.rounded(local.x).rounded(local.y);
  }
  json.close(']').close('}');
}

bool same_points(const Model& a, const Model& b) {
  const std::vector<std::pair<int, int>> of_a = listed_points(a), of_b = listed_points(b);
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), [&](const auto& p, const auto& q) {
    const Vec2<double>&at_p = a.points[static_cast<std::size_t>(p.second)].local,
          &at_q = b.points[static_cast<std::size_t>(q.second)].local;
    return p.first == q.first && at_p.x == at_q.x && at_p.y == at_q.y &&
           point_name(a, p.second) == point_name(b, q.second);
  });
}

}  // namespace

bool same_names(const Model& a, const Model& b) {
  if (a.bodies.size() != b.bodies.size() || a.elements.size() != b.elements.size()) return false;
  for (int body = 0; body < static_cast<int>(a.bodies.size()); ++body) {
    if (a.body_name(body) != b.body_name(body)) return false;
  }
  for (int e = 0; e < static_cast<int>(a.elements.size()); ++e) {
    if (a.element_type(e) != b.element_type(e) || a.element_name(e) != b.element_name(e)) return false;
  }
  return same_points(a, b);
}

void append_names(ViewJson& json, const Model& model) {
  append_body_and_element_names(json, model);
  append_points(json, model);
}

}  // namespace catena
