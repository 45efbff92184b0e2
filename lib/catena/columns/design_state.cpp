#include "catena/columns/design_state.hpp"

#include <limits>
#include <stdexcept>

#include "catena/columns/column_set.hpp"
#include "catena/columns/reaction_of.hpp"
#include "catena/columns/row_values.hpp"
#include "catena/columns/spring_of.hpp"

namespace catena {

DesignScalar DesignState::without_derivative(double value) {
  DesignScalar scalar(value);
  scalar.d.fill(std::numeric_limits<double>::quiet_NaN());
  return scalar;
}

BasicElementReactions<DesignScalar> DesignState::reactions(int element) const {
  if (plan().is_released(element)) return {};
  const auto first_row = static_cast<std::size_t>(plan().element_row[static_cast<std::size_t>(element)]);
  return reactions_of(*this, element, mechanism_.element_jacobian(element), lambda_.data() + first_row);
}

BasicSpringLoads<DesignScalar> DesignState::spring_loads(int element) const { return spring_loads_of(*this, element); }

void ColumnSet::differentiate(const DesignState& state, std::span<DesignScalar> out) const {
  if (out.size() < columns_.size()) throw std::invalid_argument("columns: there is no room for all values of a row");
  RowValues<DesignState> row(state, own_inputs_);
  for (std::size_t k = 0; k < columns_.size(); ++k) out[k] = row.value(columns_[k]);
}

}  // namespace catena
