#include "catena/analysis/accuracy/equilibrium_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/balance/static_accuracy.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
// An answer of the linear equations is used if it leaves no more than this of their right-hand sides.
constexpr double solved = 1e-3;

}  // namespace

void EquilibriumAccuracy::take(const Snapshot& snapshot, std::span<const double> values) {
  errors_.take_row(values);
  values_.assign(values.begin(), values.end());
  q_.assign(snapshot.q.begin(), snapshot.q.end());
  ++rows_;
}

std::vector<double> EquilibriumAccuracy::digits(const AnalysisReport& report) {
  if (analysis_.plan().columns > Disturbance::most_columns) return {};
  if (!report.ok() || rows_ != 1 || withheld_) return {};
  StaticSystem& system = analysis_.system();
  unique_ = report.redundant.empty();
  lambda_.assign(analysis_.lambda().begin(), analysis_.lambda().end());
  system.evaluator().set_time(analysis_.time());
  system.forget_lengths();
  system.move_to(q_);
  system.fill(lambda_, Curvature::exact, 0);
  if (!system.factorize().ok() || !correct()) return {};
  values_at(q_, lambda_, first_);
  rounding_ = balance_rounding(system, lambda_);
  square_.assign(columns_.size(), 0.0);
  for (int k = 0; k < Disturbance::disturbed_values; ++k) {
    if (!disturb()) return {};
  }
  for (std::size_t k = 0; k < square_.size(); ++k) {
    if (std::isnan(values_[k])) continue;
    errors_.take_error(k, std::abs(values_[k] - first_[k]) +
                              Disturbance::deviations * std::sqrt(square_[k] / Disturbance::disturbed_values));
  }
  errors_.take_places(columns_.info(), system.evaluator().length_scale());
  return errors_.digits();
}

// Equations that depend on each other contradict each other by rounding: of what they lack, only the part that changes
// of the coordinates can close is left, as the search leaves it.
void EquilibriumAccuracy::leave_what_closes(std::span<double> gap) {
  StaticSystem& system = analysis_.system();
  const std::vector<double> no_force(at(system.plan().columns));
  const StaticStep step = system.solve(no_force, gap, 1);
  std::fill(gap.begin(), gap.end(), 0.0);
  multiply_add(system.plan().jacobian, system.jacobian(), step.change, gap);
}

// change_, change_lambda_ of these right-hand sides, which are spoilt. They are made as large as the forces in the
// mechanism, with which the solver compares what is left.
bool EquilibriumAccuracy::answer(std::span<double> force, std::span<double> gap) {
  StaticSystem& system = analysis_.system();
  if (!unique_) leave_what_closes(gap);
  double size = system.force_norm(force) / system.force_size();
  for (std::size_t r = 0; r < gap.size(); ++r) {
    const bool angle = system.plan().row_is_angle[r] != 0;
    size = std::max(size, std::abs(gap[r]) / (angle ? 1 : system.length()));
  }
  change_.assign(force.size(), 0.0);
  change_lambda_.assign(gap.size(), 0.0);
  if (size == 0) return true;
  for (double& f : force) f /= size;
  for (double& g : gap) g /= size;
  const StaticStep step = system.solve(force, gap, solved * Disturbance::epsilon);
  if (!(step.residual <= solved)) return false;
  for (std::size_t c = 0; c < change_.size(); ++c) change_[c] = size * step.change[c];
  for (std::size_t r = 0; r < gap.size(); ++r) change_lambda_[r] = size * step.lambda[r];
  return std::isfinite(system.change_norm(change_));
}

// One Newton step more.
bool EquilibriumAccuracy::correct() {
  StaticSystem& system = analysis_.system();
  std::vector<double> force(at(system.plan().columns)), gap(system.phi().begin(), system.phi().end());
  system.residual(lambda_, force);
  for (double& f : force) f = -f;
  for (double& g : gap) g = -g;
  if (!answer(force, gap) || !(system.change_norm(change_) <= Disturbance::largest_way)) return false;
  for (std::size_t c = 0; c < change_.size(); ++c) q_[at(system.plan().coordinate[c])] += change_[c];
  for (std::size_t r = 0; r < gap.size(); ++r) lambda_[r] += change_lambda_[r];
  system.move_to(q_);
  return true;
}

bool EquilibriumAccuracy::disturb() {
  StaticSystem& system = analysis_.system();
  Evaluator& evaluator = system.evaluator();
  const Plan& plan = system.plan();
  // How far all is off for a relative rounding of one: of the time first, by differences.
  std::vector<double> force(at(plan.columns)), gap(at(plan.rows)), late(force.size());
  const double t = analysis_.time(), instant = Disturbance::amplification * Disturbance::epsilon * random_.next();
  system.residual(lambda_, force);
  std::copy(system.phi().begin(), system.phi().end(), gap.begin());
  evaluator.set_time_along(t * (1 + instant), t);
  system.move_to(q_);
  system.residual(lambda_, late);
  for (std::size_t c = 0; c < force.size(); ++c)
    force[c] =
        (force[c] - late[c]) / Disturbance::amplification + Disturbance::usual_rounding * random_.next() * rounding_[c];
  std::vector<double> moduli;
  place_moduli(evaluator, q_, moduli);
  const std::span<const double> terms = terms_.sum(system.jacobian(), moduli);
  for (std::size_t r = 0; r < gap.size(); ++r)
    gap[r] = (gap[r] - system.phi()[r]) / Disturbance::amplification + random_.next() * Disturbance::epsilon * terms[r];
  if (!answer(force, gap)) return false;
  const double shift = system.change_norm(change_);
  const double size =
      std::min(Disturbance::amplification, shift > 0 ? Disturbance::largest_way / shift : Disturbance::amplification);
  std::vector<double> q = q_, lambda = lambda_;
  for (std::size_t c = 0; c < change_.size(); ++c) {
    const std::size_t k = at(plan.coordinate[c]);
    q[k] += size * (change_[c] + Disturbance::epsilon / 2 * random_.next() * moduli[k]);
  }
  for (std::size_t r = 0; r < lambda.size(); ++r)
    lambda[r] += size * (change_lambda_[r] + Disturbance::epsilon / 2 * random_.next() * lambda_[r]);
  values_at(q, lambda, other_);
  evaluator.set_time(t);
  system.move_to(q_);
  for (std::size_t k = 0; k < square_.size(); ++k) {
    const double difference = (other_[k] - first_[k]) / size;
    square_[k] += difference * difference;
  }
  return true;
}

std::vector<double>& EquilibriumAccuracy::values_at(std::span<const double> q, std::span<const double> lambda,
                                                    std::vector<double>& values) {
  Evaluator& evaluator = analysis_.evaluator();
  evaluator.set_configuration(q);
  Snapshot snapshot{.evaluator = evaluator, .t = analysis_.time(), .q = q, .lambda = lambda, .residual = no_value};
  const std::vector<double> unknown(lambda.size(), no_value);
  if (!unique_) snapshot.lambda = unknown;
  values.resize(columns_.size());
  columns_.evaluate(snapshot, values);
  return values;
}

}  // namespace catena
