#include "catena/analysis/sensitivity/phases/phase_equations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/base/at.hpp"

namespace catena {

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
  columns_.resize(at(plan().columns));
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
  find_shared_rows();
}

// Rows of the mechanisms in which joints share friction, but for those of forces that the state alone decides.
void PhaseEquations::find_shared_rows() {
  shared_.clear();
  std::vector<char> tied(at(plan().rows), 0), by_state(tied), shares(at(plan().islands), 0);
  bool any = false;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const ContactKind kind = contacts_.points[k].kind;
    const bool ties = states_[k].tied && kind == ContactKind::joint;
    if (ties) tied[at(slide_row(k))] = 1;
    any = any || ties;
    if (kind != ContactKind::compliant) continue;
    by_state[at(gap_row(k))] = 1;
    if (const int row = slide_row(k); row >= 0) by_state[at(row)] = 1;
  }
  if (!any) return;
  shared_.assign(at(plan().rows), 0);
  for (const bool marks : {false, true}) {
    for (int c = 0; c < plan().columns; ++c) {
      char& mechanism = shares[at(plan().island[at(plan().coordinate[at(c)] / 3)])];
      for (int n = plan().jacobian.column_start[at(c)]; n < plan().jacobian.column_start[at(c) + 1]; ++n) {
        const auto row = at(plan().jacobian.row_index[at(n)]);
        if (!marks && tied[row]) mechanism = 1;
        if (marks && mechanism && !by_state[row]) shared_[row] = 1;
      }
    }
  }
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
  if (states_[k].tied && states_[k].master >= 0) law.master_row = slide_row(at(states_[k].master));
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

PlaceMotion PhaseEquations::motion_of_forces(const DesignMechanism& mechanism, const PlaceLaw& law) const {
  PlaceMotion motion;
  if (law.asks_gap()) {
    const Taylor<DesignScalar> gap = mechanism.measure(law.point.element);
    motion.gap = gap.f;
    motion.gap_rate = gap.d;
  }
  if (law.asks_slip()) motion.slip = mechanism.measure(law.point.slide).d;
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
  const auto by_forces = [&]() -> EndRate {
    const int row = watched.ends == PhaseEnd::slide ? slide_row(watched.place) : gap_row(watched.place);
    if (row < 0 || !shares_row(row)) return {};
    return {{},
            fmt::format("at t = {:.9g} s the force of \"{}\" ends a phase in which joints share friction that is not "
                        "unique: when has no derivative",
                        mechanism.time(), name())};
  };
  if (watched.ends == PhaseEnd::slide) {
    if (states_[watched.place].direction == 0) return by_forces();
    return {mechanism.measure(point.slide).dd.v, {}};
  }
  const PlaceMotion now = motion(mechanism, watched.place);
  if (!law(place, watched.place).ends_by_gap(now, watched.ends)) return by_forces();
  const double part = point.turns ? 1 / evaluator_.length_scale() : 1;
  if (std::abs(now.gap_rate.v) > no_speed * part * speed) return {now.gap_rate.v, {}};
  return {{},
          fmt::format("at t = {:.9g} s \"{}\" touches with a speed of {:.3g} that cannot be told from rounding: a "
                      "little more or less is another motion",
                      mechanism.time(), name(), now.gap_rate.v)};
}

DesignScalar PhaseEquations::normal(const Design& design, std::size_t k, std::span<const DesignScalar> lambda) const {
  const PlaceLaw there = law(design.places[k], k);
  return there.normal(motion_of_forces(design.mechanism, there), lambda);
}

DesignScalar PhaseEquations::pressing(const Design& design, std::size_t k, std::span<const DesignScalar> lambda) const {
  const PlaceLaw there = law(design.places[k], k);
  return there.pressing(motion_of_forces(design.mechanism, there), lambda);
}

// Multipliers of compliant places and of their friction, which follow from the state; the friction that does not.
std::vector<PhaseEquations::Coupled> PhaseEquations::find_known(const Design& design, std::span<const DesignScalar> q,
                                                                std::span<const DesignScalar> qd,
                                                                std::span<DesignScalar> lambda) const {
  std::vector<Coupled> coupled;
  bool is_there = false;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (!states_[k].closed) continue;
    const PlaceLaw law = this->law(design.places[k], k);
    const bool compliant = law.point.kind == ContactKind::compliant, slides = law.slides();
    if (!compliant && !slides) continue;
    if (law.asks_motion() && !std::exchange(is_there, true)) design.mechanism.set_state(q, qd);
    const PlaceMotion now = motion_of_forces(design.mechanism, law);
    const DesignScalar pressing = compliant ? law.compliant_force(now) : DesignScalar();
    if (compliant) lambda[at(law.gap_row)] = -pressing / law.row_factor(now.gap);
    if (!slides) continue;
    const DesignScalar factor = law.coefficient(now.slip);
    if (compliant)
      lambda[at(law.slide_row)] = factor * pressing;
    else
      coupled.push_back({k, law.slide_row, factor});
  }
  return coupled;
}

// Right-hand sides of the accelerations in plain numbers, where the evaluator is since it was factored.
void PhaseEquations::find_sides(std::span<const DesignScalar> qd, std::span<const DesignScalar> lambda) {
  for (std::size_t c = 0; c < values_.size(); ++c) values_[c] = qd[c].v;
  evaluator_.applied_forces(values_, f_);
  for (std::size_t r = 0; r < b_.size(); ++r) b_[r] = -lambda[r].v;
  add_loads(b_, f_);
  evaluator_.gamma(values_, b_);
}

// f += Phi_q^T lambda.
void PhaseEquations::add_loads(std::span<const double> lambda, std::span<double> f) {
  std::fill(columns_.begin(), columns_.end(), 0.0);
  multiply_transposed_add(plan().jacobian, jacobian(), lambda, columns_);
  for (std::size_t c = 0; c < columns_.size(); ++c) f[at(plan().coordinate[c])] += columns_[c];
}

bool PhaseEquations::accelerate(const Design& design, std::span<const DesignScalar> q, std::span<const DesignScalar> qd,
                                std::span<DesignScalar> qdd, std::span<DesignScalar> lambda) {
  DesignMechanism& mechanism = design.mechanism;
  std::fill(lambda.begin(), lambda.end(), DesignScalar());
  const std::vector<Coupled> coupled = find_known(design, q, qd, lambda);
  find_sides(qd, lambda);
  if (!solve_values(design, coupled)) return false;
  std::fill(qdd.begin(), qdd.end(), DesignScalar());
  for (const int c : plan().coordinate) qdd[at(c)] = DesignScalar(f_[at(c)]);
  for (std::size_t r = 0; r < b_.size(); ++r) lambda[r] += DesignScalar(b_[r]);
  for (std::size_t l = 0; l < coupled.size(); ++l) lambda[at(coupled[l].slide_row)] = DesignScalar(-sizes_[l]);
  if (design.count == 0) return true;
  mechanism.set_state(q, qd, qdd);
  // The residual's derivatives at these values.
  mechanism.rows(rows_);
  mechanism.applied_forces(loads_);
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
