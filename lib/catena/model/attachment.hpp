// Where an element of any type is attached, read from its fields: the local points on its bodies, and its axis on i.
//
// Reactions and slides need these, whatever the type; the fields' descriptions tell which member is which. Points and
// axes are in the centroidal frames of the bodies, m; for the ground in the ground frame.
#pragma once

#include <tuple>

#include "catena/model/model.hpp"

namespace catena {

template <class S>
struct BasicAttachment {
  int bodies = 0;              ///< 1: absolute, only i counts
  int i = ground, j = ground;  ///< bodies of the model
  Vec2<S> point_i, point_j;
  Vec2<S> axis_i{S(1.0), S(0.0)};  ///< the frame's own axis where the element has none
  bool has_axis = false;
};
using Attachment = BasicAttachment<double>;

template <class Entry>
auto attachment_of(const Entry& entry) {
  using E = typename Entry::Element;
  using S = typename Entry::Scalar;
  BasicAttachment<S> a;
  a.bodies = E::bodies;
  a.i = entry.i;
  a.j = entry.j;
  const auto take = [&]<class Field>(const Field& field) {
    constexpr bool attaches = requires(Entry & e) {
      e.element.*field.member = Vec2<S>{};
      field.body;
    };
    if constexpr (attaches) {
      const Vec2<S>& value = entry.element.*field.member;
      if constexpr (requires { field.required; }) {
        if (field.body == 0) {
          a.axis_i = value;
          a.has_axis = true;
        }
      } else {
        (field.body == 0 ? a.point_i : a.point_j) = value;
      }
    }
  };
  std::apply([&](const auto&... field) { (take(field), ...); }, E::fields());
  return a;
}

/// Calls f(entry) for an element of the model's list, be it a constraint or a force.
template <class S, class F>
void with_entry(const BasicModel<S>& model, int element, F&& f) {
  const ElementRecord& record = model.elements[static_cast<std::size_t>(element)];
  const auto take = [&](const auto& list) { f(list[static_cast<std::size_t>(record.index)]); };
  if (record.kind == ElementKind::force) {
    with_list(model.forces, record.type, take);
  } else {
    with_list(model.constraints, record.type, take);
  }
}

/// The same for an element of the model's list, be it a constraint or a force; S is double or DesignScalar.
template <class S>
BasicAttachment<S> attachment_of(const BasicModel<S>& model, int element);

}  // namespace catena
