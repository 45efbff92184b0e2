// The variational equations of a motion along recomputed steps, for all parameters at once.
//
//   [ M      Phi_q^T ] [ qdd_p    ]   [ R_q q_p + R_qd qd_p + R_p              ]     R = Q - M qdd - Phi_q^T lambda
//   [ Phi_q  0       ] [ lambda_p ] = [ -(Phi_q)'' q_p - 2 (Phi_q)' qd_p - Phi''_p ]
//
// at every stage, with the factors that its accelerations were found with; right-hand sides from matrices of elements
// that are evaluated once for all parameters (mechanism_tangents.hpp). The equations are those of
// motion_derivatives.hpp. Derivatives lie in rows of `width()` numbers a coordinate of y = [q, qd]; those of
// coordinates that are no unknowns are zero here and count among what parameters change by themselves. Stages of q_p
// are those of a second-order equation, whose velocities are left out (StageWeights); only rows that the right-hand
// sides read are made. Not where constraints depend on each other, nor for models that AdjointMechanism refuses.
#pragma once

#include <array>
#include <vector>

#include "catena/analysis/motion/derivative_error.hpp"
#include "catena/analysis/motion/stage_sums.hpp"
#include "catena/analysis/sensitivity/recomputed_steps.hpp"
#include "catena/assembly/design/mechanism_tangents.hpp"

namespace catena {

class MotionTangents {
 public:
  using Rows = std::vector<double>;
  using Stage = RecomputedSteps::Stage;

  /// `groups`: mechanisms with derivatives by four parameters each; all must outlive this object.
  MotionTangents(const Evaluator& evaluator, std::vector<DesignMechanism*> groups);

  std::size_t width() const { return width_; }
  /// A state at which accelerations were found, with the factors at hand.
  struct Place {
    double t;
    Side side;
    const Evaluator& evaluator;
    EquationsOfMotion& equations;
    std::span<const double> qd, qdd, lambda;
  };
  static Place place_of(Stage& stage);

  /// Derivatives at the end of a recomputed step, before it is projected, from those at its beginning.
  void step(RecomputedSteps& steps, double h, const Rows& begin, Rows& end);
  /// The same stage by stage, in their order, and then the end; `h`: of the whole step.
  void step_stage(int s, const Place& place, double h, const Rows& begin);
  void finish_step(double h, const Rows& begin, Rows& end) const;
  /// What they miss there (motion/derivative_error.hpp), or more where that is no more than is allowed.
  double error(double h, const Rows& begin, const Rows& end, const DerivativeAim& aim);
  /// The slopes of the interpolant's stages, after step() and with the projected end.
  void prepare_interpolant(RecomputedSteps& steps, double h, const Rows& begin, const Rows& end);
  void interpolate(double part, double h, const Rows& begin, const Rows& end, Rows& y) const;
  /// Projects the derivatives at the state of `stage`, whose factors are made; false where constraints depend on each
  /// other.
  bool project(Stage& stage, double t, Side side, Rows& y);
  /// The same with the factors that the stage has.
  void project_with_factors(Stage& stage, Rows& y);
  /// Derivatives of accelerations and multipliers where these were found.
  void accelerations(const Place& place, const Rows& y, Rows& out);
  /// Rows of multipliers of the last accelerations().
  const Rows& multipliers() const { return rows_; }

 private:
  void add_parameters(double t, Side side, std::span<const double> lambda, std::span<const double> qdd,
                      const TangentSums& sums);
  /// By parameter, of all coordinates of bodies that move; `largest` is what there was before, or more.
  void find_largest(std::span<const double> rows, std::span<double> largest) const;
  /// Solves for all parameters: loads to x in place, rows_ to multipliers.
  void solve(EquationsOfMotion& equations, std::span<double> x);

  /// y = [q, qd] where the stage is evaluated, or at the end, in the rows of these coordinates.
  void add_second_order(const StageWeights& of, double h, const Rows& begin, std::span<const int> which, Rows& y) const;

  const Plan& plan_;
  std::vector<DesignMechanism*> groups_;
  MechanismTangents mechanism_;
  std::vector<AdjointMechanism::Reached> reached_;  // by group
  std::size_t n_, width_;
  std::vector<int> all_, no_unknowns_;  // coordinates of bodies that move, and of all those that are no unknowns
  std::vector<Rows> accelerations_;     // by stage
  std::vector<Rows> velocities_;        // by stage, for the interpolant
  Rows stage_, rows_;
  Rows sum_, largest_;  // of error()
  std::vector<double> masses_;
  SchurRows scratch_;
};

}  // namespace catena
