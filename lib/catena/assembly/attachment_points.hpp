// Where an element is attached, read from its fields: local coordinates on its bodies, places in the ground.
#pragma once

#include <tuple>

#include "catena/model/element_lists.hpp"

namespace catena {

// Calls f(local point, body) for every attachment point of an element.
template <class E, class F>
void visit_points(const ElementEntry<E, double>& entry, F&& f) {
  std::apply(
      [&](const auto&... field) {
        (
            [&] {
              if constexpr (requires { field.body; }) {
                if constexpr (
                    requires { entry.element.*field.member + Vec2<double>{}; } && !requires { field.required; }) {
                  f(entry.element.*field.member, field.body == 0 ? entry.i : entry.j);
                }
              }
            }(),
            ...);
      },
      E::fields());
}

}  // namespace catena
