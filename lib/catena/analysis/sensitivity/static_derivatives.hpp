// Derivatives of an equilibrium: of its configuration, multipliers and energy.
//
//   [ K      Phi_q^T ] [ q_p      ]     [ (Phi_q^T lambda - Q)_p ]
//   [ Phi_q  0       ] [ lambda_p ] = - [ Phi_p                  ]      K = -Q_q + (Phi_q^T lambda)_q
//
// partials at fixed q and lambda. K is that of the certificate, symmetric where forces have an energy. Closed gaps
// count as equations, open ones not at all; a gap that touches without a force opens one way and closes the other: no
// derivative. Singular where the equilibrium is neutral (folds, branch points, motions that nothing resists). Of
// a parameter that moves one of several equations that depend on each other, the others staying, there is no
// derivative: no place meets them all. Functions of time are frozen. dV/dp = L_p, L = V + lambda^T Phi, needs no solve.
// Source: apps/manual/sensitivity.md.
#pragma once

#include <functional>

#include "catena/analysis/sensitivity/saddle_system.hpp"
#include "catena/analysis/sensitivity/state_derivatives.hpp"

namespace catena {

class StaticDerivatives : public StateDerivatives {
 public:
  StaticDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters);

  /// Asked before every find(): whether the equilibrium is known to be neutral, as its certificate judges it. The
  /// matrix alone tells that only where no rounding is in it.
  void ask_whether_neutral(std::function<bool()> is_neutral) { is_neutral_ = std::move(is_neutral); }
  /// The snapshot must have multipliers.
  bool find(const Snapshot& snapshot) override;
  /// dV/dp at the state of the last find(), by parameter.
  virtual std::vector<double> energy_gradient();

 protected:
  /// Factors the matrix at the snapshot, or its transpose; false where there are no derivatives.
  bool factorize(const Snapshot& snapshot, bool transposed);
  bool neutral();
  SaddleSystem& system() { return system_; }

 private:
  bool leave_open_gaps_out(const Snapshot& snapshot);

  SaddleSystem system_;
  std::vector<double> rest_;
  std::function<bool()> is_neutral_;
};

}  // namespace catena
