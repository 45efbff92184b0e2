#include "catena/analysis/motion/equations_of_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/assembly/systems/seen_mass.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The mass that replaces zero, as a part of the constrained mass r: four rounds of refinement then reach rounding, at
// the cost of four digits in every solve; a ratio up to a hundred times larger is accepted and takes eight rounds more.
constexpr double small_part = 1e-4, largest_part = 1e-2;
// Largest reduction of the small masses in one pass, and number of passes: 18 powers of ten beyond the first guess.
constexpr double most_reduction = 1e-3;
constexpr int most_weighings = 6;
// Part of the forces on massless coordinates that may stay unbalanced: rounding leaves 1e-15, and a coordinate without
// constrained mass leaves all of it.
constexpr double unresisted = thresholds::no_force;

}  // namespace

EquationsOfMotion::EquationsOfMotion(Evaluator& evaluator)
    : evaluator_(evaluator),
      plan_(evaluator.plan()),
      scaling_(plan_, evaluator.length_scale()),
      system_(evaluator.shared_plan()) {
  const std::size_t rows = at(plan_.rows), coordinates = at(plan_.coordinates());
  jacobian_.resize(at(plan_.trash_slot()) + 1);
  evaluator_.start_jacobian(jacobian_);
  gamma_.resize(rows);
  lambda_.resize(rows);
  residual_.resize(rows);
  multipliers_.resize(rows);
  loads_.resize(coordinates);
  change_.resize(at(3 * plan_.moving));
}

EquationsOfMotion::EquationsOfMotion(Evaluator& evaluator, const EquationsOfMotion& like)
    : evaluator_(evaluator),
      plan_(evaluator.plan()),
      masses_(like.masses_),
      scaling_(like.scaling_),
      system_(like.system_),
      weighed_(like.weighed_),
      jacobian_(like.jacobian_),
      gamma_(like.gamma_),
      lambda_(like.lambda_),
      loads_(like.loads_),
      residual_(like.residual_),
      multipliers_(like.multipliers_),
      change_(like.change_) {}

Report EquationsOfMotion::use_masses() {
  const Report report = masses_.load(evaluator_);
  if (report.ok()) system_.set_metric(masses_.mass, masses_.substitute);
  factored_ = weighed_ = false;
  return report;
}

void EquationsOfMotion::weigh_massless(std::span<const double> q) {
  if (masses_.massless.empty()) return;
  weighed_ = true;
  const double t = evaluator_.time();
  evaluator_.set_configuration(q);
  if (plan_.rows > 0) evaluator_.jacobian(jacobian_);
  const std::vector<double> seen = seen_masses(plan_, masses_.mass, jacobian_);
  for (int c : masses_.massless) {
    // A coordinate that no equation reaches is held by equations to the ground, or not at all.
    if (seen[at(c)] > 0) masses_.substitute[at(c)] = small_part * seen[at(c)];
  }
  for (int round = 0;; ++round) {
    system_.set_metric(masses_.mass, masses_.substitute);
    factored_ = false;
    if (round == most_weighings || plan_.rows == 0 || !factorize(t, Side::after, q)) return;
    const std::vector<double> shares = system_.massless_shares(evaluator_.counters);
    bool reduced = false;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      if (!(shares[k] > largest_part)) continue;
      masses_.substitute[at(masses_.massless[k])] *= std::max(small_part / shares[k], most_reduction);
      reduced = true;
    }
    if (!reduced) return;
  }
}

std::string EquationsOfMotion::undetermined() const {
  if (masses_.massless.empty() || !(system_.massless_residual() > unresisted)) return {};
  const int worst = system_.worst_massless();
  return fmt::format(
      "the motion of body \"{}\" is not determined: its {} is zero and no constraint ties it to a body with mass",
      evaluator_.model().body_name(plan_.model_body[at(worst / 3)]), worst % 3 == 2 ? "inertia" : "mass");
}

// Loads on the massless coordinates, of no special ratio: coordinates with mass must resist all of them.
Report EquationsOfMotion::check_massless(std::span<const double> q) {
  Report report;
  if (masses_.massless.empty()) return report;
  if (!weighed_) weigh_massless(q);
  std::fill(loads_.begin(), loads_.end(), 0.0);
  std::fill(gamma_.begin(), gamma_.end(), 0.0);
  for (int c : masses_.massless) {
    // Of one size in the metric of the small masses.
    loads_[at(c)] = std::sqrt(masses_.substitute[at(c)]) * (1 + std::abs(std::sin(1.0 + c)));
  }
  const bool factored = factorize(evaluator_.time(), Side::after, q);
  if (factored) system_.solve_motion(loads_, gamma_, change_, lambda_, evaluator_.counters);
  report.message = undetermined();
  if (!factored) report.message = "massless bodies: the constraints' Jacobian is not finite";
  if (!report.message.empty()) report.status = Status::refused;
  return report;
}

bool EquationsOfMotion::evaluate_jacobian(double t, Side side, std::span<const double> q) {
  evaluator_.set_time(t, side);
  evaluator_.set_configuration(q);
  if (plan_.rows == 0 || (factored_ && plan_.constant_jacobian)) return true;
  evaluator_.jacobian(jacobian_);
  factored_ = system_.factorize(jacobian_, evaluator_.counters);
  return factored_;
}

bool EquationsOfMotion::factorize(double t, Side side, std::span<const double> q) {
  return evaluate_jacobian(t, side, q);
}

bool EquationsOfMotion::accelerations(double t, Side side, std::span<const double> q, std::span<const double> qd,
                                      std::span<double> qdd, double stabilisation) {
  if (!evaluate_jacobian(t, side, q)) return false;
  evaluator_.applied_forces(qd, loads_);
  if (state_loads_) state_loads_->add(qd, loads_);
  if (plan_.rows > 0) evaluator_.gamma(qd, gamma_);
  if (plan_.rows > 0 && stabilisation > 0) stabilise(qd, stabilisation);
  system_.solve_motion(loads_, gamma_, qdd, lambda_, evaluator_.counters);
  if (system_.massless_residual() > unresisted) {
    // The constrained masses have become so small that the substitutes are no longer small beside them.
    weigh_massless(q);
    if (!evaluate_jacobian(t, side, q)) return false;
    system_.solve_motion(loads_, gamma_, qdd, lambda_, evaluator_.counters);
    if (system_.massless_residual() > unresisted) return false;
  }
  if (state_loads_ && !state_loads_->complete(*this, gamma_, loads_, qdd, lambda_)) return false;
  double sum = 0;
  for (std::size_t c = 0; c < change_.size(); ++c) sum += qdd[c];
  return std::isfinite(sum);
}

void EquationsOfMotion::stabilise(std::span<const double> qd, double rate) {
  evaluator_.nu(residual_);
  for (double& value : residual_) value = -value;
  system_.multiply_add(qd, residual_);
  for (std::size_t k = 0; k < gamma_.size(); ++k) gamma_[k] -= 2 * rate * residual_[k];
  evaluator_.phi(residual_);
  for (std::size_t k = 0; k < gamma_.size(); ++k) gamma_[k] -= rate * rate * residual_[k];
}

double EquationsOfMotion::position_residual(std::span<const double> q) {
  if (plan_.rows == 0) return 0;
  evaluator_.set_configuration(q);
  evaluator_.phi(residual_);
  return scaling_.row_norm(residual_);
}

double EquationsOfMotion::project_position(std::span<double> q, int max_iterations) {
  if (plan_.rows == 0) return 0;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0;; ++k) {
    const double size = position_residual(q);
    // Stop at rounding, when nothing is gained any more, or when the residual is NaN.
    if (!(size > thresholds::position_rounding) || k == max_iterations || size > 0.5 * before) return size;
    before = size;
    system_.least_change(residual_, change_, multipliers_, evaluator_.counters);
    for (std::size_t c = 0; c < change_.size(); ++c) q[c] -= change_[c];
  }
}

double EquationsOfMotion::project_velocity(std::span<double> qd, double rate) {
  if (plan_.rows == 0) return 0;
  // The factors are those of a point nearby; the Jacobian must be the true one.
  if (!plan_.constant_jacobian) evaluator_.jacobian(jacobian_);
  double first = 0;
  for (int k = 0; k < 3; ++k) {
    evaluator_.nu(residual_);
    for (double& value : residual_) value = -value;
    system_.multiply_add(qd, residual_);
    const double size = scaling_.row_norm(residual_);
    if (k == 0) first = size;
    if (!(size > thresholds::position_rounding * rate) || k == 2) break;
    system_.least_change(residual_, change_, multipliers_, evaluator_.counters);
    for (std::size_t c = 0; c < change_.size(); ++c) qd[c] -= change_[c];
  }
  return first;
}

void EquationsOfMotion::remove_forbidden(std::span<double> x) {
  if (plan_.rows == 0) return;
  std::fill(residual_.begin(), residual_.end(), 0.0);
  system_.multiply_add(x, residual_);
  system_.least_change_rough(residual_, change_, multipliers_, evaluator_.counters);
  for (std::size_t c = 0; c < change_.size(); ++c) x[c] -= change_[c];
}

}  // namespace catena
