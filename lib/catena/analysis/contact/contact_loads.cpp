#include "catena/analysis/contact/contact_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {

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

bool ContactLoads::slides(std::size_t k) const {
  if (!points_[k].has_friction() || !states_[k].closed) return false;
  if (states_[k].tied) return true;
  return points_[k].mu > 0 && (!points_[k].is_exact() || states_[k].direction != 0);
}

double ContactLoads::sigma(std::size_t k) const {
  return points_[k].is_exact() ? states_[k].direction : std::tanh(slide_[k].rate / points_[k].smoothing);
}

// Of what presses, against the slide.
double ContactLoads::coefficient(std::size_t k) const {
  return states_[k].tied ? -states_[k].held : points_[k].mu * sigma(k);
}

// The row of the slide whose friction that of point k follows; -1: none.
int ContactLoads::row_of_master(std::size_t k) const {
  return states_[k].tied && states_[k].master >= 0 ? row_of_slide(at(states_[k].master)) : -1;
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
    // A step that goes beyond the phase's end is looked at before it is cut there: the force goes on as an odd
    // function.
    const double d = std::abs(evaluator_.scalar_motion(point.element, {}).value);
    sum += point.k * std::pow(d, point.exponent + 1) / (point.exponent + 1);
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
