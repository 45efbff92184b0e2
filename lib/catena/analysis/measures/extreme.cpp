#include "catena/analysis/measures/extreme.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catena {
namespace {

// Two values that differ by less than this part of the quantity's size are a tie: its instants are known to 1e-10.
constexpr double tie = 1e-9;
// A top may turn out this much higher than the parabola through samples makes it: of the size, see motion_samples.hpp.
constexpr double slack = 1e-4;
// Half the width of the window of the polynomial, in parts of the part.
constexpr double window = 0.02;
// Seven values of a smooth column foretell its top to some 1e-8 of their range, those about a kink to a tenth.
constexpr double smooth = 1e-3;
constexpr int most_steps = 60;
constexpr double golden = 0.381966011250105;

/// The top of the parabola through three points, if it bends downwards.
std::optional<double> top(double t0, double v0, double t1, double v1, double t2, double v2) {
  const double d1 = (v1 - v0) / (t1 - t0), d2 = (v2 - v1) / (t2 - t1);
  const double bend = (d2 - d1) / (t2 - t0);
  if (!(bend < 0)) return {};
  return (t0 + t1) / 2 - d1 / (2 * bend);
}

struct Stationary {
  double x = 0, value = 0;  ///< in steps; of the polynomial there
};

/// Where the derivative of the polynomial through seven equidistant values at -3 ... 3 vanishes near 0.
std::optional<Stationary> stationary(const std::array<double, 7>& v) {
  // Newton's divided differences about the middle, as a polynomial in x: solved for its coefficients once a call.
  std::array<double, 7> c = v;
  for (std::size_t level = 1; level < 7; ++level) {
    for (std::size_t k = 6; k >= level; --k) c[k] = (c[k] - c[k - 1]) / static_cast<double>(level);
  }
  double x = 0, value = 0;
  for (int n = 0; n < 20; ++n) {
    // Value, slope and bend of sum c_k (x + 3)(x + 2) ... by Horner's scheme.
    double p = c[6], d = 0, dd = 0;
    for (std::size_t k = 6; k-- > 0;) {
      const double factor = x + 3 - static_cast<double>(k);
      dd = dd * factor + 2 * d;
      d = d * factor + p;
      p = p * factor + c[k];
    }
    if (dd == 0) return {};
    value = p;
    const double step = d / dd;
    x -= step;
    if (!(std::abs(x) <= 2)) return {};
    if (std::abs(step) <= 1e-14) break;
  }
  return Stationary{x, value};
}

}  // namespace

void Extreme::consider(MotionSample sample, double value, double reach) {
  if (!std::isfinite(value)) {
    if (!undefined_) undefined_ = sample.t;
    return;
  }
  size_ = std::max(size_, std::abs(value));
  if (!best_ || value > largest_ + tie * size_) {
    others_.clear();
    best_ = std::move(sample);
    largest_ = value;
    return;
  }
  // Of the samples of one top the highest counts; further away an equal one is another top.
  const bool apart = std::abs(sample.t - best_->t) > reach;
  if (value > largest_) {
    if (apart) others_.push_back(std::move(*best_));
    best_ = std::move(sample);
    largest_ = value;
  } else if (value >= largest_ - tie * size_ && apart) {
    others_.push_back(std::move(sample));
  }
}

void Extreme::add(const MotionSample& sample) { consider(sample, quantity_(sample.value), 0); }

// The top between a and b, `middle` above both.
std::optional<Extreme::Peak> Extreme::locate(double a, double middle, double b, double length, const MotionPiece& piece,
                                             const At& at) const {
  std::optional<double> va = at(a), vm = at(middle), vb = at(b);
  if (!va || !vm || !vb) return {};
  const double h = window * length;
  double step = b - a;
  for (int n = 0; n < most_steps && step > 1e-9 * length; ++n) {
    std::optional<double> guess = top(a, *va, middle, *vm, b, *vb);
    const bool useful = guess && *guess > a && *guess < b && n % 4 != 3;
    double t =
        useful ? *guess : (middle - a > b - middle ? middle - golden * (middle - a) : middle + golden * (b - middle));
    if (t == middle) t += (b - middle > middle - a ? 1 : -1) * 0.1 * h;
    const std::optional<double> v = at(t);
    if (!v) return {};
    const double before = middle;
    if (*v > *vm) {
      (t > middle ? a : b) = middle;
      (t > middle ? va : vb) = vm;
      middle = t;
      vm = v;
    } else {
      (t > middle ? b : a) = t;
      (t > middle ? vb : va) = v;
    }
    step = b - a;
    const bool close = useful && std::abs(t - before) < h / 4;
    if (!close) continue;
    // Seven instants around it, inside of the stretch.
    const double d = h / 3, centre = std::clamp(middle, piece.from() + h, piece.to() - h);
    if (centre < piece.from() + h || d == 0) continue;
    std::array<double, 7> around{}, t_around{};
    for (std::size_t k = 0; k < 7; ++k) t_around[k] = centre + d * (static_cast<double>(k) - 3);
    piece.stretch.announce(t_around);
    for (std::size_t k = 0; k < 7; ++k) {
      const std::optional<double> value = at(t_around[k]);
      if (!value) return {};
      around[k] = *value;
    }
    const std::optional<Stationary> found = stationary(around);
    if (!found) continue;
    const double peak = centre + d * found->x;
    const std::optional<double> value = at(peak);
    // At a kink the polynomial misses the value by a part of what it bends by.
    const auto [least, most] = std::minmax_element(around.begin(), around.end());
    if (value && std::abs(*value - found->value) > smooth * (*most - *least)) continue;
    if (value && *value >= *vm - 1e-12 * std::max(size_, std::abs(*vm))) return Peak{peak, *value};
  }
  return Peak{middle, *vm};
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
  const auto take = [&](double instant) {
    if (auto sample = samples.look(piece, instant, with_derivative)) {
      const double value = quantity_(sample->value);
      consider(std::move(*sample), value, 2 * (t.back() - t.front()));
    }
  };
  const auto promises = [&](double value) { return !best_ || value + slack * size_ > largest_; };
  const double length = t.back() - t.front();
  for (std::size_t k = 0; k < count; ++k) {
    const bool end = k == 0 || k == count - 1;
    if (!promises(v[k])) continue;
    if (!end && v[k] >= v[k - 1] && v[k] >= v[k + 1] && (v[k] > v[k - 1] || v[k] > v[k + 1])) {
      if (const auto peak = locate(t[k - 1], t[k], t[k + 1], length, piece, at)) take(peak->t);
    } else if (end) {
      // A top may lie between the end and the sample beside it.
      const std::size_t i = k == 0 ? 0 : count - 3;
      const std::optional<double> inside = top(t[i], v[i], t[i + 1], v[i + 1], t[i + 2], v[i + 2]);
      const double from = k == 0 ? t[0] : t[count - 2], to = k == 0 ? t[1] : t[count - 1];
      const bool between = inside && *inside > from && *inside < to;
      const std::optional<double> value = between ? at(*inside) : std::nullopt;
      if (value && *value > std::max(v[k], v[k == 0 ? 1 : count - 2])) {
        if (const auto peak = locate(from, *inside, to, length, piece, at)) take(peak->t);
      } else if (v[k] >= v[k == 0 ? 1 : count - 2] && (!best_ || v[k] > largest_)) {
        take(t[k]);
      }
    }
  }
}

}  // namespace catena
