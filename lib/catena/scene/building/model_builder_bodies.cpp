// ModelBuilder: bodies and their points.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "catena/scene/building/body_composition.hpp"
#include "catena/scene/building/model_builder.hpp"

namespace catena {

template <class S>
void ModelBuilder<S>::add_body(const BodyTemplate& source) {
  if (!make_name(source.name, name_)) return;
  std::array<S, body_numbers> v{};
  std::array<std::size_t, body_numbers> offset{};
  std::uint32_t next = source.first_number;
  for (std::size_t k = 0; k < body_numbers; ++k) {
    if (!((source.given >> k) & 1)) continue;
    const NumberValue& number = scene_.numbers[next++];
    v[k] = value(number);
    offset[k] = number.offset();
  }
  const auto get = [&](BodyNumber n) -> const S& { return v[static_cast<std::size_t>(n)]; };
  const auto pair = [&](BodyNumber n) { return Vec2<S>{get(n), v[static_cast<std::size_t>(n) + 1]}; };
  for (const BodyNumber n : {BodyNumber::mass, BodyNumber::inertia}) {
    if (value_of(get(n)) < 0) {
      report(offset[static_cast<std::size_t>(n)],
             fmt::format("\"{}\" of body {} may not be negative; it is {}", n == BodyNumber::mass ? "mass" : "inertia",
                         in_quotes(name_), value_of(get(n))));
    }
  }

  BasicBody<S> body;
  body.has_mass = source.has(BodyNumber::mass);
  body.has_inertia = source.has(BodyNumber::inertia);
  body.mass = get(BodyNumber::mass);
  body.inertia = get(BodyNumber::inertia);
  Vec2<S> position = pair(BodyNumber::position_x), centroid = pair(BodyNumber::centroid_x);
  body.angle = get(BodyNumber::angle);
  S half{};
  const bool rod = source.has(BodyNumber::from_x);
  if (rod) {
    const Vec2<S> from = pair(BodyNumber::from_x), to = pair(BodyNumber::to_x), along = to - from;
    if (value_of(along.x) == 0 && value_of(along.y) == 0) {
      report(offset[static_cast<std::size_t>(BodyNumber::from_x)],
             fmt::format("the rod of body {} has no length: its ends coincide", in_quotes(name_)));
    } else {
      using std::atan2;
      half = norm(along) * S(0.5);
      body.angle = atan2(along.y, along.x);
      // The inertia of a rod with a given centroid is not known unless it is given.
      if (!body.has_inertia && !source.has(BodyNumber::centroid_x)) {
        body.inertia = body.mass * half * half / S(3.0);
        body.has_inertia = body.has_mass;
      }
    }
    position = (from + to) * S(0.5);
  }
  if (source.parts > 0) compose(source, name_, body, centroid);
  body.origin = -centroid;
  body.position = make_frame(position.x, position.y, body.angle).point(centroid);
  body.velocity_given = source.has(BodyNumber::velocity_x);
  body.velocity = pair(BodyNumber::velocity_x);
  body.angular_velocity_given = source.has(BodyNumber::angular_velocity);
  body.angular_velocity = get(BodyNumber::angular_velocity);
  body.fixed = source.fixed;
  body.particle = source.particle;
  body.hold_x = source.hold_x;
  body.hold_y = source.hold_y;
  body.hold_angle = source.hold_angle;
  if (name_.empty()) return;  // reported by the reader
  int number = 0;
  try {
    number = model_.append_body(name_, body);
  } catch (const ModelError&) {
    report_used_name(source.name, name_);
    return;
  }
  name_offset_.push_back(source.name.offset);
  if (rod) {
    if (std::isinf(value_of(half))) report(source.offset, "the rod is too long for double precision");
    const S end = std::isfinite(value_of(half)) ? half : S(0.0);
    model_.add_point(number, "from", {-end, S{}});
    model_.add_point(number, "to", {end, S{}});
  }
  add_points(number, source);
}

template <class S>
void ModelBuilder<S>::compose(const BodyTemplate& source, std::string_view name, BasicBody<S>& body,
                              Vec2<S>& centroid) {
  BodyComposition<S> sum;
  std::vector<S> numbers;
  for (std::uint32_t k = source.first_part; k < source.first_part + source.parts; ++k) {
    const PartTemplate& part = scene_.parts[k];
    numbers.clear();
    for (const NumberValue& number : part.numbers) numbers.push_back(value(number));
    if (const char* wrong = sum.add(part.shape, value(part.mass), numbers); wrong && !known_wrong(part.offset)) {
      report(part.offset, fmt::format("a part of body {} {}", in_quotes(name), wrong));
    }
  }
  if (value_of(sum.mass()) <= 0) {
    report(scene_.parts[source.first_part].offset,
           fmt::format("the parts of body {} have no mass together", in_quotes(name)));
  }
  body.mass = sum.mass();
  body.inertia = sum.inertia();
  body.has_mass = body.has_inertia = true;
  centroid = sum.centroid();
}

template <class S>
void ModelBuilder<S>::add_points(int body, const BodyTemplate& source) {
  for (std::uint32_t k = source.first_point; k < source.first_point + source.points; ++k) {
    const PointTemplate& point = scene_.points[k];
    if (!make_name(point.name, point_name_) || point_name_.empty()) continue;
    if (model_.find_point(body, point_name_)) {
      if (!known_wrong(point.name.offset)) {
        report(point.name.offset, fmt::format("point {} of body {} is given twice", in_quotes(point_name_),
                                              in_quotes(model_.body_name(body))));
      }
      continue;
    }
    // An invalid number was reported; the point keeps its name so that references to it are valid.
    const Vec2<S> local{value(point.x), value(point.y)};
    const bool good = std::isfinite(value_of(local.x)) && std::isfinite(value_of(local.y));
    model_.add_point(body, point_name_, good ? local : Vec2<S>{});
  }
}

// Instantiated member by member: the rest of the class is in other files.
template void ModelBuilder<double>::add_body(const BodyTemplate&);
template void ModelBuilder<double>::add_points(int, const BodyTemplate&);
template void ModelBuilder<Dual<double, 4>>::add_body(const BodyTemplate&);
template void ModelBuilder<Dual<double, 4>>::add_points(int, const BodyTemplate&);

}  // namespace catena
