// MotionSamples: columns that switch from one branch to another.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/measures/switching.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// A switch nearer to an end of a part, in parts of its length, is that end itself: of the jump of a derivative so much
// is put to the wrong side.
constexpr double at_end_of_part = 1e-10;

}  // namespace

std::optional<std::array<MotionSample, 2>> MotionSamples::find_cut(const MotionPiece& piece, const Part& part) const {
  const double least = at_end_of_part * (part.back().t - part.front().t);
  const auto see_there = [&](double t) { return see(piece, t, false); };
  for (const ColumnSwitch& one : switches_) {
    // What is not smooth yet is halved; what never becomes so is rounding.
    if (!is_smooth(part, one.by)) continue;
    auto found = find_switching(part, one.by, size_[one.by], least, see_there);
    if (found) return std::array<MotionSample, 2>{std::move(found->before), std::move(found->behind)};
  }
  return {};
}

bool MotionSamples::is_tie(const MotionSample& sample, const ColumnSwitch& one) const {
  const double size = std::max(size_[one.by], size_[one.column]);
  return std::abs(sample.value[one.by]) <= thresholds::carried_rounding * size;
}

void MotionSamples::judge_ties(MotionSample& sample) const {
  for (const ColumnSwitch& one : switches_) {
    if (sample.derivative.empty() || !is_tie(sample, one)) continue;
    for (std::size_t p = 0; p < parameters_; ++p) {
      double& derivative = sample.derivative[one.column * parameters_ + p];
      const double apart = std::abs(sample.derivative[one.by * parameters_ + p]);
      if (apart <= thresholds::same_value * std::abs(derivative) + thresholds::no_derivative * size_[one.column])
        continue;
      derivative = std::numeric_limits<double>::quiet_NaN();
      sample.undecided |= bit_of_column(one.column);
    }
  }
}

void MotionSamples::use_part(const MotionPiece& piece, const Part& part,
                             const std::function<void(const Part&, const MotionPiece&)>& use) const {
  const auto stays = [&](const ColumnSwitch& one) {
    return std::all_of(part.begin(), part.end(), [&](const MotionSample& sample) { return is_tie(sample, one); });
  };
  if (std::none_of(switches_.begin(), switches_.end(), stays)) return use(part, piece);
  Part judged = part;
  for (MotionSample& sample : judged) judge_ties(sample);
  use(judged, piece);
}

bool MotionSamples::cover_cut(const MotionPiece& piece, const Part& part, const std::array<MotionSample, 2>& cut,
                              double shortened, const std::function<void(const Part&, const MotionPiece&)>& use) {
  const double length = shortened * (part.back().t - part.front().t);
  for (const bool second : {false, true}) {
    const MotionSample &a = second ? cut[1] : part.front(), &b = second ? part.back() : cut[0];
    Part half;
    if (!fill(piece, a, b, half) || !cover_part(piece, half, length / (b.t - a.t), use)) return false;
  }
  return true;
}

}  // namespace catena
