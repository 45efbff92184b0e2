// Derivatives of columns of an equilibrium by one solve a column, whatever the number of parameters.
//
//   [ K^T    Phi_q^T ] [ w  ]   [ c_q      ]
//   [ Phi_q  0       ] [ mu ] = [ c_lambda ]        dc/dp = c_p + w^T (Q - Phi_q^T lambda)_p - mu^T Phi_p
//
// with the equations of static_derivatives.hpp, transposed: forces need no energy. Of elements those that a parameter
// reaches are differentiated alone. Singular, and refused, as there; refused where rows depend on each other as well.
// Source: apps/manual/sensitivity.md.
#pragma once

#include <memory>

#include "catena/analysis/adjoint/column_slopes.hpp"
#include "catena/analysis/sensitivity/static_derivatives.hpp"
#include "catena/assembly/design/adjoint_mechanism.hpp"

namespace catena {

class StaticAdjoint final : public StaticDerivatives {
 public:
  /// The model must be one of those of AdjointMechanism.
  StaticAdjoint(const Evaluator& evaluator, const DesignModels& models, int parameters);

  bool goes_back() const override { return true; }
  bool find(const Snapshot& snapshot) override;
  bool derive(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out,
              std::span<double> change = {}) override;

 private:
  AdjointMechanism mechanism_;
  std::vector<std::unique_ptr<AdjointMechanism::Reached>> reached_;  // by group
};

}  // namespace catena
