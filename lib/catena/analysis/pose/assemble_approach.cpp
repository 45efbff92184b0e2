// From a place that meets the constraints to the nearest one to the estimate e:
//
//   W (q - e) + Phi_q^T mu = 0          Newton:  (W + sum mu Phi_qq) x = W (e - q) - Phi_q^T mu   along Phi_q x = 0
//
// x by conjugate gradients along the constraints, preconditioned by W: the first direction is the part of e - q that
// the constraints allow, each one costs a solve with the factors at hand, and negative curvature ends them. Derivatives
// of starts (sensitivity/start_derivatives.hpp) are those of this place: steps along the first direction alone come
// near it by a part of the way only, and by a small one where e is as far as the constraints curve. Source: Gould,
// Hribar, Nocedal, SIAM J. Sci. Comput. 23 (2001), for the projected conjugate gradients.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/assembly/systems/tangent.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Steps towards the estimate, each as long as the constraints are met again soon.
constexpr int max_approach_iterations = 60;
// Iterations for a return to the constraints from nearby: if more are needed, the step was too long.
constexpr int max_return_iterations = 12;
// A slope of this part of the distance changes it by half its square, which is seen; of smaller ones only slopes tell
// what a step is worth.
constexpr double unseen_slope = 1e-5;
// Of the distance: what Newton's last step leaves is far below. With as many equations as coordinates there is freedom
// only where equations depend on each other, and what is left as a rule is rounding times condition.
constexpr double settled_slope = 1e-13, settled_without_freedom = 1e-10;
// A direction is found to this part of its slope, and to the square of what is left of the first slope: as many digits
// as Newton's step has.
constexpr double direction_digits = 0.1;
// And to no more than this, which is rounding of what the constraints allow beside what they do not.
constexpr double most_direction_digits = 1e-6;
constexpr int max_directions = 50;

double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// An entry of sum mu Phi_qq, by coordinates.
struct CurvatureEntry {
  int row, column;
  double value;
};
// Residuals above this overflow when they are squared.
constexpr double largest_residual = 1e120;
// Of the misfit, a square: what may be left of it on a crossing.
constexpr double left_on_crossing = 1e-3;
// From so far away steps lead to a crossing, rad or length scales: their equations are well conditioned still, and
// eight halvings determine it to rounding.
constexpr double way_to_crossing = 0.03;
constexpr int halvings_to_crossing = 8, corrections_on_crossing = 2;
// Of steps that halve, each is more than this part of the one before; where equations are independent the third and
// later ones are rounding.
constexpr double halves = 0.3;

}  // namespace

void Assembler::project(std::span<double> r, std::span<double> z) {
  std::vector<double> allowed(r.size()), out(phi_.size(), 0.0);
  for (std::size_t c = 0; c < r.size(); ++c) allowed[c] = weights_[c] > 0 ? r[c] / weights_[c] : 0;
  solver_->multiply_add(allowed, out);
  solver_->solve(out, z, lambda_, evaluator_.counters);
  for (std::size_t c = 0; c < r.size(); ++c) {
    z[c] = allowed[c] - z[c];
    r[c] = weights_[c] * z[c];
  }
}

double Assembler::find_approach(std::span<const double> q, std::span<const double> estimate) {
  const std::size_t coordinates = step_.size();
  std::vector<double> r(coordinates), z(coordinates), along(coordinates), curved(coordinates);
  for (std::size_t c = 0; c < coordinates; ++c) r[c] = weights_[c] * (estimate[c] - q[c]);
  project(r, z);
  const double first = dot(r, z);
  std::copy(z.begin(), z.end(), step_.begin());
  if (!(first > 0)) return 0;
  const double distance = weighted_distance(q, estimate);
  const double settled = plan_.rows < plan_.columns ? settled_slope : settled_without_freedom;
  if (std::sqrt(first) <= settled * distance) return 0;
  const double enough =
      first * std::pow(std::clamp(std::sqrt(first) / distance, most_direction_digits, direction_digits), 2);
  std::vector<CurvatureEntry> curvature;
  visit_curvature(evaluator_, lambda_, [&](int row, int column, double value) {
    if (value != 0) curvature.push_back({row, column, value});
  });
  along = z;
  double now = first;
  for (int k = 0; k < max_directions && now > enough; ++k) {
    for (std::size_t c = 0; c < coordinates; ++c) curved[c] = weights_[c] * along[c];
    for (const CurvatureEntry& entry : curvature) curved[at(entry.row)] += entry.value * along[at(entry.column)];
    const double bend = dot(along, curved);
    if (!(bend > 0)) break;
    if (k == 0) std::fill(step_.begin(), step_.end(), 0.0);
    for (std::size_t c = 0; c < coordinates; ++c) {
      step_[c] += now / bend * along[c];
      r[c] -= now / bend * curved[c];
    }
    project(r, z);
    const double then = dot(r, z);
    for (std::size_t c = 0; c < coordinates; ++c) along[c] = z[c] + then / now * along[c];
    now = then;
  }
  return std::sqrt(first);
}

void Assembler::approach_estimate(std::span<double> q, std::span<const double> estimate, double tolerance,
                                  AssemblyOutcome& outcome) {
  std::vector<double> candidate(q.begin(), q.end());
  double distance = weighted_distance(q, estimate), last_slope = 0;
  for (int k = 0; k < max_approach_iterations && distance > 0; ++k) {
    evaluator_.set_configuration(q);
    const std::vector<CurvePlace> places = evaluator_.curve_places();
    evaluator_.jacobian(values_);
    if (!solver_->factorize(values_, evaluator_.counters)) return;
    const double slope = find_approach(q, estimate);
    if (slope == 0) return;
    const bool unseen = slope <= unseen_slope * distance;
    // Rounding holds it.
    if (unseen && k > 0 && slope > last_slope / 2) return;
    last_slope = slope;
    double turn = 0;
    for (std::size_t c = 2; c < step_.size(); c += 3) turn = std::max(turn, std::abs(step_[c]));
    const std::vector<double> direction = step_;
    const double closer = distance * (1 + (unseen ? thresholds::solved : -thresholds::solved));
    bool found = false;
    for (double factor = turn > thresholds::largest_turn ? thresholds::largest_turn / turn : 1; factor > 1e-3 && !found;
         factor /= 2) {
      step_ = direction;
      evaluator_.go_to_curve_places(places);
      advance(q, factor, candidate);
      AssemblyOutcome trial;
      found = restore(candidate, tolerance, max_return_iterations, trial) &&
              weighted_distance(candidate, estimate) < closer;
      outcome.iterations += trial.iterations;
    }
    if (!found) return evaluator_.go_to_curve_places(places);
    std::copy(candidate.begin(), candidate.end(), q.begin());
    distance = weighted_distance(q, estimate);
  }
}

int Assembler::element_out_of_range(std::span<const double> q) {
  merit(q);
  for (std::size_t row = 0; row < phi_.size(); ++row) {
    if (!(std::abs(phi_[row]) < largest_residual)) return plan_.row_element[row];
  }
  return -1;
}

// Where branches cross or fold, x*, Newton's steps halve the distance to it, from whatever side they come, so that the
// equations end nearly dependent and met to rounding a square root of that away from it. From further away
//
//   x_k = x* + a 2^-k + b 4^-k + ...        x_k^(m) = x_k+1^(m-1) + (x_k+1^(m-1) - x_k^(m-1)) / (2^m - 1)
//
// has x*, as far as terms go (Neville). q is left where it is if steps do not halve, or x* meets the equations no
// better.
void Assembler::land_on_crossing(std::span<double> q) {
  const double now = merit(q);
  const std::vector<CurvePlace> places = evaluator_.curve_places();
  const auto find_step = [&] {
    evaluator_.jacobian(values_);
    if (!solver_->factorize(values_, evaluator_.counters)) return false;
    solver_->solve(phi_, step_, lambda_, evaluator_.counters);
    return true;
  };
  std::vector<std::vector<double>> x(halvings_to_crossing, std::vector<double>(q.size()));
  bool found = now > 0 && find_step() && extent(step_) > 0;
  if (found) advance(q, way_to_crossing / extent(step_), trial_);
  double before = 0;
  for (std::size_t k = 0; found && k < x.size(); ++k) {
    found = std::isfinite(merit(trial_)) && find_step() && extent(step_) > halves * before;
    before = extent(step_);
    advance(trial_, -1, x[k]);
    trial_ = x[k];
  }
  double power = 2;
  for (std::size_t m = 1; m < x.size(); ++m, power *= 2) {
    for (std::size_t k = 0; k + m < x.size(); ++k) {
      for (std::size_t c = 0; c < q.size(); ++c) x[k][c] = x[k + 1][c] + (x[k + 1][c] - x[k][c]) / (power - 1);
    }
  }
  // What is left is across the branches, where equations are as good as anywhere.
  for (int k = 0; found && k < corrections_on_crossing; ++k) {
    merit(x[0]);
    found = find_step();
    advance(x[0], -1, trial_);
    x[0] = trial_;
  }
  if (found && merit(x[0]) < left_on_crossing * now) {
    std::copy(x[0].begin(), x[0].end(), q.begin());
    return;
  }
  evaluator_.go_to_curve_places(places);
  merit(q);
}

}  // namespace catena
