// Dry friction of joints in a driven motion: its slips are known, what presses follows from the reactions it changes.
//
//   Phi_q^T lambda = Q - M qdd + sum f_k w_k       f_k + mu sigma_k N_k(lambda) = 0
//
// w_k: gradient of the slip of joint k; sigma: sign of the slip, or tanh(slip / vs). lambda is linear in f, so that
// both are found at once (contact_loads.hpp). An exact joint that rests may have any friction up to mu_static N: none
// is taken, and a remark says so. Units: N, N m, W. Not solvable: as contact_loads.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"

namespace catena {

class DrivenFriction {
 public:
  /// Must outlive this object.
  explicit DrivenFriction(const Evaluator& evaluator);

  bool any() const { return !joints_.empty(); }
  /// At the evaluator's configuration. solve(loads, lambda) finds the multipliers of loads by coordinate; `lambda` are
  /// those without friction, whose forces are added to `friction`.
  template <class Solve>
  Report find(double t, std::span<const double> qd, std::span<const double> lambda, std::span<double> friction,
              Solve&& solve) {
    begin(t, qd, friction);
    for (std::size_t l = 0; l < loads_->coupled(); ++l) solve(loads_->unit_load(l), loads_->response(l));
    if (!loads_->find_sizes(lambda)) return no_friction(t);
    loads_->add_friction(friction);
    return {};
  }
  /// Takes the multipliers with it.
  void finish(std::span<const double> lambda);
  /// Of all elements, once it is finished.
  std::span<const ContactLoad> loads() const { return by_element_; }
  /// At an instant that leaves the multipliers open: forces, friction, slips and what is lost are NaN.
  void forget();
  /// Power lost then.
  double dissipation() const;
  void add_remarks(std::vector<std::string>& warnings) const;
  /// Vectors whose lengths are what friction takes, W, and bends with at their zeros: of a guide one for its force and
  /// one for its moment, of a pin its force.
  void read_pressing(std::span<const double> lambda, std::span<const double> qd,
                     std::vector<Vec2<double>>& pressing) const;

 private:
  void begin(double t, std::span<const double> qd, std::span<double> friction);
  Report no_friction(double t) const;

  const Evaluator& evaluator_;
  std::vector<ContactPoint> joints_;
  std::vector<ContactState> states_;  // of which loads_ was made last
  std::optional<ContactLoads> loads_;
  std::vector<ContactLoad> by_element_;
  std::int64_t rests_ = 0;  // instants at which a joint rested
  double first_rest_ = 0;
  std::size_t resting_ = 0;  // the joint that did first
};

}  // namespace catena
