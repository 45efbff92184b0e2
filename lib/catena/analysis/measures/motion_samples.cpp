#include "catena/analysis/measures/motion_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/measures/sample_places.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// See the header.
constexpr double shortest_part = 0x1p-12;
// From this part of the distance of rows on, enough for sixteen swings between two of them, a misfit that halving
// leaves as large in both halves is taken for noise: that of a smooth column falls to 1/32, that of a kink stays in one
// half alone.
constexpr double noisy_part = 0x1p-4;
constexpr double no_progress = 0.5;

// What the polynomial of degree eight may miss rows by, and by how much more it and the quartic miss in a part of twice
// the length, where half of what is allowed is left for bends yet to come.
constexpr double allowed_row_part = 1e-9;
constexpr double quartic_grows_by = 2 * 32, eighth_grows_by = 2 * 512;
// Limits at breakpoints are taken from instants at this part of a piece inside, or of t where rounding of instants asks
// for more: a column that swings a hundred times in the piece bends by (6e-4)^3 there.
constexpr double inside = 1e-6, inside_of_instant = 1e-11;
// A derivative along an instant of which its two parts leave so little is zero: rates are good to 1e-9.
constexpr double cancelled = 1e-8;

const auto quartic = sample_places::foretelling_weights();

}  // namespace

const std::array<double, 7>& MotionSamples::weights() { return sample_places::half_weights; }

MotionSample MotionSamples::take(const Snapshot& snapshot, bool with_derivative) const {
  MotionSample sample = take_one(snapshot, with_derivative);
  judge_ties(sample);
  return sample;
}

MotionSample MotionSamples::take_one(const Snapshot& snapshot, bool with_derivative) const {
  MotionSample sample{snapshot.t, std::vector<double>(columns_.size()), {}, {}, 0, {}};
  columns_.evaluate(snapshot, sample.value);
  if (with_derivative && parameters_ > 0) {
    sample.derivative.assign(columns_.size() * parameters_, std::numeric_limits<double>::quiet_NaN());
    sample.change.assign(columns_.size(), 0.0);
    derivatives_.at(snapshot, sample.derivative, sample.change);
    for (std::size_t c = 0; c < size_.size(); ++c) {
      if (std::abs(sample.change[c]) <= thresholds::no_jump * size_[c]) sample.change[c] = 0;
    }
  }
  return sample;
}

std::optional<MotionSample> MotionSamples::take_values(double t) const {
  std::optional<MotionSample> sample(MotionSample{t, std::vector<double>(columns_.size()), {}, {}, 0, {}});
  if (!values_(t, sample->value)) sample.reset();
  return sample;
}

std::optional<MotionSample> MotionSamples::see(const MotionPiece& piece, double t, bool with_derivative) const {
  if (values_ && !with_derivative) return take_values(t);
  const std::optional<Snapshot> snapshot = piece.stretch.at(t);
  if (!snapshot) return {};
  return take_one(*snapshot, with_derivative);
}

std::optional<MotionSample> MotionSamples::limit(const MotionPiece& piece, double t, bool with_derivative) const {
  const double length = piece.to() - piece.from(), inwards = t == piece.from() ? 1 : -1;
  const double d = std::min(std::max(inside * length, inside_of_instant * std::abs(t)), length / 8);
  MotionSample sum{t, std::vector<double>(columns_.size(), 0.0), {}, {}, inwards * d, {}};
  if (with_derivative) sum.derivative.assign(columns_.size() * parameters_, 0.0);
  sum.change.assign(columns_.size(), 0.0);
  for (std::size_t k = 0; k < limit_weights.size(); ++k) {
    const std::optional<MotionSample> one = see(piece, t + static_cast<double>(k + 1) * sum.step, with_derivative);
    if (!one) return {};
    for (std::size_t c = 0; c < sum.value.size(); ++c) sum.value[c] += limit_weights[k] * one->value[c];
    for (std::size_t c = 0; c < sum.derivative.size(); ++c) sum.derivative[c] += limit_weights[k] * one->derivative[c];
  }
  return sum;
}

std::optional<MotionSample> MotionSamples::look(const MotionPiece& piece, double t, bool with_derivative) const {
  with_derivative = with_derivative && parameters_ > 0;
  const bool breaks = piece.is_break(t);
  std::optional<MotionSample> sample = breaks ? limit(piece, t, with_derivative) : see(piece, t, with_derivative);
  if (sample) judge_ties(*sample);
  if (!breaks || !sample || !with_derivative || t == run_.last) return sample;
  const std::vector<double> moves = moving(t);
  if (moves.empty() && !later_) return sample;
  const std::optional<std::vector<double>> rate = rates(piece, t);
  if (!rate) return {};
  if (later_) {
    sample->rate = *rate;
    return sample;
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (std::size_t p = 0; p < parameters_; ++p) {
      if (moves[p] == 0) continue;
      double& derivative = sample->derivative[c * parameters_ + p];
      const double along = t == run_.first ? std::numeric_limits<double>::quiet_NaN() : (*rate)[c] * moves[p];
      const double parts = std::abs(derivative) + std::abs(along);
      derivative += along;
      if (std::abs(derivative) <= cancelled * parts) derivative = 0;
    }
  }
  return sample;
}

std::optional<std::vector<double>> MotionSamples::rates(const MotionPiece& piece, double t) const {
  const std::size_t columns = columns_.size();
  const double length = piece.to() - piece.from();
  std::vector<double> best(columns, 0.0), last(columns, 0.0);
  std::vector<double> change(columns, std::numeric_limits<double>::infinity());
  const double room = std::min(t - piece.from(), piece.to() - t);
  for (int n = 0; n < thresholds::most_differences; ++n) {
    const double d = std::ldexp(thresholds::first_difference * length, -n);
    // In the middle of the piece, or from its end inwards.
    const bool central = room >= 2 * d;
    const double step = central || t - piece.from() < piece.to() - t ? d : -d;
    constexpr double about[] = {1, -8, 0, 8, -1}, inwards[] = {-25, 48, -36, 16, -3};
    std::vector<double> now(columns, 0.0);
    for (int k = 0; k < 5; ++k) {
      if (central && k == 2) continue;
      const double there = k == 0 && !central ? t : t + step * (central ? k - 2 : k);
      const std::optional<MotionSample> sample =
          piece.is_break(there) ? limit(piece, there, false) : see(piece, there, false);
      if (!sample) return {};
      for (std::size_t c = 0; c < columns; ++c)
        now[c] += (central ? about : inwards)[k] * sample->value[c] / (12 * step);
    }
    bool done = n > 0;
    for (std::size_t c = 0; c < columns && n > 0; ++c) {
      const double moved = std::abs(now[c] - last[c]);
      if (moved < change[c] || !std::isfinite(best[c])) {
        change[c] = moved;
        best[c] = now[c];
      }
      done = done && change[c] <= thresholds::settled_difference * std::max(std::abs(best[c]), size_[c] / length);
    }
    last = now;
    if (done) break;
  }
  return best;
}

double MotionSamples::misfit_of(const Part& part, std::size_t c) const {
  double largest = 0;
  for (std::size_t f = 0; f < sample_places::foretold.size() && size_[c] > 0; ++f) {
    double value = 0;
    for (std::size_t k = 0; k < sample_places::known.size(); ++k)
      value += quartic[f][k] * part[sample_places::known[k]].value[c];
    largest = std::max(largest, miss(value, part[sample_places::foretold[f]].value[c], c));
  }
  return largest;
}

MotionSamples::Misfit MotionSamples::misfit(const Part& part) const {
  double largest = 0;
  for (std::size_t c = 0; c < size_.size(); ++c) largest = std::max(largest, misfit_of(part, c));
  largest /= allowed_part;
  const double rows = misfit_of_rows(part) / allowed_row_part;
  return {std::max(largest, rows), std::max(quartic_grows_by * largest, eighth_grows_by * rows)};
}

double MotionSamples::miss(double expected, double there, std::size_t column) const {
  // Where a column ceases to be a number halving finds the border.
  if (std::isfinite(expected) != std::isfinite(there)) return std::numeric_limits<double>::infinity();
  return std::isfinite(there) ? std::abs(expected - there) / size_[column] : 0;
}

double MotionSamples::misfit_of_rows(const Part& part) const {
  static const std::array<double, nodes + 2> barycentric = sample_places::barycentric_weights();
  const double from = part.front().t, length = part.back().t - from;
  double largest = 0;
  for (const MotionSample& row : rows_) {
    if (!(row.t > from && row.t < part.back().t)) continue;
    const double x = 2 * (row.t - from) / length - 1;
    std::array<double, nodes + 2> weight{};
    double sum = 0;
    for (std::size_t k = 0; k < weight.size(); ++k)
      sum += weight[k] = barycentric[k] / (x - sample_places::place_of(k));
    if (!std::isfinite(sum)) continue;  // a row at a sample is that sample
    for (std::size_t c = 0; c < size_.size(); ++c) {
      double value = 0;
      for (std::size_t k = 0; k < weight.size(); ++k) value += weight[k] * part[k].value[c];
      if (size_[c] > 0) largest = std::max(largest, miss(value / sum, row.value[c], c));
    }
  }
  return largest;
}

bool MotionSamples::fill(const MotionPiece& piece, const MotionSample& a, const MotionSample& b, Part& part) {
  part.front() = a;
  part.back() = b;
  std::array<double, sample_places::places.size()> t{};
  for (std::size_t k = 0; k < sample_places::places.size(); ++k)
    t[k] = a.t + (b.t - a.t) * (1 + sample_places::places[k]) / 2;
  piece.stretch.announce(t);
  for (std::size_t k = 0; k < sample_places::places.size(); ++k) {
    std::optional<MotionSample> sample = see(piece, t[k], always_);
    if (!sample) return false;
    part[k + 1] = std::move(*sample);
  }
  for (const MotionSample& sample : part) measure_sizes(sample);
  return true;
}

void MotionSamples::measure_sizes(const MotionSample& sample) {
  for (std::size_t c = 0; c < size_.size(); ++c) {
    if (std::isfinite(sample.value[c])) size_[c] = std::max(size_[c], std::abs(sample.value[c]));
  }
}

void MotionSamples::note_row(MotionSample row) {
  if (!(row.t > covered_to_)) return;
  measure_sizes(row);
  rows_.push_back(std::move(row));
}

bool MotionSamples::cover_part(const MotionPiece& piece, const Part& part, double row_distance, double shortened,
                               const std::function<void(const Part&, const MotionPiece&)>& use) {
  if (!switches_.empty()) {
    if (const auto cut = find_cut(piece, part)) return cover_cut(piece, part, *cut, row_distance, shortened, use);
  }
  const Misfit off = misfit(part);
  const double length = part.back().t - part.front().t;
  if (off.here <= 1 || length <= shortest_part * row_distance) {
    worst_if_twice_ = std::max(worst_if_twice_, off.if_twice);
    least_ = std::min(least_, shortened * length);
    use_part(piece, part, use);
    return true;
  }
  Part first, second;
  if (!fill(piece, part.front(), part[4], first) || !fill(piece, part[4], part.back(), second)) return false;
  if (length <= noisy_part * row_distance && misfit(first).here > no_progress * off.here &&
      misfit(second).here > no_progress * off.here) {
    use_part(piece, first, use);
    use_part(piece, second, use);
    return true;
  }
  return cover_part(piece, first, row_distance, shortened, use) &&
         cover_part(piece, second, row_distance, shortened, use);
}

bool MotionSamples::cover(const MotionPiece& piece, const std::function<void(const Part&, const MotionPiece&)>& use) {
  worst_if_twice_ = 0;
  least_ = piece.to() - piece.from();
  const std::optional<MotionSample> a = look(piece, piece.from(), false);
  if (!a) return false;
  const std::optional<MotionSample> b = look(piece, piece.to(), false);
  Part whole;
  const auto inside_piece = [&](const MotionSample& row) { return row.t > piece.from() && row.t < piece.to(); };
  const double row_distance = least_ / static_cast<double>(1 + std::count_if(rows_.begin(), rows_.end(), inside_piece));
  const bool looked = b && fill(piece, *a, *b, whole) && cover_part(piece, whole, row_distance, 1, use);
  covered_to_ = piece.to();
  std::erase_if(rows_, [&](const MotionSample& row) { return row.t <= covered_to_; });
  pace_ = worst_if_twice_ <= 1 ? 2 * least_ : least_;
  return looked;
}

}  // namespace catena
