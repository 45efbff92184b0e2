#include "catena/assembly/systems/seen_mass.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {

std::vector<double> seen_masses(const Plan& plan, std::span<const double> masses, std::span<const double> jacobian) {
  const SparsePattern& a = plan.jacobian;
  const SlottedPattern rows = transpose(a);  // a column a row of Phi_q
  std::vector<double> value(at(a.entries()));
  for (std::size_t k = 0; k < value.size(); ++k) value[at(rows.slot[k])] = jacobian[k];
  std::vector<double> seen(masses.size(), 0.0), compliance(at(plan.rows), 0.0);
  std::vector<int> reached, columns;
  // Contributions of a column with a mass to its rows; rows reached for the first time are noted.
  const auto add = [&](int column, double mass) {
    for (int k = a.column_start[at(column)]; k < a.column_start[at(column) + 1]; ++k) {
      const double entry = jacobian[at(k)];
      if (entry == 0) continue;
      double& sum = compliance[at(a.row_index[at(k)])];
      if (sum == 0) reached.push_back(a.row_index[at(k)]);
      sum += entry * entry / mass;
    }
  };
  for (int c = 0; c < plan.columns; ++c) {
    if (const double mass = masses[at(plan.coordinate[at(c)])]; mass > 0) add(c, mass);
  }
  while (!reached.empty()) {
    columns.clear();
    for (const int row : reached) {
      for (int k = rows.pattern.column_start[at(row)]; k < rows.pattern.column_start[at(row) + 1]; ++k) {
        const int column = rows.pattern.row_index[at(k)], coordinate = plan.coordinate[at(column)];
        const double entry = value[at(k)];
        // A column that an earlier round reached keeps its value.
        if (entry == 0 || masses[at(coordinate)] > 0) continue;
        double& mass = seen[at(coordinate)];
        if (mass == 0) columns.push_back(column);
        if (mass >= 0) mass = std::max(mass, entry * entry / compliance[at(row)]);
      }
    }
    reached.clear();
    // x and y of a body share the larger mass: a row across one direction contains only rounding there.
    for (std::size_t n = 0; n < columns.size(); ++n) {
      const int coordinate = plan.coordinate[at(columns[n])], kind = coordinate % 3;
      if (kind == 2) continue;
      const int other = kind == 0 ? coordinate + 1 : coordinate - 1;
      if (seen[at(other)] == 0 && plan.column[at(other)] >= 0) columns.push_back(plan.column[at(other)]);
      seen[at(coordinate)] = std::max(seen[at(coordinate)], std::abs(seen[at(other)]));
      if (seen[at(other)] >= 0) seen[at(other)] = seen[at(coordinate)];
    }
    // Those of this round are settled; a negative sign marks them.
    for (const int column : columns) {
      double& mass = seen[at(plan.coordinate[at(column)])];
      add(column, mass);
      mass = -mass;
    }
  }
  for (double& mass : seen) mass = std::abs(mass);
  return seen;
}

}  // namespace catena
