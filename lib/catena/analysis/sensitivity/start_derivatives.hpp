// Derivatives of where a motion starts: of the assembled configuration and of velocities that the constraints allow.
//
//   assembly     min 1/2 (q - e)^T W (q - e),  Phi(q) = 0       =>  W (q - e) + Phi_q^T mu = 0
//                [ W + sum mu Phi_qq  Phi_q^T; Phi_q  0 ] [q_p; mu_p] = [ W e_p - W_p (q-e) - (Phi_q^T)_p mu; -Phi_p ]
//   velocities   given ones kept, omitted ones of least kinetic energy:  M v + Phi_q^T mu = 0 for the latter
//                M v_p + Phi_q^T mu_p = -M_p v - (Phi_q^T)_p mu,   Phi_q v_p = nu_p - (Phi_q v)_p
//
// e is the given estimate, W = diag(1, 1, rho^2) as in assembly, rho of the body's attachments. Given velocities are
// held as there by a weight of 10^4 masses and by adding what is missing to what is asked for, until nothing is;
// massless coordinates weigh what they do there. Starts that an earlier analysis left are constants. Refused: given
// velocities that the constraints do not allow, where the nearest ones depend on what they are changed by. Source:
// apps/manual/sensitivity.md; analysis/motion/initial_velocities.hpp.
#pragma once

#include <string>

#include "catena/analysis/sensitivity/saddle_system.hpp"
#include "catena/assembly/design/design_mechanism.hpp"

namespace catena {

/// What of the start the model gives; the rest comes from an earlier analysis, and no parameter moves it.
struct GivenByModel {
  bool places = true, velocities = true;
};

class StartDerivatives {
 public:
  StartDerivatives(Evaluator& evaluator, GivenByModel given);

  /// Derivatives into q, which holds the assembled configuration at the evaluator's time; false where there are none.
  /// `count`: how many of the scalar's derivatives are in use.
  bool find_places(DesignMechanism& mechanism, int count, std::span<DesignScalar> q);
  /// The same into q and into qd, which holds the velocities at the start.
  bool find(DesignMechanism& mechanism, int count, std::span<DesignScalar> q, std::span<DesignScalar> qd);
  /// Why there are none; a sentence without full stop.
  const std::string& why() const { return why_; }
  /// Why there are none by some parameters, whose derivatives are not numbers; empty where there are by all.
  const std::string& lack() const { return lack_; }

 private:
  bool find_velocities(DesignMechanism& mechanism, int count, std::span<const DesignScalar> q,
                       std::span<DesignScalar> qd);
  /// What all groups of parameters share at one start: factors, and the multipliers of assembly; of velocities the
  /// same, and whether they are what is given. Nothing is done again for the start of the last call.
  bool prepare_places(std::span<const double> q);
  bool prepare_velocities(DesignMechanism& mechanism, std::span<const DesignScalar> q, std::span<const double> qd);
  /// What is asked of all velocities and how much it weighs, at their values; false without masses.
  bool weigh(std::span<const double> q, std::span<const double> qd);
  DesignScalar given_place(const DesignMechanism& mechanism, int coordinate) const;
  /// What is asked of the given velocity of a coordinate.
  DesignScalar given_velocity(const DesignMechanism& mechanism, int coordinate) const;
  /// Solves for velocities with what is missing of given ones added until nothing is, and small masses taken back;
  /// `goal` of given ones, `load` and `rows` in, v and multipliers out.
  bool solve_keeping(std::span<const double> goal, std::span<const double> load, std::span<const double> rows,
                     std::span<double> v, std::span<double> multipliers);
  bool fail(std::string why) {
    why_ = std::move(why);
    return false;
  }

  Evaluator& evaluator_;
  const Plan& plan_;
  GivenByModel by_model_;
  SaddleSystem assembly_, velocities_;
  std::vector<double> jacobian_, weight_, wanted_;
  std::vector<double> radius_, place_weight_, apart_, place_multipliers_, rate_multipliers_;
  std::vector<double> prepared_q_, prepared_qd_;  // the start that was prepared; empty: none
  std::vector<char> given_, follows_;             // by coordinate
  bool rests_ = false;                            // all velocities are zero
  std::string why_, lack_;
};

}  // namespace catena
