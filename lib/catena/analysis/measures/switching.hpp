// Where a column that switches (columns/switches.hpp) changes its sign within a part of a motion.
//
//   s(t*) = 0        s: smooth in the part, so that its samples show where it comes through zero, or near to it
//
// Between two samples of different signs t* is bracketed by regula falsi (Illinois: the value of an end that stays is
// halved; every third step halves the bracket) down to rounding of instants. Between samples of one sign s may dip
// through zero: where a parabola says so it is looked at there. Nothing is found where s touches zero and turns back.
// Source: M. Dowell, P. Jarratt, BIT 11 (1971) 168. Private to measures.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "catena/analysis/measures/motion_samples.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {

/// The last sample before a switch and the first one behind it; the same where the difference is zero.
struct SwitchBracket {
  MotionSample before, behind;
};

// A parabola through samples of a part whose quartic is good to 1e-5 misses less than this of the size.
inline constexpr double dips_to = 1e-2;
inline constexpr int looks_at_dip = 6;

/// Narrows the bracket [a, b]; see(t) gives a sample, or nothing.
template <class See>
std::optional<SwitchBracket> narrow(MotionSample a, MotionSample b, std::size_t column, const See& see) {
  const double room = thresholds::few_roundings * std::max({std::abs(a.t), std::abs(b.t), b.t - a.t});
  double va = a.value[column], vb = b.value[column];
  int stayed = 0;  // how often in a row: b, or, if negative, a
  for (int n = 0; n < 2 * thresholds::most_bisections && b.t - a.t > 2 * room; ++n) {
    const double guess = n % 3 == 2 ? (a.t + b.t) / 2 : a.t + (b.t - a.t) * (va / (va - vb));
    std::optional<MotionSample> middle = see(std::clamp(guess, a.t + room, b.t - room));
    if (!middle || !std::isfinite(middle->value[column])) return {};
    const double v = middle->value[column];
    if (v == 0) return SwitchBracket{*middle, *middle};
    const bool moves_a = (v < 0) == (a.value[column] < 0);
    (moves_a ? va : vb) = v;
    (moves_a ? a : b) = std::move(*middle);
    stayed = moves_a ? std::max(stayed, 0) + 1 : std::min(stayed, 0) - 1;
    if (stayed > 1) vb /= 2;
    if (stayed < -1) va /= 2;
  }
  return SwitchBracket{std::move(a), std::move(b)};
}

/// An instant between three samples of one sign at which the column has the other one.
template <class See>
std::optional<MotionSample> find_dip(const MotionSample& first, const MotionSample& second, const MotionSample& third,
                                     std::size_t column, double size, const See& see) {
  std::array<double, 3> t{first.t, second.t, third.t};
  std::array<double, 3> v{first.value[column], second.value[column], third.value[column]};
  const double sign = v[1] > 0 ? 1 : -1;
  for (int n = 0; n < looks_at_dip; ++n) {
    const double d1 = (v[1] - v[0]) / (t[1] - t[0]), d2 = (v[2] - v[1]) / (t[2] - t[1]);
    const double bend = (d2 - d1) / (t[2] - t[0]);
    const double lowest = (t[0] + t[1]) / 2 - d1 / (2 * bend);
    if (!(sign * bend > 0 && lowest > t[0] && lowest < t[2]) || lowest == t[1]) return {};
    if (sign * (v[0] + (lowest - t[0]) * (d1 + (lowest - t[1]) * bend)) > dips_to * size) return {};
    std::optional<MotionSample> there = see(lowest);
    if (!there || !std::isfinite(there->value[column])) return {};
    const double value = there->value[column];
    if (sign * value < 0) return there;
    // The lower one of the two inside goes on in the middle.
    const bool is_lower = sign * value < sign * v[1], is_left = lowest < t[1];
    const std::size_t end = is_lower == is_left ? 2 : 0;
    if (is_lower) {
      t[end] = t[1], v[end] = v[1];
      t[1] = lowest, v[1] = value;
    } else {
      t[end] = lowest, v[end] = value;
    }
  }
  return {};
}

/// Where the column changes its sign in a part, further than `least` from its ends: the first such place.
template <class See>
std::optional<SwitchBracket> find_switching(const MotionSamples::Part& part, std::size_t column, double size,
                                            double least, const See& see) {
  const auto is_inside = [&](const std::optional<SwitchBracket>& found) {
    return found && found->before.t > part.front().t + least && found->behind.t < part.back().t - least;
  };
  const MotionSample* last = nullptr;
  for (const MotionSample& sample : part) {
    const double v = sample.value[column];
    if (!std::isfinite(v)) return {};
    if (v == 0) continue;
    if (last && (v < 0) != (last->value[column] < 0)) {
      if (auto found = narrow(*last, sample, column, see); is_inside(found)) return found;
    }
    last = &sample;
  }
  for (std::size_t k = 1; k + 1 < part.size(); ++k) {
    const double before = part[k - 1].value[column], v = part[k].value[column], behind = part[k + 1].value[column];
    if (!(v * before > 0 && v * behind > 0)) continue;
    std::optional<MotionSample> dip = find_dip(part[k - 1], part[k], part[k + 1], column, size, see);
    if (!dip) continue;
    const MotionSample& left = dip->t > part[k].t ? part[k] : part[k - 1];
    if (auto found = narrow(left, std::move(*dip), column, see); is_inside(found)) return found;
  }
  return {};
}

}  // namespace catena
