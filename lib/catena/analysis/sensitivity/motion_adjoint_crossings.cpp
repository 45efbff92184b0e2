// MotionAdjoint: back across instants at which the motion goes on in another way.
#include <algorithm>
#include <limits>
#include <numeric>

#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

double product(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

// qd+ and mu by the factors at the place, which no jump changes.
bool MotionAdjoint::find_jump(const MotionCrossing& crossing, Passage& passage) {
  Stage& end = *end_;
  const std::span<const double> q = std::span<const double>(passage.before).first(n_);
  if (!end.equations.factorize(passage.t, Side::after, q)) return lose(passage.t, "constraints depend on each other");
  Vector momentum(n_), nu(mu_.size());
  for (std::size_t c = 0; c < n_; ++c) momentum[c] = masses_[c] * passage.before[n_ + c];
  if (!crossing.strikes.empty()) {
    const DesignStrike& strike = crossing.strikes.front();
    const int body = plan().plan_body[at(strike.body)];
    if (body < plan().moving) {
      const Vec2<double> impulse{strike.impulse.x.v, strike.impulse.y.v};
      const Vec2<double> arm = end.evaluator.frames()[at(body)].axis(Vec2<double>{strike.point.x.v, strike.point.y.v});
      momentum[at(3 * body)] += impulse.x;
      momentum[at(3 * body + 1)] += impulse.y;
      momentum[at(3 * body + 2)] += cross(arm, impulse);
    }
  }
  end.evaluator.nu(nu);
  end.equations.solve_motion(momentum, nu, w_, passage.impulse);
  for (const int c : plan().coordinate) {
    passage.after[n_ + at(c)] = w_[at(c)];
    passage.change[at(c)] = w_[at(c)] - passage.before[n_ + at(c)];
  }
  end.evaluator.gamma(zero_loads_, passage.by_time);
  return true;
}

bool MotionAdjoint::find_passage(const MotionCrossing& crossing, Passage& passage) {
  Stage& end = end_stage();
  end.y = passage.before;
  if (!RecomputedSteps::evaluate(end, passage.t, Side::before))
    return lose(passage.t, "constraints depend on each other");
  passage.slope_before = end.slope;
  passage.lambda_before = end.lambda;
  passage.after = passage.before;
  passage.impulse = passage.by_time = zero_rows_;
  passage.change = zero_loads_;
  if (crossing.jumps && !find_jump(crossing, passage)) return false;
  end.y = passage.after;
  if (!RecomputedSteps::evaluate(end, passage.t, Side::after))
    return lose(passage.t, "constraints depend on each other");
  passage.slope_after = end.slope;
  return true;
}

// By w: the blow is (J, (A s) x J), its moment changes with the angle by -(A s) . J.
void MotionAdjoint::strike_back(const std::vector<DesignStrike>& strikes, Way& way) {
  std::size_t first = 0;
  for (std::size_t g = 0; g < strikes.size(); ++g) {
    const DesignStrike& strike = strikes[g];
    const int body = plan().plan_body[at(strike.body)];
    if (body >= plan().moving) return;
    const Frame<double>& frame = end_->evaluator.frames()[at(body)];
    const std::size_t c = at(3 * body);
    const double turn = plan().column[c + 2] >= 0 ? w_[c + 2] : 0;
    const Vec2<double> impulse{strike.impulse.x.v, strike.impulse.y.v};
    const Vec2<double> arm = frame.axis(Vec2<double>{strike.point.x.v, strike.point.y.v});
    if (g == 0) way.y1[c + 2] -= turn * dot(arm, impulse);
    const double along[] = {w_[c], w_[c + 1], turn};
    const DesignScalar work = work_of_blow(strike, frame, along);
    for (std::size_t p = 0; p < at(groups()[g].count); ++p) way.gradient[first + p] += work.d[p];
    first += at(groups()[g].count);
  }
}

double MotionAdjoint::jump_back(const MotionCrossing& crossing, const Passage& passage, Way& way) {
  const std::span<double> q = std::span(way.y1).first(n_), qd = std::span(way.y1).subspan(n_);
  end_->equations.solve_motion(qd, zero_rows_, w_, mu_);
  mechanism_.set_motion(end_->evaluator, std::span<const double>(passage.after).subspan(n_), passage.change);
  const AdjointWeights weights{.w = w_, .lambda = passage.impulse, .rate = mu_, .forces = false};
  for (std::size_t c = 0; c < n_; ++c) qd[c] = masses_[c] > 0 ? masses_[c] * w_[c] : 0;
  mechanism_.add_by_state(end_->evaluator, weights, q, qd);
  add_parameters(passage.t, Side::after, weights, passage.change, way);
  strike_back(crossing.strikes, way);
  return product(mu_, passage.by_time);
}

// An event acts where its column reaches its value.
bool MotionAdjoint::event_back(const MotionCrossing& crossing, const Passage& passage) {
  const std::span<const double> before(passage.before), slope(passage.slope_before);
  const EventSlopes slopes = slopes_of_event(crossing.event, {.evaluator = end_->evaluator,
                                                              .t = passage.t,
                                                              .q = before.first(n_),
                                                              .qd = before.subspan(n_),
                                                              .qdd = slope.subspan(n_),
                                                              .lambda = passage.lambda_before});
  std::vector<MotionPulse> pulses(ways_.size());
  std::vector<Look> looks;
  for (std::size_t m = 0; m < ways_.size(); ++m) {
    const double weight = -ways_[m].instant / crossing.by_time;
    if (!ways_[m].begun || weight == 0) continue;
    const auto weighted = [&](std::vector<double> values) {
      for (double& value : values) value *= weight;
      return values;
    };
    const MotionPulse& by = slopes.by_state;
    pulses[m] = {passage.t, weighted(by.by_q), weighted(by.by_qd), weighted(by.by_qdd), weighted(by.by_lambda)};
    looks.push_back({&pulses[m], m});
    for (std::size_t p = 0; p < slopes.by_parameter.size(); ++p)
      ways_[m].gradient[p] += weight * slopes.by_parameter[p];
  }
  return add_pulses(looks, passage.t, Side::before, before, [this](std::size_t m) -> Vector& { return end_of(m); });
}

bool MotionAdjoint::cross_back(const MotionCrossing& crossing, const Step& last) {
  checks_.ask();
  Passage passage{.t = last.to, .before = last.end};
  if (!find_passage(crossing, passage)) return false;
  for (Way& way : ways_) {
    if (!way.begun) continue;
    way.instant -= product(way.y1, passage.slope_after);
    if (crossing.jumps) way.instant += jump_back(crossing, passage, way);
    way.instant += product(way.y1, passage.slope_before);
    for (std::size_t p = 0; p < crossing.rate.size(); ++p) way.gradient[p] += way.instant * crossing.rate[p];
  }
  const bool crossed = crossing.event < 0 || event_back(crossing, passage);
  end_->t = std::numeric_limits<double>::quiet_NaN();  // whose state is that of neither step
  for (Way& way : ways_) way.instant = 0;
  return crossed;
}

}  // namespace catena
