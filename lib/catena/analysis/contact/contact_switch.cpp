#include "catena/analysis/contact/contact_switch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "catena/analysis/contact/several_states.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A gap of this part of the length scale (or rad) is closed: instants of impacts are found to rounding, configurations
// are given to some ten digits.
constexpr double closed_gap = 1e-9;
// Friction of joints and their forces, in turns: each leaves a part of the error, about mu; a thousand rounds reach
// rounding where that part is up to 0.96.
constexpr int most_rounds = 1000;
// Of the terms that a multiplier is the sum of.
constexpr double multiplier_rounding = 1e-14;

/// Not a joint or a grip, which have a slide alone.
bool has_gap(const ContactPoint& point) {
  return point.kind == ContactKind::rigid || point.kind == ContactKind::compliant;
}

int sign(double x, double none) { return x > none ? 1 : x < -none ? -1 : 0; }

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
      evaluator_(Plan::make(*model_, plan), *model_),
      equations_(evaluator_),
      redundant_(equations_),
      bounced_at_(points.size(), -std::numeric_limits<double>::infinity()),
      landing_(points.size(), std::numeric_limits<double>::quiet_NaN()),
      left_at_(bounced_at_),
      flight_(points.size(), std::numeric_limits<double>::quiet_NaN()),
      gap_(points.size()),
      slide_(points.size()) {
  const auto coordinates = at(evaluator_.plan().coordinates());
  load_.resize(coordinates);
  qdd_.resize(coordinates);
  nothing_.assign(at(evaluator_.plan().rows), 0.0);
}

void ContactSwitch::take_over(const ContactSwitch& earlier) {
  know_speed(earlier.speed_);
  bounced_at_ = earlier.bounced_at_;
  flight_ = earlier.flight_;
  other_laws_ = earlier.other_laws_;
  several_states_ = earlier.several_states_;
  left_at_ = earlier.left_at_;
}

Report ContactSwitch::prepare(std::span<const double> q) {
  Report report = equations_.use_masses();
  if (!report.ok()) return report;
  equations_.weigh_massless(q);
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

// M (qd+ - qd-) + Phi_q^T p = [P; (R A s)^T P] on the body that is struck.
void ContactSwitch::apply(const Strike& strike, std::span<const double> q, std::span<double> qd) {
  const Plan& plan = evaluator_.plan();
  const int body = plan.plan_body[at(strike.body)];
  work_of_strike_ = 0;
  if (body >= plan.moving) return;
  const double phi = q[at(3 * body + 2)], c = std::cos(phi), s = std::sin(phi);
  const Vec2<double> arm{c * strike.point.x - s * strike.point.y, s * strike.point.x + c * strike.point.y};
  const auto speed = [&] {
    const double* rate = &qd[at(3 * body)];
    return strike.impulse.x * (rate[0] - rate[2] * arm.y) + strike.impulse.y * (rate[1] + rate[2] * arm.x);
  };
  std::fill(load_.begin(), load_.end(), 0.0);
  load_[at(3 * body)] = strike.impulse.x;
  load_[at(3 * body + 1)] = strike.impulse.y;
  load_[at(3 * body + 2)] = cross(arm, strike.impulse);
  std::vector<double> change(load_.size(), 0.0), multipliers(nothing_);
  equations_.solve_motion(load_, nothing_, change, multipliers);
  const double before = speed();
  for (std::size_t k = 0; k < qd.size(); ++k) qd[k] += change[k];
  for (std::size_t r = 0; r < p_.size(); ++r) p_[r] += multipliers[r];
  work_of_strike_ = (before + speed()) / 2;
}

// Mechanisms that constraints tie, and those that a gap or a slide ties as well.
void ContactSwitch::find_groups() {
  const Plan& plan = evaluator_.plan();
  std::vector<int> leader(at(plan.islands));
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int island) {
    while (leader[at(island)] != island) island = leader[at(island)] = leader[at(leader[at(island)])];
    return island;
  };
  std::vector<int> first(points_.size(), -1);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const auto tie = [&](int body) {
      if (body < 0 || body >= plan.moving) return;
      const int island = find(plan.island[at(body)]);
      if (first[k] < 0) first[k] = island;
      leader[at(island)] = find(first[k]);
    };
    for (const Evaluator::ScalarMotion* motion : {&gap_[k], &slide_[k]}) {
      tie(motion->body_i);
      tie(motion->body_j);
      for (const Evaluator::ScalarMotion::Part& part : motion->parts) {
        tie(part.body_i);
        tie(part.body_j);
      }
    }
  }
  group_.clear();
  for (const int island : first) group_.push_back(island < 0 ? -1 : find(island));
}

void ContactSwitch::find_touching(const std::vector<ContactState>& states, const Cause& cause) {
  active_.clear();
  const bool is_of_one_group = cause.place >= 0 && !cause.strike && !cause.jolts;
  if (is_of_one_group && group_.empty()) find_groups();
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (is_of_one_group && group_[k] != group_[at(cause.place)]) continue;
    const ContactPoint& point = points_[k];
    const double near = closed_gap * (point.turns ? 1 : evaluator_.length_scale());
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

// Without their ropes grips hold nothing.
void ContactSwitch::let_grips_go(std::vector<ContactState>& states) {
  std::vector<std::size_t> left;
  for (const std::size_t k : active_) {
    const bool holds = points_[k].kind != ContactKind::grip || is_active(at(points_[k].rope->head));
    if (holds) left.push_back(k);
    if (!holds) states[k] = {};
  }
  active_ = std::move(left);
}

// What a unit force at every touching place makes of accelerations and multipliers, on the constraints.
void ContactSwitch::find_responses() {
  change_.assign(2 * active_.size(), std::vector<double>(load_.size(), 0.0));
  multipliers_.assign(2 * active_.size(), nothing_);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    for (std::size_t along = 0; along < 2; ++along) {
      const ContactPoint& point = points_[active_[a]];
      if (along == 0 ? point.kind != ContactKind::rigid : !point.has_friction()) continue;
      std::fill(load_.begin(), load_.end(), 0.0);
      scatter_gradient(along == 0 ? gap_[active_[a]] : slide_[active_[a]], 1, load_);
      equations_.solve_motion(load_, nothing_, change_[2 * a + along], multipliers_[2 * a + along]);
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
  return part * speed_ / (points_[k].turns ? evaluator_.length_scale() : 1);
}

double ContactSwitch::rest_speed(std::size_t k) const {
  constexpr double of_the_motion = 1e-4;  // the default
  return points_[k].rest_speed >= 0 ? points_[k].rest_speed : part_of_speed(k, of_the_motion);
}

// Accelerations without rigid places and exact friction; compliant ones press as they do.
bool ContactSwitch::find_free_accelerations(double t, std::span<const double> q, std::span<const double> qd,
                                            ContactLoads& loads) {
  equations_.attach(&loads);
  const bool found = equations_.accelerations(t, Side::after, q, qd, qdd_);
  equations_.attach(nullptr);
  return found;
}

// What presses a joint depends on the forces themselves: both are found in turns.
Report ContactSwitch::press_joints(double t, std::span<const double> qd, const ContactLoads& loads,
                                   ContactProblem& problem) {
  const std::span<const double> free = equations_.multipliers();
  // The multipliers, and the sizes of the terms that they are sums of, for their rounding.
  std::vector<double> lambda(free.begin(), free.end()), terms(free.size());
  for (std::size_t r = 0; r < free.size(); ++r) terms[r] = std::abs(free[r]);
  for (int round = 0; round < most_rounds; ++round) {
    double change = 0, size = 0;
    for (std::size_t a = 0; a < active_.size(); ++a) {
      ContactProblem::Place& place = problem.place[a];
      if (place.has_normal || place.head >= 0) continue;
      const double normal = std::max(loads.normal_from(active_[a], qd, lambda), 0.0);
      const double limit = points_[active_[a]].mu_static * normal;
      change = std::max(change, std::abs(limit - place.limit));
      size = std::max(size, points_[active_[a]].mu_static * loads.normal_from(active_[a], qd, terms));
      place.limit = limit;
      place.kinetic = points_[active_[a]].mu * normal;
    }
    if (!problem.solve()) return wedged(t);
    if (change <= multiplier_rounding * size) return {};
    for (std::size_t r = 0; r < lambda.size(); ++r) {
      lambda[r] = free[r];
      terms[r] = std::abs(free[r]);
      for (std::size_t c = 0; c < problem.x.size(); ++c) {
        const double part = multipliers_[c][r] * problem.x[c];
        lambda[r] += part;
        terms[r] += std::abs(part);
      }
    }
  }
  return failure(t, fmt::format("the friction of {} and the reactions that press there do not settle within {} rounds",
                                names_of(*model_, points_, active_), most_rounds));
}

// Which places press, stick and slide from now on.
Report ContactSwitch::choose(double t, std::span<const double> q, std::span<const double> qd,
                             std::vector<ContactState>& states, const Cause& cause) {
  std::vector<ContactState> forces = states;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    if (points_[k].is_elastic_grip()) continue;
    if (points_[k].kind != ContactKind::compliant) forces[k].closed = false;
    if (points_[k].is_exact()) forces[k].direction = 0;
  }
  ContactLoads loads(evaluator_, points_, forces);
  if (!find_free_accelerations(t, q, qd, loads))
    return failure(t, loads.trouble().empty() ? "accelerations are not finite" : loads.trouble());
  forget_shared();
  let_leave(t, states, cause);
  for (std::vector<std::size_t>& group : active_by_group()) {
    active_ = std::move(group);
    if (Report chosen = choose_among(t, qd, states, cause, loads); !chosen.ok()) return chosen;
  }
  return {};
}

// Places whose gaps open already, or that nothing presses any more.
void ContactSwitch::let_leave(double t, std::vector<ContactState>& states, const Cause& cause) {
  std::erase_if(active_, [&](std::size_t k) {
    const bool opens = cause.opens && static_cast<int>(k) == cause.place;
    const bool leaves =
        points_[k].kind == ContactKind::rigid && !returns(t, k, cause) && gap_[k].rate > part_of_speed(k, no_speed);
    if (!opens && !leaves) return false;
    states[k] = {};
    left_at_[k] = t;
    return true;
  });
  let_grips_go(states);
}

// Forces of one mechanism do not reach another.
std::vector<std::vector<std::size_t>> ContactSwitch::active_by_group() {
  if (group_.empty()) find_groups();
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t k : active_) {
    const auto same = [&](const std::vector<std::size_t>& group) { return group_[group.front()] == group_[k]; };
    const auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end())
      groups.push_back({k});
    else
      found->push_back(k);
  }
  return groups;
}

// Accelerations of gaps and slides without forces there.
void ContactSwitch::set_up(ContactProblem& problem, const Cause& cause) const {
  fill(problem);
  const auto take = [&](std::size_t row, const Evaluator::ScalarMotion& motion) {
    problem.b[row] = motion.bend + product(motion, qdd_);
    problem.b_terms[row] = std::abs(motion.bend) + size_of_product(motion, qdd_);
  };
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    ContactProblem::Place& place = problem.place[a];
    if (place.has_normal) take(2 * a, gap_[k]);
    if (!points_[k].has_friction()) continue;
    take(2 * a + 1, slide_[k]);
    place.slip = sign(slide_[k].rate, part_of_speed(k, no_speed));
    if (static_cast<int>(k) == cause.place && cause.rests) place.slip = cause.leaves;
  }
}

// Places that hold each other go on as they are but for those that give way; as they all are they cannot.
void ContactSwitch::prefer_giving_way(ContactProblem& problem, const std::vector<ContactState>& states,
                                      const Cause& cause) const {
  using State = ContactProblem::State;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const ContactState& state = states[active_[a]];
    const bool sticks = points_[active_[a]].has_friction() && state.direction == 0;
    problem.state[a] = !state.closed ? State::open : sticks ? State::sticks : State::slides;
    problem.direction[a] = state.direction;
  }
  problem.rule_out_states();
  for (const GivesWay& place : cause.giving_way) {
    const auto a = static_cast<std::size_t>(std::find(active_.begin(), active_.end(), place.point) - active_.begin());
    if (a == active_.size()) continue;
    problem.state[a] = place.direction == 0 ? State::open : State::slides;
    problem.direction[a] = place.direction;
  }
  if (!cause.giving_way.empty()) problem.prefer_states();
}

// Of the active places, which are of one mechanism.
Report ContactSwitch::choose_among(double t, std::span<const double> qd, std::vector<ContactState>& states,
                                   const Cause& cause, const ContactLoads& loads) {
  find_responses();
  ContactProblem problem(active_.size());
  set_up(problem, cause);
  if (cause.shares) prefer_giving_way(problem, states, cause);
  if (Report pressed = press_joints(t, qd, loads, problem); !pressed.ok())
    return is_jammed(true) ? blocked(t, active_) : pressed;
  if (!cause.shares) stick_where_possible(problem);
  if (const std::vector<std::size_t> pushed = pushed_through(t, problem, cause); !pushed.empty())
    return blocked(t, pushed);
  if (!cause.shares) note_other_states(t, problem);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    const bool grip = points_[k].kind == ContactKind::grip;
    const bool joint = points_[k].kind != ContactKind::rigid && !grip;
    if (!joint) states[k].closed = problem.state[a] != ContactProblem::State::open;
    states[k].direction = problem.state[a] == ContactProblem::State::slides ? problem.direction[a] : 0;
    states[k].tied = false;
  }
  SharedForces forces(problem, active_);
  if (!forces.places().empty()) shared_.push_back(std::move(forces));
  tie_grips(problem, states);
  return {};
}

// What was known of the places that are decided about now.
void ContactSwitch::forget_shared() {
  const auto is_touched = [&](std::size_t k) { return std::find(active_.begin(), active_.end(), k) != active_.end(); };
  std::erase_if(shared_, [&](const SharedForces& forces) {
    return std::any_of(forces.places().begin(), forces.places().end(), is_touched);
  });
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
    if (after[k].closed && !before[k].closed) tell("contact", std::isnan(landing_[k]) ? t : landing_[k]);
    if (!after[k].closed && before[k].closed && !(bounced_at_[k] == t)) tell("release", t);
    landing_[k] = std::numeric_limits<double>::quiet_NaN();
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
  p_.assign(is_told ? nothing_.size() : 0, 0.0);
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
  if (is_told) impulses_ = impulses_of(equations_, q, qd, p_);
  if (Report chosen = choose(t, q, qd, states, cause); !chosen.ok()) return chosen;
  if (cause.tell) tell_changes(t, before, states);
  std::fill(landing_.begin(), landing_.end(), std::numeric_limits<double>::quiet_NaN());
  return {};
}

}  // namespace catena
