// The motion of a mechanism as a first-order system, for integrators:
//
//   y = [q, qd, work]        y' = [qd, qdd, power]
//
// q and qd have plan.coordinates() entries each, of which those of moving bodies change; `work` are further integrals
// (see energy_account.hpp), none if no account is kept.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "catena/analysis/motion/energy_account.hpp"
#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/analysis/run/step_switches.hpp"

namespace catena {

class Motion {
 public:
  Motion(EquationsOfMotion& equations, EnergyAccount* account)
      : equations_(equations),
        account_(account),
        coordinates_(static_cast<std::size_t>(equations.plan().coordinates())),
        length_scale_(equations.evaluator().length_scale()),
        switches_(std::make_shared<StepSwitches>(equations.evaluator())) {}

  /// Entries of q, and of qd.
  std::size_t coordinates() const { return coordinates_; }
  std::size_t size() const { return 2 * coordinates_ + works(); }
  std::size_t works() const { return account_ ? account_->size() : 0; }
  std::span<double> q(std::span<double> y) const { return y.first(coordinates_); }
  std::span<double> qd(std::span<double> y) const { return y.subspan(coordinates_, coordinates_); }
  std::span<const double> q(std::span<const double> y) const { return y.first(coordinates_); }
  std::span<const double> qd(std::span<const double> y) const { return y.subspan(coordinates_, coordinates_); }
  std::span<const double> work(std::span<const double> y) const { return y.subspan(2 * coordinates_); }

  /// y' at (t, y) into k; false where it does not exist. `stabilisation`: see EquationsOfMotion::accelerations.
  bool derivative(double t, Side side, std::span<const double> y, std::span<double> k, double stabilisation = 0) const {
    const std::span<const double> v = qd(y);
    std::copy(v.begin(), v.end(), k.begin());
    const std::span<double> a = k.subspan(coordinates_, coordinates_);
    if (!equations_.accelerations(t, side, q(y), v, a, stabilisation)) return false;
    if (std::abs(t - known_t_) <= known_for_ && equations_.is_singular()) {
      std::copy(known_.begin(), known_.end(), a.begin());
      return true;
    }
    if (departure_ && t <= departed_) {
      departure_(t, k.subspan(coordinates_));
      return true;
    }
    if (account_) {
      const std::span<double> powers = k.subspan(2 * coordinates_);
      account_->powers(v, equations_.multipliers(), powers);
      add_losses(powers);
    }
    switches_->note(t, v);
    return true;
  }

  /// Adds what contacts dissipate to `powers`: at the last evaluation.
  void add_losses(std::span<double> powers) const {
    if (const StateLoads* loads = equations_.state_loads()) EnergyAccount::dissipated(powers) += loads->dissipation();
  }

  /// Sets [qdd, power] within `moment` of t while constraints depend on each other and the equations do not determine
  /// it: at a start in a singular position.
  void know(double t, double moment, std::span<const double> accelerations_and_powers) {
    known_t_ = t;
    known_for_ = moment;
    known_.assign(accelerations_and_powers.begin(), accelerations_and_powers.end());
  }
  /// Says that `slope(t, [qdd, power])` gives them until `departed`, whatever the equations say: where drivers begin
  /// to move in a singular position.
  void depart(double departed, std::function<void(double, std::span<double>)> slope) {
    departed_ = departed;
    departure_ = std::move(slope);
  }

  /// What errors of places are compared with, m: the scene's, or another one where nothing in it gives a length.
  double length_scale() const { return length_scale_; }
  void set_length_scale(double length) { length_scale_ = length; }

  EquationsOfMotion& equations() const { return equations_; }
  /// What forces do within a step, by its stages; integrators say when one begins.
  StepSwitches& switches() const { return *switches_; }
  /// Coordinates that can change: the first ones of q and of qd.
  std::size_t moving() const { return 3 * static_cast<std::size_t>(equations_.plan().moving); }

 private:
  EquationsOfMotion& equations_;
  EnergyAccount* account_;
  std::size_t coordinates_;
  double length_scale_;
  std::shared_ptr<StepSwitches> switches_;  // of all copies
  double known_t_ = 0, known_for_ = -1;
  std::vector<double> known_;
  double departed_ = 0;
  std::function<void(double, std::span<double>)> departure_;
};

}  // namespace catena
