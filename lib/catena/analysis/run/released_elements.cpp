#include "catena/analysis/run/released_elements.hpp"

#include <algorithm>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {

std::vector<int> released_by_events(const Model& model, std::vector<int> elements) {
  std::erase_if(elements, [&](int e) {
    const ElementRecord& record = model.elements[at(e)];
    bool by_itself = record.kind == ElementKind::gap;
    with_list(model.constraints, record.type,
              [&](const auto& list) { by_itself = by_itself || Joining<ElementOf<decltype(list)>>; });
    return by_itself;
  });
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

}  // namespace catena
