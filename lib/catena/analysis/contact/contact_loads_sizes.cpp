// ContactLoads: the sizes of friction forces that depend on multipliers.

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/base/at.hpp"

namespace catena {

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
  /// Unit loads of several points side by side, and what they make.
  struct {
    std::vector<Lanes> load, nothing, change, multipliers;
    SchurLanes scratch;
  } together;

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
    const auto has_row = [&](int element) { return element >= 0 && evaluator.plan().element_row[at(element)] >= 0; };
    rows_ += (points_[k].kind == ContactKind::rigid && has_row(points_[k].element) ? 1 : 0) +
             (has_row(points_[k].slide) ? 1 : 0);
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

// Residual of the equations for the sizes of friction, at their present values.
void ContactLoads::find_residual(std::span<const double> lambda) {
  Sizes& s = *sizes_;
  for (std::size_t r = 0; r < lambda.size(); ++r) {
    s.lambda[r] = lambda[r];
    s.lambda_terms[r] = std::abs(lambda[r]);
  }
  for (std::size_t l = 0; l < coupled_.size(); ++l) {
    const double size = s.f(static_cast<Eigen::Index>(l));
    if (size == 0) continue;
    for (std::size_t r = 0; r < lambda.size(); ++r) {
      const double part = response_[l][r] * size;
      s.lambda[r] += part;
      s.lambda_terms[r] += std::abs(part);
    }
  }
  for (std::size_t p = 0; p < coupled_.size(); ++p) {
    const std::size_t k = coupled_[p];
    const auto row = static_cast<Eigen::Index>(p);
    const bool grip = points_[k].kind == ContactKind::grip;
    const double factor = grip ? growth(k) : coefficient(k);
    const int of_master = row_of_master(k);
    const double pressed = grip             ? tension_of_sizes(k)
                           : of_master >= 0 ? -s.lambda[at(of_master)]
                                            : normal_from(k, {}, s.lambda);
    const double terms = grip             ? tension_terms(k)
                         : of_master >= 0 ? s.lambda_terms[at(of_master)]
                                          : std::abs(normal_from(k, {}, s.lambda_terms));
    s.residual(row) = s.f(row) + factor * pressed;
    s.terms(row) = std::abs(s.f(row)) + std::abs(factor) * terms;
  }
}

// Its slope, after find_residual().
void ContactLoads::find_slope() {
  Sizes& s = *sizes_;
  for (std::size_t p = 0; p < coupled_.size(); ++p) {
    const std::size_t k = coupled_[p];
    const ContactPoint& point = points_[k];
    const bool grip = point.kind == ContactKind::grip, joint = point.kind == ContactKind::joint;
    const double factor = grip ? growth(k) : coefficient(k);
    const int of_master = row_of_master(k);
    const std::size_t pressing = of_master >= 0  ? at(of_master)
                                 : grip || joint ? 0
                                                 : at(evaluator_.plan().element_row[at(point.element)]);
    for (std::size_t l = 0; l < coupled_.size(); ++l) {
      const double change = grip                     ? tension_slope(k, response_[l], coupled_[l])
                            : joint && of_master < 0 ? joint_slope(point, s.lambda, response_[l])
                                                     : -response_[l][pressing];
      s.slope(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(l)) = (p == l ? 1 : 0) + factor * change;
    }
  }
}

bool ContactLoads::find_sizes(std::span<const double> lambda) {
  Sizes& s = *sizes_;
  s.f.setZero();
  for (int iteration = 0; iteration <= most_friction_iterations; ++iteration) {
    find_residual(lambda);
    if (s.is_solved() && iteration > 0) return true;
    find_slope();
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

// Multipliers that unit loads make, several at once.
void ContactLoads::find_responses(EquationsOfMotion& equations) {
  auto& together = sizes_->together;
  std::size_t l = 0;
  for (; coupled_.size() - l > 1; l = std::min(l + Lanes::count, coupled_.size())) {
    const int count = static_cast<int>(std::min<std::size_t>(coupled_.size() - l, Lanes::count));
    together.load.assign(unit_.size(), Lanes());
    together.nothing.assign(nothing_.size(), Lanes());
    together.change.resize(change_.size());
    together.multipliers.resize(nothing_.size());
    for (int lane = 0; lane < count; ++lane) {
      const std::span<const double> load = unit_load(l + at(lane));
      for (std::size_t c = 0; c < load.size(); ++c) together.load[c].set(lane, load[c]);
    }
    equations.solve_motion(together.load, together.nothing, together.change, together.multipliers, together.scratch);
    for (int lane = 0; lane < count; ++lane) {
      for (std::size_t r = 0; r < nothing_.size(); ++r) response_[l + at(lane)][r] = together.multipliers[r][lane];
    }
  }
  if (l < coupled_.size()) equations.solve_motion(unit_load(l), nothing_, change_, response_[l]);
}

bool ContactLoads::complete(EquationsOfMotion& equations, std::span<const double> gamma, std::span<double> loads,
                            std::span<double> qdd, std::span<double> lambda) {
  trouble_.clear();
  if (coupled_.empty()) {
    finish(lambda);
    return true;
  }
  find_responses(equations);
  if (!find_sizes(lambda)) return false;
  add_friction(loads);
  equations.solve_motion(loads, gamma, qdd, lambda);
  finish(lambda);
  return true;
}

}  // namespace catena
