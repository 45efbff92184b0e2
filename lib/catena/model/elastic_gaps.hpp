// A model whose elastic cables and ropes are one-sided elements with a stiffness in place of forces.
//
//   f = k max(l - L, 0)       the same as       gap g = L - l,  pressed by k (-g) while g < 0
//
// Motions follow one-sided elements phase by phase (analysis/dynamics/contact_phases.hpp): a step then ends where a
// cable becomes taut or slack, as derivatives along the motion ask for. Elements keep their numbers and names; of a
// rope the first piece becomes the gap, the others its parts. Units: m, N/m. Source: elements/forces/elastic_cable.hpp,
// elastic_rope.hpp.
#pragma once

#include <memory>
#include <tuple>
#include <type_traits>
#include <vector>

#include "catena/model/model.hpp"

namespace catena {

/// Whether there are any, and all of them may be gaps: not where a law of state looks at one, whose force it takes for
/// that of a spring, nor ropes that rub on their pulleys.
bool may_have_elastic_gaps(const Model& model);

/// Whether an element is one of these, or a part of one: it acts as a force does.
template <class E, class S>
bool is_elastic_gap(const BasicModel<S>& model, const ElementEntry<E, S>& entry) {
  if constexpr (std::is_same_v<E, Cable<S>> || std::is_same_v<E, Rope<S>>) {
    return value_of(entry.element.k) > 0;
  } else if constexpr (std::is_same_v<E, RopePart<S>>) {
    const auto& ropes = std::get<std::vector<ElementEntry<Rope<S>, S>>>(model.constraints);
    const auto head = static_cast<std::size_t>(entry.element.head);
    return value_of(ropes[static_cast<std::size_t>(model.elements[head].index)].element.k) > 0;
  } else {
    static_cast<void>(model);
    static_cast<void>(entry);
    return false;
  }
}
bool is_elastic_gap(const Model& model, int element);

template <class S>
std::shared_ptr<const BasicModel<S>> with_elastic_gaps(const BasicModel<S>& model);

extern template std::shared_ptr<const BasicModel<double>> with_elastic_gaps(const BasicModel<double>&);
extern template std::shared_ptr<const BasicModel<Dual<double, 4>>> with_elastic_gaps(
    const BasicModel<Dual<double, 4>>&);

}  // namespace catena
