#include "catena/analysis/measures/extreme.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// A top may turn out this much higher than the parabola through samples makes it: of the size, see motion_samples.hpp.
constexpr double slack = 1e-4;
// Half the width of the window of the polynomial, in parts of the part.
constexpr double window = 0.02;
// Seven values of a smooth column foretell its top to some 1e-8 of their range, those about a kink to a tenth.
constexpr double smooth = 1e-3;

/// The top of the parabola through three points, if it bends downwards.
std::optional<double> top(double t0, double v0, double t1, double v1, double t2, double v2) {
  const double d1 = (v1 - v0) / (t1 - t0), d2 = (v2 - v1) / (t2 - t1);
  const double bend = (d2 - d1) / (t2 - t0);
  if (!(bend < 0)) return {};
  return (t0 + t1) / 2 - d1 / (2 * bend);
}

/// The value of that parabola at t.
double on_parabola(double t0, double v0, double t1, double v1, double t2, double v2, double t) {
  const double d1 = (v1 - v0) / (t1 - t0), d2 = (v2 - v1) / (t2 - t1);
  return v0 + (t - t0) * (d1 + (t - t1) * (d2 - d1) / (t2 - t0));
}

struct Stationary {
  double x = 0, value = 0;
};

/// The polynomial through N values, by Newton's divided differences.
template <std::size_t N>
class Polynomial {
 public:
  Polynomial(const std::array<double, N>& x, const std::array<double, N>& values) : x_(x), c_(values) {
    for (std::size_t level = 1; level < N; ++level) {
      for (std::size_t k = N - 1; k >= level; --k) c_[k] = (c_[k] - c_[k - 1]) / (x_[k] - x_[k - level]);
    }
  }

  /// Where its derivative vanishes near `x`, between two places.
  std::optional<Stationary> stationary(double x, double from, double to) const {
    double value = 0;
    for (int n = 0; n < 20; ++n) {
      // Value, slope and bend by Horner's scheme.
      double p = c_[N - 1], d = 0, dd = 0;
      for (std::size_t k = N - 1; k-- > 0;) {
        const double factor = x - x_[k];
        dd = dd * factor + 2 * d;
        d = d * factor + p;
        p = p * factor + c_[k];
      }
      if (dd == 0) return {};
      value = p;
      const double step = d / dd;
      x -= step;
      if (!(x >= from && x <= to)) return {};
      if (std::abs(step) <= 1e-14) break;
    }
    return Stationary{x, value};
  }

 private:
  std::array<double, N> x_, c_;
};

}  // namespace

void Extreme::consider(MotionSample sample, double value, double reach, double valley) {
  if (!std::isfinite(value)) {
    if (!undefined_) undefined_ = sample.t;
    return;
  }
  size_ = std::max(size_, std::abs(value));
  if (!best_ || value > largest_ + tie_ * size_) {
    others_.clear();
    best_ = std::move(sample);
    largest_ = value;
    return;
  }
  // Of the samples of one top the highest counts; further away an equal one is another top.
  const bool apart = std::abs(sample.t - best_->t) > reach || valley < std::min(value, largest_) - tie_ * size_;
  if (value > largest_) {
    if (apart) others_.push_back(std::move(*best_));
    best_ = std::move(sample);
    largest_ = value;
  } else if (value >= largest_ - tie_ * size_ && apart) {
    others_.push_back(std::move(sample));
  }
}

void Extreme::note_slopes(const MotionSample& sample) {
  slopes_.resize(sample.derivative.size(), 0.0);
  for (std::size_t n = 0; n < slopes_.size(); ++n) {
    if (std::isfinite(sample.derivative[n])) slopes_[n] = std::max(slopes_[n], std::abs(sample.derivative[n]));
  }
}

void Extreme::add(const MotionSample& sample) {
  consider(sample, quantity_(sample.value), 0, std::numeric_limits<double>::infinity());
}

// The top near `centre` by the polynomial through seven instants around it, inside of the stretch; nothing where that
// is no better than `known`, or misses what is there.
std::optional<Extreme::Peak> Extreme::settle(double centre, double h, double known, const MotionPiece& piece,
                                             const At& at) const {
  const double d = h / 3;
  centre = std::clamp(centre, piece.from() + h, piece.to() - h);
  if (centre < piece.from() + h || d == 0) return {};
  constexpr std::array<double, 7> steps{-3, -2, -1, 0, 1, 2, 3};
  std::array<double, 7> around{}, t_around{};
  for (std::size_t k = 0; k < 7; ++k) t_around[k] = centre + d * steps[k];
  piece.stretch.announce(t_around);
  for (std::size_t k = 0; k < 7; ++k) {
    const std::optional<double> value = at(t_around[k]);
    if (!value) return {};
    around[k] = *value;
  }
  const std::optional<Stationary> found = Polynomial(steps, around).stationary(0, -2, 2);
  if (!found) return {};
  const double peak = centre + d * found->x;
  const std::optional<double> value = at(peak);
  // At a kink the polynomial misses the value by a part of what it bends by.
  const auto [least, most] = std::minmax_element(around.begin(), around.end());
  if (!value || std::abs(*value - found->value) > smooth * (*most - *least)) return {};
  if (!(*value >= known - 1e-12 * std::max(size_, std::abs(known)))) return {};
  return Peak{peak, *value};
}

// The top between a and b, `middle` above both. `guess`: where a polynomial of high degree has it.
std::optional<Extreme::Peak> Extreme::locate(Peak a, Peak middle, Peak b, std::optional<Peak> guess, double length,
                                             const MotionPiece& piece, const At& at) const {
  const double h = window * length;
  if (guess) {
    if (const std::optional<Peak> peak = settle(guess->t, h, middle.value, piece, at)) return peak;
  }
  double step = b.t - a.t;
  for (int n = 0; n < thresholds::most_bisections && step > 1e-9 * length; ++n) {
    const std::optional<double> top_of_three = top(a.t, a.value, middle.t, middle.value, b.t, b.value);
    const bool useful = top_of_three && *top_of_three > a.t && *top_of_three < b.t && n % 4 != 3;
    const double before = middle.t;
    double t = useful ? *top_of_three : before;
    if (!useful)
      t = before - a.t > b.t - before ? before - thresholds::golden_part * (before - a.t)
                                      : before + thresholds::golden_part * (b.t - before);
    if (t == before) t += (b.t - before > before - a.t ? 1 : -1) * 0.1 * h;
    const std::optional<double> v = at(t);
    if (!v) return {};
    const Peak seen{t, *v};
    if (seen.value > middle.value) {
      (t > before ? a : b) = middle;
      middle = seen;
    } else {
      (t > before ? b : a) = seen;
    }
    step = b.t - a.t;
    if (!useful || std::abs(t - before) >= h / 4) continue;
    if (const std::optional<Peak> peak = settle(middle.t, h, middle.value, piece, at)) return peak;
  }
  return middle;
}

void Extreme::add(const MotionSamples& samples, const MotionSamples::Part& part, const MotionPiece& piece,
                  bool with_derivative) {
  constexpr std::size_t count = MotionSamples::nodes + 2;
  std::array<double, count> v{}, t{};
  for (std::size_t k = 0; k < count; ++k) {
    v[k] = quantity_(part[k].value);
    t[k] = part[k].t;
    if (std::isfinite(v[k]))
      size_ = std::max(size_, std::abs(v[k]));
    else if (!undefined_)
      undefined_ = t[k];
  }
  const auto at = [&](double instant) -> std::optional<double> {
    const std::optional<MotionSample> sample = samples.look(piece, instant, false);
    if (!sample) return {};
    return quantity_(sample->value);
  };
  // The lowest sample since the best, up to an instant of this part.
  const auto lowest_until = [&](double instant) {
    double lowest = best_ && best_->t < t.front() ? lowest_ : std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count && best_; ++k) {
      if (t[k] > best_->t && t[k] < instant) lowest = std::min(lowest, v[k]);
    }
    return lowest;
  };
  const auto take = [&](double instant) {
    if (auto sample = samples.look(piece, instant, with_derivative)) {
      const double value = quantity_(sample->value);
      consider(std::move(*sample), value, 2 * (t.back() - t.front()), lowest_until(instant));
    }
    if (!with_derivative || others_.empty()) return;
    // A part is about a radian of a swing: what vanishes at its top does not in both of these.
    for (const std::size_t beside : {std::size_t{2}, std::size_t{6}}) {
      if (const auto sample = samples.look({piece.stretch}, t[beside], true)) note_slopes(*sample);
    }
  };
  const auto promises = [&](double value) { return !best_ || value + slack * size_ > largest_; };
  const double length = t.back() - t.front();
  // A kink between the samples makes a polynomial through all of them worthless: then the top is found by its bracket.
  std::array<double, count> x{};
  for (std::size_t k = 0; k < count; ++k) x[k] = (t[k] - t.front()) / length;
  const auto guess = [&](std::size_t from, double start, std::size_t to) -> std::optional<Peak> {
    const auto found = Polynomial(x, v).stationary((start - t.front()) / length, x[from], x[to]);
    return found ? std::optional(Peak{t.front() + length * found->x, found->value}) : std::nullopt;
  };
  // What the parabola through a sample and its neighbours comes up to beside it.
  const auto foreseen = [&](std::size_t k) {
    const std::size_t i = std::clamp<std::size_t>(k, 1, count - 2) - 1;
    const std::optional<double> at_top = top(t[i], v[i], t[i + 1], v[i + 1], t[i + 2], v[i + 2]);
    const bool beside = at_top && *at_top > t[k == 0 ? 0 : k - 1] && *at_top < t[std::min(k + 1, count - 1)];
    return beside ? on_parabola(t[i], v[i], t[i + 1], v[i + 1], t[i + 2], v[i + 2], *at_top) : v[k];
  };
  for (std::size_t k = 0; k < count; ++k) {
    const bool end = k == 0 || k == count - 1;
    const std::size_t from = k == 0 ? 0 : k - 1, to = std::min(k + 1, count - 1);
    const bool highest = v[k] >= v[from] && v[k] >= v[to];
    // Where nine samples tell all of a column they may lie too far apart for a parabola.
    const auto by_all = [&] { return highest ? guess(from, t[k], to) : std::nullopt; };
    if (!promises(std::max(v[k], foreseen(k)))) {
      const std::optional<Peak> far = by_all();
      if (!far || !promises(far->value)) continue;
    }
    if (!end && highest && (v[k] > v[k - 1] || v[k] > v[k + 1])) {
      const Peak before{t[k - 1], v[k - 1]}, here{t[k], v[k]}, after{t[k + 1], v[k + 1]};
      if (const auto peak = locate(before, here, after, by_all(), length, piece, at)) take(peak->t);
    } else if (end) {
      // A top may lie between the end and the sample beside it; near the end the parabola may have it outside.
      const std::size_t i = k == 0 ? 0 : count - 3;
      const double beside = v[k == 0 ? 1 : count - 2];
      const auto lies_between = [&](const std::optional<double>& at_top) {
        return at_top && *at_top > t[from] && *at_top < t[to];
      };
      std::optional<double> inside = top(t[i], v[i], t[i + 1], v[i + 1], t[i + 2], v[i + 2]);
      if (!lies_between(inside)) {
        const std::optional<Peak> by_nine = by_all();
        inside = by_nine ? std::optional(by_nine->t) : std::nullopt;
      }
      const std::optional<double> value = lies_between(inside) ? at(*inside) : std::nullopt;
      // Above all before, or as large, as a corner: of what stays the same every sample would be.
      const double tie = tie_ * size_;
      if (value && *value > std::max(v[from], v[to])) {
        const Peak before{t[from], v[from]}, here{*inside, *value}, after{t[to], v[to]};
        if (const auto peak = locate(before, here, after, guess(from, *inside, to), length, piece, at)) take(peak->t);
      } else if (v[k] >= beside && (!best_ || v[k] > largest_ || (v[k] >= largest_ - tie && v[k] > beside + tie))) {
        take(t[k]);
      }
    }
  }
  lowest_ = lowest_until(std::numeric_limits<double>::infinity());
}

}  // namespace catena
