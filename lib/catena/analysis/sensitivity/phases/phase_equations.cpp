#include "catena/analysis/sensitivity/phases/phase_equations.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// As in contact_loads.cpp: one step without joints, quadratic with them.
constexpr int most_sizes_iterations = 30;
constexpr double settled_size = 1e-15;

void set_values(std::span<const double> values, std::span<DesignScalar> out) {
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = DesignScalar(values[k]);
}

}  // namespace

PhaseEquations::PhaseEquations(Evaluator& evaluator, const ContactModel& contacts)
    : evaluator_(evaluator), contacts_(contacts), states_(contacts.points.size()) {
  const std::size_t n = at(plan().coordinates()), rows = at(plan().rows);
  jacobian_.resize(at(plan().trash_slot()) + 1);
  evaluator_.start_jacobian(jacobian_);
  values_.resize(n);
  f_.resize(n);
  b_.resize(rows);
  rows_.resize(rows);
  loads_.resize(n);
  forces_.resize(n);
  unit_.resize(rows);
  hold({}, states_);
}

void PhaseEquations::hold(const std::vector<int>& released, std::vector<ContactState> states) {
  states_ = std::move(states);
  states_.resize(contacts_.points.size());
  std::vector<char> is_released(evaluator_.model().elements.size(), 0);
  for (const int element : released) is_released[at(element)] = 1;
  held_.assign(at(plan().rows), 1);
  std::vector<int> left_out;
  for (int r = 0; r < plan().rows; ++r) {
    if (!is_released[at(plan().row_element[at(r)])]) continue;
    held_[at(r)] = 0;
    left_out.push_back(r);
  }
  system_ = &systems_.try_emplace(left_out, evaluator_.shared_plan(), SaddleBlock::diagonal).first->second;
  system_->leave_out(std::move(left_out));
}

bool PhaseEquations::sticks(std::size_t k) const {
  const ContactPoint& point = contacts_.points[k];
  return point.has_friction() && point.is_exact() && states_[k].closed && states_[k].direction == 0;
}

bool PhaseEquations::slides(std::size_t k) const {
  const ContactPoint& point = contacts_.points[k];
  if (!point.has_friction() || !states_[k].closed || point.mu == 0) return false;
  return !point.is_exact() || states_[k].direction != 0;
}

int PhaseEquations::gap_row(std::size_t k) const {
  const ContactPoint& point = contacts_.points[k];
  return point.kind == ContactKind::joint ? -1 : plan().element_row[at(point.element)];
}

int PhaseEquations::slide_row(std::size_t k) const {
  const ContactPoint& point = contacts_.points[k];
  return point.has_friction() ? plan().element_row[at(point.slide)] : -1;
}

bool PhaseEquations::factorize(double t, Side side, std::span<const DesignScalar> q, const DesignMechanism& masses) {
  for (std::size_t c = 0; c < values_.size(); ++c) values_[c] = q[c].v;
  evaluator_.set_time(t, side);
  evaluator_.set_configuration(values_);
  evaluator_.jacobian(jacobian_);
  const auto phi_q = std::span<const double>(jacobian_).first(at(plan().trash_slot()));
  return system_->factorize(phi_q, [&] {
    for (int c = 0; c < 3 * plan().moving; ++c) system_->add_diagonal(c, masses.mass(c).v);
  });
}

// k d^n + c d'.
DesignScalar PhaseEquations::compliant_force(const Design& design, std::size_t k) const {
  const DesignPlace& place = design.places[k];
  const Taylor<DesignScalar> gap = design.mechanism.measure(contacts_.points[k].element);
  const DesignScalar d = -gap.f;
  DesignScalar spring = place.k * d;
  if (contacts_.points[k].exponent != 1 && d.v != 0)
    spring = d.v > 0 ? place.k * pow(d, place.exponent) : -(place.k * pow(-d, place.exponent));
  return spring - place.c * gap.d;
}

// Psi' / g': the row of a stop with two bounds has another slope than its gap, away from them.
DesignScalar PhaseEquations::row_factor(const Design& design, std::size_t k) const {
  const DesignPlace& place = design.places[k];
  if (!place.has_range) return DesignScalar(1.0);
  const DesignScalar gap = design.mechanism.measure(contacts_.points[k].element).f;
  return DesignScalar(1.0) - DesignScalar(2.0) * gap / place.range;
}

DesignScalar PhaseEquations::slip_sign(const Design& design, std::size_t k) const {
  const ContactPoint& point = contacts_.points[k];
  if (point.is_exact()) return DesignScalar(states_[k].direction);
  return tanh(design.mechanism.measure(point.slide).d / design.places[k].smoothing);
}

DesignScalar PhaseEquations::normal(const Design& design, std::size_t k, std::span<const DesignScalar> lambda) const {
  const ContactPoint& point = contacts_.points[k];
  const DesignPlace& place = design.places[k];
  if (point.kind == ContactKind::compliant) return compliant_force(design, k);
  if (point.kind == ContactKind::rigid) return -lambda[at(gap_row(k))];
  const std::size_t row = at(plan().element_row[at(point.joint)]);
  const DesignScalar &a = lambda[row], &b = lambda[row + 1];
  if (plan().row_is_angle[row + 1])
    return place.radius * (place.has_length ? abs(a) + abs(b) / place.half_length : abs(a));
  const DesignScalar squares = a * a + b * b;
  return squares.v > 0 ? place.radius * sqrt(squares) : DesignScalar(0.0);
}

// The same in plain numbers, and its slope along a change of the multipliers.
double PhaseEquations::normal_value(const Design& design, std::size_t k, std::span<const double> lambda,
                                    std::span<const double> along, double& slope) const {
  const ContactPoint& point = contacts_.points[k];
  if (point.kind == ContactKind::rigid) {
    slope = along.empty() ? 0 : -along[at(gap_row(k))];
    return -lambda[at(gap_row(k))];
  }
  const DesignPlace& place = design.places[k];
  const std::size_t row = at(plan().element_row[at(point.joint)]);
  const double a = lambda[row], b = lambda[row + 1], da = along.empty() ? 0 : along[row],
               db = along.empty() ? 0 : along[row + 1];
  if (plan().row_is_angle[row + 1]) {
    const double share = place.has_length ? 1 / place.half_length.v : 0;
    slope = place.radius.v * ((a < 0 ? -da : da) + share * (b < 0 ? -db : db));
    return place.radius.v * (std::abs(a) + share * std::abs(b));
  }
  const double size = std::hypot(a, b);
  slope = size > 0 ? place.radius.v * (a * da + b * db) / size : 0;
  return place.radius.v * size;
}

// What a unit of each friction force makes of x and of the multipliers.
bool PhaseEquations::respond(const Design& design, std::span<const Coupled> coupled) {
  response_.resize(coupled.size());
  for (std::size_t l = 0; l < coupled.size(); ++l) {
    std::fill(unit_.begin(), unit_.end(), DesignScalar());
    unit_[at(coupled[l].slide_row)] = DesignScalar(1.0);
    std::fill(forces_.begin(), forces_.end(), DesignScalar());
    design.mechanism.add_constraint_loads(unit_, forces_);
    Response& response = response_[l];
    response.x.assign(forces_.size(), 0.0);
    for (std::size_t c = 0; c < at(3 * plan().moving); ++c) response.x[c] = forces_[c].v;
    response.lambda.assign(b_.size(), 0.0);
    if (!system_->solve(response.x, response.lambda)) return false;
  }
  return true;
}

void PhaseEquations::find_slope(const Design& design, std::span<const Coupled> coupled,
                                std::span<const double> lambda) {
  const std::size_t m = coupled.size();
  slope_.assign(m * m, 0.0);
  for (std::size_t l = 0; l < m; ++l) {
    for (std::size_t k = 0; k < m; ++k) {
      double slope = 0;
      normal_value(design, coupled[l].place, lambda, response_[k].lambda, slope);
      slope_[l * m + k] = (l == k ? 1 : 0) + coupled[l].factor.v * slope;
    }
  }
}

// x and multipliers in f_ and b_, where the friction forces have their sizes.
bool PhaseEquations::solve_values(const Design& design, std::span<const Coupled> coupled) {
  sizes_.assign(coupled.size(), 0.0);
  if (!system_->solve(f_, b_)) return false;
  if (coupled.empty()) return true;
  if (!respond(design, coupled)) return false;
  const auto m = static_cast<Eigen::Index>(coupled.size());
  const std::vector<double> alone(b_);
  Eigen::Map<Eigen::VectorXd> sizes(sizes_.data(), m);
  for (int iteration = 0;; ++iteration) {
    b_ = alone;
    for (std::size_t l = 0; l < coupled.size(); ++l) {
      for (std::size_t r = 0; r < b_.size(); ++r) b_[r] += response_[l].lambda[r] * sizes_[l];
    }
    Eigen::VectorXd residual(m);
    for (Eigen::Index l = 0; l < m; ++l) {
      double unused = 0;
      const Coupled& one = coupled[static_cast<std::size_t>(l)];
      residual(l) = sizes(l) + one.factor.v * normal_value(design, one.place, b_, {}, unused);
    }
    find_slope(design, coupled, b_);
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> slope(slope_.data(),
                                                                                                         m, m);
    const Eigen::PartialPivLU<Eigen::MatrixXd> factors(slope);
    if (!(factors.determinant() > 0)) return false;
    const Eigen::VectorXd step = factors.solve(residual);
    if (step.lpNorm<Eigen::Infinity>() <= settled_size * sizes.lpNorm<Eigen::Infinity>()) break;
    if (iteration == most_sizes_iterations) return false;
    sizes -= step;
  }
  for (std::size_t l = 0; l < coupled.size(); ++l) {
    for (std::size_t c = 0; c < f_.size(); ++c) f_[c] += response_[l].x[c] * sizes_[l];
  }
  return true;
}

// x and lambda have the derivatives that friction forces without any leave: what their own add.
void PhaseEquations::add_slopes(const Design& design, std::span<const Coupled> coupled, std::span<DesignScalar> x,
                                std::span<DesignScalar> lambda) {
  if (coupled.empty()) return;
  const auto m = static_cast<Eigen::Index>(coupled.size());
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> slope(slope_.data(), m,
                                                                                                       m);
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(slope);
  std::vector<DesignScalar> residual;
  for (const Coupled& one : coupled) residual.push_back(one.factor * normal(design, one.place, lambda));
  for (std::size_t p = 0; p < design.count; ++p) {
    Eigen::VectorXd side(m);
    for (Eigen::Index l = 0; l < m; ++l) side(l) = -residual[static_cast<std::size_t>(l)].d[p];
    const Eigen::VectorXd change = factors.solve(side);
    for (std::size_t l = 0; l < coupled.size(); ++l) {
      const double own = change(static_cast<Eigen::Index>(l));
      for (const int c : plan().coordinate) x[at(c)].d[p] += response_[l].x[at(c)] * own;
      for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r].d[p] += response_[l].lambda[r] * own;
      lambda[at(coupled[l].slide_row)].d[p] = -own;
    }
  }
}

bool PhaseEquations::accelerate(const Design& design, std::span<const DesignScalar> q, std::span<const DesignScalar> qd,
                                std::span<DesignScalar> qdd, std::span<DesignScalar> lambda) {
  DesignMechanism& mechanism = design.mechanism;
  mechanism.set_state(q, qd);
  mechanism.rows(rows_);
  mechanism.applied_forces(loads_);
  // What is known: compliant places, and their friction.
  std::fill(lambda.begin(), lambda.end(), DesignScalar());
  std::vector<Coupled> coupled;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (!states_[k].closed) continue;
    const bool compliant = contacts_.points[k].kind == ContactKind::compliant;
    const DesignScalar pressing = compliant ? compliant_force(design, k) : DesignScalar();
    if (compliant) lambda[at(gap_row(k))] = -pressing / row_factor(design, k);
    if (!slides(k)) continue;
    const DesignScalar factor = design.places[k].mu * slip_sign(design, k);
    if (compliant)
      lambda[at(slide_row(k))] = factor * pressing;
    else
      coupled.push_back({k, slide_row(k), factor});
  }
  std::fill(forces_.begin(), forces_.end(), DesignScalar());
  mechanism.add_constraint_loads(lambda, forces_);
  for (std::size_t c = 0; c < f_.size(); ++c) f_[c] = loads_[c].v - forces_[c].v;
  for (std::size_t r = 0; r < b_.size(); ++r) b_[r] = -rows_[r].dd.v;
  if (!solve_values(design, coupled)) return false;
  std::fill(qdd.begin(), qdd.end(), DesignScalar());
  for (const int c : plan().coordinate) qdd[at(c)] = DesignScalar(f_[at(c)]);
  for (std::size_t r = 0; r < b_.size(); ++r) lambda[r] += DesignScalar(b_[r]);
  for (std::size_t l = 0; l < coupled.size(); ++l) lambda[at(coupled[l].slide_row)] = DesignScalar(-sizes_[l]);
  // The residual's derivatives at these values.
  mechanism.set_state(q, qd, qdd);
  mechanism.rows(rows_);
  for (DesignScalar& load : loads_) load = -load;
  for (int c = 0; c < 3 * plan().moving; ++c) loads_[at(c)] += mechanism.mass(c) * qdd[at(c)];
  mechanism.add_constraint_loads(lambda, loads_);
  for (std::size_t p = 0; p < design.count; ++p) {
    for (std::size_t c = 0; c < f_.size(); ++c) f_[c] = -loads_[c].d[p];
    for (std::size_t r = 0; r < b_.size(); ++r) b_[r] = -rows_[r].dd.d[p];
    if (!system_->solve(f_, b_)) return false;
    for (const int c : plan().coordinate) qdd[at(c)].d[p] = f_[at(c)];
    for (std::size_t r = 0; r < b_.size(); ++r) {
      if (held_[r]) lambda[r].d[p] = b_[r];
    }
  }
  add_slopes(design, coupled, qdd, lambda);
  return true;
}

void PhaseEquations::contacts(const Design& design, std::span<const DesignScalar> lambda, DesignContacts& out) const {
  out.loads.assign(evaluator_.model().elements.size(), {});
  out.energy = DesignScalar();
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const ContactPoint& point = contacts_.points[k];
    const DesignPlace& place = design.places[k];
    if (!states_[k].closed) continue;
    DesignContactLoad& load = out.loads[at(point.element)];
    load.force = normal(design, k, lambda) / place.radius;
    load.glides = !point.has_friction();
    if (point.has_friction()) {
      load.friction = -lambda[at(slide_row(k))];
      if (!sticks(k)) load.slip = design.mechanism.measure(point.slide).d;
    }
    if (point.kind != ContactKind::compliant) continue;
    const DesignScalar d = -design.mechanism.measure(point.element).f, order = place.exponent + DesignScalar(1.0);
    if (d.v > 0) out.energy += place.k * pow(d, order) / order;
  }
}

bool PhaseEquations::project(const Design& design, std::span<const DesignScalar> anchor, std::span<DesignScalar> q,
                             std::span<DesignScalar> qd) {
  DesignMechanism& mechanism = design.mechanism;
  DesignVector bare(q.size());
  for (const bool velocity : {false, true}) {
    const std::span<DesignScalar> part = velocity ? qd : q;
    for (std::size_t c = 0; c < bare.size(); ++c) {
      const bool unknown = c < plan().column.size() && plan().column[c] >= 0;
      bare[c] = velocity || unknown ? DesignScalar(part[c].v) : q[c];
    }
    if (velocity)
      mechanism.set_state(q, bare);
    else
      mechanism.set_state(bare);
    mechanism.rows(rows_);
    for (std::size_t p = 0; p < design.count; ++p) {
      for (std::size_t c = 0; c < f_.size(); ++c)
        f_[c] = c < at(3 * plan().moving) ? mechanism.mass(static_cast<int>(c)).v * part[c].d[p] : 0;
      for (std::size_t r = 0; r < b_.size(); ++r)
        b_[r] = velocity ? -rows_[r].d.d[p] : anchor[r].d[p] - rows_[r].f.d[p];
      if (!system_->solve(f_, b_)) return false;
      for (const int c : plan().coordinate) part[at(c)].d[p] = f_[at(c)];
    }
  }
  return true;
}

bool PhaseEquations::jump(const Design& design, const VelocityJump& jump, const DesignStrike* strike,
                          std::span<const DesignScalar> target, std::span<const double> instant,
                          std::span<const DesignScalar> q, std::span<DesignScalar> qd) {
  DesignMechanism& mechanism = design.mechanism;
  std::vector<Coupled> coupled;
  for (const ImpactPlace& place : jump.places) {
    if (place.direction != 0)
      coupled.push_back(
          {place.place, slide_row(place.place), design.places[place.place].mu * DesignScalar(place.direction)});
  }
  DesignVector blow(f_.size());
  mechanism.set_state(q);
  const int struck = strike ? plan().plan_body[at(strike->body)] : -1;
  if (struck >= 0 && struck < plan().moving) {
    const Vec2<DesignScalar> arm = mechanism.ground_frame(struck).axis(strike->point);
    blow[at(3 * struck)] = strike->impulse.x;
    blow[at(3 * struck + 1)] = strike->impulse.y;
    blow[at(3 * struck + 2)] = cross(arm, strike->impulse);
  }
  mechanism.rows(rows_);
  std::vector<double> by_time(b_.size());  // nu_t, with the other sign
  for (std::size_t r = 0; r < b_.size(); ++r) {
    by_time[r] = rows_[r].dd.v;
    b_[r] = target[r].v - rows_[r].d.v;
  }
  for (std::size_t c = 0; c < f_.size(); ++c)
    f_[c] = c < at(3 * plan().moving) ? mechanism.mass(static_cast<int>(c)).v * qd[c].v + blow[c].v : 0;
  if (!solve_values(design, coupled)) return false;
  DesignVector after(qd.size()), impulse(b_.size());
  for (const int c : plan().coordinate) after[at(c)] = DesignScalar(f_[at(c)]);
  set_values(b_, impulse);
  for (std::size_t l = 0; l < coupled.size(); ++l) impulse[at(coupled[l].slide_row)] = DesignScalar(-sizes_[l]);
  mechanism.set_state(q, after);
  mechanism.rows(rows_);
  for (std::size_t c = 0; c < loads_.size(); ++c) {
    loads_[c] = -blow[c];
    if (c < at(3 * plan().moving)) loads_[c] += mechanism.mass(static_cast<int>(c)) * (after[c] - qd[c]);
  }
  mechanism.add_constraint_loads(impulse, loads_);
  for (std::size_t p = 0; p < design.count; ++p) {
    for (std::size_t c = 0; c < f_.size(); ++c) f_[c] = -loads_[c].d[p];
    for (std::size_t r = 0; r < b_.size(); ++r) b_[r] = target[r].d[p] - rows_[r].d.d[p] - by_time[r] * instant[p];
    if (!system_->solve(f_, b_)) return false;
    for (const int c : plan().coordinate) after[at(c)].d[p] = f_[at(c)];
    for (std::size_t r = 0; r < b_.size(); ++r) {
      if (held_[r]) impulse[r].d[p] = b_[r];
    }
  }
  add_slopes(design, coupled, after, impulse);
  for (const int c : plan().coordinate) qd[at(c)] = after[at(c)];
  return true;
}

}  // namespace catena
