#include "catena/analysis/measures/motion_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/measures/sample_places.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// What a column with a kink or a jump inside of a part has in its integral over it is off by some quarter of the misfit
// times the length. Below this part of all that was looked at so far, which is what the rule of seven nodes misses
// where the quartic just passes, it is left.
constexpr double no_part = MotionSamples::allowed_part * MotionSamples::allowed_part;
// A misfit that halving leaves as large in both halves may be noise: that of a smooth column falls to 1/32, that of a
// kink stays in one half alone. But it does so as well where a column swings many times in the part.
constexpr double no_progress = 0.5;
// A step of a method has no such swings: from this part of it on what stays is noise, and shorter parts are not made.
constexpr double noisy_part_of_step = 0x1p-4, shortest_part_of_step = 0x1p-12;

// What the polynomial of degree eight may miss rows by, and by how much more it and the quartic miss in a part of twice
// the length, where half of what is allowed is left for bends yet to come.
constexpr double allowed_row_part = 1e-9;
constexpr double quartic_grows_by = 2 * 32, eighth_grows_by = 2 * 512;
// Limits at breakpoints are taken from instants at this part of a piece inside, or of t where rounding of instants asks
// for more: a column that swings a hundred times in the piece bends by (6e-4)^3 there. Noise differs at instants that
// are this part of a part away from each other, by a third difference of some four times the noise, what is smooth by
// no more than limits do.
constexpr double inside = 1e-6, inside_of_instant = 1e-11;
// A derivative along an instant of which its two parts leave so little is zero: rates are good to 1e-9.
constexpr double cancelled = 1e-8;

// Of the quartic's misfit. Of 20,000 kinks anywhere in a part all had more than 0.013, half of them 0.086 and more;
// swings that the quartic misses by less than 1e-5 have 0.0009 and less.
constexpr double falls_to = 0.0125;

const auto quartic = sample_places::foretelling_weights();
const auto highest = sample_places::highest_weights();

/// How fast bodies with these rates turn, and move, in length scales.
double pace_of(std::span<const double> rates, double length_scale) {
  double pace = 0;
  for (std::size_t k = 0; k + 2 < rates.size(); k += 3) {
    const double shift = std::max(std::abs(rates[k]), std::abs(rates[k + 1])) / length_scale;
    pace = std::max({pace, shift, std::abs(rates[k + 2])});
  }
  return std::isfinite(pace) ? pace : 0;
}

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
  const std::optional<double> pace = values_(t, sample->value);
  if (!pace) return {};
  if (follows_places_) sample->pace = *pace;
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

double MotionSamples::kink_of(const Part& part, std::size_t c) const {
  double top = 0;
  for (const auto& weights : highest) {
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * part[k].value[c];
    if (size_[c] > 0 && std::isfinite(sum)) top = std::max(top, std::abs(sum) / size_[c]);
  }
  return top > falls_to * misfit_of(part, c) ? top : 0;
}

MotionSamples::Misfit MotionSamples::misfit(const Part& part) const {
  double largest = 0, kink = 0;
  for (std::size_t c = 0; c < size_.size(); ++c) {
    largest = std::max(largest, misfit_of(part, c));
    // Steps of a method end where it sees forces bend, and what is dense between them has noise of its tolerance.
    if (follows_places_) kink = std::max(kink, kink_of(part, c));
  }
  const double of_rows = misfit_of_rows(part), rows = of_rows / allowed_row_part, of_size = std::max(largest, of_rows);
  largest /= allowed_part;
  return {std::max(largest, rows), std::max(quartic_grows_by * largest, eighth_grows_by * rows), of_size, kink};
}

std::optional<bool> MotionSamples::is_noise(const MotionPiece& piece, const Part& part, double least_kink) const {
  constexpr std::array<double, 4> third{1, -3, 3, -1};
  const double from = part[4].t, length = part.back().t - part.front().t;
  const double step = std::min(std::max(inside * length, inside_of_instant * std::abs(from)), length / 8);
  std::vector<double> difference(size_.size(), 0.0);
  for (std::size_t k = 0; k < third.size(); ++k) {
    const std::optional<MotionSample> there = see(piece, from + static_cast<double>(k) * step, false);
    if (!there) return {};
    for (std::size_t c = 0; c < size_.size(); ++c) difference[c] += third[k] * there->value[c];
  }
  // Third differences of what is dense and smooth vanish; of noise they are up to eight times as large, or as small.
  const double progress = no_progress / 8;
  bool misses = false, differs = false;
  const double of_rows = misfit_of_rows(part);
  for (std::size_t c = 0; c < size_.size(); ++c) {
    const double quartic_off = misfit_of(part, c), kink = kink_of(part, c), noise = std::abs(difference[c]);
    const double off = std::max(quartic_off > allowed_part ? quartic_off : 0, kink > least_kink ? kink : 0);
    if (off > 0 && !(noise >= progress * off * size_[c])) return false;
    misses = misses || off > 0;
    differs = differs || (size_[c] > 0 && noise >= progress * of_rows * size_[c]);
  }
  return misses || differs;  // or rows alone are missed
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
  std::vector<double> before, change;  // places at the sample before, and since then, where velocities are not known
  for (std::size_t k = 0; k < sample_places::places.size(); ++k) {
    std::optional<MotionSample> sample;
    if (values_ && !always_) {
      sample = take_values(t[k]);
    } else if (const std::optional<Snapshot> there = piece.stretch.at(t[k])) {
      sample = take_one(*there, always_);
      const double length_scale = there->evaluator.length_scale();
      if (follows_places_ && !there->qd.empty()) sample->pace = pace_of(there->qd, length_scale);
      if (follows_places_ && there->qd.empty()) {
        change.resize(before.size());
        for (std::size_t c = 0; c < before.size(); ++c) change[c] = (there->q[c] - before[c]) / (t[k] - t[k - 1]);
        sample->pace = pace_of(change, length_scale);
        before.assign(there->q.begin(), there->q.end());
      }
    }
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

bool MotionSamples::cover_part(const MotionPiece& piece, const Part& part, double shortened,
                               const std::function<void(const Part&, const MotionPiece&)>& use) {
  const double length = part.back().t - part.front().t;
  double pace = 0;
  for (const MotionSample& sample : part) pace = std::max(pace, sample.pace);
  const auto is_inside = [&](const MotionSample& row) { return row.t > part.front().t && row.t < part.back().t; };
  const auto rows = static_cast<double>(std::count_if(rows_.begin(), rows_.end(), is_inside));
  const double gap = length * sample_places::widest_gap / (1 + rows);
  const bool turns_far = pace * gap > thresholds::driven_stretch;
  if (!turns_far && !switches_.empty()) {
    if (const auto cut = find_cut(piece, part)) return cover_cut(piece, part, *cut, shortened, use);
  }
  const Misfit off = misfit(part);
  const auto take = [&](const Part& one) {
    worst_if_twice_ = std::max(worst_if_twice_, off.if_twice);
    least_ = std::min(least_, shortened * (one.back().t - one.front().t));
    use_part(piece, one, use);
    return true;
  };
  const double so_far = std::max(piece.to() - run_.first, piece.to() - piece.from());
  const bool is_rounding =
      length <= thresholds::sum_rounding * std::max(std::abs(part.front().t), std::abs(part.back().t));
  // What may be missed of a column's size, by so short a part.
  const double least = no_part * so_far / length;
  const bool is_told = (off.here <= 1 && off.kink <= least) || std::min(off.of_size, 1.0) <= least;
  const double of_piece = follows_places_ ? 1 : length / (piece.to() - piece.from());
  const bool is_short = of_piece <= shortest_part_of_step;
  if (is_rounding || is_short || (!turns_far && is_told)) return take(part);
  Part first, second;
  if (!fill(piece, part.front(), part[4], first) || !fill(piece, part[4], part.back(), second)) return false;
  const auto stays = [&](const Part& half) {
    const Misfit now = misfit(half);
    return std::max(now.of_size, now.kink) > no_progress * std::max(off.of_size, off.kink);
  };
  if (!turns_far && stays(first) && stays(second)) {
    const bool of_step = of_piece <= noisy_part_of_step;
    const std::optional<bool> noise = of_step ? true : follows_places_ ? is_noise(piece, part, least) : false;
    if (!noise) return false;
    if (*noise) return take(first) && take(second);
  }
  return cover_part(piece, first, shortened, use) && cover_part(piece, second, shortened, use);
}

bool MotionSamples::cover(const MotionPiece& piece, const std::function<void(const Part&, const MotionPiece&)>& use) {
  worst_if_twice_ = 0;
  least_ = piece.to() - piece.from();
  const std::optional<MotionSample> a = look(piece, piece.from(), false);
  if (!a) return false;
  const std::optional<MotionSample> b = look(piece, piece.to(), false);
  Part whole;
  const bool looked = b && fill(piece, *a, *b, whole) && cover_part(piece, whole, 1, use);
  covered_to_ = piece.to();
  std::erase_if(rows_, [&](const MotionSample& row) { return row.t <= covered_to_; });
  pace_ = worst_if_twice_ <= 1 ? 2 * least_ : least_;
  return looked;
}

}  // namespace catena
