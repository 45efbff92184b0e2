#include "catena/analysis/balance/static_system.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/force_sizes.hpp"
#include "catena/analysis/balance/way_of_forces.hpp"
#include "catena/assembly/length_scale.hpp"

namespace catena {
namespace {

// Part of the largest residual force that adds to every body's convex stiffness against turning.
constexpr double turning_floor = 0.1;
// Stands for the force where there is none at all, N.
constexpr double smallest_force = 1e-200;
// Of rows that are left out, m/N: anything that is no rounding.
constexpr double left_out_compliance = 1;

}  // namespace

StaticSystem::StaticSystem(Evaluator& evaluator)
    : evaluator_(evaluator),
      plan_(evaluator.plan()),
      radius_(evaluator.attachment_radii()),
      matrix_(evaluator.shared_plan(), radius_),
      length_(evaluator.length_scale()),
      scaling_(plan_, length_),
      springs_(evaluator, matrix_.structure().hessian) {
  rest_.assign(at(plan_.coordinates()), 0.0);
  loads_.resize(rest_.size());
  if (springs_.any()) foreseen_.assign(rest_.size(), 0.0);
  gradient_.resize(at(plan_.columns));
  torque_.resize(at(plan_.columns));
  phi_.resize(at(plan_.rows));
  jacobian_.resize(at(plan_.trash_slot()) + 1);
  evaluator_.start_jacobian(jacobian_);
  solution_.resize(at(plan_.columns + plan_.rows));
  lacks_length_ = lacks_length(evaluator);
  if (!has_gaps()) return;
  gaps_.is.assign(at(plan_.rows), 0);
  for (int r : plan_.gap_rows) gaps_.is[at(r)] = 1;
  use_gaps();
}

void StaticSystem::use_gaps() {
  gaps_.one_sided = has_gaps();
  gaps_.open.clear();
  evaluator_.leave_out({});
  matrix_.set_compliance({});
}

void StaticSystem::close_gaps(std::span<const char> closed) {
  if (!has_gaps()) return;
  gaps_.one_sided = false;
  gaps_.open.clear();
  std::vector<double> compliance(at(plan_.rows), 0.0);
  for (std::size_t k = 0; k < closed.size(); ++k) {
    if (closed[k]) continue;
    gaps_.open.push_back(plan_.gap_rows[k]);
    compliance[at(plan_.gap_rows[k])] = left_out_compliance;
  }
  evaluator_.leave_out(gaps_.open);
  matrix_.set_compliance(compliance);
}

void StaticSystem::all_gaps(std::vector<double>& out) {
  out.clear();
  if (!has_gaps()) return;
  gaps_.all.resize(phi_.size());
  evaluator_.leave_out({});
  evaluator_.phi(gaps_.all);
  evaluator_.leave_out(gaps_.open);
  for (int r : plan_.gap_rows) out.push_back(gaps_.all[at(r)]);
}

// The forces give a length where the scene does not, once and for all that is compared later.
void StaticSystem::take_length() {
  lacks_length_ = false;
  const std::vector<CurvePlace> places = evaluator_.curve_places();
  const double way = way_of_forces(evaluator_);
  evaluator_.go_to_curve_places(places);
  if (way == 0) return;
  found_length_ = way;
  take_over_model();
}

void StaticSystem::take_over_model() {
  radius_ = evaluator_.attachment_radii();
  length_ = evaluator_.length_scale();
  if (found_length_ > 0) {
    // Without arms all radii are the length scale.
    for (double& r : radius_) r *= found_length_ / length_;
    length_ = found_length_;
  }
  matrix_.set_radius(radius_);
  scaling_ = Scaling(plan_, length_);
  springs_.take_over_model(evaluator_);
  load_ = total_load_ = 0;
  dead_load_.t = std::numeric_limits<double>::quiet_NaN();
  linear_ = -1;
}

void StaticSystem::move_to(std::span<const double> q) {
  if (lacks_length_) take_length();
  evaluator_.set_configuration(q);
  evaluator_.applied_forces(rest_, loads_);
  for (int c = 0; c < plan_.columns; ++c) gradient_[at(c)] = -loads_[at(plan_.coordinate[at(c)])];
  const ForceSize applied = measure(gradient_);
  load_ = std::max(load_, applied.largest);
  total_load_ = std::max(total_load_, applied.sum);
  evaluator_.phi(phi_);
  evaluator_.jacobian(jacobian_);
  extent_ = length_;
  for (int b = 0; b < plan_.moving; ++b) {
    extent_ = std::max({extent_, std::abs(q[at(3 * b)]), std::abs(q[at(3 * b + 1)])});
  }
}

bool StaticSystem::has_linear_constraints() {
  if (linear_ < 0) {
    linear_ = plan_.constant_jacobian || matrix_.constraints_are_linear(evaluator_);
    matrix_.keep_equal_factors(linear_ == 1);
  }
  return linear_ == 1;
}

void StaticSystem::residual(std::span<const double> lambda, std::span<double> out) const {
  std::copy(gradient_.begin(), gradient_.end(), out.begin());
  multiply_transposed_add(plan_.jacobian, jacobian(), lambda, out);
}

StaticSystem::ForceSize StaticSystem::measure(std::span<const double> forces) const {
  const std::span<const double> inverse_arms = matrix_.inverse_arms();
  ForceSize size;
  for (std::size_t c = 0; c < inverse_arms.size(); ++c) {
    const double force = std::abs(forces[c]) * inverse_arms[c];
    size.largest = std::max(size.largest, force);
    size.sum += force;
  }
  return size;
}

double StaticSystem::force_norm(std::span<const double> forces) const {
  const ForceSize size = measure(forces);
  // A sum shows what is not finite, a maximum may not.
  return std::isfinite(size.sum) ? size.largest : size.sum;
}

double StaticSystem::change_norm(std::span<const double> change) const { return scaling_.column_norm(change); }

double StaticSystem::phi_norm() const {
  if (!gaps_.one_sided) return scaling_.row_norm(phi_);
  return scaling_.scan_rows(phi_.size(),
                            [&](std::size_t row) { return gaps_.is[row] ? std::min(phi_[row], 0.0) : phi_[row]; });
}

double StaticSystem::force_scale(std::span<const double> lambda) const {
  double largest = force_norm(gradient_);
  const SparsePattern& a = plan_.jacobian;
  for (int c = 0; c < plan_.columns; ++c) {
    double own = 0;
    for (int k = a.column_start[at(c)]; k < a.column_start[at(c) + 1]; ++k) {
      own = std::max(own, std::abs(jacobian_[at(k)] * lambda[at(a.row_index[at(k)])]));
    }
    largest = std::max(largest, own * matrix_.inverse_arms()[at(c)]);
  }
  return largest;
}

void StaticSystem::foresee(std::span<const double> change, double factor, double largest_turn) {
  if (!springs_.any()) return;
  if (!change.empty()) {
    std::fill(foreseen_.begin(), foreseen_.end(), 0.0);
    advance(foreseen_, change, factor, largest_turn);
  }
  springs_.foresee(evaluator_, change.empty() ? change : std::span<const double>(foreseen_));
}

double StaticSystem::dead_load() {
  if (dead_load_.t == evaluator_.time()) return dead_load_.size;
  dead_load_.t = evaluator_.time();
  const std::vector<double> loads = force_sizes(evaluator_).loads;
  std::vector<double> of_columns(at(plan_.columns));
  for (int c = 0; c < plan_.columns; ++c) of_columns[at(c)] = loads[at(plan_.coordinate[at(c)])];
  return dead_load_.size = measure(of_columns).largest;
}

void StaticSystem::fill(std::span<const double> lambda, Curvature curvature, double shift) {
  force_ = std::max(force_scale(lambda), smallest_force);
  matrix_.set_hessian(evaluator_, lambda, curvature, &springs_);
  if (curvature == Curvature::convex) {
    residual(lambda, torque_);
    const std::span<double> turning = matrix_.turning();
    const double floor = force_norm(torque_);
    for (int b = 0; b < plan_.moving; ++b) {
      const int column = plan_.column[at(3 * b + 2)];
      if (column >= 0)
        turning[at(b)] = std::hypot(turning[at(b)], torque_[at(column)], turning_floor * floor * radius_[at(b)]);
    }
  }
  matrix_.complete(jacobian(), shift);
}

void StaticSystem::fill_weights() {
  force_ = std::max(force_norm(gradient_), smallest_force);
  matrix_.set_weights(jacobian(), force_ / length_);
}

FactorResult StaticSystem::factorize() {
  const FactorResult result = matrix_.factorize(force_ / length_, evaluator_.counters);
  has_factors_ = result.ok();
  return result;
}

StaticStep StaticSystem::solve(std::span<const double> force, std::span<const double> gap, double tolerance) {
  std::copy(force.begin(), force.end(), solution_.begin());
  std::copy(gap.begin(), gap.end(), solution_.begin() + plan_.columns);
  const Refinement outcome = matrix_.solve(solution_, force_, extent_, tolerance, evaluator_.counters);
  const std::span<const double> all = solution_;
  return {all.first(at(plan_.columns)), all.subspan(at(plan_.columns)), outcome.residual};
}

StaticStep StaticSystem::newton_step(double tolerance) {
  for (std::size_t c = 0; c < gradient_.size(); ++c) solution_[c] = -gradient_[c];
  for (std::size_t r = 0; r < phi_.size(); ++r) solution_[gradient_.size() + r] = -phi_[r];
  const Refinement outcome = matrix_.solve(solution_, force_, extent_, tolerance, evaluator_.counters);
  const std::span<const double> all = solution_;
  return {all.first(at(plan_.columns)), all.subspan(at(plan_.columns)), outcome.residual};
}

void StaticSystem::advance(std::span<double> q, std::span<const double> change, double factor,
                           double largest_turn) const {
  for (int c = 0; c < plan_.columns; ++c) {
    const int coordinate = plan_.coordinate[at(c)];
    double step = factor * change[at(c)];
    if (coordinate % 3 == 2) step = std::clamp(step, -largest_turn, largest_turn);
    q[at(coordinate)] += step;
  }
}

}  // namespace catena
