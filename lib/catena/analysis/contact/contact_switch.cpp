#include "catena/analysis/contact/contact_switch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

/// Not a joint or a grip, which have a slide alone.
bool has_gap(const ContactPoint& point) {
  return point.kind == ContactKind::rigid || point.kind == ContactKind::compliant;
}

}  // namespace

double product(const Evaluator::ScalarMotion& of, std::span<const double> x) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += of.gradient[k] * x[at(3 * of.body_i + k)] + of.gradient[3 + k] * x[at(3 * of.body_j + k)];
  for (const Evaluator::ScalarMotion::Part& part : of.parts) {
    for (int k = 0; k < 3; ++k)
      sum += part.gradient[k] * x[at(3 * part.body_i + k)] + part.gradient[3 + k] * x[at(3 * part.body_j + k)];
  }
  return sum;
}

double size_of_product(const Evaluator::ScalarMotion& of, std::span<const double> x) {
  double sum = 0;
  const auto add = [&](int body, const double* gradient) {
    for (int k = 0; k < 3; ++k) sum += std::abs(gradient[k] * x[at(3 * body + k)]);
  };
  add(of.body_i, of.gradient);
  add(of.body_j, of.gradient + 3);
  for (const Evaluator::ScalarMotion::Part& part : of.parts) {
    add(part.body_i, part.gradient);
    add(part.body_j, part.gradient + 3);
  }
  return sum;
}

ContactSwitch::ContactSwitch(std::shared_ptr<const Model> model, const std::vector<ContactPoint>& points,
                             const PlanOptions& plan)
    : model_(std::move(model)),
      points_(points),
      evaluator_(Plan::make(*model_, plan), *model_, evaluation_),
      equations_(evaluator_),
      redundant_(equations_),
      past_(points.size()),
      gap_(points.size()),
      slide_(points.size()) {
  const auto coordinates = at(evaluator_.plan().coordinates());
  unit_.load.resize(coordinates);
  unit_.qdd.resize(coordinates);
  unit_.nothing.assign(at(evaluator_.plan().rows), 0.0);
}

void ContactSwitch::take_over(const ContactSwitch& earlier) {
  know_speed(earlier.speed_);
  sizes_.take(earlier.sizes_);
  past_.take_over(earlier.past_);
  other_laws_ = earlier.other_laws_;
  several_states_ = earlier.several_states_;
}

Report ContactSwitch::prepare(std::span<const double> q) {
  Report report = equations_.use_masses();
  if (!report.ok()) return report;
  equations_.weigh_massless(q);
  // Where ranks are looked for drivers go on as they do now: tables may end, and at rest their rates are rounding.
  const Evaluator::TimeLimit limit(evaluator_, {evaluator_.time(), evaluator_.time()});
  redundant_.find(q);
  return equations_.check_massless(q);
}

// Gaps, slides and their rates at the evaluator's configuration.
void ContactSwitch::look(std::span<const double> qd) {
  know_speed(fastest(evaluator_, qd));
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (has_gap(points_[k])) gap_[k] = evaluator_.scalar_motion(points_[k].element, qd);
    const bool slides = points_[k].has_friction() && !points_[k].is_elastic_grip();
    if (slides) slide_[k] = evaluator_.scalar_motion(points_[k].slide, qd);
  }
}

void ContactSwitch::find_touching(const std::vector<ContactState>& states, const Cause& cause) {
  active_.clear();
  const bool is_of_one_group = cause.place >= 0 && !cause.strike && !cause.jolts;
  if (is_of_one_group && group_.empty()) find_groups();
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (is_of_one_group && group_[k] != group_[at(cause.place)]) continue;
    const ContactPoint& point = points_[k];
    const double near = thresholds::closed_gap * (point.turns ? 1 : evaluator_.length_scale());
    bool touches = states[k].closed || (point.kind == ContactKind::rigid && gap_[k].value <= near);
    touches = touches || (point.kind == ContactKind::rigid && static_cast<int>(k) == cause.place);
    // Compliant and smoothed places are forces; only exact friction is decided about there.
    if (point.kind != ContactKind::rigid) touches = touches && point.has_friction() && point.is_exact();
    if (point.kind == ContactKind::grip)
      touches = !point.is_elastic_grip() && point.has_friction() && is_active(at(point.rope->head));
    if (touches) active_.push_back(k);
  }
}

bool ContactSwitch::is_active(std::size_t k) const {
  return std::find(active_.begin(), active_.end(), k) != active_.end();
}

// What a unit force at every touching place makes of accelerations and multipliers, on the constraints.
void ContactSwitch::find_responses() {
  change_.assign(2 * active_.size(), std::vector<double>(unit_.load.size(), 0.0));
  multipliers_.assign(2 * active_.size(), unit_.nothing);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    for (std::size_t along = 0; along < 2; ++along) {
      const ContactPoint& point = points_[active_[a]];
      if (along == 0 ? point.kind != ContactKind::rigid : !point.has_friction()) continue;
      std::fill(unit_.load.begin(), unit_.load.end(), 0.0);
      scatter_gradient(along == 0 ? gap_[active_[a]] : slide_[active_[a]], 1, unit_.load);
      equations_.solve_motion(unit_.load, unit_.nothing, change_[2 * a + along], multipliers_[2 * a + along]);
    }
  }
}

void ContactSwitch::fill(ContactProblem& problem) const {
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const ContactPoint& point = points_[active_[a]];
    problem.place[a] = {.has_normal = point.kind == ContactKind::rigid,
                        .has_friction = point.has_friction() && point.is_exact(),
                        .mu = point.mu,
                        .mu_static = point.mu_static};
    for (std::size_t c = 0; c < 2 * active_.size(); ++c) {
      if (problem.place[a].has_normal) problem.D(2 * a, c) = product(gap_[active_[a]], change_[c]);
      if (point.has_friction()) problem.D(2 * a + 1, c) = product(slide_[active_[a]], change_[c]);
    }
    if (point.kind == ContactKind::grip) {
      const auto head = std::find(active_.begin(), active_.end(), at(point.rope->head)) - active_.begin();
      problem.place[a].head = static_cast<int>(head);
      problem.place[a].growth = std::exp(std::max(point.lines->exponent(evaluator_, {}).f, 0.0));
    }
  }
  // What constraints and drivers carry altogether is left with rounding.
  for (std::size_t row = 0; row < 2 * active_.size(); ++row) {
    const bool acts = row % 2 == 0 ? problem.place[row / 2].has_normal : problem.place[row / 2].has_friction;
    if (!acts || gives_way(row, problem.D(row, row))) continue;
    for (std::size_t c = 0; c < 2 * active_.size(); ++c) problem.D(row, c) = problem.D(c, row) = 0;
  }
}

Report ContactSwitch::failure(double t, const std::string& why) const {
  Report report;
  report.status = Status::inconsistent;
  report.message = fmt::format("at t = {:.12g} s {}", t, why);
  return report;
}

Report ContactSwitch::wedged(double t) const {
  return failure(t,
                 fmt::format("no forces of the contacts {} fit, or several do (a Painleve situation: friction wedges "
                             "rigid bodies in this position); give a contact a stiffness k, or less friction",
                             names_of(*model_, points_, active_)));
}

double ContactSwitch::part_of_speed(std::size_t k, double part) const {
  return rate_of_speed(points_[k], part * speed_, evaluator_.length_scale());
}

double ContactSwitch::rest_speed(std::size_t k) const {
  constexpr double of_the_motion = 1e-4;  // the default
  return points_[k].rest_speed >= 0 ? points_[k].rest_speed : part_of_speed(k, of_the_motion);
}

void ContactSwitch::tell_changes(double t, const std::vector<ContactState>& before,
                                 const std::vector<ContactState>& after) {
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const int element = points_[k].element;
    const auto tell = [&](std::string_view kind, double when) { events_.push_back({element, kind, when}); };
    // A rope tells for its grips.
    const bool grip = points_[k].kind == ContactKind::grip;
    if (grip) {
      if (after[k].closed && before[k].closed && (after[k].direction == 0) != (before[k].direction == 0))
        tell(after[k].direction == 0 ? "stick" : "slip", t);
      continue;
    }
    if (after[k].closed && !before[k].closed) tell("contact", std::isnan(past_.landing[k]) ? t : past_.landing[k]);
    if (!after[k].closed && before[k].closed && !(past_.bounced_at[k] == t)) tell("release", t);
    past_.landing[k] = std::numeric_limits<double>::quiet_NaN();
    const bool exact = points_[k].has_friction() && points_[k].is_exact();
    if (!exact || !after[k].closed || !before[k].closed) continue;
    if (after[k].direction == 0 && before[k].direction != 0) tell("stick", t);
    if (after[k].direction != 0 && before[k].direction == 0) tell("slip", t);
  }
}

Report ContactSwitch::decide(double t, std::span<const double> q, std::span<double> qd,
                             std::vector<ContactState>& states, const Cause& cause) {
  const std::vector<ContactState> before = states;
  if (!equations_.factorize(t, Side::after, q)) {
    Report report;
    report.status = Status::singular;
    report.message = fmt::format("the constraints' Jacobian is not finite at t = {:.12g} s", t);
    return report;
  }
  look(qd);
  const bool is_told = cause.jolts || cause.strike;
  p_.assign(is_told ? unit_.nothing.size() : 0, 0.0);
  impulses_.clear();
  jump_.reset();
  if (is_told) {
    jump_.emplace().meets_constraints = true;
    if (cause.strike) jump_->strike = *cause.strike;
  }
  if (cause.strike) apply(*cause.strike, q, qd);
  if (is_told) {
    const std::vector<double> given(qd.begin(), qd.end());
    equations_.project_velocity(qd, 0);
    const std::vector<double> p = impulse_of_change(equations_, given, qd);
    for (std::size_t r = 0; r < p_.size(); ++r) p_[r] += p[r];
    look(qd);
  }
  find_touching(states, cause);
  if (Report hit = collide(t, qd, states); !hit.ok()) return hit;
  settle(qd);
  if (is_told) impulses_ = impulses_of(equations_, q, qd, p_);
  if (Report chosen = choose(t, q, qd, states, cause); !chosen.ok()) return chosen;
  if (cause.tell) tell_changes(t, before, states);
  std::fill(past_.landing.begin(), past_.landing.end(), std::numeric_limits<double>::quiet_NaN());
  return {};
}

}  // namespace catena
