#include "catena/drawing/shapes/pen.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

template <class Entry>
void draw_element(DrawingBuilder& builder, const Entry& entry, int number, bool driver) {
  using E = typename Entry::Element;
  // An element with one body acts between it and the ground, as its second body.
  Pen pen(builder, number, entry.i, E::bodies == 1 ? ground : entry.j, driver);
  if constexpr (requires { entry.element.draw(pen); }) {
    entry.element.draw(pen);
  } else if constexpr (requires { entry.element.s_i, entry.element.s_j; }) {
    pen.tie(entry.element.s_i, entry.element.s_j);
  }
}

}  // namespace

Drawing draw_model(const Model& model) {
  DrawingBuilder builder(model);
  for (int number = 0; number < static_cast<int>(model.elements.size()); ++number) {
    const ElementRecord& record = model.elements[static_cast<std::size_t>(number)];
    const auto index = static_cast<std::size_t>(record.index);
    const auto draw = [&](const auto& list) {
      draw_element(builder, list[index], number,
                   record.kind == ElementKind::driver || record.kind == ElementKind::force);
    };
    if (record.kind == ElementKind::force) {
      with_list(model.forces, record.type, draw);
    } else {
      with_list(model.constraints, record.type, draw);
    }
  }
  return builder.finish();
}

}  // namespace catena
