// Bodies: from JSON to templates.
#include <fmt/format.h>

#include <array>

#include "catena/scene/describing/body_keys.hpp"
#include "catena/scene/numbers/name_rules.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

/// Numbers of a body that is being read, by BodyNumber.
class Numbers {
 public:
  void set(BodyNumber which, const NumberValue& value) {
    const auto k = static_cast<std::size_t>(which);
    values_[k] = value;
    given_ = static_cast<std::uint16_t>(given_ | 1u << k);
  }
  void set_pair(BodyNumber first, const std::array<NumberValue, 2>& pair) {
    set(first, pair[0]);
    set(static_cast<BodyNumber>(static_cast<int>(first) + 1), pair[1]);
  }
  void store(SceneReading& reading, BodyTemplate& body) const {
    body.given = given_;
    body.first_number = static_cast<std::uint32_t>(reading.scene.numbers.size());
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if ((given_ >> k) & 1) reading.scene.numbers.push_back(values_[k]);
    }
  }

 private:
  std::array<NumberValue, body_numbers> values_;
  std::uint16_t given_ = 0;
};

void read_hold(const JsonValue& value, std::string_view owner, BodyTemplate& body, Diagnostics& diagnostics) {
  const FieldName field{"hold", owner};
  if (!value.is(JsonKind::array)) {
    report(
        value,
        fmt::format("{} must be a list such as [\"x\", \"angle\"]; this is {}", field.text(), describe(value.kind())),
        diagnostics);
    return;
  }
  for (const JsonValue& column : value.elements()) {
    const int word = read_word(column, hold_columns, field, diagnostics);
    if (word == 0) body.hold_x = true;
    if (word == 1) body.hold_y = true;
    if (word == 2) body.hold_angle = true;
  }
}

// The ends of a rod, both given in any case: what is missing is reported.
void read_rod(SceneReading& reading, const JsonValue& rod, const std::string& body_owner, Numbers& given) {
  const std::string owner = "rod of " + body_owner;
  std::array<JsonValue, rod_keys.size()> ends;
  const bool is_rod = read_members(rod, rod_keys, owner, ends, reading.diagnostics);
  for (std::size_t k = 0; k < rod_keys.size(); ++k) {
    const BodyNumber which = k == 0 ? BodyNumber::from_x : BodyNumber::to_x;
    if (is_rod && ends[k]) {
      given.set_pair(which, reading.numbers.read_pair(ends[k], dimension_of(UnitKind::length), {rod_keys[k], owner}));
      continue;
    }
    if (is_rod) reading.error(rod, fmt::format("{} needs {}", owner, in_quotes(rod_keys[k])));
    given.set_pair(which, {});
  }
}

}  // namespace

void SceneReading::point_list(const JsonValue& value, BodyTemplate& body, std::string_view owner) {
  body.first_point = static_cast<std::uint32_t>(scene.points.size());
  if (!value.is(JsonKind::object)) {
    error(value, fmt::format("{} must be an object of names and places [x', y']; this is {}",
                             FieldName{"points", owner}.text(), describe(value.kind())));
    return;
  }
  for (const JsonMember member : value.members()) {
    PointTemplate point;
    point.name = name(member.key);
    const std::string text = sample(point.name);
    if (!point.name.empty() || member.name().empty()) {
      if (const std::string problem = point_name_problem(text); !problem.empty()) error(member.key, problem);
    }
    const auto place =
        numbers.read_pair(member.value, ExpectedDimension(dimension_of(UnitKind::length)), {member.name(), owner});
    point.x = place[0];
    point.y = place[1];
    scene.points.push_back(point);
    ++body.points;
  }
}

void SceneReading::corners(const JsonValue& list, std::size_t least, const FieldName& field, PartTemplate& part) {
  if (!list.is(JsonKind::array) || list.size() < least) {
    error(list,
          fmt::format("{} must be a list of at least {} corners [x', y']", field.text(), least == 2 ? "two" : "three"));
    return;
  }
  for (const JsonValue& corner : list.elements()) {
    const auto place = numbers.read_pair(corner, ExpectedDimension(dimension_of(UnitKind::length)), field);
    part.numbers.insert(part.numbers.end(), place.begin(), place.end());
  }
}

bool SceneReading::shape(const JsonValue& rectangle, const JsonValue& disc, const JsonValue& polygon,
                         const std::string& owner, PartTemplate& part) {
  using Shape = PartTemplate::Shape;
  const auto read = [&](const JsonValue& value, UnitKind unit, std::string_view key, std::string_view of, bool required,
                        const JsonValue& whole) {
    if (!value && required) error(whole, fmt::format("{} needs {}", of, in_quotes(key)));
    part.numbers.push_back(value      ? numbers.read(value, unit, {key, of})
                           : required ? NumberValue()
                                      : NumberValue::constant(0));
  };
  const auto read_place = [&](const JsonValue& value, std::string_view key, std::string_view of) {
    std::array<NumberValue, 2> place{NumberValue::constant(0), NumberValue::constant(0)};
    if (value) place = numbers.read_pair(value, dimension_of(UnitKind::length), {key, of});
    part.numbers.insert(part.numbers.end(), place.begin(), place.end());
  };
  if (rectangle) {
    part.shape = Shape::rectangle;
    const std::string of = "rectangle in " + owner;
    std::array<JsonValue, rectangle_keys.size()> r;
    if (!read_members(rectangle, rectangle_keys, of, r, diagnostics)) return true;
    read_place(r[0], rectangle_keys[0], of);
    read(r[1], UnitKind::length, rectangle_keys[1], of, true, rectangle);
    read(r[2], UnitKind::length, rectangle_keys[2], of, true, rectangle);
    read(r[3], UnitKind::angle, rectangle_keys[3], of, false, rectangle);
  } else if (disc) {
    part.shape = Shape::disc;
    const std::string of = "disc in " + owner;
    std::array<JsonValue, disc_keys.size()> d;
    if (!read_members(disc, disc_keys, of, d, diagnostics)) return true;
    read_place(d[0], disc_keys[0], of);
    read(d[1], UnitKind::length, disc_keys[1], of, true, disc);
  } else if (polygon) {
    part.shape = Shape::polygon;
    corners(polygon, 3, {"polygon", owner}, part);
  } else {
    return false;
  }
  return true;
}

void SceneReading::part(const JsonValue& object, std::string_view body_owner) {
  PartTemplate part;
  part.offset = static_cast<std::uint32_t>(object.offset());
  const std::string owner = "a part of " + std::string(body_owner);
  std::array<JsonValue, part_keys.size()> v;
  if (!read_members(object, part_keys, owner, v, diagnostics)) return;
  const auto& [mass, centroid, inertia, rectangle, disc, polygon] = v;
  if (mass) {
    part.mass = numbers.read(mass, UnitKind::mass, {"mass", owner});
  } else {
    error(object, owner + " needs \"mass\"");
  }
  const int shapes = (rectangle ? 1 : 0) + (disc ? 1 : 0) + (polygon ? 1 : 0);
  if (shapes > 1) error(object, owner + " may have only one shape");
  if (shapes > 0 && (centroid || inertia)) {
    error(centroid ? centroid : inertia, fmt::format("{} of {} follows from its shape and may not be given",
                                                     centroid ? "centroid" : "inertia", owner));
  }
  if (!shape(rectangle, disc, polygon, owner, part)) {
    std::array<NumberValue, 2> place{NumberValue::constant(0), NumberValue::constant(0)};
    if (centroid) place = numbers.read_pair(centroid, dimension_of(UnitKind::length), {"centroid", owner});
    part.numbers.assign(place.begin(), place.end());
    part.numbers.push_back(inertia ? numbers.read(inertia, UnitKind::inertia, {"inertia", owner})
                                   : NumberValue::constant(0));
  }
  scene.parts.push_back(std::move(part));
}

void SceneReading::drawn_shapes(const JsonValue& list, std::string_view body_owner, BodyTemplate& body) {
  body.first_drawn = static_cast<std::uint32_t>(scene.drawn.size());
  if (!list.is(JsonKind::array)) {
    error(list, fmt::format("{} must be a list of shapes; this is {}", FieldName{"draw", body_owner}.text(),
                            describe(list.kind())));
    return;
  }
  const std::string owner = "a drawn shape of " + std::string(body_owner);
  for (const JsonValue& object : list.elements()) {
    PartTemplate part;
    part.offset = static_cast<std::uint32_t>(object.offset());
    std::array<JsonValue, drawn_keys.size()> v;
    if (!read_members(object, drawn_keys, owner, v, diagnostics)) continue;
    const auto& [rectangle, disc, polygon, line] = v;
    const int shapes = (rectangle ? 1 : 0) + (disc ? 1 : 0) + (polygon ? 1 : 0) + (line ? 1 : 0);
    if (shapes != 1) {
      error(object, owner + " must be one of \"rectangle\", \"disc\", \"polygon\", \"line\"");
      continue;
    }
    if (line) {
      part.shape = PartTemplate::Shape::line;
      corners(line, 2, {"line", owner}, part);
    } else {
      shape(rectangle, disc, polygon, owner, part);
    }
    scene.drawn.push_back(std::move(part));
  }
  body.drawn = static_cast<std::uint32_t>(scene.drawn.size()) - body.first_drawn;
}

void SceneReading::ground_body(const JsonValue& value) {
  std::array<JsonValue, ground_keys.size()> v;
  if (!read_members(value, ground_keys, "the ground", v, diagnostics)) return;
  if (v[0]) point_list(v[0], scene.ground, "the ground");
  if (v[1]) drawn_shapes(v[1], "the ground", scene.ground);
}

void SceneReading::body(const JsonMember& member, BlockTemplate& block) {
  if (member.name() == "ground") return ground_body(member.value);
  BodyTemplate body;
  body.offset = static_cast<std::uint32_t>(member.value.offset());
  body.name = name(member.key);
  if (!body.name.empty() || member.name().empty()) {
    if (const std::string problem = element_name_problem(sample(body.name)); !problem.empty())
      error(member.key, problem);
  }
  const std::string owner = "body " + in_quotes(member.name());
  std::array<JsonValue, body_keys.size()> v;
  if (!read_members(member.value, body_keys, owner, v, diagnostics)) {
    block.bodies.push_back(body);
    return;
  }
  const auto& [mass, inertia, position, angle, velocity, angular_velocity, points, centroid, parts, rod, fixed,
               particle, hold, draw] = v;
  Numbers given;
  const auto number = [&](const JsonValue& value, BodyNumber which, UnitKind unit, std::string_view key) {
    if (value) given.set(which, numbers.read(value, unit, {key, owner}));
  };
  const auto pair = [&](const JsonValue& value, BodyNumber which, UnitKind unit, std::string_view key) {
    if (value) given.set_pair(which, numbers.read_pair(value, dimension_of(unit), {key, owner}));
  };
  number(mass, BodyNumber::mass, UnitKind::mass, "mass");
  number(inertia, BodyNumber::inertia, UnitKind::inertia, "inertia");
  pair(position, BodyNumber::position_x, UnitKind::length, "position");
  number(angle, BodyNumber::angle, UnitKind::angle, "angle");
  pair(velocity, BodyNumber::velocity_x, UnitKind::velocity, "velocity");
  number(angular_velocity, BodyNumber::angular_velocity, UnitKind::angular_velocity, "angular_velocity");
  pair(centroid, BodyNumber::centroid_x, UnitKind::length, "centroid");
  if (points) point_list(points, body, owner);
  if (parts) {
    part_list(parts, owner, body);
    if (const JsonValue& excluded = mass ? mass : inertia ? inertia : centroid)
      error(excluded,
            fmt::format("mass, inertia and centroid of {} follow from its parts and may not be given", owner));
  }
  if (rod) {
    read_rod(*this, rod, owner, given);
    if (position || angle)
      error(position ? position : angle,
            fmt::format("{} of {} follows from its rod and may not be given", position ? "position" : "angle", owner));
  }
  if (fixed) body.fixed = read_flag(fixed, {"fixed", owner}, diagnostics);
  if (particle) body.particle = read_flag(particle, {"particle", owner}, diagnostics);
  if (hold) read_hold(hold, owner, body, diagnostics);
  if (draw) drawn_shapes(draw, owner, body);
  given.store(*this, body);
  block.bodies.push_back(body);
}

void SceneReading::part_list(const JsonValue& parts, const std::string& owner, BodyTemplate& body) {
  body.first_part = static_cast<std::uint32_t>(scene.parts.size());
  if (!parts.is(JsonKind::array) || parts.size() == 0) {
    error(parts, FieldName{"parts", owner}.text() + " must be a list of parts");
  } else {
    for (const JsonValue& object : parts.elements()) part(object, owner);
  }
  body.parts = static_cast<std::uint32_t>(scene.parts.size()) - body.first_part;
}

}  // namespace catena
