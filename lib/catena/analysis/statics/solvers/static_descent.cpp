#include "catena/analysis/statics/solvers/static_descent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/balance/static_turns.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/motion_groups.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/analysis/statics/solvers/endless_fall.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Extents beyond which a search asks whether the energy falls along its way for ever: most searches stay below.
constexpr double far_away = 1e5;
// Rad: after so many whole turns a search asks whether they have led to the place where it was.
constexpr double several_turns = 6 * std::numbers::pi;

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

}  // namespace

bool restore_constraints(StaticSystem& system, std::span<double> q) {
  const Plan& plan = system.plan();
  system.move_to(q);
  const std::vector<double> no_force(at(plan.columns), 0.0), predicted(q.begin(), q.end());
  std::vector<double> gap(at(plan.rows));
  const double enough = std::max(descent::restored, 10 * system.rounding_change());
  // With the present factors as long as they converge; then, as beyond a singular position, with new ones at every
  // step.
  for (const bool anew : {false, true}) {
    // A trial further on may have reached a configuration that cannot be factored (coinciding centres of gears).
    if (!anew && !system.has_factors()) continue;
    double before = system.phi_norm();
    for (int k = 0; k < descent::most_corrections; ++k) {
      if (before <= enough) return true;
      if (anew) {
        system.fill_weights();
        if (!system.factorize().ok()) return false;
      }
      for (std::size_t r = 0; r < gap.size(); ++r) gap[r] = -system.phi()[r];
      const StaticStep step = system.solve(no_force, gap, 1e-3);
      if (!(system.change_norm(step.change) < descent::longest_correction)) break;
      system.advance(q, step.change, 1, 1);
      system.move_to(q);
      const double now = system.phi_norm();
      if (!(now <= descent::remaining_part * before)) break;
      before = now;
    }
    if (system.phi_norm() <= enough) return true;
    if (!anew) {
      std::copy(predicted.begin(), predicted.end(), q.begin());
      system.move_to(q);
    }
  }
  return false;
}

namespace {

class Descent {
 public:
  Descent(StaticSystem& system, std::span<double> q, std::span<double> lambda, const StaticDescentOptions& options)
      : system_(system),
        q_(q),
        lambda_(lambda),
        options_(options),
        start_(q.begin(), q.end()),
        residual_(at(system.plan().columns)),
        gradient_(residual_.size()),
        change_(residual_.size()),
        product_(residual_.size()),
        trial_(q.size()),
        next_lambda_(at(system.plan().rows)) {}

  StaticOutcome run();

 private:
  enum class Trial { accepted, rejected, ended };
  bool begin();
  void measure();
  double energy_on_constraints(std::span<const double> lambda) const;
  void tell() const;
  bool step();
  Trial go(double shift);
  void finish();
  bool is_neutral(double shift, double slope);
  bool search_along(double shift, double slope);
  bool goes_on();
  bool is_turned();

  StaticSystem& system_;
  std::span<double> q_, lambda_;
  const StaticDescentOptions& options_;
  StaticOutcome outcome_;
  const std::vector<double> start_;
  std::vector<double> residual_, gradient_, change_, product_, trial_, next_lambda_;
  std::vector<CurvePlace> curve_places_;
  bool balanced_ = false;  // where the step begins
  bool is_far_ = false;    // from the start
  double extent_ = 0, load_ = 0;
  double reach_ = 1;       // the limit on steps, in those of the first
  double last_shift_ = 0;  // of K, in the step before
  double energy_ = 0, energy_size_ = 0;
};

// Onto the constraints, with multipliers. False: that cannot be done.
bool Descent::begin() {
  system_.move_to(q_);
  std::fill(lambda_.begin(), lambda_.end(), 0.0);
  // Where constraints have no second derivatives the first step needs no multipliers.
  const bool prepare = !system_.has_linear_constraints() || system_.phi_norm() > descent::restored;
  if (prepare && (!first_multipliers(system_, lambda_, true) || !restore_constraints(system_, q_))) return false;
  extent_ = system_.extent();
  load_ = system_.force_norm(system_.gradient());
  measure();
  energy_ = energy_on_constraints(lambda_);
  energy_size_ = std::abs(energy_);
  return true;
}

void Descent::measure() {
  system_.residual(lambda_, residual_);
  outcome_.residual = system_.force_norm(residual_);
}

// Constraints are met to 1e-10, and the energy there misses that of the place on them by -lambda^T Phi to first order,
// which is more than the last steps lower it by.
double Descent::energy_on_constraints(std::span<const double> lambda) const {
  return system_.energy() + dot(lambda, system_.phi());
}

void Descent::tell() const {
  if (const IterationTrace* trace = system_.evaluator().trace)
    (*trace)("downhill", outcome_.iterations, outcome_.residual, outcome_.step);
}

StaticOutcome Descent::run() {
  if (!begin()) {
    outcome_.end = StaticEnd::singular;
    return outcome_;
  }
  iterate(system_, options_.max_iterations, outcome_, [this] {
    if (!step()) return false;
    for (std::size_t c = 0; c < change_.size(); ++c) {
      const std::size_t k = at(system_.plan().coordinate[c]);
      change_[c] = trial_[k] - q_[k];
    }
    std::copy(trial_.begin(), trial_.end(), q_.begin());
    std::copy(next_lambda_.begin(), next_lambda_.end(), lambda_.begin());
    measure();
    tell();
    return goes_on();
  });
  return outcome_;
}

// False where the way that the last step made in change_ does not end.
bool Descent::goes_on() {
  const Travel travel = travel_between(start_, q_);
  if (travel.turn > several_turns && is_turned()) {
    outcome_.end = StaticEnd::turning;
    return false;
  }
  is_far_ = std::max(travel.length / extent_, travel.turn) > far_away;
  if (!is_far_) return true;
  if (!travel.is_lost(extent_) && !falls_for_ever(system_, q_, change_)) return true;
  outcome_.end = StaticEnd::unbounded;
  return false;
}

// Whether bodies have turned by whole turns that no element counts: the forces are those of the place without these
// turns, where the energy is higher.
bool Descent::is_turned() {
  std::vector<double> before(q_.begin(), q_.end());
  curve_places_ = system_.evaluator().curve_places();
  const double energy = system_.energy();
  if (!drop_whole_turns(system_.plan(), start_, before)) return false;
  gradient_.assign(system_.gradient().begin(), system_.gradient().end());
  system_.move_to(before);
  for (std::size_t c = 0; c < gradient_.size(); ++c) gradient_[c] -= system_.gradient()[c];
  const double work = system_.energy() - energy, force = system_.force_size();
  const bool same = system_.force_norm(gradient_) <= thresholds::no_force * force;
  system_.evaluator().go_to_curve_places(curve_places_);
  system_.move_to(q_);
  return same && work > thresholds::no_force * force * extent_;
}

// One step downhill, to trial_: with the exact K, stiffened until its inertia is that of a minimum and a step can be
// made. False: the search ends.
bool Descent::step() {
  balanced_ = outcome_.residual <= options_.tolerance * system_.force_scale(lambda_);
  double stiffest = 0, loads = 0;
  for (double shift = 0; std::isfinite(shift) && shift <= descent::largest_shift * std::max(stiffest, loads);) {
    system_.fill(lambda_, Curvature::exact, shift);
    const bool minimum = system_.factorize().ok() && system_.matrix().negative_modes() == 0;
    outcome_.exact = minimum && shift == 0;
    const double used = shift;
    if (shift == 0) {
      stiffest = system_.matrix().largest_stiffness();
      // Far away a step is long that changes the place by a part of itself.
      loads = system_.force_size() / (is_far_ ? system_.extent() : extent_);
      shift = std::max({descent::first_of_rounding * stiffest, descent::first_of_force * loads,
                        descent::part_of_last * last_shift_});
    } else {
      shift *= minimum ? growth_after_failure : descent::stiffening;
    }
    if (!minimum) continue;
    const Trial trial = go(used);
    if (trial != Trial::rejected) return trial == Trial::accepted;
  }
  outcome_.end = StaticEnd::slow;
  return false;
}

// A step with the factors of K and this shift.
Descent::Trial Descent::go(double shift) {
  const StaticStep step = system_.newton_step(1e-12);
  outcome_.step = system_.change_norm(step.change);
  if (!std::isfinite(outcome_.step)) return Trial::rejected;
  std::copy(step.change.begin(), step.change.end(), change_.begin());
  std::copy(step.lambda.begin(), step.lambda.end(), next_lambda_.begin());
  if (outcome_.step <= descent::polishing_change) {
    finish();
    return Trial::ended;
  }
  std::copy(system_.gradient().begin(), system_.gradient().end(), gradient_.begin());
  const double slope = dot(gradient_, change_) - dot(next_lambda_, system_.phi());
  if (is_neutral(shift, slope)) {
    if (!balanced_) return Trial::rejected;
    outcome_.end = StaticEnd::stationary;
    return Trial::ended;
  }
  const bool accepted = search_along(shift, slope);
  system_.move_to(accepted ? std::span<const double>(trial_) : std::span<const double>(q_));
  return accepted ? Trial::accepted : Trial::rejected;
}

// The last step, a short one.
void Descent::finish() {
  system_.advance(q_, change_, 1, 1);
  std::copy(next_lambda_.begin(), next_lambda_.end(), lambda_.begin());
  system_.move_to(q_);
  polish(system_, q_, lambda_, outcome_, options_.tolerance);
  tell();
  const double force = std::max(system_.force_scale(lambda_), load_);
  outcome_.end = outcome_.exact                                 ? StaticEnd::minimum
                 : outcome_.residual <= negligible_part * force ? StaticEnd::stationary
                                                                : StaticEnd::slow;
}

// On the constraints the slope is minus the curvature along the step. Where both are rounding the motion is neutral and
// the step has no meaning: if forces balance the point is kept, else the shift limits the motion.
bool Descent::is_neutral(double shift, double slope) {
  if (shift != 0) return false;
  if (-slope <= neutral_part * system_.matrix().absolute_quadratic(change_)) return true;
  if (!balanced_) return false;
  // Terms that cancel within K, as those of a counterweight, do not appear there, and a balanced slope is itself
  // rounding.
  system_.matrix().multiply_stiffness(change_, product_);
  return dot(change_, product_) <= StiffnessFloor(system_, lambda_, 0)(change_);
}

// Halves the step until the energy decreases; trial_ is where it ends.
bool Descent::search_along(double shift, double slope) {
  const Travel travel = travel_of(system_.plan(), change_);
  double factor = std::min({1.0, reach_ * descent::largest_turn / travel.turn, reach_ * extent_ / travel.length});
  const bool clipped = factor < 1;
  const double noise = descent::noise_part * (energy_size_ + system_.force_size() * extent_);
  curve_places_ = system_.evaluator().curve_places();
  for (; factor > thresholds::smallest_factor; factor /= 2) {
    std::copy(q_.begin(), q_.end(), trial_.begin());
    system_.advance(trial_, change_, factor, std::numeric_limits<double>::infinity());
    if (!restore_constraints(system_, trial_)) {
      system_.evaluator().go_to_curve_places(curve_places_);
      continue;
    }
    const double then = energy_on_constraints(next_lambda_);
    if (then <= energy_ + descent::sufficient_decrease * factor * std::min(slope, 0.0) + noise) {
      energy_ = then;
      energy_size_ = std::max(energy_size_, std::abs(then));
      last_shift_ = shift;
      // Steps that reach the limit double it: an energy without a minimum is then recognised after few steps.
      if (clipped) reach_ *= 2;
      return true;
    }
    reach_ = std::max(reach_ / 2, 1.0);
    // The trial that was rejected may have found contacts far from here.
    system_.evaluator().go_to_curve_places(curve_places_);
  }
  return false;
}

}  // namespace

StaticOutcome solve_by_descent(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                               const StaticDescentOptions& options) {
  return Descent(system, q, lambda, options).run();
}

}  // namespace catena
