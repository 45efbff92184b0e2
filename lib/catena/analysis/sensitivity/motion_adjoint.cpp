#include "catena/analysis/sensitivity/motion_adjoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/switches.hpp"

namespace catena {
MotionAdjoint::~MotionAdjoint() = default;

MotionAdjoint::MotionAdjoint(const Evaluator& of, const DesignModels& models, int parameters, GivenByModel start,
                             DerivativeAim aim)
    : StateDerivatives(of, models, parameters),
      n_(at(plan().coordinates())),
      given_start_(start),
      mechanism_(evaluator()),
      again_(evaluator()),
      aim_(std::move(aim)),
      bends_(!switches_of_loads(evaluator().model(), {}, true).empty()) {
  if (const std::string why = AdjointMechanism::why_not(evaluator().model()); !why.empty()) {
    fail("the adjoint of the motion is not built where " + why);
    return;
  }
  if (!again_.why_not().empty()) {
    fail("the adjoint of the motion is not built where " + again_.why_not());
    return;
  }
  back_.assign(dormand_prince_8().c.size(), Vector(2 * n_));
  for (Group& group : groups())
    reached_.push_back(std::make_unique<AdjointMechanism::Reached>(mechanism_, group.mechanism));
  w_.assign(n_, 0.0);
  mu_.assign(at(plan().rows), 0.0);
  zero_rows_ = mu_;
  zero_loads_ = w_;
  slope_.assign(2 * n_, 0.0);
  masses_.assign(n_, 0.0);
  for (int c = 0; c < 3 * plan().moving; ++c) {
    if (plan().column[at(c)] >= 0) masses_[at(c)] = groups().front().mechanism.mass(c).v;
  }
}

int MotionAdjoint::reached_elements() const {
  int sum = 0;
  for (const auto& reached : reached_) sum += reached->elements();
  return sum;
}

bool MotionAdjoint::lose(double t, std::string_view what) {
  return fail(fmt::format("at t = {:.9g} s {}, which the adjoint of the motion does not pass", t, what));
}

bool MotionAdjoint::find(const Snapshot&) { return false; }

bool MotionAdjoint::crosses_at(double t) const {
  return std::any_of(crossings_.begin(), crossings_.end(),
                     [&](const auto& crossing) { return steps_[crossing.first - 1].to == t; });
}

std::optional<double> MotionAdjoint::covered_to() const {
  if (steps_.empty()) return {};
  return steps_.back().to;
}

void MotionAdjoint::go_on_otherwise(MotionCrossing crossing) {
  crossings_.insert_or_assign(steps_.size(), std::move(crossing));
}

MotionAdjoint::EventSlopes MotionAdjoint::slopes_of_event(int, const Snapshot&) {
  return {{}, std::vector<double>(at(parameters()), 0.0)};
}

void MotionAdjoint::cover(const MotionStretch& stretch) {
  if (!why().empty()) return;
  double looked_at = 0;
  std::optional<Step> step = RecomputedSteps::step_of(stretch, goes_on_ ? &steps_.back().end : nullptr, looked_at);
  if (!step) {
    lose(looked_at, "the motion could not be looked at");
    return;
  }
  if (steps_.empty() && instant_at(stretch.from).moves()) {
    lose(stretch.from, "the motion begins at a jump of a function of time that moves");
    return;
  }
  if (!steps_.empty() && !crossings_.contains(steps_.size())) {
    const Vector& before = steps_.back().end;
    for (std::size_t c = n_; c < 2 * n_; ++c) {
      // Velocities before and after an instant that differ by less are one.
      if (std::abs(step->begin[c] - before[c]) <= thresholds::same_value * std::max(1.0, std::abs(before[c]))) continue;
      lose(stretch.from, "velocities jump");
      return;
    }
  }
  const MovingInstant& instant = instant_at(stretch.to);
  if (std::any_of(instant.rate.begin(), instant.rate.end(), [](double rate) { return std::isnan(rate); })) {
    lose(stretch.to, "functions of time jump together that move apart with the parameters");
    return;
  }
  goes_on_ = instant.order == 0 && stretch.ended_by < 0;
  steps_.push_back(*std::move(step));
  if (instant.order == 1 || instant.moves())
    go_on_otherwise({.jumps = instant.order == 1, .strikes = {}, .rate = instant.rate});
}

}  // namespace catena
