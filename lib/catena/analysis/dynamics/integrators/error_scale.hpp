// The sizes that errors of positions and velocities are compared with, so that one tolerance serves all coordinates.
//
//   positions    max(tolerance x L, 4 eps D) (lengths), tolerance x 1 rad (angles)
//   velocities   tolerance x (min(V L, sqrt(2 E / m)) + |v|), tolerance x (min(V, sqrt(2 E / J)) + |omega|)
//
// L: the scene's length scale. D: how far bodies have come from where they were given; places are known no better than
// to rounding of that. V, in 1/s: the rate of the mechanism, by its velocities and by the time in which its
// accelerations cause a displacement of L or 1 rad: max(|v|/L, |omega|, sqrt(|a|/L), sqrt(|alpha|)). An error of
// velocity then counts as much as the error of position it grows into. V decreases again after a fast passage, but the
// time scale 1/V grows no faster than time itself: where a mechanism rests for an instant its velocities keep a scale.
//
// E, in J: the largest kinetic energy so far, at the start also the work of the accelerations over a length L. It
// bounds the velocity of each body, so that beside a fast light part the velocity of a heavy one still counts. The
// start is over when the motion has come further than tolerance^(1/2) length scales, which is tolerance^(1/4) radians
// of V: a driver whose acceleration grows from zero moves next to nothing in first steps, and velocities would be asked
// for to a part of that. Errors of work are compared with the mean of both, as the balance is.
//
// Rounding: accelerations are not known better than to 4 eps min(A, F / m), A the largest |Q| / m, F the largest force,
// which constraints transmit. The resulting errors of velocities and positions in a step of size h are ignored: where
// loads are in balance and only rounding moves the bodies, no step would be short enough otherwise.
//
// Where a method's estimate is of a lower order than its error, as that of Radau, a tolerance x of the error is one of
// factor x^power of the estimate: see loosen().
//
// tolerance: `step_tolerance` of a run of up to n0 = 200 radians of V. In a longer one errors of energy become errors
// of phase, so that errors of steps add up with the square of the length: they are allowed (n0/n)^2 of it, n = integral
// of V over the whole run, estimated with the present V. Never less than double precision allows.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "catena/analysis/motion/motion_memory.hpp"
#include "catena/analysis/motion/step_growth.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {

class ErrorScale {
 public:
  double step_tolerance = 1e-10;
  double length = 1;
  double horizon = 0;  ///< s; where the run ends

  /// Masses and moments of inertia by coordinate, zeros allowed.
  void set_masses(std::span<const double> masses) {
    mass_.assign(masses.begin(), masses.end());
    speed_.resize(mass_.size());
    inverse_.resize(mass_.size());
    for (std::size_t c = 0; c < mass_.size(); ++c) {
      inverse_[c] = mass_[c] > 0 ? (c % 3 == 2 ? length : 1 / length) / mass_[c] : 0;
      speed_[c] = mass_[c] > 0 ? std::sqrt(2 / mass_[c]) : std::numeric_limits<double>::infinity();
    }
  }

  /// Of the motion so far, but for the step.
  IntegratorMemory memory() const {
    return {.rate = rate_, .root_energy = root_energy_, .root_of_start = root_of_start_, .radians = radians_};
  }
  void remember(const IntegratorMemory& memory) {
    rate_ = memory.rate;
    root_energy_ = memory.root_energy;
    root_of_start_ = memory.root_of_start;
    radians_ = memory.radians;
  }

  /// Tolerances of steps are of an estimate that is of a lower order than the error: factor tolerance^power.
  void loosen(double factor, double power) {
    factor_ = factor;
    power_ = power;
    set_tolerances();
  }
  /// What another one knows of the motion; the tolerance stays one of this method's estimate.
  void take_over(const ErrorScale& other) {
    const double factor = factor_, power = power_;
    *this = other;
    loosen(factor, power);
  }
  /// What an error may be, as a part of tolerance(), if the estimate is of no higher order than the error.
  double strict_part() const { return strict_ / tolerance_; }

  double rate() const { return rate_; }
  double tolerance() const { return tolerance_; }
  /// Of an error of position and of velocity v at coordinate c that count as much as the tolerance; the latter is zero
  /// where nothing has moved yet.
  double position_unit(std::size_t c, double h) const {
    const double moved = h * h * rounding(c);
    return c % 3 == 2 ? tolerance_ + moved : (place_tolerance_ + moved) * length;
  }
  /// What a position may be off by rounding alone, where constraints tie it to others that are larger.
  double rounding_of_place(std::size_t c) const {
    return c % 3 == 2 ? thresholds::few_roundings : std::max(thresholds::few_roundings, place_rounding_) * length;
  }
  double velocity_unit(std::size_t c, double h, double v) const {
    const double unit = c % 3 == 2 ? 1 : length;
    return tolerance_ * (std::min(rate_ * unit, std::max(root_energy_, root_of_start_) * speed_[c]) + std::abs(v)) +
           std::abs(h) * rounding(c) * unit;
  }
  /// Where EnergyAccount has the work of the loads among its integrals; errors are judged of this one and of the first,
  /// which is what dampers take.
  static constexpr std::size_t work_of_loads = 1;
  static constexpr std::array<std::size_t, 2> judged_integrals{0, work_of_loads};
  /// None where nothing is summed up.
  static std::span<const std::size_t> judged(std::size_t works) {
    return works > 0 ? std::span<const std::size_t>(judged_integrals) : std::span<const std::size_t>();
  }
  /// A step of size h, s, and what one of the works is at its beginning and end, J.
  struct WorkInStep {
    double h, begin, end;
  };
  /// An error of work, J, compared with what may be: a part of what the balance of energy may miss (balance_watch.hpp),
  /// by the kinetic energy and the work so far; at least what loads F, or those that accelerate all masses together, do
  /// in displacements that count as nothing: F L (tolerance^2 + h^2 rounding). `loads`, `qdd`: at the end of the step,
  /// for at a start where they grow from zero those of the beginning say nothing.
  double size_of_work(double error, const WorkInStep& work, std::span<const double> loads,
                      std::span<const double> qdd) const {
    const double energy = root_energy_ * std::max(root_energy_, root_of_start_) +
                          std::max(std::abs(work.end), std::abs(work.end - work.begin));
    double allowed = loosened(work_part * step_tolerance) * energy;
    if (error > allowed) allowed = std::max(allowed, work_of_nothing(work.h, loads, qdd));
    return allowed > 0 ? error / allowed : 0;
  }
  /// What the work done in a step of size h, in which powers go from `begin` to `end`, may be wrong by where a power
  /// bends within it: 0.36 at most of what it differs from the trapezoid rule by, of order 5 and of Radau.
  static double error_of_switch(double h, double begin, double end, double work) {
    return std::abs(work - h / 2 * (begin + end)) / 2;
  }
  /// The shortest step, s, that may be tried at t: below it time does not advance.
  double smallest_step(double t) const {
    const double moment = rate_ > 0 ? 1 / rate_ : 0;
    return shortest_step * std::max(std::abs(t), horizon > t ? std::min(moment, horizon - t) : moment);
  }
  /// Repeats `error()` where velocities and accelerations at the end of a failed step show a faster mechanism than
  /// known before: at a start where forces only begin to grow they are the only scale. The new rates are kept if the
  /// step is then accepted.
  template <class Error>
  double compare_with_end(std::span<const double> qd, std::span<const double> qdd, double error, Error&& again) {
    const double rate = rate_, root_energy = root_energy_;
    measure(qd, qdd);
    if (rate_ > 2 * rate) error = again();
    if (!(error <= 1)) rate_ = rate, root_energy_ = root_energy;
    return error;
  }

  /// Records places, velocities and accelerations (three a body) at t, a time `step` after the last ones; 0: at a
  /// start. Generalized forces `loads` and the smallest pivot ratio of the equations determine the rounding of
  /// accelerations.
  void observe(double t, double step, std::span<const double> q, std::span<const double> qd,
               std::span<const double> qdd, std::span<const double> loads, double pivot_ratio) {
    rate_ /= 1 + std::abs(step) * rate_;
    measure(qd, qdd);
    force_ = acceleration_ = 0;
    measure_loads(loads.first(qd.size()), force_, acceleration_);
    const double condition = 1 / std::max(pivot_ratio, dependence::refined);
    condition_ = rate_ * rate_ <= condition * thresholds::few_roundings * acceleration_ ? condition : 1;
    if (step == 0 || std::pow(radians_, 4) < step_tolerance) {
      double energy = 0;
      for (std::size_t c = 0; c < qd.size(); ++c) energy += mass_[c] * std::abs(qdd[c]) * (c % 3 == 2 ? 1 : length);
      double& root = step == 0 ? root_energy_ : root_of_start_;
      root = std::max(root, std::sqrt(energy));
    }
    radians_ += rate_ * std::abs(step);
    const double part = std::min(1.0, brief_run / (radians_ + rate_ * std::max(horizon - t, 0.0)));
    strict_ = std::max(step_tolerance * part * part, least_tolerance);
    double farthest = 0;
    for (std::size_t c = 0; c + 2 < q.size(); c += 3)
      farthest = std::max({farthest, std::abs(q[c]), std::abs(q[c + 1])});
    place_rounding_ = thresholds::few_roundings * farthest / length;
    set_tolerances();
  }

 private:
  void set_tolerances() {
    tolerance_ = loosened(strict_);
    place_tolerance_ = std::max(tolerance_, place_rounding_);
  }
  double loosened(double tolerance) const { return power_ == 1 ? tolerance : factor_ * std::pow(tolerance, power_); }
  double rounding(std::size_t c) const {
    return condition_ * thresholds::few_roundings * std::min(acceleration_, force_ * inverse_[c]);
  }
  void measure_loads(std::span<const double> loads, double& largest, double& acceleration) const {
    for (std::size_t c = 0; c < loads.size(); ++c) {
      const double force = std::abs(loads[c]) / (c % 3 == 2 ? length : 1);
      largest = std::max(largest, force);
      if (mass_[c] > 0) acceleration = std::max(acceleration, force * inverse_[c]);
    }
  }
  double work_of_nothing(double h, std::span<const double> loads, std::span<const double> qdd) const {
    double force = force_, acceleration = acceleration_;
    measure_loads(loads.first(mass_.size()), force, acceleration);
    double inertia = 0;
    for (std::size_t c = 0; c < mass_.size(); ++c) inertia += mass_[c] * std::abs(qdd[c]) / (c % 3 == 2 ? length : 1);
    force = std::max(force, inertia);
    return force * length * (tolerance_ * tolerance_ + h * h * condition_ * thresholds::few_roundings * acceleration);
  }
  void measure(std::span<const double> qd, std::span<const double> qdd) {
    double fastest = 0, strongest = 0, energy = 0;
    for (std::size_t c = 0; c + 2 < qd.size(); c += 3) {
      fastest = std::max({fastest, std::abs(qd[c]) / length, std::abs(qd[c + 1]) / length, std::abs(qd[c + 2])});
      strongest = std::max({strongest, std::abs(qdd[c]) / length, std::abs(qdd[c + 1]) / length, std::abs(qdd[c + 2])});
      for (std::size_t k = c; k < c + 3; ++k) energy += 0.5 * mass_[k] * qd[k] * qd[k];
    }
    rate_ = std::max({rate_, fastest, std::sqrt(strongest)});
    root_energy_ = std::max(root_energy_, std::sqrt(energy));
  }

  // In tolerances of a step, of which the balance may miss some 5000; steps add up.
  static constexpr double work_part = 50;
  static constexpr double brief_run = 200, least_tolerance = 1e-15;
  double rate_ = 0, root_energy_ = 0, radians_ = 0, tolerance_ = 0;
  double root_of_start_ = 0;                         // of the work of the accelerations behind the first instant
  double place_tolerance_ = 0, place_rounding_ = 0;  // of lengths, in parts of L
  double strict_ = 0, factor_ = 1, power_ = 1;
  double condition_ = 1;
  double force_ = 0, acceleration_ = 0;         // N, and in units: largest of the loads and of what they would do alone
  std::vector<double> mass_, speed_, inverse_;  // speed_: of a coordinate that has 1 J; inverse_: units / s^2 a N
};

}  // namespace catena
