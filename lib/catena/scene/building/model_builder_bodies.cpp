// ModelBuilder: bodies and their points.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "catena/scene/building/body_composition.hpp"
#include "catena/scene/building/model_builder.hpp"

namespace catena {

namespace {

/// The numbers of a body that are given, with their places in the scene.
template <class S>
struct BodyNumbers {
  std::array<S, body_numbers> values{};
  std::array<std::size_t, body_numbers> offsets{};

  const S& get(BodyNumber n) const { return values[static_cast<std::size_t>(n)]; }
  Vec2<S> pair(BodyNumber n) const { return {get(n), values[static_cast<std::size_t>(n) + 1]}; }
  std::size_t offset(BodyNumber n) const { return offsets[static_cast<std::size_t>(n)]; }
};

/// The body without its place.
template <class S>
BasicBody<S> body_as_given(const BodyTemplate& source, const BodyNumbers<S>& numbers) {
  BasicBody<S> body;
  body.has_mass = source.has(BodyNumber::mass);
  body.has_inertia = source.has(BodyNumber::inertia);
  body.mass = numbers.get(BodyNumber::mass);
  body.inertia = numbers.get(BodyNumber::inertia);
  body.angle = numbers.get(BodyNumber::angle);
  body.velocity_given = source.has(BodyNumber::velocity_x);
  body.velocity = numbers.pair(BodyNumber::velocity_x);
  body.angular_velocity_given = source.has(BodyNumber::angular_velocity);
  body.angular_velocity = numbers.get(BodyNumber::angular_velocity);
  body.fixed = source.fixed;
  body.particle = source.particle;
  body.hold_x = source.hold_x;
  body.hold_y = source.hold_y;
  body.hold_angle = source.hold_angle;
  return body;
}

/// The middle of a rod, its angle and half its length, which is zero where its ends coincide; its inertia too, unless
/// that is given or its centroid is.
template <class S>
Vec2<S> place_rod(const BodyNumbers<S>& numbers, bool has_centroid, BasicBody<S>& body, S& half) {
  const Vec2<S> from = numbers.pair(BodyNumber::from_x), to = numbers.pair(BodyNumber::to_x), along = to - from;
  if (value_of(along.x) != 0 || value_of(along.y) != 0) {
    using std::atan2;
    half = norm(along) * S(0.5);
    body.angle = atan2(along.y, along.x);
    if (!body.has_inertia && !has_centroid) {
      body.inertia = body.mass * half * half / S(3.0);
      body.has_inertia = body.has_mass;
    }
  }
  return (from + to) * S(0.5);
}

}  // namespace

template <class S>
void ModelBuilder<S>::add_body(const BodyTemplate& source) {
  if (!make_name(source.name, name_)) return;
  BodyNumbers<S> numbers;
  std::uint32_t next = source.first_number;
  for (std::size_t k = 0; k < body_numbers; ++k) {
    if (!((source.given >> k) & 1)) continue;
    const NumberValue& number = scene_.numbers[next++];
    numbers.values[k] = value(number);
    numbers.offsets[k] = number.offset();
  }
  for (const BodyNumber n : {BodyNumber::mass, BodyNumber::inertia}) {
    if (value_of(numbers.get(n)) < 0) {
      report(numbers.offset(n),
             fmt::format("\"{}\" of body {} may not be negative; it is {}", n == BodyNumber::mass ? "mass" : "inertia",
                         in_quotes(name_), value_of(numbers.get(n))));
    }
  }
  BasicBody<S> body = body_as_given(source, numbers);
  Vec2<S> position = numbers.pair(BodyNumber::position_x), centroid = numbers.pair(BodyNumber::centroid_x);
  S half{};
  const bool rod = source.has(BodyNumber::from_x);
  if (rod) {
    position = place_rod(numbers, source.has(BodyNumber::centroid_x), body, half);
    if (value_of(half) == 0)
      report(numbers.offset(BodyNumber::from_x),
             fmt::format("the rod of body {} has no length: its ends coincide", in_quotes(name_)));
  }
  if (source.parts > 0) compose(source, name_, body, centroid);
  body.origin = -centroid;
  body.position = make_frame(position.x, position.y, body.angle).point(centroid);
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
  add_shapes(number, source);
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
