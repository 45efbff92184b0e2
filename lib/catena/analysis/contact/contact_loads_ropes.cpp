// ContactLoads: grips of ropes without stiffness.
#include <cmath>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/base/at.hpp"

namespace catena {

// h of a grip that slides: f = -h T_before.
double ContactLoads::growth(std::size_t k) const {
  return -std::expm1(states_[k].tied ? states_[k].held : -states_[k].direction * exponent_[k]);
}

// T_k-1 of a grip of an inextensible rope: what the grips between it and the end i add is theirs in these multipliers.
double ContactLoads::tension_before(std::size_t k, std::span<const double> lambda) const {
  const Plan& plan = evaluator_.plan();
  const int head = plan.element_row[at(points_[k].element)];
  double tension = head < 0 ? 0 : -lambda[at(head)];
  for (const std::size_t other : points_[k].rope->grips) {
    if (other >= k) break;
    if (slides(other)) {
      tension *= 1 - growth(other);
    } else if (const int row = row_of_slide(other); row >= 0) {
      tension -= lambda[at(row)];
    }
  }
  return tension;
}

// How it changes with the friction of a place, that makes the multipliers `along`.
double ContactLoads::tension_slope(std::size_t k, std::span<const double> along, std::size_t sliding) const {
  double slope = -along[at(evaluator_.plan().element_row[at(points_[k].element)])];
  for (const std::size_t other : points_[k].rope->grips) {
    if (other >= k) break;
    if (slides(other)) {
      slope += other == sliding ? 1 : 0;
    } else if (const int row = row_of_slide(other); row >= 0) {
      slope -= along[at(row)];
    }
  }
  return slope;
}

int ContactLoads::row_of_slide(std::size_t k) const { return evaluator_.plan().element_row[at(points_[k].slide)]; }

}  // namespace catena
