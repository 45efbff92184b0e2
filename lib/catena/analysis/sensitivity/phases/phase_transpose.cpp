#include "catena/analysis/sensitivity/phases/phase_transpose.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <utility>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

DesignScalar bare(const DesignScalar& x) { return DesignScalar(x.v); }

DesignPlace bare(DesignPlace place) {
  for (DesignScalar* x : {&place.restitution, &place.k, &place.c, &place.exponent, &place.mu, &place.mu_static,
                          &place.smoothing, &place.radius, &place.half_length, &place.range})
    *x = bare(*x);
  return place;
}

PlaceMotion bare(const PlaceMotion& motion) { return {bare(motion.gap), bare(motion.gap_rate), bare(motion.slip)}; }

void lift_values(std::span<const double> values, DesignVector& out) {
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = DesignScalar(values[k]);
}

void take_values(const DesignVector& values, std::vector<double>& out) {
  out.resize(values.size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = values[k].v;
}

}  // namespace

PhaseTranspose::PhaseTranspose(PhaseEquations& equations, AdjointMechanism& adjoint, DesignMechanism& plain,
                               const std::vector<DesignPlace>& places)
    : equations_(equations), adjoint_(adjoint), plain_(plain) {
  for (const DesignPlace& place : places) places_.push_back(bare(place));
  const std::size_t n = at(plan().coordinates()), rows = at(plan().rows);
  zero_loads_.assign(n, 0.0);
  zero_rows_.assign(rows, 0.0);
  masses_.assign(n, 0.0);
  for (const int c : plan().coordinate) masses_[at(c)] = plain.mass(c).v;
  for (DesignVector* of : {&q_, &qd_, &qdd_}) of->resize(n);
  lambda_.resize(rows);
  phi_ = rate_ = zero_rows_;
}

bool PhaseTranspose::factorize(const Point& point) {
  plain_.set_time(point.t, point.side);
  lift_values(point.q, q_);
  return equations_.factorize(point.t, point.side, q_, plain_) && equations_.dependent_rows().empty();
}

bool PhaseTranspose::evaluate(Point& point) {
  if (!factorize(point)) return false;
  lift_values(point.qd, qd_);
  if (!equations_.accelerate({plain_, places_, 0}, q_, qd_, qdd_, lambda_)) return false;
  take_values(qdd_, point.qdd);
  take_values(lambda_, point.lambda);
  return find_terms(point);
}

void PhaseTranspose::set_state(DesignMechanism& mechanism, const Point& point) {
  mechanism.set_time(point.t, point.side);
  mechanism.lift_configuration(point.q, q_);
  lift_values(point.qd, qd_);
  lift_values(point.qdd, qdd_);
  mechanism.set_state(q_, qd_, qdd_);
}

void PhaseTranspose::take_multipliers(const Point& point) { lift_values(point.lambda, lambda_); }

PlaceMotion PhaseTranspose::motion_at(const Point& point, std::size_t place) {
  set_state(plain_, point);
  return bare(equations_.motion(plain_, place));
}

PhaseTranspose::Rows PhaseTranspose::normal_rows(std::size_t place) const {
  const PlaceLaw law = equations_.law(places_[place], place);
  if (law.master_row >= 0) return {law.master_row, -1, -1};
  if (law.point.kind == ContactKind::compliant) return {-1, -1, -1};
  if (law.point.kind == ContactKind::rigid) return {law.gap_row, -1, -1};
  return {law.joint_row, law.joint_row + 1, -1};
}

// Gap, its rate and slip are varied first, then multipliers.
template <class F>
PhaseTranspose::Partials PhaseTranspose::partials(const PlaceMotion& motion, const Rows& rows, F&& f) {
  PlaceMotion moved = motion;
  moved.gap.d[0] = moved.gap_rate.d[1] = moved.slip.d[2] = 1;
  const DesignScalar by_motion = f(moved);
  Partials by{by_motion.d[0], by_motion.d[1], by_motion.d[2]};
  for (std::size_t s = 0; s < rows.size(); ++s) {
    if (rows[s] >= 0) lambda_[at(rows[s])].d[s] = 1;
  }
  const DesignScalar by_lambda = f(motion);
  for (std::size_t s = 0; s < rows.size(); ++s) {
    by.lambda[s] = by_lambda.d[s];
    if (rows[s] >= 0) lambda_[at(rows[s])].d[s] = 0;
  }
  return by;
}

DesignScalar PhaseTranspose::known(const Term& term, const DesignPlace& place, const PlaceMotion& motion) const {
  const PlaceLaw law = equations_.law(place, term.place);
  if (!term.is_slide) return -law.compliant_force(motion) / law.row_factor(motion.gap);
  const DesignScalar factor =
      term.direction != 0 ? place.mu * DesignScalar(term.direction) : law.coefficient(motion.slip);
  return factor * law.pressing(motion, lambda_);
}

bool PhaseTranspose::find_terms(const Point& point) {
  terms_.clear();
  take_multipliers(point);
  bool is_there = false;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const PlaceLaw law = equations_.law(places_[k], k);
    const bool compliant = law.point.kind == ContactKind::compliant;
    if (!law.state.closed || (!compliant && !law.slides())) continue;
    if (law.asks_motion() && !std::exchange(is_there, true)) set_state(plain_, point);
    const PlaceMotion motion = bare(equations_.motion_of_forces(plain_, law));
    if (compliant) terms_.push_back(Term{law.gap_row, k, false, 0, motion});
    if (law.slides()) terms_.push_back(Term{law.slide_row, k, true, 0, motion});
  }
  return std::all_of(terms_.begin(), terms_.end(), [this](Term& term) { return complete(term); });
}

// What its multiplier changes by, and what a unit of it weighs in the equations that hold.
bool PhaseTranspose::complete(Term& term) {
  if (term.is_slide) term.lambda_rows = normal_rows(term.place);
  const DesignPlace& place = places_[term.place];
  term.by = partials(term.motion, term.lambda_rows, [&](const PlaceMotion& m) { return known(term, place, m); });
  if (term.lambda_rows == Rows{-1, -1, -1}) return true;
  term.w = zero_loads_;
  term.mu = zero_rows_;
  for (std::size_t s = 0; s < term.lambda_rows.size(); ++s) {
    if (term.lambda_rows[s] >= 0) term.mu[at(term.lambda_rows[s])] = term.by.lambda[s];
  }
  if (!solve(term.w, term.mu)) return false;
  term.along = rates_of_rows(term.w);
  return true;
}

// In place; coordinates that are no unknowns weigh nothing.
bool PhaseTranspose::solve(Vector& w, Vector& mu) {
  if (!equations_.solve(w, mu)) return false;
  for (std::size_t c = 0; c < w.size(); ++c) {
    if (c >= plan().column.size() || plan().column[c] < 0) w[c] = 0;
  }
  return true;
}

PhaseTranspose::Vector PhaseTranspose::rates_of_rows(const Vector& qd) const {
  Vector columns(at(plan().columns)), rates(zero_rows_);
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c] = qd[at(plan().coordinate[c])];
  multiply_add(plan().jacobian, equations_.jacobian(), columns, rates);
  return rates;
}

void PhaseTranspose::add_rows(std::span<const double> rows, std::span<double> out) const {
  Vector columns(at(plan().columns), 0.0);
  multiply_transposed_add(plan().jacobian, equations_.jacobian(), rows, columns);
  for (std::size_t c = 0; c < columns.size(); ++c) out[at(plan().coordinate[c])] += columns[c];
}

bool PhaseTranspose::weigh(std::span<const double> by_qdd, std::span<const double> by_lambda) {
  w_ = zero_loads_;
  mu_ = zero_rows_;
  std::copy(by_qdd.begin(), by_qdd.end(), w_.begin());
  std::copy(by_lambda.begin(), by_lambda.end(), mu_.begin());
  const auto given = [&](int row) { return by_lambda.empty() ? 0 : by_lambda[at(row)]; };
  if (!solve(w_, mu_)) return false;
  std::vector<Term*> coupled;
  for (Term& term : terms_) {
    if (term.is_coupled()) coupled.push_back(&term);
  }
  if (!coupled.empty()) {
    const auto m = static_cast<Eigen::Index>(coupled.size());
    const Vector along = rates_of_rows(w_);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(m, m);
    Eigen::VectorXd side(m);
    for (Eigen::Index l = 0; l < m; ++l) {
      const std::size_t row = at(coupled[static_cast<std::size_t>(l)]->row);
      side(l) = given(static_cast<int>(row)) - along[row];
      for (Eigen::Index k = 0; k < m; ++k) matrix(l, k) += coupled[static_cast<std::size_t>(k)]->along[row];
    }
    const Eigen::VectorXd nu = Eigen::PartialPivLU<Eigen::MatrixXd>(matrix).solve(side);
    for (Eigen::Index l = 0; l < m; ++l) {
      Term& term = *coupled[static_cast<std::size_t>(l)];
      term.nu = nu(l);
      for (std::size_t c = 0; c < w_.size(); ++c) w_[c] += term.nu * term.w[c];
      for (std::size_t r = 0; r < mu_.size(); ++r) mu_[r] += term.nu * term.mu[r];
    }
  }
  if (coupled.size() == terms_.size()) return true;
  const Vector along = rates_of_rows(w_);
  for (Term& term : terms_) {
    if (!term.is_coupled()) term.nu = given(term.row) - along[at(term.row)];
  }
  return true;
}

// g = Psi / (Psi' / g') to first order, and g' likewise: by Psi and Psi', whose derivatives are those of rows.
void PhaseTranspose::add_place(std::size_t k, const PlaceMotion& motion, const Partials& by, double weight) {
  const PlaceLaw law = equations_.law(places_[k], k);
  if (law.gap_row >= 0 && (by.gap != 0 || by.gap_rate != 0)) {
    const double factor = law.row_factor(motion.gap).v;
    phi_[at(law.gap_row)] +=
        weight * (by.gap / factor - by.gap_rate * motion.gap_rate.v * law.row_bend() / (factor * factor));
    rate_[at(law.gap_row)] += weight * by.gap_rate / factor;
  }
  if (law.slide_row >= 0) rate_[at(law.slide_row)] += weight * by.slip;
}

void PhaseTranspose::add_by_state(const Point& point, std::span<double> by_q, std::span<double> by_qd) {
  phi_ = rate_ = zero_rows_;
  for (const Term& term : terms_) add_place(term.place, term.motion, term.by, term.nu);
  adjoint_.set_motion(equations_.evaluator(), point.qd, point.qdd, point.side);
  add_rows(phi_, by_q);
  add_rows(rate_, by_qd);
  for (double& rate : rate_) rate = -rate;
  const AdjointWeights weights{.w = w_, .lambda = point.lambda, .rate = rate_, .bend = mu_};
  adjoint_.add_by_state(equations_.evaluator(), weights, by_q, by_qd);
}

PhaseTranspose::ByParameter PhaseTranspose::by_parameters(const Point& point, const PhaseGroup& group) {
  if (group.reached.asks_mechanism()) group.mechanism.set_time(point.t, point.side);
  const AdjointWeights weights{.w = w_, .lambda = point.lambda, .bend = mu_};
  ByParameter sum = adjoint_.by_parameters(group.mechanism, group.reached, weights, point.qdd);
  const bool known_act = std::any_of(terms_.begin(), terms_.end(), [](const Term& term) { return term.nu != 0; });
  if (!known_act) return sum;
  bool is_there = false;
  take_multipliers(point);
  for (const Term& term : terms_) {
    if (term.nu == 0) continue;
    const PlaceLaw law = equations_.law(group.places[term.place], term.place);
    if (law.asks_motion() && !std::exchange(is_there, true)) set_state(group.mechanism, point);
    const PlaceMotion motion = equations_.motion_of_forces(group.mechanism, law);
    const DesignScalar value = known(term, group.places[term.place], motion);
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += term.nu * value.d[p];
  }
  return sum;
}

// Velocities are projected after positions: back in the other order.
bool PhaseTranspose::project_back(const Point& point, std::span<double> q, std::span<double> qd,
                                  std::span<double> anchor, std::span<Vector, 2> parameters) {
  adjoint_.set_motion(equations_.evaluator(), point.qd, {}, point.side);
  for (const bool velocity : {true, false}) {
    const std::span<double> part = velocity ? qd : q;
    Vector w(part.begin(), part.end()), &mu = parameters[velocity ? 1 : 0];
    mu = zero_rows_;
    if (!solve(w, mu)) return false;
    for (std::size_t c = 0; c < part.size(); ++c) part[c] = masses_[c] * w[c];
    if (velocity)
      adjoint_.add_by_state(equations_.evaluator(), {.rate = mu}, q, qd);
    else
      for (std::size_t r = 0; r < mu.size(); ++r) anchor[r] += mu[r];
  }
  return true;
}

PhaseTranspose::ByParameter PhaseTranspose::rows_by_parameters(const Point& point, std::span<const double> values,
                                                               std::span<const double> rates, const PhaseGroup& group) {
  if (group.reached.asks_mechanism()) group.mechanism.set_time(point.t, point.side);
  adjoint_.set_motion(equations_.evaluator(), point.qd, {}, point.side);
  return adjoint_.by_parameters(group.mechanism, group.reached, {.phi = values, .rate = rates}, {});
}

double PhaseTranspose::end_value(const Point& point, const WatchedPlace& watched) {
  take_multipliers(point);
  const PlaceMotion motion = motion_at(point, watched.place);
  return equations_.law(places_[watched.place], watched.place).end_value(motion, lambda_, watched.ends).v;
}

PhaseEquations::EndRate PhaseTranspose::rate_of_end(const Point& point, const WatchedPlace& watched) {
  set_state(plain_, point);
  return equations_.rate_of_end(plain_, places_[watched.place], watched, fastest(equations_.evaluator(), point.qd));
}

DesignScalar PhaseTranspose::end_value(const Point& point, const WatchedPlace& watched, const PhaseGroup& group) {
  set_state(group.mechanism, point);
  take_multipliers(point);
  const PlaceMotion motion = equations_.motion(group.mechanism, watched.place);
  return equations_.law(group.places[watched.place], watched.place).end_value(motion, lambda_, watched.ends);
}

void PhaseTranspose::add_end(const Point& point, const WatchedPlace& watched, double weight, std::span<double> by_q,
                             std::span<double> by_qd, std::span<double> by_lambda) {
  const std::size_t k = watched.place;
  take_multipliers(point);
  const PlaceMotion motion = motion_at(point, k);
  const PlaceLaw law = equations_.law(places_[k], k);
  Rows rows = normal_rows(k);
  rows[2] = law.slide_row;
  const Partials by =
      partials(motion, rows, [&](const PlaceMotion& m) { return law.end_value(m, lambda_, watched.ends); });
  phi_ = rate_ = zero_rows_;
  add_place(k, motion, by, weight);
  for (std::size_t s = 0; s < rows.size(); ++s) {
    if (rows[s] >= 0) by_lambda[at(rows[s])] += weight * by.lambda[s];
  }
  adjoint_.set_motion(equations_.evaluator(), point.qd, point.qdd, point.side);
  add_rows(phi_, by_q);
  add_rows(rate_, by_qd);
  for (double& rate : rate_) rate = -rate;
  adjoint_.add_by_state(equations_.evaluator(), {.rate = rate_}, by_q, by_qd);
}

}  // namespace catena
