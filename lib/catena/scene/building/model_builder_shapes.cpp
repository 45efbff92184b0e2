// ModelBuilder: what bodies look like, from the shapes they are given or made of.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/scene/building/model_builder.hpp"

namespace catena {
namespace {

/// The corners of a rectangle: centre, width, height, angle.
std::vector<Vec2<double>> rectangle_corners(const std::vector<double>& n) {
  const Frame<double> frame = make_frame(n[0], n[1], n[4]);
  const Vec2<double> half{n[2] / 2, n[3] / 2};
  return {frame.point(Vec2<double>{-half.x, -half.y}), frame.point(Vec2<double>{half.x, -half.y}), frame.point(half),
          frame.point(Vec2<double>{-half.x, half.y})};
}

/// The shape in the author's frame; without corners where it is none: a mass, or numbers that were reported.
BodyShape shape_of(PartTemplate::Shape kind, const std::vector<double>& n) {
  using Shape = PartTemplate::Shape;
  BodyShape shape;
  const bool finite = std::all_of(n.begin(), n.end(), [](double value) { return std::isfinite(value); });
  if (!finite || kind == Shape::mass) return shape;
  if (kind == Shape::rectangle && n.size() == 5) shape.points = rectangle_corners(n);
  if (kind == Shape::disc && n.size() == 3) {
    shape.points = {{n[0], n[1]}};
    shape.radius = n[2];
  }
  if (kind == Shape::polygon || kind == Shape::line) {
    for (std::size_t k = 0; k + 1 < n.size(); k += 2) shape.points.push_back({n[k], n[k + 1]});
    shape.closed = kind == Shape::polygon;
  }
  return shape;
}

/// Nothing, or why the shape is invisible. Numbers that could not be read were reported, and are none.
const char* unseen(PartTemplate::Shape kind, const std::vector<double>& n) {
  if (kind == PartTemplate::Shape::disc && n.size() == 3 && n[2] <= 0) return "is a disc without area";
  if (kind == PartTemplate::Shape::rectangle && n.size() == 5 && (n[2] <= 0 || n[3] <= 0))
    return "is a rectangle without area";
  return nullptr;
}

}  // namespace

// Shapes that are given for it take the place of those of the parts. A part of negative mass is a hole: its outline.
template <class S>
void ModelBuilder<S>::add_shapes(int body, const BodyTemplate& source) {
  const bool given = source.drawn > 0;
  const std::vector<PartTemplate>& list = given ? scene_.drawn : scene_.parts;
  const std::uint32_t first = given ? source.first_drawn : source.first_part;
  const std::uint32_t count = given ? source.drawn : source.parts;
  for (std::uint32_t k = first; k < first + count; ++k) {
    const PartTemplate& part = list[k];
    std::vector<double> numbers;
    for (const NumberValue& number : part.numbers) numbers.push_back(value_of(value(number)));
    if (const char* wrong = unseen(part.shape, numbers); given && wrong && !known_wrong(part.offset)) {
      report(part.offset, fmt::format("a drawn shape of body {} {}", in_quotes(model_.body_name(body)), wrong));
      continue;
    }
    BodyShape shape = shape_of(part.shape, numbers);
    if (shape.points.empty()) continue;
    shape.body = body;
    const Vec2<S> origin = body < 0 ? Vec2<S>{} : model_.bodies[static_cast<std::size_t>(body)].origin;
    for (Vec2<double>& p : shape.points) p = p + Vec2<double>{value_of(origin.x), value_of(origin.y)};
    if (!given && value_of(value(part.mass)) < 0) {
      shape.closed = false;
      if (shape.radius == 0) shape.points.push_back(shape.points.front());
    }
    model_.shapes.push_back(std::move(shape));
  }
}

// Instantiated member by member: the rest of the class is in other files.
template void ModelBuilder<double>::add_shapes(int, const BodyTemplate&);
template void ModelBuilder<Dual<double, 4>>::add_shapes(int, const BodyTemplate&);

}  // namespace catena
