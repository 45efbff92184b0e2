// The kinds of TimeFunction. Private to time_function.cpp; each kind evaluates itself, knows where it is defined and
// where its next breakpoint lies.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "catena/base/time_function.hpp"

namespace catena::time_function_kinds {

inline constexpr double never = std::numeric_limits<double>::infinity();

inline bool same_instant(double a, double b) { return std::abs(a - b) <= 1e-13 * std::max(std::abs(a), std::abs(b)); }

/// Whether t lies on the later side of `instant`.
inline bool is_after(double t, double instant, Side side) {
  return same_instant(t, instant) ? side == Side::after : t > instant;
}

template <class S>
struct Polynomial {
  std::vector<S> coefficients;

  Taylor<S> evaluate(double t, Side) const {
    const Taylor<S> time(S(t), S(1.0), S(0.0));
    Taylor<S> sum(coefficients.back());
    for (std::size_t k = coefficients.size() - 1; k-- > 0;) sum = sum * time + Taylor<S>(coefficients[k]);
    return sum;
  }
  Taylor<S> continue_from(double, Side side, double t) const { return evaluate(t, side); }
  TimeRange domain() const { return {}; }
  double next_breakpoint(double) const { return never; }
};

template <class S>
struct Harmonic {
  S amplitude, omega, phase, offset;

  Taylor<S> evaluate(double t, Side) const {
    const Taylor<S> angle(omega * S(t) + phase, omega, S(0.0));
    return Taylor<S>(offset) + Taylor<S>(amplitude) * sin(angle);
  }
  Taylor<S> continue_from(double, Side side, double t) const { return evaluate(t, side); }
  TimeRange domain() const { return {}; }
  double next_breakpoint(double) const { return never; }
};

template <class S>
struct Law {
  S t0, t1, from, to;
  MotionLawPieces pieces;

  Taylor<S> evaluate(double t, Side side) const { return continue_from(t, side, t); }
  Taylor<S> continue_from(double place, Side side, double t) const {
    if (!is_after(place, value_of(t0), side)) return Taylor<S>(from);
    if (is_after(place, value_of(t1), side)) return Taylor<S>(to);
    const S width = t1 - t0;
    std::size_t k = 0;
    while (k + 1 < pieces.count && is_after(place, end(k), side)) ++k;
    const Taylor<S> u((S(t) - t0) / width, S(1.0) / width, S(0.0));
    return Taylor<S>(from) + Taylor<S>(to - from) * pieces.piece[k].rise(u);
  }
  /// The instant at which piece k ends and the next one begins.
  double end(std::size_t k) const { return value_of(t0) + pieces.piece[k + 1].start * value_of(t1 - t0); }
  TimeRange domain() const { return {}; }
  double next_breakpoint(double t) const {
    if (t < value_of(t0)) return value_of(t0);
    for (std::size_t k = 0; k + 1 < pieces.count; ++k) {
      if (t < end(k) && !same_instant(t, end(k))) return end(k);
    }
    return t < value_of(t1) ? value_of(t1) : never;
  }
};

template <class S>
struct Table {
  Spline<S> curve;

  bool ends() const { return !curve.periodic() && curve.beyond() == Beyond::error; }

  Taylor<S> evaluate(double t, Side side) const {
    if (!std::isfinite(t)) throw OutsideTable(t, curve.first(), curve.last());
    if (ends()) {
      t = inside(t);
    } else if (!curve.periodic() && (same_instant(t, curve.first()) || same_instant(t, curve.last()))) {
      // The continuation beyond the end need not be as smooth as the spline is at its inner knots.
      return continue_from(t, side, t);
    }
    const SplineValue<S> value = curve.evaluate(S(t));
    return {value.f, value.d1, value.d2};
  }
  Taylor<S> continue_from(double place, Side side, double t) const {
    if (ends()) {
      place = inside(place);
      if (same_instant(place, curve.first())) side = Side::after;
      if (same_instant(place, curve.last())) side = Side::before;
    }
    const SplineValue<S> value = curve.continue_from(place, side == Side::after, S(t));
    return {value.f, value.d1, value.d2};
  }
  /// Times are multiples of a step and carry its rounding: just outside the table counts as its end.
  double inside(double t) const {
    const double nearest = std::clamp(t, curve.first(), curve.last());
    const double slack = 1e-12 * std::max(std::abs(curve.first()), std::abs(curve.last()));
    if (!(std::abs(t - nearest) <= slack)) throw OutsideTable(t, curve.first(), curve.last());
    return nearest;
  }
  TimeRange domain() const { return ends() ? TimeRange{curve.first(), curve.last()} : TimeRange{}; }
  double next_breakpoint(double t) const {
    const std::span<const double> knots = curve.knots();
    if (!curve.periodic()) {
      const auto next = std::upper_bound(knots.begin(), knots.end(), t);
      return next == knots.end() ? never : *next;
    }
    const double period = curve.last() - curve.first();
    // At times so large that a period is lost in rounding, and at times that are not finite, there are no breakpoints.
    if (!std::isfinite(t) || same_instant(t, t + period)) return never;
    double cycles = std::floor((t - curve.first()) / period);
    auto next = std::upper_bound(knots.begin(), knots.end(), t - cycles * period);
    // Rounding may name a knot that is not later than t: take the next one, in the next period if need be.
    for (;; ++next) {
      if (next == knots.end()) {
        next = knots.begin();
        cycles += 1;
      }
      const double instant = *next + cycles * period;
      if (instant > t && !same_instant(instant, t)) return instant;
    }
  }
};

template <class S>
struct Combination {
  std::vector<TimeFunction<S>> parts;
  bool is_product;

  Taylor<S> evaluate(double t, Side side) const {
    return combine([&](const TimeFunction<S>& part) { return part.evaluate(t, side); });
  }
  Taylor<S> continue_from(double place, Side side, double t) const {
    return combine([&](const TimeFunction<S>& part) { return part.continue_from(place, side, t); });
  }
  template <class F>
  Taylor<S> combine(const F& value) const {
    Taylor<S> result = value(parts.front());
    for (std::size_t k = 1; k < parts.size(); ++k) {
      const Taylor<S> part = value(parts[k]);
      result = is_product ? result * part : result + part;
    }
    return result;
  }
  TimeRange domain() const {
    TimeRange common;
    for (const TimeFunction<S>& part : parts) {
      const TimeRange range = part.domain();
      common = {std::max(common.first, range.first), std::min(common.last, range.last)};
    }
    return common;
  }
  double next_breakpoint(double t) const {
    double first = never;
    for (const TimeFunction<S>& part : parts) first = std::min(first, part.next_breakpoint(t));
    return first;
  }
};

template <class S>
struct Custom {
  typename TimeFunction<S>::Callback function;
  std::vector<double> breaks;
  TimeRange range;

  Taylor<S> evaluate(double t, Side side) const {
    if (!range.contains(t)) throw OutsideTable(t, range.first, range.last);
    // A callback has one value at an instant: the value before a breakpoint is taken one rounding earlier.
    const bool before = side == Side::before && t > range.first && std::binary_search(breaks.begin(), breaks.end(), t);
    const Taylor<double> value = function(before ? std::nextafter(t, -never) : t);
    return {S(value.f), S(value.d), S(value.dd)};
  }
  Taylor<S> continue_from(double place, Side side, double t) const {
    const Taylor<S> there = evaluate(place, side);
    const S h(t - place);
    return {there.f + h * (there.d + S(0.5) * h * there.dd), there.d + h * there.dd, there.dd};
  }
  TimeRange domain() const { return range; }
  double next_breakpoint(double t) const {
    const auto next = std::upper_bound(breaks.begin(), breaks.end(), t);
    return next == breaks.end() ? never : *next;
  }
};

}  // namespace catena::time_function_kinds
