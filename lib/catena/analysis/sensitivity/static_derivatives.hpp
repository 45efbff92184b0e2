// Derivatives of an equilibrium: of its configuration, multipliers and energy.
//
//   [ K      Phi_q^T ] [ q_p      ]     [ (Phi_q^T lambda - Q)_p ]
//   [ Phi_q  0       ] [ lambda_p ] = - [ Phi_p                  ]      K = -Q_q + (Phi_q^T lambda)_q
//
// partials at fixed q and lambda. K is that of the certificate, symmetric where forces have an energy. Closed gaps
// count as equations, open ones not at all; a gap that touches without a force opens one way and closes the other: no
// derivative. Singular where the equilibrium is neutral (folds, branch points, motions that nothing resists). Of
// a parameter that moves one of several equations that depend on each other, the others staying, there is no
// derivative: no place meets them all. Functions of time are frozen. dV/dp = L_p, L = V + lambda^T Phi, needs no solve
// with K: a neutral equilibrium has it. Source: apps/manual/sensitivity.md.
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
  /// dV/dp by parameter at the snapshot, which must have multipliers: where the equilibrium is neutral, too. Not a
  /// number by parameters that contradict rows, and `why` says it.
  std::vector<double> energy_gradient(const Snapshot& snapshot, std::string& why);

 protected:
  /// Factors the matrix at the snapshot, or its transpose; false where there are no derivatives.
  bool factorize(const Snapshot& snapshot, bool transposed);
  /// Takes the snapshot into all groups, without derivatives of the state.
  void lift_at_rest(const Snapshot& snapshot);
  bool neutral();
  SaddleSystem& system() { return system_; }

 private:
  /// Gaps that do not push, ascending; `touching`: the first of them that is closed, or -1.
  std::vector<int> gaps_without_force(const Snapshot& snapshot, int& touching);
  bool leave_open_gaps_out(const Snapshot& snapshot);
  /// Makes the gradient none by parameters that contradict rows; those of the groups are at the snapshot.
  void leave_out_contradicting(const Snapshot& snapshot, std::vector<double>& gradient, std::string& why);

  SaddleSystem system_;
  std::function<bool()> is_neutral_;
};

}  // namespace catena
