#include "catena/analysis/sensitivity/phases/phase_equations.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// As in contact_loads.cpp: one step without joints, quadratic with them.
constexpr int most_sizes_iterations = 30;
constexpr double settled_size = 1e-15;

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
  impulse_.resize(rows);
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

bool PhaseEquations::sticks(std::size_t k) const { return law({}, k).sticks(); }

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

PlaceLaw PhaseEquations::law(const DesignPlace& place, std::size_t k) const {
  const ContactPoint& point = contacts_.points[k];
  PlaceLaw law{point, states_[k], place, gap_row(k), slide_row(k)};
  if (point.kind != ContactKind::joint) return law;
  law.joint_row = plan().element_row[at(point.joint)];
  law.has_moment = plan().row_is_angle[at(law.joint_row) + 1] != 0;
  return law;
}

PlaceMotion PhaseEquations::motion(const DesignMechanism& mechanism, std::size_t k) const {
  const ContactPoint& point = contacts_.points[k];
  PlaceMotion motion;
  if (point.kind != ContactKind::joint) {
    const Taylor<DesignScalar> gap = mechanism.measure(point.element);
    motion.gap = gap.f;
    motion.gap_rate = gap.d;
  }
  if (point.has_friction()) motion.slip = mechanism.measure(point.slide).d;
  return motion;
}

PhaseEquations::EndRate PhaseEquations::rate_of_end(const DesignMechanism& mechanism, const DesignPlace& place,
                                                    const WatchedPlace& watched, double speed) const {
  const ContactPoint& point = contacts_.points[watched.place];
  const auto name = [&] { return contacts_.model->element_name(point.element); };
  if (watched.ends == PhaseEnd::shares)
    return {
        {},
        fmt::format("at t = {:.9g} s places that hold each other, \"{}\" among them, give way: when has no derivative",
                    mechanism.time(), name())};
  if (watched.ends == PhaseEnd::slide) {
    if (states_[watched.place].direction == 0) return {};
    return {mechanism.measure(point.slide).dd.v, {}};
  }
  const PlaceMotion now = motion(mechanism, watched.place);
  if (!law(place, watched.place).ends_by_gap(now, watched.ends)) return {};
  const double part = point.turns ? 1 / evaluator_.length_scale() : 1;
  if (std::abs(now.gap_rate.v) > no_speed * part * speed) return {now.gap_rate.v, {}};
  return {{},
          fmt::format("at t = {:.9g} s \"{}\" touches with a speed of {:.3g} that cannot be told from rounding: a "
                      "little more or less is another motion",
                      mechanism.time(), name(), now.gap_rate.v)};
}

DesignScalar PhaseEquations::normal(const Design& design, std::size_t k, std::span<const DesignScalar> lambda) const {
  const bool compliant = contacts_.points[k].kind == ContactKind::compliant;
  return law(design.places[k], k).normal(compliant ? motion(design.mechanism, k) : PlaceMotion{}, lambda);
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
    const PlaceLaw law = this->law(design.places[k], k);
    const bool compliant = law.point.kind == ContactKind::compliant, slides = law.slides();
    const PlaceMotion now = compliant || slides ? motion(mechanism, k) : PlaceMotion{};
    const DesignScalar pressing = compliant ? law.compliant_force(now) : DesignScalar();
    if (compliant) lambda[at(law.gap_row)] = -pressing / law.row_factor(now.gap);
    if (!slides) continue;
    const DesignScalar factor = law.place.mu * law.slip_sign(now.slip);
    if (compliant)
      lambda[at(law.slide_row)] = factor * pressing;
    else
      coupled.push_back({k, law.slide_row, factor});
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

}  // namespace catena
