#include "catena/analysis/pose/least_velocity.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/assembly/systems/tangent.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of the largest residual: rows with more than this share in it.
constexpr double comparable = 0.2;

bool has_masses(const Evaluator& evaluator) {
  const Plan& plan = evaluator.plan();
  return std::all_of(plan.coordinate.begin(), plan.coordinate.end(), [&](int coordinate) {
    const auto& body = evaluator.model().bodies[at(plan.model_body[at(coordinate / 3)])];
    return coordinate % 3 == 2 ? body.has_inertia && body.inertia > 0 : body.has_mass && body.mass > 0;
  });
}

}  // namespace

LeastVelocity::LeastVelocity(Evaluator& evaluator)
    : evaluator_(evaluator),
      plan_(evaluator.plan()),
      scaling_(evaluator.plan(), evaluator.length_scale()),
      solver_(evaluator.shared_plan()),
      in_mass_metric_(has_masses(evaluator)) {
  const std::vector<double> radius = evaluator.attachment_radii();
  weight_.resize(at(3 * plan_.moving));
  for (const int c : plan_.coordinate) {
    const bool angle = c % 3 == 2;
    const std::size_t b = at(c / 3);
    const auto& body = evaluator.model().bodies[at(plan_.model_body[b])];
    weight_[at(c)] = in_mass_metric_ ? (angle ? body.inertia : body.mass) : angle ? radius[b] * radius[b] : 1;
  }
  solver_.set_metric(weight_);
  jacobian_.resize(at(plan_.trash_slot()) + 1);
  evaluator_.start_jacobian(jacobian_);
  for (std::vector<double>* rows : {&right_, &rest_, &mu_, &lambda_}) rows->resize(at(plan_.rows));
  start_.resize(weight_.size());
  step_.resize(weight_.size());
  turning_.resize(at(plan_.coordinates()));
}

bool LeastVelocity::factorize(double t, Side side, std::span<const double> q) {
  evaluator_.set_time(t, side);
  evaluator_.set_configuration(q);
  evaluator_.jacobian(jacobian_);
  return plan_.rows == 0 || solver_.factorize(jacobian_, evaluator_.counters);
}

bool LeastVelocity::complete(std::span<const double> right_hand_side, std::span<double> out) {
  const auto subtract_product = [&] {
    std::copy(right_hand_side.begin(), right_hand_side.end(), rest_.begin());
    for (std::size_t c = 0; c < start_.size(); ++c) step_[c] = -start_[c];
    solver_.multiply_add(step_, rest_);
  };
  subtract_product();
  solver_.solve(rest_, step_, lambda_, evaluator_.counters);
  for (std::size_t c = 0; c < start_.size(); ++c) start_[c] += step_[c];
  std::fill(out.begin(), out.end(), 0.0);
  std::copy(start_.begin(), start_.end(), out.begin());
  subtract_product();
  const double left = scaling_.row_norm(rest_);
  const double scale = std::max(scaling_.row_norm(right_hand_side), size(start_));
  return std::isfinite(scale) && left <= thresholds::contradiction * scale;
}

bool LeastVelocity::velocity(double t, Side side, std::span<const double> q, std::span<double> qd) {
  if (!factorize(t, side, q)) return false;
  evaluator_.nu(right_);
  std::fill(start_.begin(), start_.end(), 0.0);
  const bool met = complete(right_, qd);
  mu_ = lambda_;
  return met;
}

bool LeastVelocity::acceleration(std::span<const double> qd, std::span<double> qdd) {
  std::fill(turning_.begin(), turning_.end(), 0.0);
  visit_curvature(evaluator_, mu_,
                  [&](int row, int column, double value) { turning_[at(row)] += value * qd[at(column)]; });
  for (const int c : plan_.coordinate) start_[at(c)] = turning_[at(c)] / weight_[at(c)];
  evaluator_.gamma(qd, right_);
  return complete(right_, qdd);
}

double LeastVelocity::project(double t, Side side, std::span<double> q) {
  double residual = 0, last = 0;
  if (plan_.rows == 0) return residual;
  if (!factorize(t, side, q)) return std::nan("");
  // Each correction halves the residual at least: some fifty end it.
  for (int k = 0;; ++k) {
    evaluator_.set_configuration(q);
    evaluator_.phi(right_);
    residual = scaling_.row_norm(right_);
    if (!(residual > thresholds::position_rounding) || (k > 0 && residual > last / 2)) break;
    last = residual;
    solver_.solve(right_, step_, lambda_, evaluator_.counters);
    ++evaluator_.counters.iterations;
    for (std::size_t c = 0; c < step_.size(); ++c) q[c] -= step_[c];
  }
  return residual;
}

double LeastVelocity::growth(std::span<const double> qd, std::span<const double> x) const {
  double product = 0, square = 0;
  for (std::size_t c = 0; c < weight_.size(); ++c) {
    product += weight_[c] * qd[c] * x[c];
    square += weight_[c] * qd[c] * qd[c];
  }
  return square > 0 ? product / square : 0;
}

double LeastVelocity::size(std::span<const double> rate) const { return scaling_.coordinate_norm(plan_, rate); }

std::vector<int> LeastVelocity::worst_elements() const {
  const double worst = scaling_.row_norm(rest_);
  std::vector<std::pair<double, int>> order;
  for (int r = 0; r < plan_.rows; ++r) {
    const double size = std::abs(rest_[at(r)]) * scaling_.row_unit(r);
    if (!(size < comparable * worst)) order.push_back({-size, plan_.row_element[at(r)]});
  }
  std::stable_sort(order.begin(), order.end());
  std::vector<int> elements;
  for (const auto& [size, element] : order) {
    if (std::find(elements.begin(), elements.end(), element) == elements.end()) elements.push_back(element);
  }
  return elements;
}

int LeastVelocity::heaviest_row() const {
  int heaviest = 0;
  const auto size = [&](int r) { return std::abs(mu_[at(r)]) / scaling_.row_unit(r); };
  for (int r = 0; r < plan_.rows; ++r) {
    if (size(r) > size(heaviest)) heaviest = r;
  }
  return heaviest;
}

}  // namespace catena
