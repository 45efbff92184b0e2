// Derivatives of columns of a driven mechanism by one solve a column and level, whatever the number of parameters.
//
//   Phi_q w = c_lambda          Phi_q^T mu2 = c_qdd - M w
//   qd^ = c_qd + w^T R_qd - mu2^T Phi''_qd         Phi_q^T mu1 = qd^
//   q^  = c_q  + w^T R_q  - mu2^T Phi''_q - mu1^T Phi'_q       Phi_q^T mu0 = q^
//   dc/dp = c_p + w^T R_p - mu2^T Phi''_p - mu1^T Phi'_p - mu0^T Phi_p        R = Q - M qdd - Phi_q^T lambda
//
// the equations of kinematic_derivatives.hpp transposed. Singular as there; refused where functions of time jump at an
// instant that parameters move, and where rows depend on each other. Source: apps/manual/sensitivity.md.
#pragma once

#include <memory>

#include "catena/analysis/adjoint/column_slopes.hpp"
#include "catena/analysis/sensitivity/saddle_system.hpp"
#include "catena/analysis/sensitivity/state_derivatives.hpp"
#include "catena/assembly/design/adjoint_mechanism.hpp"

namespace catena {

class KinematicAdjoint final : public StateDerivatives {
 public:
  /// The model must be one of those of AdjointMechanism.
  KinematicAdjoint(const Evaluator& evaluator, const DesignModels& models, int parameters);

  bool goes_back() const override { return true; }
  bool find(const Snapshot& snapshot) override;
  bool derive(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out,
              std::span<double> change = {}) override;
  /// out += df/dp of a function f of the places q whose slopes f_q at this snapshot are given, over coordinates: what a
  /// program measures itself. False where there is none, and why() says it.
  bool add_gradient(const Snapshot& snapshot, std::span<const double> by_q, std::span<double> out);

 protected:
  int seen_order() const override { return 3; }

 private:
  /// Factors and the motion where the evaluator is, at the snapshot.
  bool factorize(const Snapshot& snapshot, const Evaluator& there);
  bool singular_at(double t);
  /// w and the three multipliers of a column; false where the solves fail.
  bool solve(const Snapshot& snapshot, StateSlopes& by);

  SaddleSystem system_;
  AdjointMechanism mechanism_;
  std::vector<std::unique_ptr<AdjointMechanism::Reached>> reached_;  // by group
  std::unique_ptr<ColumnSlopes> slopes_;
  const ColumnSet* columns_ = nullptr;  // that these are of
  std::vector<double> w_, mu0_, mu1_, mu2_, zero_rows_, zero_loads_;
};

}  // namespace catena
