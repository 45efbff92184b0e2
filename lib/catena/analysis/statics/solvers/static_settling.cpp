#include "catena/analysis/statics/solvers/static_settling.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "catena/analysis/balance/static_tangent.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/statics/solvers/static_active_set.hpp"
#include "catena/analysis/statics/solvers/static_settling_gaps.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of a step, in extents of the scene.
constexpr double largest_travel = 0.5;
// Growth of the residual allowed in an accepted step, and the change of the damping from step to step.
constexpr double tolerated_growth = 3, fastest_fading = 0.05;
// Of the largest stiffness: more damping helps no more, and less is none.
constexpr double largest_damping = 1e12, least_damping = 1e-14;

class Settling {
 public:
  Settling(StaticSystem& system, std::span<double> q, std::span<double> lambda, const StaticSettlingOptions& options,
           ActiveSet& set)
      : system_(system),
        q_(q),
        lambda_(lambda),
        options_(options),
        set_(set),
        start_(q.begin(), q.end()),
        x_(at(system.plan().columns) + at(system.plan().rows)),
        residual_(at(system.plan().columns)) {}

  StaticOutcome run();

 private:
  bool begin();
  double size();
  bool solve();
  bool solve_with_gaps();
  bool stiffen();
  double move();
  bool is_balanced();
  void polish();
  bool step();

  StaticSystem& system_;
  std::span<double> q_, lambda_;
  const StaticSettlingOptions& options_;
  ActiveSet& set_;
  std::optional<StaticTangent> tangent_;
  std::optional<SettlingGaps> gaps_;
  StaticOutcome outcome_;
  const std::vector<double> start_;
  std::vector<double> x_, residual_;  // x: changes of q and lambda
  KeptPlace before_;
  double extent_ = 1, force_ = 1, stiffness_ = 1;
  double damping_ = 0, size_ = 0;  // E times the stiffness; of the residual where the step begins
  double factor_ = 1;              // part of the step that was made
};

bool Settling::begin() {
  if (system_.has_gaps()) gaps_.emplace(system_, set_, options_.tolerance);
  system_.move_to(q_);
  if (!first_multipliers(system_, lambda_)) return false;
  tangent_.emplace(system_);
  extent_ = system_.extent();
  force_ = std::max(system_.force_scale(lambda_), 1e-200);
  stiffness_ = force_ / system_.length();
  damping_ = stiffness_;
  size_ = size();
  return true;
}

double Settling::size() {
  system_.residual(lambda_, residual_);
  outcome_.residual = system_.force_norm(residual_);
  return outcome_.residual / force_ + system_.phi_norm() + (gaps_ ? gaps_->overlap() : 0);
}

// The step from where the system is, to x_. False: there is none with this damping.
bool Settling::solve() {
  tangent_->fill(lambda_, damping_);
  tangent_->set_compliance(settling_regularisation / stiffness_);
  if (!tangent_->factorize()) return false;
  const std::size_t columns = residual_.size();
  for (std::size_t c = 0; c < columns; ++c) x_[c] = -residual_[c];
  for (std::size_t r = columns; r < x_.size(); ++r) x_[r] = -system_.phi()[r - columns];
  return tangent_->solve(x_);
}

// The same with the gaps that hold at its end.
bool Settling::solve_with_gaps() {
  gaps_->begin(q_, force_);
  do {
    gaps_->hold(q_, lambda_);
    system_.residual(lambda_, residual_);
    if (!solve()) return false;
  } while (gaps_->change(lambda_, x_));
  return gaps_->is_found();
}

// More damping after a step that failed. False: no more helps.
bool Settling::stiffen() {
  damping_ = std::max(growth_after_failure * damping_, 1e-6 * stiffness_);
  return damping_ <= largest_damping * stiffness_;
}

// Moves by the step in x_, shortened; the size of the residual there. What cannot be a step moves nothing.
double Settling::move() {
  const std::span<const double> change(x_.data(), residual_.size());
  const auto [turn, travel] = travel_of(system_.plan(), change);
  factor_ = std::min({1.0, thresholds::largest_turn / turn, largest_travel * extent_ / travel});
  if (!std::isfinite(turn + travel)) return size_;
  system_.advance(q_, change, factor_, thresholds::largest_turn);
  for (std::size_t r = 0; r < lambda_.size(); ++r) lambda_[r] += factor_ * x_[change.size() + r];
  system_.move_to(q_);
  outcome_.step = system_.change_norm(change);
  const double then = size();
  if (const IterationTrace* trace = system_.evaluator().trace)
    (*trace)("settling", outcome_.iterations, outcome_.residual, outcome_.step);
  return then;
}

// Rounding of the stiffest spring may be the whole force of a soft one: then the step decides.
bool Settling::is_balanced() {
  const double scale = std::max(system_.force_scale(lambda_), force_);
  const double rounding = damping_ == 0 && outcome_.step <= last_change ? system_.rounding_force() : 0;
  return outcome_.residual <= options_.tolerance * scale + rounding &&
         system_.phi_norm() <= std::max(options_.tolerance, 10 * system_.rounding_change()) &&
         (!gaps_ || gaps_->hold_all(lambda_));
}

// From a place that is balanced: further, while steps halve the residual. The last step but one may just pass by this
// solver's measure of the forces, and not by that of the judge.
void Settling::polish() {
  while (outcome_.step > last_change) {
    before_.keep(system_, q_, lambda_);
    const ActiveSet set = set_;
    const double residual = outcome_.residual;
    const double then = (gaps_ ? solve_with_gaps() : solve()) ? move() : size_;
    if (then <= thresholds::least_gain * size_ && is_balanced()) {
      size_ = then;
      continue;
    }
    set_ = set;
    if (gaps_) system_.close_gaps(set_.closed);
    before_.take_back(system_, q_, lambda_);
    outcome_.residual = residual;
    return;
  }
}

// False: the search ends.
bool Settling::step() {
  before_.keep(system_, q_, lambda_);
  const bool solved = gaps_ ? solve_with_gaps() : solve();
  const double then = solved ? move() : size_;
  if (!solved || !(then <= tolerated_growth * size_ + options_.tolerance)) {
    before_.take_back(system_, q_, lambda_);
    size_ = size();
    return stiffen();
  }
  const double ratio = then / std::max(size_, 1e-300);
  damping_ *= factor_ < 1 ? 2 : std::clamp(ratio, fastest_fading, growth_after_failure);
  // Short steps may be so for the damping alone, which then hides by how much the residual could shrink.
  if (outcome_.step < exact_change) damping_ /= 2;
  if (damping_ < least_damping * stiffness_) damping_ = 0;
  size_ = then;
  if (travel_between(start_, q_).is_lost(extent_)) {
    outcome_.end = StaticEnd::unbounded;
    return false;
  }
  if (!is_balanced()) return true;
  outcome_.end = StaticEnd::stationary;
  polish();
  if (gaps_) mark_weak(system_, lambda_, set_);
  return false;
}

StaticOutcome Settling::run() {
  if (!begin()) {
    outcome_.end = StaticEnd::singular;
    return outcome_;
  }
  iterate(system_, options_.max_iterations, outcome_, [this] { return step(); });
  return outcome_;
}

}  // namespace

StaticOutcome solve_by_settling(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                                const StaticSettlingOptions& options) {
  ActiveSet none;
  return solve_by_settling(system, q, lambda, none, options);
}

StaticOutcome solve_by_settling(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                                const StaticSettlingOptions& options) {
  return Settling(system, q, lambda, options, set).run();
}

}  // namespace catena
