#include "catena/analysis/spectrum/spectrum_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// How many crossings an interval may have.
constexpr std::size_t most_crossings = 40;

std::vector<double> real_values(const CirculatoryModes& found) {
  std::vector<double> values;
  for (const CirculatoryMode& mode : found.modes) {
    if (!mode.is_pair()) values.push_back(mode.omega2);
  }
  return values;
}

/// The real value that passes zero: of two samples the one with more negative ones has it below.
const CirculatoryMode* nearest_zero(const CirculatoryModes& found, bool below) {
  const CirculatoryMode* nearest = nullptr;
  for (const CirculatoryMode& mode : found.modes) {
    if (mode.is_pair() || (mode.omega2 < 0) != below) continue;
    if (!nearest || std::abs(mode.omega2) < std::abs(nearest->omega2)) nearest = &mode;
  }
  return nearest;
}

/// The pair nearest to the place where its values met.
const CirculatoryMode* youngest_pair(const CirculatoryModes& found) {
  const CirculatoryMode* youngest = nullptr;
  for (const CirculatoryMode& mode : found.modes) {
    if (mode.is_pair() && (!youngest || mode.imaginary < youngest->imaginary)) youngest = &mode;
  }
  return youngest;
}

/// Square of half the distance of the neighbours that are about to meet at `omega2`.
double squared_distance(const CirculatoryModes& found, double omega2) {
  const std::vector<double> values = real_values(found);
  double best = std::numeric_limits<double>::infinity(), half = best;
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    const double own = 0.5 * (values[k + 1] - values[k]);
    const double off = std::abs(0.5 * (values[k + 1] + values[k]) - omega2) + own;
    if (off >= best) continue;
    best = off;
    half = own;
  }
  return half * half;
}

/// One change between two samples of different kinds.
class Crossing {
 public:
  Crossing(const SpectrumAt& at, const SpectrumSample& low, const SpectrumSample& high)
      : at_(at),
        low_(low),
        high_(high),
        accuracy_(thresholds::carried_rounding * std::max(std::abs(high.s - low.s), 1e-300)) {}

  /// False where a sample between cannot be had. Then low() and high() enclose the change.
  bool locate() {
    for (int k = 0; k < thresholds::most_bisections && high_.s - low_.s > accuracy_; ++k) {
      SpectrumSample trial;
      trial.s = 0.5 * (low_.s + high_.s);
      if (k % 3 != 2) {
        const double a = function(low_), b = function(high_);
        const double secant = low_.s + (high_.s - low_.s) * a / (a - b);
        if (a * b < 0 && secant > low_.s && secant < high_.s) trial.s = aside(secant, k);
      }
      if (trial.s <= low_.s || trial.s >= high_.s) break;
      if (!at_(trial.s, trial.found)) return false;
      (trial.is_like(low_) ? low_ : high_) = std::move(trial);
    }
    return true;
  }

  SpectrumCrossing result() const {
    SpectrumCrossing crossing;
    const double a = function(low_), b = function(high_);
    crossing.flutter = is_flutter();
    crossing.s = a * b < 0 ? low_.s + (high_.s - low_.s) * a / (a - b) : 0.5 * (low_.s + high_.s);
    crossing.values = high_.found.negative - low_.found.negative;
    crossing.pairs = high_.found.pairs - low_.found.pairs;
    if (crossing.flutter) {
      const CirculatoryMode* pair = youngest_pair(more_pairs().found);
      crossing.omega2 = pair->omega2;
      crossing.mode = pair->shape;
    } else if (const CirculatoryMode* mode = nearest_zero(low_.found, crossing.values < 0)) {
      crossing.mode = mode->shape;
    }
    return crossing;
  }
  const SpectrumSample& high() const { return high_; }

 private:
  // Close to a root the secant comes from one side only: every other one goes a little beyond it, so that the bracket
  // closes from both.
  double aside(double secant, int k) const {
    const double beyond = std::max(0.5 * accuracy_, 1e-3 * std::min(secant - low_.s, high_.s - secant));
    const double moved = secant + (k % 3 == 0 ? beyond : -beyond);
    return moved > low_.s && moved < high_.s ? moved : secant;
  }
  bool is_flutter() const { return low_.found.pairs != high_.found.pairs; }
  const SpectrumSample& more_pairs() const { return low_.found.pairs > high_.found.pairs ? low_ : high_; }

  /// Of opposite signs on both sides.
  double function(const SpectrumSample& sample) const {
    if (is_flutter()) {
      const CirculatoryMode* pair = youngest_pair(more_pairs().found);
      if (&sample == &more_pairs()) return -pair->imaginary * pair->imaginary;
      return squared_distance(sample.found, pair->omega2);
    }
    const bool below = (sample.found.negative > low_.found.negative) || (sample.found.negative > high_.found.negative);
    const CirculatoryMode* mode = nearest_zero(sample.found, below);
    return mode ? mode->omega2 : 0;
  }

  const SpectrumAt& at_;
  SpectrumSample low_, high_;
  double accuracy_;
};

/// Equal mechanisms change at one place, where rounding makes one after the other do so, and back: their sum counts.
std::vector<SpectrumCrossing> merged(const std::vector<SpectrumCrossing>& found, double together) {
  std::vector<SpectrumCrossing> result;
  for (const SpectrumCrossing& crossing : found) {
    if (result.empty() || result.back().flutter != crossing.flutter || crossing.s - result.back().s > together) {
      result.push_back(crossing);
      continue;
    }
    result.back().values += crossing.values;
    result.back().pairs += crossing.pairs;
  }
  std::erase_if(result, [](const SpectrumCrossing& c) { return (c.flutter ? c.pairs : c.values) == 0; });
  return result;
}

}  // namespace

std::vector<SpectrumCrossing> find_crossings(const SpectrumAt& at, const SpectrumSample& low,
                                             const SpectrumSample& high, bool& complete) {
  std::vector<SpectrumCrossing> found;
  SpectrumSample from = low;
  complete = true;
  while (!from.is_like(high) && found.size() < most_crossings) {
    Crossing crossing(at, from, high);
    if (!crossing.locate()) break;
    found.push_back(crossing.result());
    from = crossing.high();
    if (from.s >= high.s) break;
  }
  complete = from.is_like(high);
  return merged(found, thresholds::same_instant * (high.s - low.s));
}

bool find_hidden_change(const SpectrumAt& at, const SpectrumSample& a, const SpectrumSample& b, const SpectrumSample& c,
                        SpectrumSample& hidden) {
  if (!a.is_like(b) || !b.is_like(c)) return false;
  // Number 0: the lowest value above zero; k + 1: the squared distance of neighbours k and k + 1.
  const auto quantity = [](const SpectrumSample& sample, std::size_t number) {
    const std::vector<double> values = real_values(sample.found);
    if (number == 0) {
      const auto above = std::find_if(values.begin(), values.end(), [](double v) { return v >= 0; });
      return above == values.end() ? std::numeric_limits<double>::infinity() : *above;
    }
    if (number >= values.size()) return std::numeric_limits<double>::infinity();
    const double half = 0.5 * (values[number] - values[number - 1]);
    return half * half;
  };
  const std::size_t count = real_values(b.found).size();
  for (std::size_t number = 0; number < count; ++number) {
    const double ha = quantity(a, number), hb = quantity(b, number), hc = quantity(c, number);
    if (!(hb < ha) || !(hb < hc)) continue;
    // The parabola through the three tells whether it may come near zero.
    const double x = a.s - b.s, y = c.s - b.s, rate = ((ha - hb) * y * y - (hc - hb) * x * x) / (x * y * (y - x));
    const double bend = ((hc - hb) * x - (ha - hb) * y) / (x * y * (y - x));
    if (hb - rate * rate / (4 * bend) > 0.5 * hb) continue;
    double low = a.s, middle = b.s, high = c.s, least = hb;
    // Near its least a quantity is level to rounding over more than this part.
    const double width = high - low;
    for (int step = 0; step < thresholds::most_bisections && high - low > thresholds::same_value * width; ++step) {
      const bool right = high - middle > middle - low;
      hidden.s = right ? middle + thresholds::golden_part * (high - middle)
                       : middle - thresholds::golden_part * (middle - low);
      if (!at(hidden.s, hidden.found)) break;
      if (!hidden.is_like(b)) return true;
      const double now = quantity(hidden, number);
      if (now < least) {
        (right ? low : high) = middle;
        middle = hidden.s;
        least = now;
      } else {
        (right ? high : low) = hidden.s;
      }
    }
  }
  return false;
}

}  // namespace catena
