#include "catena/analysis/sensitivity/moving_instants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/breakpoints.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// Differences for f''' take this part of the piece after the instant: their error is its fourth power.
constexpr double part_of_piece = 1e-3;
// Differences for rates that have not settled to this part tell nothing, as in a stretch that is no longer than
// rounding.
constexpr double unsettled_rate = 1e-5;

/// Largest values of f, f', f'' and of their derivatives by the parameters around an instant.
struct Sizes {
  std::array<double, 3> value{};
  std::array<std::array<double, parameters_at_once>, 3> derivative{};

  void take(const Taylor<DesignScalar>& f) {
    const DesignScalar* levels[] = {&f.f, &f.d, &f.dd};
    for (std::size_t k = 0; k < 3; ++k) {
      value[k] = std::max(value[k], std::abs(levels[k]->v));
      for (std::size_t p = 0; p < parameters_at_once; ++p)
        derivative[k][p] = std::max(derivative[k][p], std::abs(levels[k]->d[p]));
    }
  }
};

/// f''' of the piece on one side of t, by differences of order 4 of its f''.
double third_derivative(const TimeFunction<DesignScalar>& function, double t, Side side) {
  const double next = function.next_breakpoint(t);
  const double h = part_of_piece * std::min(next - t, std::max(std::abs(t), 1.0));
  const auto bend = [&](double there) { return function.continue_from(t, side, there).dd.v; };
  return (bend(t - 2 * h) - 8 * bend(t - h) + 8 * bend(t + h) - bend(t + 2 * h)) / (12 * h);
}

/// Where f'' is continuous, but bends.
FunctionJump kink_of(const TimeFunction<DesignScalar>& function, double t, const DesignScalar& change,
                     const std::array<double, parameters_at_once>& size, FunctionJump jump) {
  const auto moves = [&](std::size_t p) { return std::abs(change.d[p]) > no_jump_part * size[p]; };
  bool any = false;
  for (std::size_t p = 0; p < parameters_at_once; ++p) any = any || moves(p);
  if (!any) return jump;
  const double before = third_derivative(function, t, Side::before), after = third_derivative(function, t, Side::after);
  if (!(std::abs(before - after) > thresholds::same_value * std::max(std::abs(before), std::abs(after)))) return jump;
  jump.order = 3;
  for (std::size_t p = 0; p < parameters_at_once; ++p) {
    if (moves(p)) jump.rate[p] = -change.d[p] / (before - after);
  }
  return jump;
}

}  // namespace

FunctionJump jump_of(const TimeFunction<DesignScalar>& function, double t) {
  FunctionJump jump;
  const TimeRange domain = function.domain();
  if (function.is_constant() || !is_breakpoint(function, t) || !domain.contains(t)) return jump;
  // By the pieces themselves: at the inner knots of a table evaluate() takes one side for both.
  const Taylor<DesignScalar> before = function.continue_from(t, Side::before, t);
  const Taylor<DesignScalar> after = function.continue_from(t, Side::after, t);
  Sizes sizes;
  sizes.take(before);
  sizes.take(after);
  double distance = std::max(std::abs(t), 1.0);
  for (int k = 0; k < jump_looks; ++k, distance /= 2) {
    for (const double there : {t - distance, t + distance}) {
      if (domain.contains(there)) sizes.take(function.evaluate(there));
    }
  }
  const DesignScalar change[] = {before.f - after.f, before.d - after.d, before.dd - after.dd};
  const auto jumps = [&](std::size_t k) { return std::abs(change[k].v) > no_jump_part * sizes.value[k]; };
  jump.order = jumps(1) ? 1 : jumps(2) ? 2 : 0;
  const auto moves = [&](std::size_t k, std::size_t p) {
    return std::abs(change[k].d[p]) > no_jump_part * sizes.derivative[k][p];
  };
  if (jump.order == 0) {
    for (std::size_t p = 0; p < parameters_at_once; ++p) {
      // Jumps that move apart and cancel out at this instant.
      if (moves(0, p) || moves(1, p)) jump.rate[p] = std::numeric_limits<double>::quiet_NaN();
    }
    return kink_of(function, t, change[2], sizes.derivative[2], jump);
  }
  for (std::size_t p = 0; p < parameters_at_once; ++p) {
    const auto k = static_cast<std::size_t>(jump.order);
    if (moves(k - 1, p)) jump.rate[p] = -change[k - 1].d[p] / change[k].v;
    if (jump.order == 2 && moves(0, p)) jump.rate[p] = std::numeric_limits<double>::quiet_NaN();
  }
  return jump;
}

std::optional<double> rate_at_end(const MotionStretch& stretch, const std::function<std::optional<double>(double)>& f) {
  constexpr double weights[] = {25, -48, 36, -16, 3};
  const std::optional<double> end = f(stretch.to);
  if (!end) return {};
  double best = std::numeric_limits<double>::quiet_NaN(), last = best, change = std::numeric_limits<double>::infinity();
  for (int n = 0; n < thresholds::most_differences; ++n) {
    const double d = std::ldexp(thresholds::first_difference * (stretch.to - stretch.from), -n);
    double sum = weights[0] * *end;
    for (int k = 1; k < 5; ++k) {
      const std::optional<double> value = f(stretch.to - k * d);
      if (!value) return {};
      sum += weights[k] * *value;
    }
    const double now = sum / (12 * d);
    if (!(std::abs(now - last) >= change)) {
      if (n > 0) change = std::abs(now - last);
      best = now;
    }
    last = now;
    if (change <= thresholds::settled_difference * std::abs(best)) break;
  }
  if (!(change <= unsettled_rate * std::abs(best))) return {};
  return best;
}

std::optional<double> rate_at_end(const MotionStretch& stretch, const ColumnSet& column) {
  return rate_at_end(stretch, [&](double t) -> std::optional<double> {
    const std::optional<Snapshot> there = stretch.at(t);
    if (!there) return {};
    double value = 0;
    column.evaluate(*there, {&value, 1});
    return value;
  });
}

void MovingInstant::add(const FunctionJump& jump, std::size_t first) {
  const bool alone = order == 0;
  for (std::size_t p = 0; p < parameters_at_once && first + p < rate.size(); ++p) {
    double& known = rate[first + p];
    const double other = jump.rate[p];
    if (jump.order == 0) {
      if (std::isnan(other)) known = other;
      continue;
    }
    const bool apart = std::abs(other - known) > thresholds::same_rate * std::max(std::abs(other), std::abs(known));
    if (!alone && apart)
      known = std::numeric_limits<double>::quiet_NaN();
    else if (alone && !std::isnan(known))
      known = other;
  }
  if (jump.order > 0) order = alone ? jump.order : std::min(order, jump.order);
}

}  // namespace catena
