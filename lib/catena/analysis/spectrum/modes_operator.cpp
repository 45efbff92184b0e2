#include "catena/analysis/spectrum/modes_operator.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/refine_to_rounding.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Each leaves of what is outside 1e-10 x condition, by which constraints yield in KktMatrix: three leave rounding up to
// conditions of 1e5.
constexpr int projections = 3;

}  // namespace

std::vector<double> length_weights(const StaticSystem& system) {
  const Plan& plan = system.plan();
  std::vector<double> weights(at(plan.columns));
  for (int c = 0; c < plan.columns; ++c) {
    const int coordinate = plan.coordinate[at(c)];
    const double r = coordinate % 3 == 2 ? system.radius()[at(coordinate / 3)] : 1;
    weights[at(c)] = r * r;
  }
  return weights;
}

double decisive_component(const Plan& plan, std::span<const double> shape) {
  double largest[2] = {0, 0};
  for (int c = 0; c < plan.columns; ++c) {
    double& most = largest[plan.coordinate[at(c)] % 3 == 2];
    // Equal ones but for rounding: the first.
    if (std::abs(shape[at(c)]) > (1 + 1e-9) * std::abs(most)) most = shape[at(c)];
  }
  return std::abs(largest[1]) > 1e-9 * std::abs(largest[0]) ? largest[1] : largest[0];
}

double solve_to_rounding(StaticSystem& system, std::span<const double> weight, std::span<const double> given,
                         std::span<double> x, std::span<double> correction) {
  const KktMatrix& matrix = system.matrix();
  return refine_to_rounding(
      weight, given, x, correction,
      [&](std::span<double> v) { system.matrix().solve_unrefined(v, system.evaluator().counters); },
      [&](std::span<const double> v, std::span<double> y) { matrix.multiply(v, y); });
}

void project_to_null_space(StaticSystem& system, std::span<double> v, std::span<double> x) {
  const Plan& plan = system.plan();
  if (plan.rows == 0) return;
  const std::span<double> gap = x.subspan(v.size());
  for (int k = 0; k < projections; ++k) {
    std::fill(x.begin(), x.end(), 0.0);
    multiply_add(plan.jacobian, system.jacobian(), v, gap);
    system.matrix().solve_unrefined(x, system.evaluator().counters);
    for (std::size_t c = 0; c < v.size(); ++c) v[c] -= x[c];
  }
}

ModeOperator::ModeOperator(StaticSystem& system, std::vector<double> mass, bool refined)
    : system_(system),
      refined_(refined),
      mass_(std::move(mass)),
      typical_(mass_.size(), 0.0),
      weight_(length_weights(system)) {
  double sum = 0, count = 0;
  for (std::size_t c = 0; c < mass_.size(); ++c) {
    sum += mass_[c] / weight_[c];
    count += mass_[c] > 0;
  }
  // Coordinates without mass are included like the others.
  const double mean = count > 0 ? sum / count : 1;
  for (std::size_t c = 0; c < mass_.size(); ++c) {
    typical_[c] = 1 / std::sqrt(mass_[c] > 0 ? mass_[c] : mean * weight_[c]);
  }
  given_.resize(at(system.plan().columns + system.plan().rows));
  solution_.resize(given_.size());
  correction_.resize(given_.size());
}

bool ModeOperator::factorize(std::span<const double> lambda, double sigma) {
  system_.fill(lambda, Curvature::exact, 0);
  system_.matrix().add_diagonal(mass_, -sigma);
  return system_.factorize().ok();
}

void ModeOperator::metric(std::span<const double> v, std::span<double> Gv) {
  for (std::size_t c = 0; c < v.size(); ++c) Gv[c] = mass_[c] * v[c];
}

void ModeOperator::invert(std::span<double> v) {
  std::fill(given_.begin(), given_.end(), 0.0);
  metric(v, {given_.data(), v.size()});
  if (refined_) {
    solve_to_rounding(system_, weight_, given_, solution_, correction_);
  } else {
    solution_ = given_;
    system_.matrix().solve_unrefined(solution_, system_.evaluator().counters);
  }
  std::copy_n(solution_.begin(), v.size(), v.begin());
}

void ModeOperator::project(std::span<double> v) {
  // Without refinement the factors that would project v are those that it comes from: nothing would be gained.
  if (refined_) project_to_null_space(system_, v, solution_);
}

}  // namespace catena
