// Impacts: what velocities become where places close with a speed.
//
//   Newton    w+ >= -e w-                       with the rebounds of all places at once
//   Poisson   w_c = w- + D x_c >= 0,  w+ = w_c + D x_e,  x_e across = e x_c across,  |x_e along| <= mu x_e across
//
// Newton's law is taken unless its impulses would do work, as they may where restitutions differ or friction acts
// (Kane's example). Then Poisson's takes its place, whose impulses of release are a part of those of compression; where
// a place would close again in the release, or work is done even so, all restitutions are reduced until none is.
// Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (1996), chapter 8; T. Kane, D. Levinson,
// Dynamics (1985), 4.7.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {

double ContactSwitch::kinetic_energy(std::span<const double> qd) const {
  const std::vector<double>& mass = equations_.masses().mass;
  double twice = 0;
  for (int c = 0; c < 3 * evaluator_.plan().moving; ++c) twice += mass[at(c)] * qd[at(c)] * qd[at(c)];
  return twice / 2;
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
  std::fill(unit_.load.begin(), unit_.load.end(), 0.0);
  unit_.load[at(3 * body)] = strike.impulse.x;
  unit_.load[at(3 * body + 1)] = strike.impulse.y;
  unit_.load[at(3 * body + 2)] = cross(arm, strike.impulse);
  std::vector<double> change(unit_.load.size(), 0.0), multipliers(unit_.nothing);
  equations_.solve_motion(unit_.load, unit_.nothing, change, multipliers);
  const double before = speed();
  for (std::size_t k = 0; k < qd.size(); ++k) qd[k] += change[k];
  for (std::size_t r = 0; r < p_.size(); ++r) p_[r] += multipliers[r];
  work_of_strike_ = (before + speed()) / 2;
}

// Whether a touching place is hit: its gap closes.
bool ContactSwitch::hits(std::size_t k) const {
  return points_[k].kind == ContactKind::rigid && gap_[k].rate < -part_of_speed(k, no_speed);
}

// The speed at which place k comes back; 0: it stays.
double ContactSwitch::rebound(std::size_t k) const {
  const double speed = -points_[k].restitution * std::min(gap_[k].rate, 0.0);
  return speed >= rest_speed(k) ? speed : 0;
}

// Which places have impulses, at the velocities before them.
void ContactSwitch::take_note(const ContactProblem& problem) {
  jump_->places.clear();
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    const bool presses = problem.state[a] != ContactProblem::State::open;
    if (!problem.place[a].has_normal || (!presses && !hits(k))) continue;
    ImpactPlace& place = jump_->places.emplace_back();
    place.place = k;
    place.was_hit = hits(k);
    place.presses = presses;
    place.rebounds = rebound(k) > 0;
    place.sticks = problem.state[a] == ContactProblem::State::sticks;
    if (problem.place[a].has_friction && !place.sticks) place.direction = problem.direction[a];
  }
}

// Of impulses with the given part of every restitution, at the velocities qd; with what rates of the active places are
// sums of, for their rounding: that is what a rate of none is left with.
void ContactSwitch::set_up(ContactProblem& problem, double restitution_part, std::span<const double> qd) const {
  fill(problem);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    ContactProblem::Place& place = problem.place[a];
    if (!place.has_normal && place.head >= 0) {
      problem.b[2 * a + 1] = slide_[k].rate;
      continue;
    }
    if (!place.has_normal) {
      // What is pressed by a force of finite size has no impulse, and no friction of one.
      place.has_friction = false;
      place.limit = place.kinetic = 0;
      continue;
    }
    place.mu_static = place.mu;
    problem.b[2 * a] = gap_[k].rate - restitution_part * rebound(k);
    problem.b[2 * a + 1] = place.has_friction ? slide_[k].rate : 0;
  }
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const ContactProblem::Place& place = problem.place[a];
    // Bodies that came to rest have rates that are rounding of those of the motion.
    const double speed = part_of_speed(active_[a], thresholds::few_roundings / ContactProblem::rounding_of_sums);
    if (place.has_normal) problem.b_terms[2 * a] = std::max(size_of_product(gap_[active_[a]], qd), speed);
    if (place.has_friction) problem.b_terms[2 * a + 1] = std::max(size_of_product(slide_[active_[a]], qd), speed);
  }
}

// Adds the impulses to velocities and multipliers. Returns their work, from the rates of gaps and slides before them.
double ContactSwitch::act(const ContactProblem& problem, std::span<double> qd) {
  for (std::size_t c = 0; c < problem.x.size(); ++c) {
    for (std::size_t n = 0; n < qd.size(); ++n) qd[n] += change_[c][n] * problem.x[c];
    for (std::size_t r = 0; r < p_.size(); ++r) p_[r] += multipliers_[c][r] * problem.x[c];
  }
  double work = 0;
  for (std::size_t r = 0; r < problem.x.size(); ++r) {
    double rate = r % 2 == 0 ? gap_[active_[r / 2]].rate : slide_[active_[r / 2]].rate;
    for (std::size_t c = 0; c < problem.x.size(); ++c) rate += problem.D(r, c) * problem.x[c] / 2;
    work += rate * problem.x[r];
  }
  return work;
}

bool ContactSwitch::bounce(double restitution_part, std::span<double> qd, double& work) {
  ContactProblem problem(active_.size());
  set_up(problem, restitution_part, qd);
  if (!problem.solve()) return false;
  take_note(problem);
  work = act(problem, qd);
  return true;
}

// False: compression has no solution, a place would close again while others are released, or ropes rub on pulleys.
bool ContactSwitch::bounce_by_poisson(std::span<double> qd, double& work) {
  ContactProblem compression(active_.size());
  set_up(compression, 0, qd);
  const auto grips = [](const ContactProblem::Place& place) { return place.head >= 0; };
  if (std::any_of(compression.place.begin(), compression.place.end(), grips) || !compression.solve()) return false;
  ContactProblem release(active_.size());
  fill(release);
  std::vector<double> across(active_.size(), 0.0);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    ContactProblem::Place& place = release.place[a];
    if (place.has_normal && rebound(k) > 0) across[a] = points_[k].restitution * compression.x[2 * a];
    // What a place is released with is known: only its friction is sought.
    place.has_friction = place.has_normal && place.has_friction;
    place.has_normal = false;
    place.limit = place.kinetic = place.mu * across[a];
  }
  const auto rate_of = [&](std::size_t r) {
    return r % 2 == 0 ? gap_[active_[r / 2]].rate : slide_[active_[r / 2]].rate;
  };
  for (std::size_t r = 0; r < release.b.size(); ++r) {
    release.b[r] = rate_of(r);
    release.b_terms[r] = compression.b_terms[r];
    for (std::size_t c = 0; c < release.b.size(); ++c) {
      const double released = c % 2 == 0 ? across[c / 2] : 0;
      const double part = compression.D(r, c) * (compression.x[c] + released);
      release.b[r] += part;
      release.b_terms[r] += std::abs(part);
    }
  }
  if (!release.solve()) return false;
  ContactProblem both = compression;
  for (std::size_t c = 0; c < both.x.size(); ++c) both.x[c] += c % 2 == 0 ? across[c / 2] : release.x[c];
  for (std::size_t a = 0; a < active_.size(); ++a) {
    if (!both.place[a].has_normal) continue;
    double rate = rate_of(2 * a);
    for (std::size_t c = 0; c < both.x.size(); ++c) rate += both.D(2 * a, c) * both.x[c];
    if (rate < -part_of_speed(active_[a], no_speed)) return false;
  }
  take_note(both);
  jump_->other_law = true;
  work = act(both, qd);
  return true;
}

// Impulses that do no work but that of drivers. False: there are none.
bool ContactSwitch::bounce_without_gain(double t, const std::vector<std::size_t>& hit, std::span<double> qd) {
  const std::vector<double> before(qd.begin(), qd.end()), p_before(p_);
  const double energy = kinetic_energy(qd);
  const auto take_back = [&] {
    std::copy(before.begin(), before.end(), qd.begin());
    p_ = p_before;
  };
  // Beyond rounding of velocities that follow from linear equations.
  const auto gains = [&](double work) { return work > thresholds::solved * energy; };
  double work = 0;
  if (!bounce(1, qd, work)) return false;
  if (!gains(work)) return true;
  if (other_laws_.poisson + other_laws_.reduced == 0) {
    other_laws_.first = t;
    other_laws_.element = points_[hit.front()].element;
  }
  take_back();
  if (bounce_by_poisson(qd, work) && !gains(work)) {
    ++other_laws_.poisson;
    return true;
  }
  ++other_laws_.reduced;
  for (double part = 0.5;;) {
    take_back();
    if (!bounce(part, qd, work)) return false;
    jump_->other_law = true;
    if (!gains(work) || part == 0) return true;
    // What is left of a part that is rounding of one is far below any speed of rest.
    part = part > std::numeric_limits<double>::epsilon() ? part / 2 : 0;
  }
}

Report ContactSwitch::collide(double t, std::span<double> qd, std::vector<ContactState>& states) {
  std::vector<std::size_t> hit;
  std::copy_if(active_.begin(), active_.end(), std::back_inserter(hit), [&](std::size_t k) { return hits(k); });
  if (hit.empty()) return {};
  if (!jump_) jump_.emplace();
  find_responses();
  if (!bounce_without_gain(t, hit, qd)) return is_jammed(false) ? blocked(t, hit) : wedged(t);
  look(qd);
  if (std::any_of(hit.begin(), hit.end(), [&](std::size_t k) { return hits(k); })) return blocked(t, hit);
  const double end = end_rocking(t, hit, qd);
  for (const std::size_t k : hit) {
    events_.push_back({points_[k].element, "impact", t});
    const double rebound = gap_[k].rate;
    if (rebound > part_of_speed(k, no_speed)) {
      past_.bounced_at[k] = t;
      states[k].closed = false;
      continue;
    }
    // It stays. The bounces that were left out would have taken their time.
    past_.landing[k] = end;
    if (points_[k].restitution > 0 && points_[k].restitution < 1 &&
        past_.bounced_at[k] > -std::numeric_limits<double>::infinity()) {
      const double fall = std::max(t - past_.bounced_at[k], 0.0);
      past_.landing[k] = t + fall * points_[k].restitution / (1 - points_[k].restitution);
    }
  }
  note_flights(t, hit);
  return {};
}

}  // namespace catena
