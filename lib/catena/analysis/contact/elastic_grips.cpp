#include "catena/analysis/contact/elastic_grips.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/contact/problem/contact_problem.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of tensions: that of angles of contact, as bodies are on their constraints.
constexpr double tension_rounding = 1e-10;

}  // namespace

ElasticGrips::ElasticGrips(const std::vector<ContactPoint>& points, std::shared_ptr<const RopePlaces> rope)
    : points_(points), rope_(std::move(rope)) {
  const std::size_t parts = rope_->grips.size() + 1;
  motion_.resize(parts);
  for (std::vector<Rate>* rates : {&u_, &S_, &T_, &exponent_, &ratio_}) rates->resize(parts);
}

bool ElasticGrips::divides(std::size_t part, const std::vector<ContactState>& states) const {
  if (part == 0) return true;
  const std::size_t place = rope_->grips[part - 1];
  return points_[place].has_friction() && states[place].direction == 0;
}

// The tensions of the parts from a grip that sticks, or the end i, to the next such one.
void ElasticGrips::share(std::size_t first, std::size_t end, const std::vector<ContactState>& states) {
  const std::vector<double>& y = rope_->yields;
  const Rate behind = end < T_.size() ? S_[end] : Rate{};
  ratio_[first] = {1, 0};
  Rate yields{y[first], 0};
  for (std::size_t n = first + 1; n < end; ++n) {
    const int sigma = states[rope_->grips[n - 1]].direction;
    const double by = std::exp(-sigma * exponent_[n].f);
    ratio_[n] = {ratio_[n - 1].f * by, by * (ratio_[n - 1].d - sigma * exponent_[n].d * ratio_[n - 1].f)};
    yields.f += y[n] * ratio_[n].f;
    yields.d += y[n] * ratio_[n].d;
  }
  const Rate stretch{S_[first].f - behind.f, S_[first].d - behind.d};
  // While it is taut also below zero, where a step reaches beyond the instant at which it slackens: no kink is in it.
  Rate pull;
  if (states[rope_->grips.front()].closed) {
    pull.f = stretch.f / yields.f;
    pull.d = (stretch.d - pull.f * yields.d) / yields.f;
  }
  Rate sum = behind;
  for (std::size_t n = end; n-- > first;) {
    T_[n] = {pull.f * ratio_[n].f, pull.d * ratio_[n].f + pull.f * ratio_[n].d};
    sum.f += y[n] * T_[n].f;
    sum.d += y[n] * T_[n].d;
    if (n > first) S_[n] = sum;
  }
}

void ElasticGrips::look(const Evaluator& evaluator, std::span<const double> qd,
                        const std::vector<ContactState>& states) {
  const std::size_t parts = T_.size();
  for (std::size_t n = 0; n < parts; ++n) {
    const ContactPoint* grip = n > 0 ? &points_[rope_->grips[n - 1]] : nullptr;
    exponent_[n] = {};
    if (grip && !grip->has_friction()) {
      u_[n] = S_[n] = {};
      motion_[n] = {};
      continue;
    }
    const int element = grip ? grip->slide : rope_->whole;
    motion_[n] = element >= 0 ? evaluator.scalar_motion(element, qd) : Evaluator::ScalarMotion{};
    u_[n] = {motion_[n].value, motion_[n].rate};
    S_[n] = {(grip ? states[rope_->grips[n - 1]].held : 0) - u_[n].f, -u_[n].d};
    if (!grip) continue;
    const Taylor<double> exponent = grip->lines->exponent(evaluator, qd);
    exponent_[n] = {exponent.f, exponent.d};
  }
  for (std::size_t end = parts, n = parts; n-- > 0;) {
    if (!divides(n, states)) continue;
    share(n, end, states);
    end = n;
  }
}

// More by what rounding of lengths makes of tensions: a grip that has come to rest begins at its limit.
double ElasticGrips::margin(std::size_t grip) const {
  const double most = std::exp(exponent_[grip + 1].f), before = T_[grip].f, behind = T_[grip + 1].f;
  const double doubt =
      thresholds::sum_rounding * rope_->length * (1 / rope_->yields[grip] + 1 / rope_->yields[grip + 1]);
  return std::min(before * most - behind, behind * most - before) + tension_rounding * (before + behind) + doubt;
}

// Whether a grip that sticks cannot: at zero tension, by how these begin.
bool ElasticGrips::slips(std::size_t grip) const {
  const double most = std::exp(exponent_[grip + 1].f);
  const Rate before = T_[grip], behind = T_[grip + 1];
  if (before.f > 0 || behind.f > 0) return margin(grip) < 0;
  const double sum = std::abs(before.d) + std::abs(behind.d);
  return std::min(before.d * most - behind.d, behind.d * most - before.d) < -thresholds::solved * sum;
}

void ElasticGrips::settle(const Evaluator& evaluator, std::span<const double> qd, std::vector<ContactState>& states) {
  // Least index first, which ends where there is one answer.
  const std::size_t grips = rope_->grips.size();
  for (std::size_t pass = 0; pass < 8 * grips + 8; ++pass) {
    look(evaluator, qd, states);
    bool changed = false;
    for (std::size_t k = 0; k < grips && !changed; ++k) {
      ContactState& state = states[rope_->grips[k]];
      if (!points_[rope_->grips[k]].has_friction()) continue;
      if (state.direction == 0 && slips(k)) {
        const bool forward = T_[k + 1].f != T_[k].f ? T_[k + 1].f > T_[k].f : T_[k + 1].d > T_[k].d;
        state.direction = forward ? -1 : 1;
        changed = true;
      } else if (state.direction * slip(k) < -thresholds::solved * (std::abs(u_[k + 1].d) + std::abs(S_[k + 1].d))) {
        state.direction = 0;
        state.held = held(k);
        changed = true;
      }
    }
    if (!changed) return;
  }
}

double ElasticGrips::energy_at(const Evaluator& evaluator, const std::vector<ContactState>& states) const {
  ElasticGrips there(*this);
  there.look(evaluator, {}, states);
  double sum = 0;
  for (std::size_t n = 0; n < T_.size(); ++n) sum += rope_->yields[n] * there.T_[n].f * there.T_[n].f / 2;
  const double whole = std::max(there.stretch(), 0.0);
  return sum - rope_->k * whole * whole / 2;
}

double ElasticGrips::dissipation(const std::vector<ContactState>& states) const {
  double lost = 0;
  for (std::size_t k = 0; k + 1 < T_.size(); ++k) {
    if (states[rope_->grips[k]].direction != 0) lost -= friction(k) * slip(k);
  }
  return lost;
}

void ElasticGrips::add(std::span<double> loads) const {
  scatter_gradient(motion_[0], T_[0].f - rope_->k * std::max(stretch(), 0.0), loads);
  for (std::size_t k = 0; k + 1 < T_.size(); ++k) {
    if (motion_[k + 1].body_i >= 0) scatter_gradient(motion_[k + 1], friction(k), loads);
  }
}

}  // namespace catena
