// What the adjoint of a motion asks of a mechanism at one state: products of multipliers with derivatives of the
// equations, by positions and velocities, and by design parameters.
//
//   R = Q(q, qd) - M qdd - Phi_q^T lambda        Phi, Phi' and Phi'' along the motion (q, qd, qdd)
//   w^T R_q - mu^T Phi''_q    with   Phi''_q = (Phi_q)''  and  (Phi_q^T lambda)_q = sum lambda Phi_qq
//   w^T R_qd - mu^T Phi''_qd  with   Phi''_qd = 2 (Phi_q)'
//   w^T R_p - mu2^T Phi''_p - mu1^T Phi'_p - mu0^T Phi_p
//
// Derivatives by q of all elements come from dual numbers over series in time, one element after the other, those of
// pins from closed forms: what they cost does not depend on the number of parameters. Those by parameters are taken of
// elements, bodies and functions that a parameter reaches alone. Slides of contacts, whose equations show a few scalars
// alone, are moved by four coordinates at a time. Not for laws of state, ropes and elements that only C++ can make
// (why_not()). Units as in evaluate.hpp. Source: apps/manual/sensitivity.md.
#pragma once

#include <array>
#include <string>

#include "catena/assembly/design/design_mechanism.hpp"

namespace catena {

/// Weights of the equations; empty spans count as zero. w: over coordinates; the others over rows of the plan.
struct AdjointWeights {
  std::span<const double> w{}, lambda{}, phi{}, rate{}, bend{};
  bool forces = true;  ///< Q is in R; not in that of a blow, M (qd+ - qd-) + Phi_q^T lambda = 0
};

class AdjointMechanism {
 public:
  /// Empty, or why the model cannot be asked, as a phrase. `has_phases`: contacts on curves are moved to where the
  /// motion had them (Evaluator::go_to_curve_places()), and the model may have slides of contacts.
  static std::string why_not(const Model& model, bool has_phases = false);

  /// Of the model in plain numbers of an evaluator, whose configuration and time are read where asked.
  explicit AdjointMechanism(const Evaluator& evaluator);

  /// The motion at the evaluator's configuration: sizes coordinates(); may be empty: at rest, without acceleration.
  /// `side` where functions of time jump. Contacts on curves are where the evaluator's are.
  void set_motion(const Evaluator& evaluator, std::span<const double> qd, std::span<const double> qdd,
                  Side side = Side::after);

  /// by_q += w^T R_q - bend^T Phi''_q - rate^T Phi'_q, by_qd += w^T R_qd - bend^T Phi''_qd. Sizes coordinates().
  void add_by_state(const Evaluator& evaluator, const AdjointWeights& weights, std::span<double> by_q,
                    std::span<double> by_qd);

  /// Elements, bodies and functions of a mechanism with derivatives by up to four parameters that these reach.
  class Reached {
   public:
    /// A slide that is made of what a contact is made of: by their numbers.
    struct SlideOfContact {
      int slide, contact;
    };
    Reached(const AdjointMechanism& adjoint, const DesignMechanism& mechanism,
            std::span<const SlideOfContact> slides = {});
    int elements() const { return elements_; }
    /// Whether derivatives ask the mechanism itself: its functions and its bodies that do not move.
    bool asks_mechanism() const { return any_constraint_ || any_force_ || gravity_; }

   private:
    friend class AdjointMechanism;
    friend class MechanismTangents;
    using Derivatives = std::array<double, parameters_at_once>;
    /// An end of a pin in a body: what its equations move by with the parameters, in the body's axes.
    struct PinEnd {
      int row, body;
      Derivatives x, y;
    };
    /// A coordinate whose mass moves, and what gravity pulls it with.
    struct Mass {
      int coordinate;
      double pull;
      Derivatives by;
    };
    bool take_pin(const AdjointMechanism& adjoint, int row, const std::array<int, 2>& bodies,
                  const Revolute<DesignScalar>& pin);
    void take_masses(const Plan& plan, const DesignMechanism& mechanism);
    std::vector<std::vector<int>> constraints_, forces_;  // by type: places in the block
    std::vector<PinEnd> pins_;                            // of pins, which are not among the constraints
    std::vector<Mass> masses_;
    bool gravity_ = false, any_constraint_ = false, any_force_ = false;
    int elements_ = 0;
  };
  /// w^T R_p - bend^T Phi''_p - rate^T Phi'_p - phi^T Phi_p by the parameters of a group, at the motion that was set;
  /// `mechanism` is set to its time.
  std::array<double, parameters_at_once> by_parameters(const DesignMechanism& mechanism, const Reached& reached,
                                                       const AdjointWeights& weights, std::span<const double> qdd);

 protected:
  using Series = Taylor<double>;

  const Plan& plan() const { return *plan_; }

  std::shared_ptr<const Plan> plan_;
  const Model* model_;
  std::vector<Vec2<double>> origin_;    // per plan body, and the ground's
  std::vector<double> scale_;           // per element: of its rows
  std::vector<Frame<Series>> motion_;   // per plan body, relative
  std::vector<Taylor<double>> values_;  // of functions, at the present time
  std::vector<double> rates_;           // qd
  std::vector<CurvePlace> contacts_;    // as Pose::contacts

  bool is_immobile(int body) const { return body >= plan_->moving && body < plan_->bodies; }
  /// A body's motion with derivatives by parameters: immobile bodies move with them, and so do the angles of particles,
  /// which are no unknowns.
  Frame<Taylor<DesignScalar>> frame_of(const DesignMechanism& mechanism, int body) const;
  Frame<Taylor<DesignScalar>> turned_by_parameters(const DesignModel& model, Frame<Taylor<DesignScalar>> frame,
                                                   int body) const;

 private:
  void add_pins(const Reached& reached, const AdjointWeights& weights,
                std::array<double, parameters_at_once>& sum) const;
  /// sum -= lambda^T Phi_q w and the rows by their weights, of constraints that parameters reach.
  void add_constraints(const DesignMechanism& mechanism, const Reached& reached, const AdjointWeights& weights,
                       DesignScalar& sum) const;
  /// sum += w^T Q of forces that parameters reach.
  void add_forces(const DesignMechanism& mechanism, const Reached& reached, std::span<const double> w,
                  DesignScalar& sum) const;
  void add_constraints_by_q(const AdjointWeights& weights, std::span<double> by_q, std::span<double> by_qd) const;
  void add_curvature(const AdjointWeights& weights, std::span<double> by_q) const;
  // Of slides: adjoint_slides.cpp.
  void add_slides_by_q(const AdjointWeights& weights, std::span<double> by_q, std::span<double> by_qd) const;
  void add_slides_curvature(const AdjointWeights& weights, std::span<double> by_q) const;
  void add_forces_by_state(const Evaluator& evaluator, std::span<const double> w, std::span<double> by_q,
                           std::span<double> by_qd) const;
};

}  // namespace catena
