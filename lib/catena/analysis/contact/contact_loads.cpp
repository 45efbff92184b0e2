#include "catena/analysis/contact/contact_loads.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Newton's method on forces that are nearly linear in each other: without joints one step is exact, with joints the
// error is squared in every step.
constexpr int most_iterations = 30;

}  // namespace

void scatter_gradient(const Evaluator::ScalarMotion& of, double factor, std::span<double> loads) {
  for (int k = 0; k < 3; ++k) {
    loads[at(3 * of.body_i + k)] += factor * of.gradient[k];
    loads[at(3 * of.body_j + k)] += factor * of.gradient[3 + k];
  }
  for (const Evaluator::ScalarMotion::Part& part : of.parts) {
    for (int k = 0; k < 3; ++k) {
      loads[at(3 * part.body_i + k)] += factor * part.gradient[k];
      loads[at(3 * part.body_j + k)] += factor * part.gradient[3 + k];
    }
  }
}

double fastest(const Evaluator& evaluator, std::span<const double> qd) {
  double largest = 0;
  for (int c = 0; c < 3 * evaluator.plan().moving; ++c)
    largest = std::max(largest, std::abs(qd[at(c)]) * (c % 3 == 2 ? evaluator.length_scale() : 1));
  return largest;
}

std::string names_of(const Model& model, const std::vector<ContactPoint>& points, std::span<const std::size_t> which) {
  std::string names;
  for (const std::size_t k : which)
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", model.element_name(points[k].element));
  return names;
}

/// f + mu sigma N(lambda_0 + B f) = 0, with the memory for its solution.
struct ContactLoads::Sizes {
  Eigen::VectorXd f, residual, terms, step;
  Eigen::MatrixXd slope;
  Eigen::PartialPivLU<Eigen::MatrixXd> factors;
  std::vector<double> lambda;        // lambda_0 + B f
  std::vector<double> lambda_terms;  // sums of the sizes of its terms

  void resize(std::size_t points, std::size_t rows) {
    const auto m = static_cast<Eigen::Index>(points);
    f.resize(m);
    residual.resize(m);
    terms.resize(m);
    step.resize(m);
    slope.resize(m, m);
    lambda.resize(rows);
    lambda_terms.resize(rows);
  }
  /// Whether what is left of the equations is rounding: of sums of m + 1 products in lambda, of few in what follows.
  bool is_solved() const {
    const double rounding = std::numeric_limits<double>::epsilon() * static_cast<double>(f.size() + 6);
    return (residual.array().abs() <= rounding * terms.array()).all();
  }
};

ContactLoads::ContactLoads(const Evaluator& evaluator, const std::vector<ContactPoint>& points,
                           std::vector<ContactState> states)
    : evaluator_(evaluator),
      points_(points),
      states_(std::move(states)),
      slide_(points.size()),
      normal_(points.size(), 0.0),
      friction_(points.size(), 0.0),
      exponent_(points.size(), 0.0),
      sizes_(std::make_unique<Sizes>()) {
  const auto coordinates = at(evaluator.plan().coordinates());
  unit_.resize(coordinates);
  change_.resize(coordinates);
  nothing_.assign(at(evaluator.plan().rows), 0.0);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const bool compliant = points_[k].kind == ContactKind::compliant || points_[k].is_elastic_grip();
    if (slides(k) && !compliant) coupled_.push_back(k);
    dissipates_ |= slides(k) || (compliant && states_[k].closed && points_[k].c > 0);
    holds_ |= states_[k].closed && !points_[k].is_elastic_grip() &&
              (points_[k].kind == ContactKind::rigid || (points_[k].has_friction() && points_[k].is_exact()));
    // Also of a slack rope: its spring would pull where a step reaches beyond the instant at which it becomes taut.
    if (points_[k].is_elastic_grip() && points_[k].rope->grips.front() == k)
      elastic_.emplace_back(points_, points_[k].rope);
  }
  response_.assign(coupled_.size(), nothing_);
  sizes_->resize(coupled_.size(), nothing_.size());
}

ContactLoads::~ContactLoads() = default;

bool ContactLoads::slides(std::size_t k) const {
  if (!points_[k].has_friction() || !states_[k].closed || points_[k].mu == 0) return false;
  return !points_[k].is_exact() || states_[k].direction != 0 || states_[k].tied;
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

bool ContactLoads::is_guide(const ContactPoint& point) const {
  return evaluator_.plan().row_is_angle[at(evaluator_.plan().element_row[at(point.joint)] + 1)] != 0;
}

// Multipliers of a joint: its force, and of a guide its moment, which two ends of the guide share.
double ContactLoads::joint_force(const ContactPoint& point, std::span<const double> lambda) const {
  const std::size_t row = at(evaluator_.plan().element_row[at(point.joint)]);
  const double a = lambda[row], b = lambda[row + 1];
  return point.radius * (is_guide(point) ? std::abs(a) + std::abs(b) / point.half_length : std::hypot(a, b));
}

double ContactLoads::joint_slope(const ContactPoint& point, std::span<const double> lambda,
                                 std::span<const double> along) const {
  const std::size_t row = at(evaluator_.plan().element_row[at(point.joint)]);
  const double a = lambda[row], b = lambda[row + 1];
  if (is_guide(point)) {
    return point.radius * (std::copysign(1, a) * along[row] + std::copysign(1, b) * along[row + 1] / point.half_length);
  }
  const double size = std::hypot(a, b);
  return size > 0 ? point.radius * (a * along[row] + b * along[row + 1]) / size : 0;
}

double ContactLoads::normal_from(std::size_t k, std::span<const double> qd, std::span<const double> lambda) const {
  const ContactPoint& point = points_[k];
  if (point.kind == ContactKind::joint) return joint_force(point, lambda);
  if (point.kind == ContactKind::grip) return point.is_elastic_grip() ? 0 : tension_before(k, lambda);
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
    if (point.is_elastic_grip()) continue;
    if (point.has_friction()) slide_[k] = evaluator_.scalar_motion(point.slide, qd);
    if (point.lines) exponent_[k] = point.lines->exponent(evaluator_, {}).f;
    if (point.kind != ContactKind::compliant) continue;
    const Evaluator::ScalarMotion gap = evaluator_.scalar_motion(point.element, qd);
    normal_[k] = compliant_force(point, gap);
    lost_in_springs_ += point.c * gap.rate * gap.rate;
    scatter_gradient(gap, normal_[k], loads);
    if (!slides(k)) continue;
    friction_[k] = -point.mu * sigma(k) * normal_[k];
    scatter_gradient(slide_[k], friction_[k], loads);
  }
  for (ElasticGrips& rope : elastic_) {
    rope.look(evaluator_, qd, states_);
    rope.add(loads);
    lost_in_springs_ += rope.dissipation(states_);
    for (std::size_t n = 0; n < rope.rope().grips.size(); ++n) friction_[rope.rope().grips[n]] = rope.friction(n);
    normal_[rope.rope().grips.front()] = rope.tension(0) - rope.rope().k * std::max(rope.stretch(), 0.0);
  }
}

// The tension before a grip with the sizes of friction as the iteration has them.
double ContactLoads::tension_of_sizes(std::size_t k) const {
  double tension = -sizes_->lambda[at(evaluator_.plan().element_row[at(points_[k].element)])];
  for (const std::size_t other : points_[k].rope->grips) {
    if (other >= k) break;
    if (slides(other)) {
      const auto found = std::find(coupled_.begin(), coupled_.end(), other) - coupled_.begin();
      tension += sizes_->f(static_cast<Eigen::Index>(found));
    } else if (const int row = row_of_slide(other); row >= 0) {
      tension -= sizes_->lambda[at(row)];
    }
  }
  return tension;
}

// Of the terms of that sum, for its rounding.
double ContactLoads::tension_terms(std::size_t k) const {
  const int head = evaluator_.plan().element_row[at(points_[k].element)];
  double terms = head < 0 ? 0 : sizes_->lambda_terms[at(head)];
  for (const std::size_t other : points_[k].rope->grips) {
    if (other >= k) break;
    if (slides(other)) {
      const auto found = std::find(coupled_.begin(), coupled_.end(), other) - coupled_.begin();
      terms += std::abs(sizes_->f(static_cast<Eigen::Index>(found)));
    } else if (const int row = row_of_slide(other); row >= 0) {
      terms += sizes_->lambda_terms[at(row)];
    }
  }
  return terms;
}

// Residual and slope of the equations for the sizes of friction, at their present values.
void ContactLoads::linearise(std::span<const double> lambda) {
  Sizes& s = *sizes_;
  for (std::size_t r = 0; r < lambda.size(); ++r) {
    s.lambda[r] = lambda[r];
    s.lambda_terms[r] = std::abs(lambda[r]);
    for (std::size_t l = 0; l < coupled_.size(); ++l) {
      const double part = response_[l][r] * s.f(static_cast<Eigen::Index>(l));
      s.lambda[r] += part;
      s.lambda_terms[r] += std::abs(part);
    }
  }
  for (std::size_t p = 0; p < coupled_.size(); ++p) {
    const ContactPoint& point = points_[coupled_[p]];
    const double factor = point.mu * sigma(coupled_[p]);
    const auto row = static_cast<Eigen::Index>(p);
    if (point.kind == ContactKind::grip) {
      const double h = growth(coupled_[p]);
      const double tension = tension_of_sizes(coupled_[p]);
      s.residual(row) = s.f(row) + h * tension;
      s.terms(row) = std::abs(s.f(row)) + std::abs(h) * tension_terms(coupled_[p]);
      for (std::size_t l = 0; l < coupled_.size(); ++l)
        s.slope(row, static_cast<Eigen::Index>(l)) =
            (p == l ? 1 : 0) + h * tension_slope(coupled_[p], response_[l], coupled_[l]);
      continue;
    }
    s.residual(row) = s.f(row) + factor * normal_from(coupled_[p], {}, s.lambda);
    s.terms(row) = std::abs(s.f(row)) + std::abs(factor * normal_from(coupled_[p], {}, s.lambda_terms));
    for (std::size_t l = 0; l < coupled_.size(); ++l) {
      const double change = point.kind == ContactKind::joint
                                ? joint_slope(point, s.lambda, response_[l])
                                : -response_[l][at(evaluator_.plan().element_row[at(point.element)])];
      s.slope(row, static_cast<Eigen::Index>(l)) = (p == l ? 1 : 0) + factor * change;
    }
  }
}

bool ContactLoads::find_sizes(std::span<const double> lambda) {
  Sizes& s = *sizes_;
  s.f.setZero();
  for (int iteration = 0; iteration <= most_iterations; ++iteration) {
    linearise(lambda);
    if (s.is_solved() && iteration > 0) return true;
    s.factors.compute(s.slope);
    const double determinant = s.factors.determinant();
    if (!std::isfinite(determinant)) break;
    if (!(determinant > 0)) {
      trouble_ = fmt::format(
          "the friction of {} has no force that fits, or several (a Painleve situation): mu is too large for rigid "
          "bodies in this position; give a contact a stiffness k, or less friction",
          names_of(evaluator_.model(), points_, coupled_));
      return false;
    }
    s.step.noalias() = s.factors.solve(s.residual);
    s.f -= s.step;
  }
  trouble_ = fmt::format("the friction of {} and the reactions that press there do not settle",
                         names_of(evaluator_.model(), points_, coupled_));
  return false;
}

std::span<const double> ContactLoads::unit_load(std::size_t l) {
  std::fill(unit_.begin(), unit_.end(), 0.0);
  scatter_gradient(slide_[coupled_[l]], 1, unit_);
  return unit_;
}

void ContactLoads::add_friction(std::span<double> loads) {
  for (std::size_t l = 0; l < coupled_.size(); ++l) {
    friction_[coupled_[l]] = sizes_->f(static_cast<Eigen::Index>(l));
    scatter_gradient(slide_[coupled_[l]], friction_[coupled_[l]], loads);
  }
}

bool ContactLoads::complete(EquationsOfMotion& equations, std::span<const double> gamma, std::span<double> loads,
                            std::span<double> qdd, std::span<double> lambda) {
  trouble_.clear();
  if (coupled_.empty()) {
    finish(lambda);
    return true;
  }
  for (std::size_t l = 0; l < coupled_.size(); ++l)
    equations.solve_motion(unit_load(l), nothing_, change_, response_[l]);
  if (!find_sizes(lambda)) return false;
  add_friction(loads);
  equations.solve_motion(loads, gamma, qdd, lambda);
  finish(lambda);
  return true;
}

// Everything that follows from the multipliers.
void ContactLoads::finish(std::span<const double> lambda) {
  lost_ = lost_in_springs_;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const ContactPoint& point = points_[k];
    if (!states_[k].closed || point.is_elastic_grip()) continue;
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
  for (const ElasticGrips& rope : elastic_) sum += rope.energy_at(evaluator_, states_);
  return sum;
}

void ContactLoads::scatter(std::span<ContactLoad> loads) const {
  std::fill(loads.begin(), loads.end(), ContactLoad{});
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (!states_[k].closed) continue;
    ContactLoad& load = loads[at(points_[k].element)];
    // What sticks has no slip but rounding.
    const bool sticks = points_[k].has_friction() && points_[k].is_exact() && states_[k].direction == 0;
    // The grips of a rope come behind it, and have its tension at the end i.
    if (points_[k].kind != ContactKind::grip) {
      load = {normal_[k] / points_[k].radius, friction_[k], sticks ? 0 : slide_[k].rate, !points_[k].has_friction()};
    }
    if (points_[k].kind == ContactKind::grip) load.friction += friction_[k];
    if (points_[k].is_elastic_grip() && points_[k].rope->grips.front() == k) load.force = normal_[k];
  }
}

}  // namespace catena
