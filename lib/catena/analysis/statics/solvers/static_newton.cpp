#include "catena/analysis/statics/solvers/static_newton.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of corrections with the same factors at the end.
constexpr int polishing_steps = 4;
// Part of the residual that a correction may leave, and the multiple of rounding that still counts as rounding.
constexpr double polishing_part = 1e-2, multiple_of_rounding = 10;
// Motion of a balanced start under the weights of the first multipliers, length scales or rad: forces are known to
// first_tolerance, and the weights are forces over the length.
constexpr double still = 1e-3;
// Multipliers beyond this many times the sum of all applied forces, which bounds the force through one joint of an
// unfolded mechanism, belong to rows that depend on each other and contradict.
constexpr double largest_multiplier = 1e7;
// Of the linearised equations, relative to the forces and the extent: the error of one step is removed by the next one
// and by the corrections at the end.
constexpr double step_tolerance = 1e-7, first_tolerance = 1e-4;
// A longer step, length scales or rad, is none: the equations are singular.
constexpr double largest_change = 1e14;

}  // namespace

bool first_multipliers(StaticSystem& system, std::span<double> lambda, bool exact) {
  system.fill_weights();
  if (!system.factorize().ok()) return false;
  StaticStep step = system.newton_step(exact ? 0 : first_tolerance);
  // Where almost nothing would move the forces may balance already, which only exact multipliers show.
  if (!exact && system.change_norm(step.change) <= still) step = system.newton_step(0);
  std::copy(step.lambda.begin(), step.lambda.end(), lambda.begin());
  return true;
}

bool first_tensions(StaticSystem& system, std::span<double> lambda) {
  std::fill(lambda.begin(), lambda.end(), 0.0);
  system.foresee();
  system.fill(lambda, Curvature::convex, 0);
  const double softest = least_shift * system.matrix().largest_stiffness();
  system.fill(lambda, Curvature::convex, std::max(system.dead_load() / system.length(), softest));
  if (!system.factorize().ok()) return false;
  StaticStep step = system.newton_step(first_tolerance);
  if (system.change_norm(step.change) <= still) step = system.newton_step(0);
  std::copy(step.lambda.begin(), step.lambda.end(), lambda.begin());
  system.foresee(step.change, 1, newton_turn);
  return true;
}

namespace {

// Corrections with the factors at hand while they gain.
void correct(StaticSystem& system, std::span<double> q, std::span<double> lambda, StaticOutcome& outcome) {
  std::vector<double> residual(at(system.plan().columns)), gap(at(system.plan().rows));
  KeptPlace before_step;
  const double force = system.force_size(), rounding = system.rounding_change();
  // In units of the possible rounding.
  const auto size = [&] {
    system.residual(lambda, residual);
    outcome.residual = system.force_norm(residual);
    return std::max(outcome.residual / (force_rounding * force), system.phi_norm() / rounding);
  };
  double now = size(), before = outcome.step;
  for (int k = 0; k < polishing_steps; ++k) {
    // The factors are those of the point before: the multipliers' change is solved for, not they themselves.
    for (double& r : residual) r = -r;
    for (std::size_t r = 0; r < gap.size(); ++r) gap[r] = -system.phi()[r];
    const double tolerance =
        polishing_part * std::max(outcome.residual / force, system.phi_norm() * system.length() / system.extent());
    const StaticStep step = system.solve(residual, gap, tolerance);
    const double change = system.change_norm(step.change);
    before_step.keep(system, q, lambda);
    system.advance(q, step.change, 1, newton_turn);
    for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] += step.lambda[r];
    system.move_to(q);
    const double then = size();
    // Residuals of the size of rounding carry no information. The first correction removes the error of the Newton step
    // in soft modes; further ones are made while they shrink.
    const bool rounded = then <= std::max(4 * now, multiple_of_rounding);
    if (!(then < now || (rounded && (k == 0 || change < 0.1 * before)))) {
      before_step.take_back(system, q, lambda);
      size();
      return;
    }
    // The size of one more correction: each is shorter than the one before by the same factor.
    const double next = change * std::min(change / before, 1.0);
    outcome.step = before = change;
    now = then;
    if (next <= rounding && now <= multiple_of_rounding) return;
  }
}

}  // namespace

// Along a motion that nothing resists a correction by K is a force that is rounding over a stiffness that is: it leads
// far away, and what it would mend of constraints and other motions is lost with it. Under the shift it is short.
void polish(StaticSystem& system, std::span<double> q, std::span<double> lambda, StaticOutcome& outcome,
            double tolerance) {
  correct(system, q, lambda, outcome);
  // Where forces balance coordinate by coordinate what is left of each is rounding: loads count as they were.
  const double force = std::max(system.load_size(), system.force_scale(lambda));
  const double met = std::max(tolerance, multiple_of_rounding * system.rounding_change());
  if (outcome.residual <= tolerance * force && system.phi_norm() <= met) return;
  const double stiffest = std::max(system.matrix().largest_stiffness(), system.force_size() / system.length());
  system.fill(lambda, Curvature::exact, descent::suspicious_part * stiffest);
  if (system.factorize().ok()) correct(system, q, lambda, outcome);
}

namespace {

class NewtonSearch {
 public:
  NewtonSearch(StaticSystem& system, std::span<double> q, std::span<double> lambda, const StaticNewtonOptions& options)
      : system_(system), q_(q), lambda_(lambda), options_(options), residual_(at(system.plan().columns)) {}
  ~NewtonSearch() { system_.forget_lengths(); }
  NewtonSearch(const NewtonSearch&) = delete;
  NewtonSearch& operator=(const NewtonSearch&) = delete;

  StaticOutcome run();

 private:
  bool begin();
  void measure();
  bool is_balanced(double rounding) const;
  bool factorize();
  bool step();
  double move(const StaticStep& step);
  bool returns_from_rounding(double change, double residual_before);
  bool is_solved(double change);

  StaticSystem& system_;
  std::span<double> q_, lambda_;
  const StaticNewtonOptions& options_;
  StaticOutcome outcome_;
  std::vector<double> residual_;
  KeptPlace before_;  // the last step from a balanced place
  double force_ = 0;
  bool linear_ = false, near_ = false, balanced_ = false;
  bool minimum_ = false;  // by the inertia of the last exact K
};

bool NewtonSearch::begin() {
  system_.move_to(q_);
  linear_ = system_.has_linear_constraints();
  if (!options_.warm) {
    std::fill(lambda_.begin(), lambda_.end(), 0.0);
    // Without second derivatives of constraints the first step gives the multipliers as well.
    const bool found =
        system_.has_springs() ? first_tensions(system_, lambda_) : linear_ || first_multipliers(system_, lambda_);
    if (!found) return false;
  }
  near_ = options_.warm || linear_;
  outcome_.step = largest_change;
  measure();
  balanced_ = is_balanced(0);
  return true;
}

void NewtonSearch::measure() {
  system_.residual(lambda_, residual_);
  outcome_.residual = system_.force_norm(residual_);
  force_ = system_.force_scale(lambda_);
}

bool NewtonSearch::is_balanced(double rounding) const {
  return outcome_.residual <= options_.tolerance * force_ + rounding &&
         system_.phi_norm() <= std::max(options_.tolerance, 10 * system_.rounding_change());
}

// The exact K where the search is near and that is a minimum, or any place of rest is wanted; else the convex one.
bool NewtonSearch::factorize() {
  minimum_ = outcome_.exact = false;
  if (near_) {
    system_.fill(lambda_, Curvature::exact, 0);
    const bool factored = system_.factorize().ok();
    minimum_ = factored && system_.matrix().negative_modes() == 0;
    outcome_.exact = factored && (minimum_ || options_.stationary);
  }
  if (outcome_.exact) return true;
  return factorize_convex(system_, lambda_);
}

// Moves by a step; the residual from before.
double NewtonSearch::move(const StaticStep& step) {
  const double residual_before = outcome_.residual;
  if (balanced_) before_.keep(system_, q_, lambda_);
  system_.foresee(step.change, 1, newton_turn);
  system_.advance(q_, step.change, 1, newton_turn);
  std::copy(step.lambda.begin(), step.lambda.end(), lambda_.begin());
  system_.move_to(q_);
  measure();
  return residual_before;
}

// Along motions that nothing resists a step from a balanced place consists of rounding: it is taken back.
bool NewtonSearch::returns_from_rounding(double change, double residual_before) {
  if (!balanced_ || !(change > descent::last_step) || outcome_.residual <= thresholds::least_gain * residual_before)
    return false;
  before_.take_back(system_, q_, lambda_);
  outcome_.residual = residual_before;
  return true;
}

// Whether the place is a solution, which is then polished.
bool NewtonSearch::is_solved(double change) {
  // A residual that looks like rounding of the stiffest spring may be the whole force of a soft one: the step shows it.
  const auto is_small = [&] { return is_balanced(outcome_.step <= last_change ? system_.rounding_force() : 0); };
  balanced_ = is_balanced(0);
  // One step ends a linear problem, whatever its length.
  if (change > descent::last_step && !(linear_ && outcome_.exact && is_small())) return false;
  polish(system_, q_, lambda_, outcome_, options_.tolerance);
  force_ = system_.force_scale(lambda_);
  return is_small() || change <= last_change;
}

// False: the search ends.
bool NewtonSearch::step() {
  if (!factorize()) {
    outcome_.end = balanced_ ? StaticEnd::stationary : StaticEnd::singular;
    return false;
  }
  const StaticStep step = system_.newton_step(near_ ? step_tolerance : first_tolerance);
  const double change = system_.change_norm(step.change);
  if (!(change < largest_change)) {
    outcome_.end = balanced_ ? StaticEnd::stationary : StaticEnd::diverged;
    return false;
  }
  const double residual_before = move(step);
  if (returns_from_rounding(change, residual_before)) {
    outcome_.end = StaticEnd::stationary;
    return false;
  }
  outcome_.step = change;
  if (const IterationTrace* trace = system_.evaluator().trace)
    (*trace)("newton", outcome_.iterations, outcome_.residual, change);
  near_ = change <= exact_change;
  if (!(force_ <= largest_multiplier * system_.total_load())) {
    outcome_.end = StaticEnd::diverged;
    return false;
  }
  if (!is_solved(change)) return true;
  outcome_.end = outcome_.exact && minimum_ ? StaticEnd::minimum : StaticEnd::stationary;
  return false;
}

StaticOutcome NewtonSearch::run() {
  if (!begin()) {
    outcome_.end = StaticEnd::singular;
    return outcome_;
  }
  iterate(system_, options_.max_iterations, outcome_, [this] { return step(); });
  return outcome_;
}

}  // namespace

StaticOutcome solve_by_newton(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                              const StaticNewtonOptions& options) {
  return NewtonSearch(system, q, lambda, options).run();
}

}  // namespace catena
