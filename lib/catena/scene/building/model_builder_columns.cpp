// ModelBuilder: the columns that stops bound, and the joints that rub.
#include <fmt/format.h>

#include "catena/elements/all.hpp"
#include "catena/scene/building/model_builder.hpp"
#include "catena/scene/json/near_miss.hpp"

namespace catena {
namespace {

/// Points, axis and quantity of a stop, from the element whose column it bounds; false if it has no such column.
template <class Entry, class S>
bool take_column(const Entry& entry, std::string_view column, ElementEntry<Stop<S>, S>& stop) {
  using E = typename Entry::Element;
  bool has_axis = false;
  const auto take = [&]<class Field>(const Field& field) {
    if constexpr (requires {
                    stop.element.s_i = entry.element.*field.member;
                    field.body;
                  }) {
      if constexpr (requires { field.required; }) {
        if (field.body == 0) {
          stop.element.axis_i = entry.element.*field.member;
          has_axis = true;
        }
      } else {
        (field.body == 0 ? stop.element.s_i : stop.element.s_j) = entry.element.*field.member;
      }
    }
  };
  std::apply([&](const auto&... field) { (take(field), ...); }, E::fields());
  stop.i = entry.i;
  stop.j = entry.j;
  constexpr bool turns = E::type == "revolute" || E::type == "torsion_spring";
  constexpr bool stretches = E::type == "spring_damper" || E::type == "cable";
  if (column == "angle" && turns) {
    stop.element.quantity = StopQuantity::angle;
  } else if (column == "slide" && has_axis && E::bodies == 2) {
    stop.element.quantity = StopQuantity::slide;
  } else if (column == "length" && stretches) {
    stop.element.quantity = StopQuantity::distance;
  } else {
    return false;
  }
  return true;
}

}  // namespace

template <class S>
bool ModelBuilder<S>::find_column(const ElementTemplate& source, ElementEntry<Stop<S>, S>& stop) {
  const NameText& text = source.attachment[0].body;
  std::string column;
  // An attachment without a form was not a text, which was reported.
  if (source.attachment[0].form == AttachmentTemplate::Form::absent || !make_name(text, column)) return false;
  const std::size_t dot = column.find('.');
  const std::string_view head = std::string_view(column).substr(0, dot);
  const std::string_view rest =
      dot == std::string::npos ? std::string_view() : std::string_view(column).substr(dot + 1);
  const auto wrong = [&](const std::string& message) {
    if (!known_wrong(text.offset)) report(text.offset, owner(source) + ": " + message);
    return false;
  };
  if (const int body = model_.find_body(head); body >= 0) {
    // A coordinate of a body, measured from the ground.
    const std::size_t last = rest.rfind('.');
    const std::string_view coordinate = last == std::string_view::npos ? rest : rest.substr(last + 1);
    const Vec2<S>* point = nullptr;
    if (last != std::string_view::npos) {
      point = model_.find_point(body, rest.substr(0, last));
      if (!point)
        return wrong(fmt::format("body {} has no point {}", in_quotes(head), in_quotes(rest.substr(0, last))));
    }
    const bool angle = coordinate == "angle" && !point;
    if (!angle && coordinate != "x" && coordinate != "y")
      return wrong(fmt::format("{} cannot be bounded: of a body a stop bounds x, y or angle, of its points x or y",
                               in_quotes(column)));
    stop.i = ground;
    stop.j = body;
    stop.element.quantity = angle ? StopQuantity::angle : StopQuantity::slide;
    stop.element.axis_i = coordinate == "y" ? Vec2<S>{S(0.0), S(1.0)} : Vec2<S>{S(1.0), S(0.0)};
    stop.element.s_j = point ? *point : model_.bodies[static_cast<std::size_t>(body)].origin;
    return true;
  }
  const int element = model_.find_element(head);
  if (element < 0) {
    NearMiss near(head);
    for (int k = 0; k < model_.names.size() && k < 10000; ++k) near.consider(model_.names[k]);
    return wrong(fmt::format("there is no body, joint or spring {}{}", in_quotes(head), near.hint()));
  }
  bool found = false;
  const ElementRecord& record = model_.elements[static_cast<std::size_t>(element)];
  const auto look = [&](const auto& list) {
    found = take_column(list[static_cast<std::size_t>(record.index)], rest, stop);
  };
  if (record.kind == ElementKind::force) {
    with_list(model_.forces, record.type, look);
  } else {
    with_list(model_.constraints, record.type, look);
  }
  if (found) return true;
  return wrong(
      fmt::format("{} of the {} {} cannot be bounded: a stop bounds the angle of a revolute or torsion_spring, "
                  "the slide along a joint's axis, or the length of a spring_damper or cable",
                  in_quotes(column), model_.element_type(element), in_quotes(head)));
}

template <class S>
bool ModelBuilder<S>::find_column(const ElementTemplate& source, ElementEntry<Friction<S>, S>& friction) {
  const NameText& text = source.attachment[0].body;
  std::string name;
  if (source.attachment[0].form == AttachmentTemplate::Form::absent || !make_name(text, name)) return false;
  const auto wrong = [&](const std::string& message) {
    if (!known_wrong(text.offset)) report(text.offset, owner(source) + ": " + message);
    return false;
  };
  const int element = model_.find_element(name);
  if (element < 0) {
    NearMiss near(name);
    for (int k = 0; k < model_.names.size() && k < 10000; ++k) near.consider(model_.names[k]);
    return wrong(fmt::format("there is no joint {}{}", in_quotes(name), near.hint()));
  }
  bool found = false;
  const ElementRecord& record = model_.elements[static_cast<std::size_t>(element)];
  const auto take = [&](const auto& list) {
    using E = ElementOf<decltype(list)>;
    const auto& entry = list[static_cast<std::size_t>(record.index)];
    if constexpr (std::is_same_v<E, Revolute<S>> || std::is_same_v<E, Translational<S>>) {
      friction.element.s_i = entry.element.s_i;
      friction.element.s_j = entry.element.s_j;
      friction.element.turns = std::is_same_v<E, Revolute<S>>;
      if constexpr (std::is_same_v<E, Translational<S>>) friction.element.axis_i = entry.element.axis_i;
      friction.i = entry.i;
      friction.j = entry.j;
      friction.element.joint = element;
      found = true;
    }
  };
  if (record.kind != ElementKind::force) with_list(model_.constraints, record.type, take);
  if (found) return true;
  return wrong(fmt::format("{} {} has no dry friction: a revolute or translational joint has",
                           model_.element_type(element), in_quotes(name)));
}

template bool ModelBuilder<double>::find_column(const ElementTemplate&, ElementEntry<Friction<double>, double>&);
template bool ModelBuilder<Dual<double, 4>>::find_column(const ElementTemplate&,
                                                         ElementEntry<Friction<Dual<double, 4>>, Dual<double, 4>>&);
template bool ModelBuilder<double>::find_column(const ElementTemplate&, ElementEntry<Stop<double>, double>&);
template bool ModelBuilder<Dual<double, 4>>::find_column(const ElementTemplate&,
                                                         ElementEntry<Stop<Dual<double, 4>>, Dual<double, 4>>&);

}  // namespace catena
