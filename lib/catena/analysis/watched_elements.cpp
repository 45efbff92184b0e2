#include "catena/analysis/watched_elements.hpp"

#include <fmt/format.h>

#include "catena/elements/all.hpp"

namespace catena {

WatchedElements::WatchedElements(const Evaluator& evaluator) : evaluator_(evaluator) {
  for_each_list(evaluator.model().constraints, [&](const auto& list, int) {
    if constexpr (HasTrouble<ElementOf<decltype(list)>>) {
      for (const auto& entry : list) {
        if (evaluator.plan().element_row[static_cast<std::size_t>(entry.id)] >= 0) elements_.push_back(entry.id);
      }
    }
  });
}

Report WatchedElements::check() const {
  Report report;
  for (int element : elements_) {
    const char* trouble = evaluator_.trouble(element);
    if (!trouble) continue;
    const Model& model = evaluator_.model();
    report.status = Status::singular;
    report.message = fmt::format("{} \"{}\" determines nothing at t = {:.12g} s: {}", model.element_type(element),
                                 model.element_name(element), evaluator_.time(), trouble);
    break;
  }
  return report;
}

}  // namespace catena
