#include "catena/model/joint_damping.hpp"

#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {

bool has_damping(const Model& model, int element) {
  const ElementRecord& record = model.elements.at(static_cast<std::size_t>(element));
  bool damped = false;
  if (record.kind == ElementKind::force) return damped;
  with_list(model.constraints, record.type, [&](const auto& list) {
    if constexpr (HasDamping<ElementOf<decltype(list)>>)
      damped = is_damped(list[static_cast<std::size_t>(record.index)].element);
  });
  return damped;
}

}  // namespace catena
