// Whether dry friction can hold a given position: the least part of it that is used up, over all forces that balance.
//
//   min u   such that   Q + sum_k (N_k J_n,k + T_k J_t,k) - Phi_q^T lambda = 0,   N_k >= 0,   |T_k| <= u mu_static N_k
//
// Of a rope without stiffness that slides over pulleys with friction: e^(-u E) <= T_out / T_in <= e^(u E) at each
// (rope_grips.hpp), a cone with an edge for every choice of signs.
//
// The friction of joints counts likewise, |T| <= u mu_static N(lambda), lambda the joint's own multipliers
// (held_joints.hpp): exact where statics determines them, else the least u that was found from many slopes of N.
//
// For a given u the forces of a place form a cone with two edges, J_n +- u mu_static J_t, so that the question is one
// of least squares with coefficients that are not negative (Lawson and Hanson); a larger u never makes it harder, so
// that the least u is found by bisection. Places count as closed within 1e-6 length scales; as in all of equilibrium a
// stiffness is not looked at. Dense: meant for up to some hundred coordinates. No u: the position is
// held by no friction however large. Source: Lawson and Hanson, Solving Least Squares Problems (1974), chapter 23.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "catena/analysis/contact/contact_points.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"

namespace catena {

struct Holding : Report {
  std::optional<double> utilisation;  ///< the least u; above 1: friction does not suffice
  bool held() const { return utilisation && *utilisation <= 1 + 1e-12; }
};

/// Largest number of coordinates that are treated.
inline constexpr int most_held_coordinates = 600;

/// The evaluator's plan has no rows of contacts; its model is the given one with equations of slides.
class ContactHolding {
 public:
  /// Throws std::invalid_argument where an elastic rope has friction: its tensions are no free forces.
  explicit ContactHolding(std::shared_ptr<const Model> model);

  Evaluator& evaluator() { return *evaluator_; }
  /// At the state's place, assembled first; the evaluator is left there, and the configuration in `q` (size
  /// coordinates()).
  Holding find(const SystemState& state, std::vector<double>& q);

 private:
  void lay_grips(const SystemState& state);

  ContactModel contacts_;
  EvaluationWork evaluation_;
  std::unique_ptr<Evaluator> evaluator_;
};

}  // namespace catena
