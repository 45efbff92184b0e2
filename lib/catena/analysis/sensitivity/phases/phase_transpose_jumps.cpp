// PhaseTranspose: jumps of velocities.
#include <algorithm>
#include <numeric>

#include "catena/analysis/sensitivity/phases/phase_transpose.hpp"
#include "catena/base/at.hpp"

namespace catena {

PhaseTranspose::Vector PhaseTranspose::rebound_rows(const Jump& jump) const {
  Vector rows(zero_rows_);
  for (const ImpactPlace& place : jump.jump->places) {
    if (place.rebounds && place.presses) rows[at(equations_.gap_row(place.place))] = places_[place.place].restitution.v;
  }
  return rows;
}

bool PhaseTranspose::jump(Jump& jump) {
  const Point& before = jump.before;
  if (!factorize(before)) return false;
  const Vector rebounds = rebound_rows(jump);
  DesignVector target(zero_rows_.size()), qd(before.qd.size());
  if (std::any_of(rebounds.begin(), rebounds.end(), [](double e) { return e != 0; })) {
    const Vector rates = rates_of_rows(before.qd);
    for (std::size_t r = 0; r < target.size(); ++r) target[r] = DesignScalar(-rebounds[r] * rates[r]);
  }
  for (std::size_t c = 0; c < qd.size(); ++c) qd[c] = DesignScalar(before.qd[c]);
  const DesignStrike* strike = jump.strikes ? &jump.strikes->front() : nullptr;
  if (!equations_.jump({plain_, places_, 0}, *jump.jump, strike, target, {}, q_, qd)) return false;
  Point& after = jump.after = before;
  after.qdd = zero_loads_;
  for (const int c : plan().coordinate) {
    after.qd[at(c)] = qd[at(c)].v;
    after.qdd[at(c)] = qd[at(c)].v - before.qd[at(c)];
  }
  after.lambda.resize(zero_rows_.size());
  for (std::size_t r = 0; r < after.lambda.size(); ++r) after.lambda[r] = equations_.impulse()[r].v;
  return find_terms(jump);
}

bool PhaseTranspose::find_terms(const Jump& jump) {
  terms_.clear();
  take_multipliers(jump.after);
  for (const ImpactPlace& place : jump.jump->places) {
    if (place.direction == 0) continue;
    terms_.push_back(Term{equations_.slide_row(place.place), place.place, true, place.direction});
  }
  return std::all_of(terms_.begin(), terms_.end(), [this](Term& term) { return complete(term); });
}

bool PhaseTranspose::jump_back(const Jump& jump, std::span<double> by_q, std::span<double> by_qd, double& instant) {
  if (!factorize(jump.before) || !find_terms(jump) || !weigh(by_qd, {})) return false;
  for (std::size_t c = 0; c < by_qd.size(); ++c) by_qd[c] = masses_[c] * w_[c];
  Evaluator& evaluator = equations_.evaluator();
  Vector by_time(zero_rows_), rebound = rebound_rows(jump);
  evaluator.gamma(zero_loads_, by_time);
  instant += std::inner_product(mu_.begin(), mu_.end(), by_time.begin(), 0.0);
  adjoint_.set_motion(evaluator, jump.after.qd, jump.after.qdd);
  adjoint_.add_by_state(evaluator, {.w = w_, .lambda = jump.after.lambda, .rate = mu_, .forces = false}, by_q, by_qd);
  if (jump.strikes) {
    const DesignStrike& strike = jump.strikes->front();
    const int body = plan().plan_body[at(strike.body)];
    if (body < plan().moving) {
      const std::size_t turn = at(3 * body + 2);
      const Vec2<double> arm = evaluator.frames()[at(body)].axis(Vec2<double>{strike.point.x.v, strike.point.y.v});
      by_q[turn] -= w_[turn] * dot(arm, Vec2<double>{strike.impulse.x.v, strike.impulse.y.v});
    }
  }
  if (std::all_of(rebound.begin(), rebound.end(), [](double e) { return e == 0; })) return true;
  for (std::size_t r = 0; r < rebound.size(); ++r) rebound[r] *= -mu_[r];
  add_rows(rebound, by_qd);
  for (double& weight : rebound) weight = -weight;
  adjoint_.set_motion(evaluator, jump.before.qd, {});
  adjoint_.add_by_state(evaluator, {.rate = rebound}, by_q, by_qd);
  return true;
}

PhaseTranspose::ByParameter PhaseTranspose::jump_by_parameters(const Jump& jump, const PhaseGroup& group,
                                                               std::size_t number) {
  Evaluator& evaluator = equations_.evaluator();
  if (group.reached.asks_mechanism()) group.mechanism.set_time(jump.before.t, Side::after);
  adjoint_.set_motion(evaluator, jump.after.qd, jump.after.qdd);
  const AdjointWeights weights{.w = w_, .lambda = jump.after.lambda, .rate = mu_, .forces = false};
  ByParameter sum = adjoint_.by_parameters(group.mechanism, group.reached, weights, jump.after.qdd);
  const auto add = [&](double weight, const DesignScalar& value) {
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += weight * value.d[p];
  };
  take_multipliers(jump.after);
  for (const Term& term : terms_) add(term.nu, known(term, group.places[term.place], term.motion));
  if (jump.strikes) {
    const DesignStrike& strike = (*jump.strikes)[number];
    const int body = plan().plan_body[at(strike.body)];
    if (body < plan().moving) add(1, work_of_blow(strike, evaluator.frames()[at(body)], w_.data() + 3 * body));
  }
  Vector rebound = rebound_rows(jump);
  if (std::all_of(rebound.begin(), rebound.end(), [](double e) { return e == 0; })) return sum;
  const Vector rates = rates_of_rows(jump.before.qd);
  for (const ImpactPlace& place : jump.jump->places) {
    if (!place.rebounds || !place.presses) continue;
    const std::size_t row = at(equations_.gap_row(place.place));
    add(-mu_[row] * rates[row], group.places[place.place].restitution);
  }
  for (std::size_t r = 0; r < rebound.size(); ++r) rebound[r] *= mu_[r];
  adjoint_.set_motion(evaluator, jump.before.qd, {});
  const ByParameter more = adjoint_.by_parameters(group.mechanism, group.reached, {.rate = rebound}, {});
  for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += more[p];
  return sum;
}

}  // namespace catena
