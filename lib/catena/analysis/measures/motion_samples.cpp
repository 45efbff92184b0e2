#include "catena/analysis/measures/motion_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

// Of [-1, 1]: the nodes of Kronrod's extension of Gauss' rule with three nodes, and half its weights.
constexpr std::array<double, 7> places = {-0.960491268708020283423507092629080, -0.774596669241483377035853079956480,
                                          -0.434243749346802558002071502844628, 0.0,
                                          0.434243749346802558002071502844628,  0.774596669241483377035853079956480,
                                          0.960491268708020283423507092629080};
constexpr std::array<double, 7> half_weights = {
    0.104656226026467265193823857192073 / 2, 0.268488089868333440728569280666710 / 2,
    0.401397414775962222905051818618432 / 2, 0.450916538658474142345110087045571 / 2,
    0.401397414775962222905051818618432 / 2, 0.268488089868333440728569280666710 / 2,
    0.104656226026467265193823857192073 / 2};
// Samples of a part that the quartic goes through (both ends, three nodes), and those that it must foretell.
constexpr std::array<std::size_t, 5> known = {0, 2, 4, 6, 8};
constexpr std::array<std::size_t, 4> foretold = {1, 3, 5, 7};
// See the header.
constexpr double allowed_part = 1e-5;
constexpr int deepest = 12;
// From so many halvings on, enough for sixteen swings between two rows, a misfit that halving leaves as large in both
// halves is taken for noise: that of a smooth column falls to 1/32, that of a kink stays in one half alone.
constexpr int noise_depth = 4;
constexpr double no_progress = 0.5;

double place_of(std::size_t sample) { return sample == 0 ? -1 : sample == 8 ? 1 : places[sample - 1]; }

/// The quartic's weights of the known samples at the foretold ones (Lagrange).
std::array<std::array<double, 5>, 4> foretelling_weights() {
  std::array<std::array<double, 5>, 4> weights{};
  for (std::size_t f = 0; f < foretold.size(); ++f) {
    const double x = place_of(foretold[f]);
    for (std::size_t k = 0; k < known.size(); ++k) {
      double w = 1;
      for (std::size_t j = 0; j < known.size(); ++j) {
        if (j != k) w *= (x - place_of(known[j])) / (place_of(known[k]) - place_of(known[j]));
      }
      weights[f][k] = w;
    }
  }
  return weights;
}

}  // namespace

const std::array<double, 7>& MotionSamples::weights() { return half_weights; }

MotionSample MotionSamples::take(const Snapshot& snapshot, bool with_derivative) const {
  MotionSample sample{snapshot.t, std::vector<double>(columns_.size()), {}};
  columns_.evaluate(snapshot, sample.value);
  if (with_derivative && parameters_ > 0) {
    sample.derivative.assign(columns_.size() * static_cast<std::size_t>(parameters_),
                             std::numeric_limits<double>::quiet_NaN());
    derivatives_(snapshot, sample.derivative);
  }
  return sample;
}

std::optional<MotionSample> MotionSamples::look(const MotionStretch& stretch, double t, bool with_derivative) const {
  const std::optional<Snapshot> snapshot = stretch.at(t);
  if (!snapshot) return {};
  return take(*snapshot, with_derivative);
}

double MotionSamples::misfit(const Part& part) const {
  static const auto weights = foretelling_weights();
  double largest = 0;
  for (std::size_t c = 0; c < size_.size(); ++c) {
    for (std::size_t f = 0; f < foretold.size() && size_[c] > 0; ++f) {
      double value = 0;
      for (std::size_t k = 0; k < known.size(); ++k) value += weights[f][k] * part[known[k]].value[c];
      const double there = part[foretold[f]].value[c];
      // Where a column ceases to be a number halving finds the border.
      if (std::isfinite(value) != std::isfinite(there)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, std::abs(value - there) / size_[c]);
    }
  }
  return largest;
}

bool MotionSamples::fill(const MotionStretch& stretch, const MotionSample& a, const MotionSample& b, Part& part) {
  part.front() = a;
  part.back() = b;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double t = a.t + (b.t - a.t) * (1 + places[k]) / 2;
    std::optional<MotionSample> sample = look(stretch, t, always_);
    if (!sample) return false;
    part[k + 1] = std::move(*sample);
  }
  for (const MotionSample& sample : part) {
    for (std::size_t c = 0; c < size_.size(); ++c) {
      if (std::isfinite(sample.value[c])) size_[c] = std::max(size_[c], std::abs(sample.value[c]));
    }
  }
  return true;
}

bool MotionSamples::cover_part(const MotionStretch& stretch, const Part& part, int depth,
                               const std::function<void(const Part&, const MotionStretch&)>& use) {
  const double off = misfit(part);
  if (off <= allowed_part || depth == deepest) {
    use(part, stretch);
    return true;
  }
  Part first, second;
  if (!fill(stretch, part.front(), part[4], first) || !fill(stretch, part[4], part.back(), second)) return false;
  if (depth >= noise_depth && misfit(first) > no_progress * off && misfit(second) > no_progress * off) {
    use(first, stretch);
    use(second, stretch);
    return true;
  }
  return cover_part(stretch, first, depth + 1, use) && cover_part(stretch, second, depth + 1, use);
}

bool MotionSamples::cover(const MotionStretch& stretch,
                          const std::function<void(const Part&, const MotionStretch&)>& use) {
  const std::optional<MotionSample> a = look(stretch, stretch.from, false);
  if (!a) return false;
  const std::optional<MotionSample> b = look(stretch, stretch.to, false);
  Part whole;
  return b && fill(stretch, *a, *b, whole) && cover_part(stretch, whole, 0, use);
}

}  // namespace catena
