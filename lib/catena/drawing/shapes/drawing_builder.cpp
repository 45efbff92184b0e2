#include "catena/drawing/shapes/drawing_builder.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "catena/drawing/shapes/symbols.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/rack_pinion.hpp"

namespace catena {
namespace {

std::size_t hash_of(const DrawnSymbol& symbol) {
  std::size_t hash = symbol.lines.size();
  const auto mix = [&](double value) { hash = hash * 1099511628211u ^ std::hash<double>{}(value); };
  for (const DrawnLine& line : symbol.lines) {
    mix(static_cast<double>(line.role));
    mix(line.radius);
    mix(line.width);
    for (const Vec2<double>& p : line.points) mix(p.x), mix(p.y);
  }
  return hash;
}

constexpr double link_width = 1.7, mass_radius = 1.25;

}  // namespace

DrawingBuilder::DrawingBuilder(const Model& model) : model_(model), looks_(model.bodies.size(), 0) {
  smallest_wheel_ = std::numeric_limits<double>::infinity();
  for (const auto& entry : std::get<std::vector<ElementEntry<Gear<double>, double>>>(model.constraints))
    smallest_wheel_ = std::min({smallest_wheel_, entry.element.radius_i, entry.element.radius_j});
  for (const auto& entry : std::get<std::vector<ElementEntry<RackPinion<double>, double>>>(model.constraints))
    smallest_wheel_ = std::min(smallest_wheel_, entry.element.radius);
}

int DrawingBuilder::symbol(DrawnSymbol symbol) {
  const std::size_t hash = hash_of(symbol);
  const auto [first, last] = known_.equal_range(hash);
  for (auto k = first; k != last; ++k) {
    if (drawing_.symbols[static_cast<std::size_t>(k->second)].lines == symbol.lines) return k->second;
  }
  const int number = static_cast<int>(drawing_.symbols.size());
  drawing_.symbols.push_back(std::move(symbol));
  known_.emplace(hash, number);
  return number;
}

void DrawingBuilder::add_guide(DrawnGuide guide, const DrawnShape& shape, DrawnSymbol look, double member_width) {
  if (guide.body_i >= 0 && member_width > 0) {
    guide.member = static_cast<int>(drawing_.shapes.size());
    add({.anchor = Anchor::span, .body_i = guide.body_i, .body_j = guide.body_i}, bar_symbol(member_width, Role::link));
  }
  guide.shape = static_cast<int>(drawing_.shapes.size());
  add(shape, std::move(look));
  drawing_.guides.push_back(guide);
}

void DrawingBuilder::add_rope(RopePath path, DrawnSymbol look) {
  DrawnShape shape{.anchor = Anchor::rope, .element = path.element};
  shape.body_i = path.nodes.front().body;
  shape.body_j = path.nodes.back().body;
  shape.rope = static_cast<int>(drawing_.ropes.size());
  add(shape, std::move(look));
  drawing_.ropes.push_back(std::move(path));
}

void DrawingBuilder::follow(int element, int body, const Vec2<double>& local) {
  // Those of the element that is being drawn came last.
  for (auto guide = drawing_.guides.rbegin(); guide != drawing_.guides.rend(); ++guide) {
    if (drawing_.shapes[static_cast<std::size_t>(guide->shape)].element != element) return;
    if (guide->body_j == body) guide->point_j = local;
  }
}

void DrawingBuilder::attach(int body, const Vec2<double>& local) {
  if (body >= 0) places_.emplace_back(body, local);
}

void DrawingBuilder::has_look(int body) {
  if (body >= 0) looks_[static_cast<std::size_t>(body)] = 1;
}

void DrawingBuilder::add_pin(int body_i, int body_j, int body, const Vec2<double>& local) {
  pins_.emplace(std::minmax(body_i, body_j), Pin{body, local});
}

void DrawingBuilder::add_at_pin(int element, int body_i, int body_j, const Vec2<double>& otherwise, DrawnSymbol look) {
  at_pins_.push_back({element, body_i, body_j, otherwise, std::move(look)});
}

void DrawingBuilder::add_symbols_at_pins() {
  for (AtPin& wanted : at_pins_) {
    const auto pin = pins_.find(std::minmax(wanted.body_i, wanted.body_j));
    const bool pinned = pin != pins_.end();
    add({.anchor = Anchor::point,
         .element = wanted.element,
         .body_i = pinned ? pin->second.body : wanted.body_j,
         .point_i = pinned ? pin->second.local : wanted.otherwise,
         .point_j = {1, 0}},
        std::move(wanted.look));
  }
}

// The smallest one has enough teeth to look like a wheel.
int DrawingBuilder::teeth_of(double radius) const {
  constexpr int least = 18, most = 240;  // more look like a thick line
  return std::min(most, static_cast<int>(std::lround(least * radius / std::min(radius, smallest_wheel_))));
}

const DrawingBuilder::Wheel* DrawingBuilder::find_wheel(int body, const Vec2<double>& centre, double radius) const {
  const auto same = [&](const Wheel& wheel) {
    constexpr double alike = 1e-9;  // of the radius: places that were computed in different ways
    return wheel.body == body && std::abs(wheel.radius - radius) <= alike * radius &&
           norm(wheel.centre - centre) <= alike * radius;
  };
  const auto wheel = std::find_if(wheels_.begin(), wheels_.end(), same);
  return wheel == wheels_.end() ? nullptr : &*wheel;
}

void DrawingBuilder::add_given_shapes() {
  for (const BodyShape& given : model_.shapes) {
    DrawnLine line{.role = Role::link, .points = given.points, .radius = given.radius};
    line.closed = line.filled = given.closed;
    add({.body_i = given.body}, {{line}});
    has_look(given.body);
  }
}

void DrawingBuilder::add_links() {
  const std::size_t bodies = model_.bodies.size();
  for (std::size_t b = 0; b < bodies; ++b) {
    for (int k = model_.bodies[b].first_point; k >= 0; k = model_.points[static_cast<std::size_t>(k)].next)
      places_.emplace_back(static_cast<int>(b), model_.points[static_cast<std::size_t>(k)].local);
  }
  std::stable_sort(places_.begin(), places_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  auto place = places_.begin();
  for (int body = 0; body < static_cast<int>(bodies); ++body) {
    std::vector<Vec2<double>> own;
    for (; place != places_.end() && place->first == body; ++place) own.push_back(place->second);
    add_link(body, convex_hull(beyond_discs(body, std::move(own))));
  }
}

// A wheel is its own link to what lies on it: a bar would only stick out of its rim.
std::vector<Vec2<double>> DrawingBuilder::beyond_discs(int body, std::vector<Vec2<double>> places) const {
  std::vector<Vec2<double>> centres;
  for (const Disc& disc : discs_) {
    if (disc.body != body) continue;
    constexpr double alike = 1 + 1e-9;  // of the radius: points of the rim
    std::erase_if(places, [&](const Vec2<double>& p) { return norm(p - disc.centre) <= alike * disc.radius; });
    if (std::find(centres.begin(), centres.end(), disc.centre) == centres.end()) centres.push_back(disc.centre);
  }
  if (!places.empty() || centres.size() > 1) places.insert(places.end(), centres.begin(), centres.end());
  return places;
}

// One place: a rod from there to the centroid, where the mass is; none: the mass alone.
void DrawingBuilder::add_link(int body, std::vector<Vec2<double>> places) {
  const bool looks = looks_[static_cast<std::size_t>(body)] != 0;
  if (places.size() >= 3) {
    DrawnLine plate{.role = Role::link, .points = std::move(places), .closed = true, .filled = true, .width = 1.2};
    return add({.body_i = body}, {{plate}});
  }
  if (places.size() < 2 && !looks) {
    add({.anchor = Anchor::point, .body_i = body, .body_j = body, .point_j = {1, 0}},
        disc_symbol(mass_radius, Role::link));
    if (places.size() == 1 && squared_norm(places[0]) > 0) places.push_back({});
  }
  if (places.size() < 2) return;
  lengths_.push_back(norm(places[1] - places[0]));
  add({.anchor = Anchor::span, .body_i = body, .body_j = body, .point_i = places[0], .point_j = places[1]},
      bar_symbol(link_width, Role::link));
}

/// Where nothing is a link: the diameter of the largest wheel or disc of a body, or else the longest spring.
double DrawingBuilder::usual_size() const {
  double wheel = 0, spring = 0;
  for (const DrawnShape& shape : drawing_.shapes) {
    if (shape.anchor == Anchor::body && shape.body_i >= 0) {
      for (const DrawnLine& line : drawing_.symbols[static_cast<std::size_t>(shape.symbol)].lines)
        wheel = std::max(wheel, 2 * line.radius);
    } else if (shape.anchor == Anchor::span && shape.body_i != shape.body_j) {
      const Vec2<double> p = model_.frame(shape.body_i).point(shape.point_i),
                         q = model_.frame(shape.body_j).point(shape.point_j);
      spring = std::max(spring, norm(q - p));
    }
  }
  return wheel > 0 ? wheel : spring;
}

void DrawingBuilder::find_typical_length() {
  if (lengths_.empty()) {
    drawing_.typical_length = usual_size();
    return;
  }
  const auto middle = lengths_.begin() + static_cast<std::ptrdiff_t>(lengths_.size() / 2);
  std::nth_element(lengths_.begin(), middle, lengths_.end());
  drawing_.typical_length = *middle;
}

void DrawingBuilder::sort_shapes() {
  std::vector<std::size_t> order(drawing_.shapes.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto height = [&](std::size_t k) {
    return drawing_.symbols[static_cast<std::size_t>(drawing_.shapes[k].symbol)].lines.front().role;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return height(a) < height(b); });
  std::vector<DrawnShape> sorted;
  std::vector<int> now(order.size());
  for (const std::size_t k : order) {
    now[k] = static_cast<int>(sorted.size());
    sorted.push_back(drawing_.shapes[k]);
  }
  drawing_.shapes = std::move(sorted);
  for (DrawnGuide& guide : drawing_.guides) {
    guide.shape = now[static_cast<std::size_t>(guide.shape)];
    if (guide.member >= 0) guide.member = now[static_cast<std::size_t>(guide.member)];
  }
}

Drawing DrawingBuilder::finish() {
  add_given_shapes();
  add_links();
  add_symbols_at_pins();
  find_typical_length();
  sort_shapes();
  return std::move(drawing_);
}

}  // namespace catena
