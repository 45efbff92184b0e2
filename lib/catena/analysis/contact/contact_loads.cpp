#include "catena/analysis/contact/contact_loads.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "catena/analysis/motion/equations_of_motion.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// Newton's method on forces that are nearly linear in each other: without joints one step is exact, with joints the
// error is squared in every step.
constexpr int most_iterations = 30;
constexpr double settled = 1e-15;

}  // namespace

void scatter_gradient(const Evaluator::ScalarMotion& of, double factor, std::span<double> loads) {
  for (int k = 0; k < 3; ++k) {
    loads[at(3 * of.body_i + k)] += factor * of.gradient[k];
    loads[at(3 * of.body_j + k)] += factor * of.gradient[3 + k];
  }
}

double fastest(const Evaluator& evaluator, std::span<const double> qd) {
  double largest = 0;
  for (int c = 0; c < 3 * evaluator.plan().moving; ++c)
    largest = std::max(largest, std::abs(qd[at(c)]) * (c % 3 == 2 ? evaluator.length_scale() : 1));
  return largest;
}

ContactLoads::ContactLoads(const Evaluator& evaluator, const std::vector<ContactPoint>& points,
                           std::vector<ContactState> states)
    : evaluator_(evaluator),
      points_(points),
      states_(std::move(states)),
      slide_(points.size()),
      normal_(points.size(), 0.0),
      friction_(points.size(), 0.0) {
  const auto coordinates = at(evaluator.plan().coordinates());
  unit_.resize(coordinates);
  change_.resize(coordinates);
  nothing_.assign(at(evaluator.plan().rows), 0.0);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const bool compliant = points_[k].kind == ContactKind::compliant;
    if (slides(k) && !compliant) coupled_.push_back(k);
    dissipates_ |= slides(k) || (compliant && states_[k].closed && points_[k].c > 0);
  }
  response_.assign(coupled_.size(), nothing_);
}

bool ContactLoads::slides(std::size_t k) const {
  if (!points_[k].has_friction() || !states_[k].closed || points_[k].mu == 0) return false;
  return !points_[k].is_exact() || states_[k].direction != 0;
}

double ContactLoads::sigma(std::size_t k) const {
  return points_[k].is_exact() ? states_[k].direction : std::tanh(slide_[k].rate / points_[k].smoothing);
}

double ContactLoads::compliant_force(const ContactPoint& point, const Evaluator::ScalarMotion& gap) const {
  const double d = -gap.value;
  const double spring =
      point.exponent == 1 ? point.k * d : std::copysign(point.k * std::pow(std::abs(d), point.exponent), d);
  return spring - point.c * gap.rate;
}

// Multipliers of a joint: its force, and of a guide its moment, which two ends of the guide share.
double ContactLoads::joint_force(const ContactPoint& point, std::span<const double> lambda) const {
  const std::size_t row = at(evaluator_.plan().element_row[at(point.joint)]);
  const double a = lambda[row], b = lambda[row + 1];
  const bool turns = evaluator_.plan().row_is_angle[row + 1] != 0;
  return point.radius * (turns ? std::abs(a) + std::abs(b) / point.half_length : std::hypot(a, b));
}

double ContactLoads::joint_slope(const ContactPoint& point, std::span<const double> lambda,
                                 std::span<const double> along) const {
  const std::size_t row = at(evaluator_.plan().element_row[at(point.joint)]);
  const double a = lambda[row], b = lambda[row + 1];
  if (evaluator_.plan().row_is_angle[row + 1] != 0) {
    return point.radius * (std::copysign(1, a) * along[row] + std::copysign(1, b) * along[row + 1] / point.half_length);
  }
  const double size = std::hypot(a, b);
  return size > 0 ? point.radius * (a * along[row] + b * along[row + 1]) / size : 0;
}

double ContactLoads::normal_from(std::size_t k, std::span<const double> qd, std::span<const double> lambda) const {
  const ContactPoint& point = points_[k];
  if (point.kind == ContactKind::joint) return joint_force(point, lambda);
  if (point.kind == ContactKind::compliant) return compliant_force(point, evaluator_.scalar_motion(point.element, qd));
  const int row = evaluator_.plan().element_row[at(point.element)];
  return row < 0 ? 0 : -lambda[at(row)];
}

void ContactLoads::add(std::span<const double> qd, std::span<double> loads) {
  lost_in_springs_ = 0;
  speed_ = std::max(speed_, fastest(evaluator_, qd));
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const ContactPoint& point = points_[k];
    normal_[k] = friction_[k] = 0;
    if (!states_[k].closed) continue;
    if (point.has_friction()) slide_[k] = evaluator_.scalar_motion(point.slide, qd);
    if (point.kind != ContactKind::compliant) continue;
    const Evaluator::ScalarMotion gap = evaluator_.scalar_motion(point.element, qd);
    normal_[k] = compliant_force(point, gap);
    lost_in_springs_ += point.c * gap.rate * gap.rate;
    scatter_gradient(gap, normal_[k], loads);
    if (!slides(k)) continue;
    friction_[k] = -point.mu * sigma(k) * normal_[k];
    scatter_gradient(slide_[k], friction_[k], loads);
  }
}

bool ContactLoads::complete(EquationsOfMotion& equations, std::span<const double> gamma, std::span<double> loads,
                            std::span<double> qdd, std::span<double> lambda) {
  trouble_.clear();
  if (coupled_.empty()) {
    finish(lambda);
    return true;
  }
  const auto m = static_cast<Eigen::Index>(coupled_.size());
  for (std::size_t l = 0; l < coupled_.size(); ++l) {
    std::fill(unit_.begin(), unit_.end(), 0.0);
    scatter_gradient(slide_[coupled_[l]], 1, unit_);
    equations.solve_motion(unit_, nothing_, change_, response_[l]);
  }
  Eigen::VectorXd f = Eigen::VectorXd::Zero(m), rest(m);
  Eigen::MatrixXd slope(m, m);
  std::vector<double> now(lambda.begin(), lambda.end());
  for (int iteration = 0;; ++iteration) {
    for (Eigen::Index p = 0; p < m; ++p) {
      const std::size_t k = coupled_[static_cast<std::size_t>(p)];
      const double factor = points_[k].mu * sigma(k);
      rest(p) = f(p) + factor * normal_from(k, {}, now);
      for (Eigen::Index l = 0; l < m; ++l) {
        const std::vector<double>& by = response_[static_cast<std::size_t>(l)];
        const double change = points_[k].kind == ContactKind::joint
                                  ? joint_slope(points_[k], now, by)
                                  : -by[at(evaluator_.plan().element_row[at(points_[k].element)])];
        slope(p, l) = (p == l ? 1 : 0) + factor * change;
      }
    }
    const Eigen::PartialPivLU<Eigen::MatrixXd> factors(slope);
    if (!(factors.determinant() > 0)) {
      trouble_ = fmt::format(
          "friction at \"{}\" has no force that fits, or several (a Painleve situation): mu = {:.4g} is too large for "
          "rigid bodies in this position; give the contact a stiffness k, or less friction",
          evaluator_.model().element_name(points_[coupled_.front()].element), points_[coupled_.front()].mu);
      return false;
    }
    const Eigen::VectorXd step = factors.solve(rest);
    f -= step;
    for (std::size_t r = 0; r < now.size(); ++r) {
      now[r] = lambda[r];
      for (std::size_t l = 0; l < coupled_.size(); ++l) now[r] += response_[l][r] * f(static_cast<Eigen::Index>(l));
    }
    if (step.lpNorm<Eigen::Infinity>() <= settled * f.lpNorm<Eigen::Infinity>()) break;
    if (iteration == most_iterations || !f.allFinite()) {
      trouble_ = "friction and reactions of joints do not settle";
      return false;
    }
  }
  for (std::size_t l = 0; l < coupled_.size(); ++l) {
    friction_[coupled_[l]] = f(static_cast<Eigen::Index>(l));
    scatter_gradient(slide_[coupled_[l]], friction_[coupled_[l]], loads);
  }
  equations.solve_motion(loads, gamma, qdd, lambda);
  finish(lambda);
  return true;
}

// Everything that follows from the multipliers.
void ContactLoads::finish(std::span<const double> lambda) {
  lost_ = lost_in_springs_;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const ContactPoint& point = points_[k];
    if (!states_[k].closed) continue;
    if (point.kind != ContactKind::compliant) normal_[k] = normal_from(k, {}, lambda);
    if (!point.has_friction()) continue;
    if (slides(k)) {
      lost_ -= friction_[k] * slide_[k].rate;
    } else if (const int row = evaluator_.plan().element_row[at(point.slide)]; row >= 0) {
      friction_[k] = -lambda[at(row)];
    }
  }
}

double ContactLoads::energy() const {
  double sum = 0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const ContactPoint& point = points_[k];
    if (point.kind != ContactKind::compliant || !states_[k].closed) continue;
    const double d = -evaluator_.scalar_motion(point.element, {}).value;
    if (d > 0) sum += point.k * std::pow(d, point.exponent + 1) / (point.exponent + 1);
  }
  return sum;
}

void ContactLoads::scatter(std::span<double> force, std::span<double> friction, std::span<double> slip) const {
  std::fill(force.begin(), force.end(), 0.0);
  std::fill(friction.begin(), friction.end(), 0.0);
  std::fill(slip.begin(), slip.end(), 0.0);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (!states_[k].closed) continue;
    const std::size_t e = at(points_[k].element);
    force[e] = normal_[k];
    friction[e] = friction_[k];
    slip[e] = slide_[k].rate;
  }
}

}  // namespace catena
