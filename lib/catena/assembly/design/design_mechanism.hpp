// A mechanism whose numbers carry derivatives by up to four design parameters, at one state.
//
//   set_time(t)                  functions of time                    c, c', c'' with derivatives
//   set_state(q, qd, qdd)        frames of the bodies as series in time along this motion
//   rows                         Phi, dPhi/dt, d2Phi/dt2 along it:    Phi_q qd - nu and Phi_q qdd - gamma
//   add_constraint_loads         Phi_q^T lambda                       applied_forces   Q
//
// q, qd, qdd and lambda are dual numbers as well: with the parts that are sought left at zero, the derivatives of a
// residual are the right-hand side for them, and once they are known the same evaluation gives the next level
// (apps/manual/sensitivity.md). Structure, numbering, origins of the relative coordinates and scales of rows are those
// of an evaluator of the same model in plain numbers; origins and scales are constants. Coordinates that are no
// unknowns (poses of immobile bodies, angles of particles) take their derivatives from the model. Units as in
// evaluate.hpp. Nothing allocates after construction.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/design_scalar.hpp"

namespace catena {

using DesignModel = BasicModel<DesignScalar>;

/// Dense Phi_q of one element as published with its derivatives; see Evaluator::ElementJacobian.
struct DesignElementJacobian {
  int rows = 0, bodies = 0;
  int body_i = -1, body_j = -1;
  double scale = 1;
  DesignScalar entries[18] = {};
};

class DesignMechanism {
 public:
  /// `model` is that of the evaluator with derivatives: of the same structure, std::invalid_argument otherwise. The
  /// evaluator is only read here.
  DesignMechanism(const Evaluator& evaluator, std::shared_ptr<const DesignModel> model);
  ~DesignMechanism();
  DesignMechanism(DesignMechanism&&) noexcept;

  const Plan& plan() const { return *plan_; }
  const DesignModel& model() const { return *model_; }

  /// Functions of time at t; `side` where they jump there.
  void set_time(double t, Side side = Side::after);
  /// The same, frozen there: as constants.
  void freeze_time(double t);
  double time() const { return time_; }
  /// Of every function of the model, as it was set.
  std::span<const Taylor<DesignScalar>> functions() const { return function_; }
  /// q as dual numbers, without derivatives but those of coordinates that are no unknowns. Sizes coordinates().
  void lift_configuration(std::span<const double> q, std::span<DesignScalar> out) const;
  /// qd and qdd may be empty: at rest, without acceleration.
  void set_state(std::span<const DesignScalar> q, std::span<const DesignScalar> qd = {},
                 std::span<const DesignScalar> qdd = {});

  /// Searches for contacts on curves begin at these places: those of the state that is set next.
  void go_to_curve_places(std::span<const CurvePlace> places);
  /// The contact of curves of a constraint at this state; no_contact where it does not search for one.
  CurvePlace contact(int element) const;

  Frame<DesignScalar> ground_frame(int plan_body) const;
  const Frame<Taylor<DesignScalar>>& motion(int plan_body) const {
    return motion_[static_cast<std::size_t>(plan_body)];
  }

  /// Every row of the plan in the solver's scale, as a series in time.
  void rows(std::span<Taylor<DesignScalar>> out) const;
  /// Q += Phi_q^T lambda; lambda: of the solver's rows. Size coordinates().
  void add_constraint_loads(std::span<const DesignScalar> lambda, std::span<DesignScalar> Q) const;
  /// Generalized forces of gravity and all force elements at this state. Size coordinates().
  void applied_forces(std::span<DesignScalar> Q) const;
  /// Mass or moment of inertia of a coordinate of a moving body.
  const DesignScalar& mass(int coordinate) const;
  /// Potential energy, J, as a series along the motion, by conservative elements and gravity.
  Taylor<DesignScalar> potential() const;

  DesignElementJacobian element_jacobian(int element) const;
  /// The measured quantity of a scalar constraint or gap as a series in time; zero for elements without one.
  Taylor<DesignScalar> measure(int element) const;
  /// c, c', c'' of an element.
  Taylor<DesignScalar> element_value(int element) const;
  /// The value of a law of state.
  DesignScalar law_value(int law) const;

 private:
  void place_immobile_bodies();

  std::shared_ptr<const Plan> plan_;
  std::shared_ptr<const DesignModel> model_;
  double time_ = 0;
  std::vector<Vec2<double>> origin_;            // per plan body, and the ground's
  std::vector<double> scale_;                   // per element: of its rows
  std::vector<int> place_;                      // per element: in its block, -1: none
  std::vector<Taylor<DesignScalar>> function_;  // at the present time
  std::vector<CompiledLaw<DesignScalar>> laws_;
  std::vector<Frame<Taylor<DesignScalar>>> motion_;  // per plan body and the ground, relative to the origins
  std::vector<CurvePlace> contacts_;                 // at this state, as Pose::contacts
};

}  // namespace catena
