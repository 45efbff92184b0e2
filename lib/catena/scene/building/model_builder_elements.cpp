// ModelBuilder: the attachments of elements.
#include <fmt/format.h>

#include "catena/scene/building/model_builder.hpp"
#include "catena/scene/describing/element_description.hpp"
#include "catena/scene/json/near_miss.hpp"

namespace catena {

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
bool ModelBuilder<S>::attach(const AttachmentTemplate& attachment, const Vec2<S>* place, int& body, Vec2<S>& local) {
  using Form = AttachmentTemplate::Form;
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
  if (type.bodies == 0) return element_filler<S>(source.type)(*this, source, bodies, points);
  bool good = true, complete = true;
  for (int end = 0; end < type.bodies; ++end) {
    const bool absent = source.attachment[end].form == AttachmentTemplate::Form::absent;
    if (absent && (end == 0 || !type.second_body_optional)) complete = false;  // reported by the reader
    good = attach(source.attachment[end], source.has_at ? &place : nullptr, bodies[end], points[end]) && good;
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
  if (type.bodies == 2 && bodies[0] == bodies[1] && !type.may_return()) {
    if (!known_wrong(source.offset)) {
      report(source.offset,
             fmt::format("{} ties {} to itself", owner(source),
                         bodies[0] < 0 ? "the ground" : "body " + in_quotes(model_.body_name(bodies[0]))));
    }
    return;
  }
  element_filler<S>(source.type)(*this, source, bodies, points);
}

// Instantiated member by member: the rest of the class is in other files.
template std::string ModelBuilder<double>::owner(const ElementTemplate&) const;
template void ModelBuilder<double>::add_element(const ElementTemplate&);
template std::string ModelBuilder<Dual<double, 4>>::owner(const ElementTemplate&) const;
template void ModelBuilder<Dual<double, 4>>::add_element(const ElementTemplate&);

}  // namespace catena
