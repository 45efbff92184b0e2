// Definitions of ModelBuilder: expansion, bodies, attachments. Included by the files that instantiate it.
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "catena/scene/body_composition.hpp"
#include "catena/scene/element_description.hpp"
#include "catena/scene/model_builder.hpp"
#include "catena/scene/near_miss.hpp"

namespace catena {

template <class S>
BasicModel<S> ModelBuilder<S>::build() {
  model_.gravity = {value(scene_.gravity[0]), value(scene_.gravity[1])};
  if (!count_elements()) return std::move(model_);
  add_points(ground, scene_.ground);
  visit(scene_.root, Pass::bodies);
  visit(scene_.root, Pass::elements);
  return std::move(model_);
}

// ---- Messages and names

template <class S>
void ModelBuilder<S>::report(std::size_t offset, const std::string& message, std::size_t position) {
  report_evaluation(*scene_.source, offset, position, message, evaluation_.loop_names(), evaluation_.loop_values(),
                    diagnostics_);
}

template <class S>
std::string ModelBuilder<S>::owner(const ElementTemplate& element) const {
  const std::string_view type = element_descriptions()[static_cast<std::size_t>(element.type)].type;
  if (element.name.empty()) return std::string(type);
  std::string name(element.name.text);
  if (element.name.pattern >= 0) {
    name.clear();
    evaluation_.append_name(scene_.patterns[static_cast<std::size_t>(element.name.pattern)], element.name.offset, name);
  }
  return fmt::format("{} {}", type, in_quotes(name));
}

template <class S>
bool ModelBuilder<S>::make_name(const NameText& name, std::string& out) {
  out.clear();
  if (name.pattern < 0) {
    out = name.text;
    return true;
  }
  return evaluation_.append_name(scene_.patterns[static_cast<std::size_t>(name.pattern)], name.offset, out);
}

/// Whether a body or element may take the name; reports it if not.
template <class S>
bool ModelBuilder<S>::free_name(const NameText& text, std::string_view name) {
  const int number = model_.names.find(name);
  if (number < 0) return true;
  if (known_wrong(text.offset)) return false;
  const int target = model_.name_target[static_cast<std::size_t>(number)];
  const TextPlace first = scene_.source->place(name_offset_[static_cast<std::size_t>(number)]);
  report(text.offset, fmt::format("the name {} is used twice: {} in line {} has it already", in_quotes(name),
                                  target >= 0 ? "a body" : "an element", first.line));
  return false;
}

template <class S>
bool ModelBuilder<S>::name_element(const ElementTemplate& element, std::string& out) {
  if (element.name.empty()) return true;
  return make_name(element.name, out) && free_name(element.name, out);
}

// ---- Repeated blocks

template <class S>
std::int64_t ModelBuilder<S>::integer(const NumberValue& number, std::string_view what) {
  const double value = value_of(this->value(number));
  if (std::isnan(value)) return 0;
  if (value != std::round(value) || std::abs(value) > 9e15) {
    report(number.offset(), fmt::format("\"{}\" of a replicate block must be a whole number; it is {}", what, value));
    return 0;
  }
  return static_cast<std::int64_t>(value);
}

template <class S>
bool ModelBuilder<S>::count_block(const BlockTemplate& block, std::int64_t& bodies, std::int64_t& elements) {
  const std::int64_t count = integer(block.count, "count");
  if (count < 0) report(block.count.offset(), fmt::format("\"count\" of a replicate block is {}", count));
  if (count <= 0) return true;
  const auto too_many = [&] {
    if (bodies + elements <= options_.max_elements) return false;
    report(block.count.offset(),
           fmt::format("this scene has more than {} bodies and elements; --max-elements N allows more",
                       options_.max_elements));
    return true;
  };
  const auto own_bodies = static_cast<std::int64_t>(block.bodies.size());
  const auto own_elements = static_cast<std::int64_t>(block.elements.size());
  if (count > options_.max_elements / std::max<std::int64_t>(1, own_bodies + own_elements)) {
    bodies += options_.max_elements + 1;
    if (own_bodies + own_elements > 0 || !block.blocks.empty()) return !too_many();
    return true;  // an empty block
  }
  bodies += count * own_bodies;
  elements += count * own_elements;
  if (block.blocks.empty()) return !too_many();
  evaluation_.enter_block(block.variable);
  const std::int64_t first = integer(block.first, "first");
  bool good = true;
  for (std::int64_t k = 0; good && k < count; ++k) {
    evaluation_.set_variable(static_cast<double>(first + k));
    for (const BlockTemplate& nested : block.blocks) good = good && count_block(nested, bodies, elements);
  }
  evaluation_.leave_block();
  return good && !too_many();
}

template <class S>
bool ModelBuilder<S>::count_elements() {
  auto bodies = static_cast<std::int64_t>(scene_.root.bodies.size());
  auto elements = static_cast<std::int64_t>(scene_.root.elements.size());
  for (const BlockTemplate& block : scene_.root.blocks) {
    if (!count_block(block, bodies, elements)) return false;
  }
  if (bodies + elements > options_.max_elements) {
    report(0, fmt::format("this scene has {} bodies and elements, more than {}; --max-elements N allows more",
                          bodies + elements, options_.max_elements));
    return false;
  }
  model_.bodies.reserve(static_cast<std::size_t>(bodies));
  model_.elements.reserve(static_cast<std::size_t>(elements));
  return true;
}

template <class S>
void ModelBuilder<S>::visit(const BlockTemplate& block, Pass pass) {
  using Section = BlockTemplate::Section;
  for (const Section& section : block.sections) {
    for (std::uint32_t k = section.first; k < section.last; ++k) {
      if (section.kind == Section::Kind::blocks) {
        repeat(block.blocks[k], pass);
      } else if (section.kind == Section::Kind::bodies && pass == Pass::bodies) {
        add_body(block.bodies[k]);
      } else if (section.kind == Section::Kind::elements && pass == Pass::elements) {
        add_element(block.elements[k]);
      }
    }
  }
}

template <class S>
void ModelBuilder<S>::repeat(const BlockTemplate& block, Pass pass) {
  const std::int64_t count = integer(block.count, "count"), first = integer(block.first, "first");
  evaluation_.enter_block(block.variable);
  for (std::int64_t k = 0; k < count && !diagnostics_.full(); ++k) {
    evaluation_.set_variable(static_cast<double>(first + k));
    visit(block, pass);
  }
  evaluation_.leave_block();
}

// ---- Bodies

template <class S>
void ModelBuilder<S>::add_body(const BodyTemplate& source) {
  if (!make_name(source.name, name_) || !free_name(source.name, name_)) return;
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
      // Of a rod whose centroid is elsewhere only its author knows the inertia.
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
  const int number = model_.append_body(name_, body);
  remember_name(source.name);
  if (rod) {
    model_.add_point(number, "from", {-half, S{}});
    model_.add_point(number, "to", {half, S{}});
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
    if (!make_name(point.name, point_name_)) continue;
    if (model_.find_point(body, point_name_)) {
      if (!known_wrong(point.name.offset)) {
        report(point.name.offset, fmt::format("point {} of body {} is given twice", in_quotes(point_name_),
                                              in_quotes(model_.body_name(body))));
      }
      continue;
    }
    model_.add_point(body, point_name_, {value(point.x), value(point.y)});
  }
}

// ---- Elements

template <class S>
void ModelBuilder<S>::report_missing_body(const NameText& text, std::string_view name) {
  if (known_wrong(text.offset)) return;
  std::string message = fmt::format("there is no body {}", in_quotes(name));
  if (const int element = model_.find_element(name); element >= 0) {
    message += fmt::format(": that is a {}", model_.element_type(element));
  } else if (searches_++ < 10 || model_.names.size() < 10000) {
    NearMiss near(name);
    near.consider("ground");
    for (const auto& body : model_.bodies) near.consider(model_.names[body.name]);
    message += near.hint();
  }
  report(text.offset, message, text.position);
}

template <class S>
bool ModelBuilder<S>::attach(const ElementTemplate& source, int end, const Vec2<S>* place, int& body, Vec2<S>& local) {
  using Form = AttachmentTemplate::Form;
  const AttachmentTemplate& attachment = source.attachment[end];
  body = ground;
  local = {};
  if (attachment.form == Form::absent) return true;
  if (attachment.body.pattern < 0) {
    body = model_.find_body(attachment.body.text);
  } else {
    if (!make_name(attachment.body, name_)) return false;
    body = model_.find_body(name_);
  }
  if (body < ground) {
    report_missing_body(attachment.body, attachment.body.pattern < 0 ? attachment.body.text : std::string_view(name_));
    return false;
  }
  const Vec2<S> origin = body < 0 ? Vec2<S>{} : model_.bodies[static_cast<std::size_t>(body)].origin;
  local = origin;
  if (place) {
    const Frame<S> frame = model_.frame(body);
    local = frame.to_local(*place - frame.origin());
  } else if (attachment.form == Form::point) {
    if (!make_name(attachment.point, point_name_)) return false;
    if (const Vec2<S>* point = model_.find_point(body, point_name_)) {
      local = *point;
      return true;
    }
    if (known_wrong(attachment.point.offset)) return false;
    NearMiss near(point_name_);
    int k = body < 0 ? model_.first_ground_point : model_.bodies[static_cast<std::size_t>(body)].first_point;
    for (; k >= 0; k = model_.points[static_cast<std::size_t>(k)].next)
      near.consider(model_.point_names[model_.points[static_cast<std::size_t>(k)].name]);
    report(attachment.point.offset,
           fmt::format("{} has no point {}{}", body < 0 ? "the ground" : "body " + in_quotes(model_.body_name(body)),
                       in_quotes(point_name_), near.hint()),
           attachment.point.position);
    return false;
  }
  return true;
}

template <class S>
void ModelBuilder<S>::add_element(const ElementTemplate& source) {
  const ElementDescription& type = element_descriptions()[static_cast<std::size_t>(source.type)];
  Vec2<S> place;
  if (source.has_at) place = pair(source.first_number + static_cast<std::uint32_t>(type.slots));
  int bodies[2] = {ground, ground};
  Vec2<S> points[2];
  bool good = true, complete = true;
  for (int end = 0; end < type.bodies; ++end) {
    const bool absent = source.attachment[end].form == AttachmentTemplate::Form::absent;
    if (absent && (end == 0 || !type.second_body_optional)) complete = false;  // reported by the reader
    good = attach(source, end, source.has_at ? &place : nullptr, bodies[end], points[end]) && good;
    if (!good || absent || source.attachment[end].form != AttachmentTemplate::Form::local) continue;
    for (const FieldDescription& field : type.fields) {
      if (field.kind == FieldKind::point && field.body == end)
        points[end] += pair(source.first_number + static_cast<std::uint32_t>(field.slot));
    }
  }
  if (!good || !complete) return;
  if (type.bodies == 1 && bodies[0] == ground) {
    if (!known_wrong(source.offset))
      report(source.offset, owner(source) + " acts on a body: \"i\" may not be the ground");
    return;
  }
  if (type.bodies == 2 && bodies[0] == bodies[1]) {
    if (!known_wrong(source.offset)) {
      report(source.offset,
             fmt::format("{} ties {} to itself", owner(source),
                         bodies[0] < 0 ? "the ground" : "body " + in_quotes(model_.body_name(bodies[0]))));
    }
    return;
  }
  element_filler<S>(source.type)(*this, source, bodies, points);
}

// ---- Functions, curves, tables

template <class S>
TimeFunction<S> ModelBuilder<S>::function(const FunctionTemplate& source) {
  using Kind = FunctionTemplate::Kind;
  std::vector<S> n;
  for (const NumberValue& number : source.numbers) n.push_back(value(number));
  // What could not be read or has no value was reported: any function will do.
  for (const S& number : n) {
    if (std::isnan(value_of(number))) return S(1.0);
  }
  std::vector<TimeFunction<S>> parts;
  for (const FunctionTemplate& part : source.parts) parts.push_back(function(part));
  if (n.empty() && parts.empty()) return S(1.0);
  switch (source.kind) {
    case Kind::constant:
      break;
    case Kind::polynomial:
      return TimeFunction<S>::polynomial(n);
    case Kind::harmonic:
      return TimeFunction<S>::harmonic(n[0], n[1], n[2], n[3]);
    case Kind::step:
      return TimeFunction<S>::step(n[0], n[1], n[2], n[3], source.order);
    case Kind::spline:
      return TimeFunction<S>::spline(std::span(n).first(n.size() / 2), std::span(n).last(n.size() / 2), source.end);
    case Kind::sum:
      return TimeFunction<S>::sum(std::move(parts));
    case Kind::product:
      return TimeFunction<S>::product(std::move(parts));
  }
  return n[0];
}

template <class S>
Curve<S> ModelBuilder<S>::curve(const CurveTemplate& source, const Vec2<S>& origin) {
  using Kind = CurveTemplate::Kind;
  std::vector<S> n;
  for (const NumberValue& number : source.numbers) {
    n.push_back(value(number));
    if (std::isnan(value_of(n.back()))) n.clear();
  }
  // What could not be read or has no value was reported: any curve will do.
  const auto any = [] { return Curve<S>::circle({}, S(1.0)); };
  if (n.size() != source.numbers.size() || n.empty()) return any();
  switch (source.kind) {
    case Kind::circle:
      return Curve<S>::circle(Vec2<S>{n[0], n[1]} + origin, n[2]);
    case Kind::spline: {
      std::vector<Vec2<S>> points;
      for (std::size_t k = 0; k + 1 < n.size(); k += 2) points.push_back(Vec2<S>{n[k], n[k + 1]} + origin);
      return Curve<S>::spline(points, source.end);
    }
    case Kind::polar:
      if (value_of(origin.x) != 0 || value_of(origin.y) != 0)
        throw std::invalid_argument("a polar curve needs a body whose origin is its centroid");
      return Curve<S>::polar(std::span(n).first(n.size() / 2), std::span(n).last(n.size() / 2));
    case Kind::line:
      return Curve<S>::line(Vec2<S>{n[0], n[1]} + origin, {n[2], n[3]});
  }
  return any();
}

template <class S>
std::vector<Vec2<S>> ModelBuilder<S>::table(const TableTemplate& source) {
  std::vector<Vec2<S>> pairs;
  for (std::size_t k = 0; k + 1 < source.numbers.size(); k += 2)
    pairs.push_back({value(source.numbers[k]), value(source.numbers[k + 1])});
  return pairs;
}

}  // namespace catena
