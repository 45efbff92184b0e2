// Derivatives of a driven mechanism's positions, velocities, accelerations and multipliers.
//
//   Phi_q q_p = -Phi_p        Phi_q qd_p = nu_p - (Phi_q qd)_p        Phi_q qdd_p = gamma_p - (Phi_q qdd)_p
//   Phi_q^T lambda_p = Q_p - (M qdd)_p - (Phi_q^T)_p lambda
//
// The right-hand sides are minus the derivatives of the rows Phi, Phi', Phi'' and of the balance M qdd + Phi_q^T lambda
// - Q along what is known of q_p, qd_p, qdd_p: from matrices of elements for all parameters at once, and what these
// reach (mechanism_tangents.hpp); where there are none, by one evaluation in dual numbers each. One factorization an
// instant and, for each parameter, one solve a level. Singular at singular configurations; multipliers of rows that
// depend on others have no derivative: of many, the least are shown, and which these are depends on the parameters.
// Source: apps/manual/sensitivity.md.
#pragma once

#include <memory>

#include "catena/analysis/sensitivity/saddle_system.hpp"
#include "catena/analysis/sensitivity/state_derivatives.hpp"
#include "catena/assembly/design/mechanism_tangents.hpp"

namespace catena {

class KinematicDerivatives final : public StateDerivatives {
 public:
  KinematicDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters);

  bool find(const Snapshot& snapshot) override { return find_at(snapshot, Side::after); }

 protected:
  bool find_before(const Snapshot& snapshot) override { return find_at(snapshot, Side::before); }
  int seen_order() const override { return 3; }
  void complete_state() override;

 private:
  bool find_at(const Snapshot& snapshot, Side side);
  /// Rates of the group, and multipliers, on the other side of an instant at which functions of time jump: the
  /// snapshot has those after it.
  bool solve_values(Group& group, const Snapshot& snapshot);
  /// Series coefficient `level` of the rows (0: Phi, 1, 2) to the derivatives of q, qd or qdd.
  bool solve_level(Group& group, int level, std::vector<DesignScalar>& target);
  bool solve_multipliers(Group& group);

  /// All levels for all parameters; the factors are those of the snapshot's configuration.
  bool find_by_tangents(const Snapshot& snapshot, Side side);
  /// Solves Phi_q x = -rows for all parameters; `places`: x is q_p, and parameters that contradict rows are left out.
  bool solve_rows(const std::vector<double>& rows, std::vector<double>& x, bool places);

  SaddleSystem system_;
  std::unique_ptr<MechanismTangents> tangents_;  // nullptr: not for this model
  std::vector<AdjointMechanism::Reached> reached_;
  std::size_t width_ = 0;
  bool has_rates_ = false, is_complete_ = true;  // of the last find_by_tangents()
  double found_t_ = 0;
  std::vector<Lanes> side_, place_;
  std::vector<double> q_, qd_, qdd_, loads_, phi_, rates_, bends_;  // rows of width_, a coordinate or equation each
};

}  // namespace catena
