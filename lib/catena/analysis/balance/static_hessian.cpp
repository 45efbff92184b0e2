#include "catena/analysis/balance/static_hessian.hpp"

#include <algorithm>

#include "catena/base/at.hpp"

namespace catena {

StaticHessian::StaticHessian(StaticSystem& system) : system_(system) {
  const Plan& plan = system.plan();
  const KktStructure& structure = system.matrix().structure();
  std::vector<char> written(at(structure.values()), 0);
  for (const auto& list : structure.hessian.constraints) {
    for (int s : list) written[at(s)] = 1;
  }
  for (const auto& list : structure.hessian.forces) {
    for (int s : list) written[at(s)] = 1;
  }
  // The stiffness against turning is kept by body and belongs on the diagonal.
  for (int b = 0; b < plan.moving; ++b) {
    const int c = plan.column[at(3 * b + 2)];
    if (c >= 0 && written[at(structure.turning(b))]) written[at(structure.diagonal[at(c)])] = 1;
  }
  for (int c = 0; c < structure.columns; ++c) {
    for (int k = structure.pattern.column_start[at(c)]; k < structure.pattern.column_start[at(c) + 1]; ++k) {
      if (!written[at(k)]) continue;
      slot.push_back(k);
      row.push_back(structure.pattern.row_index[at(k)]);
      column.push_back(c);
    }
  }
  value.resize(slot.size());
  scaled_.resize(at(plan.rows));
}

void StaticHessian::add(double factor, std::span<const double> lambda) {
  KktMatrix& matrix = system_.matrix();
  matrix.set_hessian(system_.evaluator(), lambda, Curvature::exact);
  matrix.complete(system_.jacobian(), 0);
  for (std::size_t k = 0; k < slot.size(); ++k) value[k] += factor * matrix.values()[at(slot[k])];
}

void StaticHessian::evaluate(double factor, std::span<const double> lambda) {
  std::fill(value.begin(), value.end(), 0.0);
  // Elements give V_qq + sum lambda Phi_qq together.
  if (factor != 0) {
    for (std::size_t r = 0; r < scaled_.size(); ++r) scaled_[r] = lambda[r] / factor;
    add(factor, scaled_);
    return;
  }
  add(1, lambda);
  std::fill(scaled_.begin(), scaled_.end(), 0.0);
  add(-1, scaled_);
}

}  // namespace catena
