// MotionAdjoint: what measures look at, on the way back.
#include <algorithm>
#include <limits>

#include "catena/analysis/motion/stage_sums.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Most rounds of Newton's method that bring the interpolant onto the constraints: it is as near to them as the
// tolerance of the motion.
constexpr int most_rounds_inside = 4;

}  // namespace

// Accelerations and multipliers there are functions of the state.
bool MotionAdjoint::add_pulses(std::span<const Look> looks, double t, Side side, std::span<const double> values,
                               const std::function<Vector&(std::size_t)>& target) {
  bool evaluated = false;
  for (const Look& look : looks) {
    const MotionPulse& pulse = *look.pulse;
    Vector& y = target(look.measure);
    ways_[look.measure].instant += pulse.by_instant;
    for (std::size_t c = 0; c < pulse.by_q.size(); ++c) y[c] += pulse.by_q[c];
    for (std::size_t c = 0; c < pulse.by_qd.size(); ++c) y[n_ + c] += pulse.by_qd[c];
    if (pulse.by_qdd.empty() && pulse.by_lambda.empty()) continue;
    if (!evaluated) {
      Stage& end = end_stage();
      std::copy(values.begin(), values.end(), end.y.begin());
      if (!RecomputedSteps::evaluate(end, t, side)) return lose(t, "constraints depend on each other");
    }
    evaluated = true;
    const std::span<const double> qdd = std::span<const double>(end_->slope).subspan(n_);
    end_->equations.solve_motion(pulse.by_qdd.empty() ? zero_loads_ : pulse.by_qdd,
                                 pulse.by_lambda.empty() ? zero_rows_ : pulse.by_lambda, w_, mu_);
    mechanism_.set_motion(end_->evaluator, values.subspan(n_), qdd, side);
    const AdjointWeights weights{.w = w_, .lambda = end_->lambda, .bend = mu_};
    mechanism_.add_by_state(end_->evaluator, weights, std::span(y).first(n_), std::span(y).subspan(n_));
    add_parameters(t, side, weights, qdd, ways_[look.measure]);
  }
  return true;
}

bool MotionAdjoint::add_inside(const Step& step, std::span<const Look> looks) {
  const double t = looks.front().pulse->t, h = step.to - step.from;
  const InterpolantWeights weights = interpolant_weights((t - step.from) / h);
  Vector there(2 * n_);
  for (std::size_t i = 0; i < there.size(); ++i) there[i] = step.begin[i] + weights.end * (step.end[i] - step.begin[i]);
  for (std::size_t s = 0; s < weights.slope.size(); ++s) {
    if (weights.slope[s] != 0) add_times(there, h * weights.slope[s], again_.stage(static_cast<int>(s)).slope);
  }
  if (!factorize_end(t, Side::after, there)) return false;
  end_->equations.project_position(std::span(there).first(n_), most_rounds_inside);
  end_->equations.project_velocity(std::span(there).subspan(n_), 1 / h);
  end_->t = std::numeric_limits<double>::quiet_NaN();  // it was moved away from its factors
  std::vector<Vector> back(ways_.size());
  const bool added = add_pulses(looks, t, Side::after, there, [&](std::size_t measure) -> Vector& {
    back[measure].resize(2 * n_, 0.0);
    return back[measure];
  });
  if (!added) return false;
  for (std::size_t m = 0; m < back.size(); ++m) {
    if (back[m].empty()) continue;
    Way& way = ways_[m];
    project_back(t, Side::after, there, way, back[m]);
    add_times(way.y1, weights.end, back[m]);
    add_times(way.y0, 1 - weights.end, back[m]);
    for (std::size_t s = 0; s < weights.slope.size(); ++s) add_times(way.slopes[s], h * weights.slope[s], back[m]);
    way.begun = true;
  }
  return true;
}

// The pulses of all measures in the order of their instants; nothing where one lies outside of the motion.
std::optional<std::vector<MotionAdjoint::Look>> MotionAdjoint::looks_at(
    const std::vector<std::vector<MotionPulse>>& measures) {
  std::vector<Look> looks;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    for (const MotionPulse& pulse : measures[m]) looks.push_back({&pulse, m});
  }
  std::stable_sort(looks.begin(), looks.end(), [](const Look& a, const Look& b) { return a.pulse->t < b.pulse->t; });
  if (looks.empty()) return looks;
  const double first = looks.front().pulse->t, last = looks.back().pulse->t;
  if (first >= steps_.front().from && last <= steps_.back().to) return looks;
  lose(first < steps_.front().from ? first : last, "there is no motion");
  return {};
}

// The pulses at the last instant of those left, taken away from them.
std::span<const MotionAdjoint::Look> MotionAdjoint::take_last(std::span<const Look>& looks) {
  const double t = looks.back().pulse->t;
  std::size_t first = looks.size() - 1;
  while (first > 0 && looks[first - 1].pulse->t == t) --first;
  const std::span<const Look> last = looks.subspan(first);
  looks = looks.first(first);
  return last;
}

}  // namespace catena
