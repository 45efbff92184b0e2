#include "catena/analysis/accuracy/row_terms.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {

template <class Add>
void RowTerms::visit(std::span<const double> jacobian, Add&& add) const {
  const std::vector<int>&start = plan_.jacobian.column_start, &row = plan_.jacobian.row_index;
  for (int c = 0; c < plan_.columns; ++c) {
    const int coordinate = plan_.coordinate[at(c)];
    const bool turns = coordinate % 3 == 2;
    double arm = turns ? radius_[at(coordinate / 3)] : 0;
    for (int k = start[at(c)]; turns && k < start[at(c) + 1]; ++k) {
      if (!plan_.row_is_angle[at(row[at(k)])]) arm = std::max(arm, std::abs(jacobian[at(k)]));
    }
    for (int k = start[at(c)]; k < start[at(c) + 1]; ++k) {
      const int r = row[at(k)];
      add(r, coordinate, turns && !plan_.row_is_angle[at(r)] ? arm : std::abs(jacobian[at(k)]));
    }
  }
}

std::span<double> RowTerms::sum(std::span<const double> jacobian, std::span<const double> moduli,
                                std::span<const double> rates) {
  terms_.assign(at(plan_.rows), 0.0);
  if (!rates.empty()) {
    fastest_.assign(at(plan_.rows), 0.0);
    visit(jacobian, [&](int r, int coordinate, double factor) {
      const double rate = std::abs(rates[at(coordinate)]);
      terms_[at(r)] += factor * rate;
      if (coordinate % 3 == 2) fastest_[at(r)] = std::max(fastest_[at(r)], rate);
    });
    for (std::size_t r = 0; r < terms_.size(); ++r) terms_[r] *= fastest_[r];
  }
  visit(jacobian,
        [&](int r, int coordinate, double factor) { terms_[at(r)] += factor * std::abs(moduli[at(coordinate)]); });
  return terms_;
}

void place_moduli(const Evaluator& evaluator, std::span<const double> q, std::vector<double>& moduli) {
  moduli.assign(q.size(), 0.0);
  for (int p = 0; p < evaluator.plan().moving; ++p) {
    const Vec2<double> origin = evaluator.origin(p);
    const std::size_t k = 3 * at(p);
    moduli[k] = std::abs(q[k]) + std::abs(origin.x);
    moduli[k + 1] = std::abs(q[k + 1]) + std::abs(origin.y);
    moduli[k + 2] = 1 + std::abs(q[k + 2]);
  }
}

}  // namespace catena
