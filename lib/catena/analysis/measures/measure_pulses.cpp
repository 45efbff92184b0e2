// What measures are made of: pulses of columns at instants, and of which branch of columns that switch.
#include <fmt/format.h>

#include "catena/analysis/measures/measure_account.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// In SI units: a root mean square below is that of a column of zeros, or of their rounding.
constexpr double no_rms = 1e-13;

}  // namespace

void MeasureSet::Account::add_pulses(const MotionSample& sample, std::size_t column, double weight,
                                     std::vector<ColumnPulse>& out) {
  if (sample.step == 0) {
    out.push_back({sample.t, column, weight});
    return;
  }
  for (std::size_t k = 0; k < limit_weights.size(); ++k)
    out.push_back({sample.t + static_cast<double>(k + 1) * sample.step, column, weight * limit_weights[k]});
  if (!sample.rate.empty()) out.push_back({sample.t, ColumnPulse::by_instant, weight * sample.rate[column]});
}

void MeasureSet::Account::path_pulses(double value, std::vector<ColumnPulse>& out) const {
  const double scale = 1 / (static_cast<double>(request_.points.size()) * value);
  for (std::size_t k = 0; k < request_.points.size(); ++k) {
    const MotionSample& sample = request_.timed ? *instants_[k].sample : extremes_[k].best();
    add_pulses(sample, column_, scale * (sample.value[column_] - request_.points[k].x), out);
    add_pulses(sample, second_, scale * (sample.value[second_] - request_.points[k].y), out);
  }
}

// Integrals have had what instants add that are known to move.
void MeasureSet::Account::take_given(MeasureResult& result, const std::vector<double>& gradient) const {
  const bool gains = is_integral() && duration_ > 0;
  for (std::size_t p = 0; p < parameters_; ++p)
    result.gradient[p] = gains ? result.gradient[p] + gradient[p] : gradient[p];
}

std::string_view MeasureSet::Account::pulses(const MeasureResult& result, std::vector<ColumnPulse>& out) const {
  if (!result.value) return {};
  const double value = *result.value;
  if (is_undecided()) return "looks at a column that switches, where both branches are equal";
  if (jumps_at_) return "looks at a column that jumps where it switches";
  switch (request_.kind) {
    case MeasureKind::maximum:
    case MeasureKind::minimum:
    case MeasureKind::range:
      for (std::size_t k = 0; k < extremes_.size(); ++k) {
        if (!extremes_[k].others().empty()) return "reaches its extreme at two instants";
        add_pulses(extremes_[k].best(), column_, k == 0 ? 1.0 : -1.0, out);
      }
      return {};
    case MeasureKind::first:
      out.push_back({first_->t, column_, 1});
      return {};
    case MeasureKind::final:
      out.push_back({last_->t, column_, 1});
      return {};
    case MeasureKind::at:
      out.push_back({instants_[0].sample->t, column_, 1});
      return {};
    case MeasureKind::path:
      path_pulses(value, out);
      return {};
    case MeasureKind::integral:
    case MeasureKind::mean:
    case MeasureKind::rms:
      if (!(duration_ > 0)) {
        if (last_ && request_.kind != MeasureKind::integral) out.push_back({last_->t, column_, 1});
        return {};
      }
      if (request_.kind == MeasureKind::rms && value <= no_rms) return "is the root mean square of a column of zeros";
      for (const Node& node : nodes_) {
        const double weight = request_.kind == MeasureKind::integral ? 1
                              : request_.kind == MeasureKind::mean   ? 1 / duration_
                                                                     : node.value / (value * duration_);
        out.push_back({node.t, column_, weight * node.weight});
      }
      for (const Jump& jump : jumps_) {
        const double gain = request_.kind == MeasureKind::integral ? jump.value
                            : request_.kind == MeasureKind::mean   ? jump.value / duration_
                                                                   : jump.square / (2 * value * duration_);
        out.push_back({jump.t, ColumnPulse::by_instant, gain});
      }
      return {};
    case MeasureKind::field:
      return {};
  }
  return {};
}

// Parts that are halved share a sample, those that a switch parts do not.
void MeasureSet::Account::note_switches(const MotionSamples::Part& part, const MotionPiece& piece) {
  for (const MotionSample& sample : part) undecided_ = undecided_ || is_undecided(sample);
  const double value = part.front().value[column_];
  if (last_part_ && part.front().t != piece.from() && part.front().t != last_part_->first && !jumps_at_ &&
      std::abs(value - last_part_->second) > thresholds::no_jump * size_)
    jumps_at_ = part.front().t;
  last_part_ = {part.back().t, part.back().value[column_]};
}

bool MeasureSet::Account::is_undecided() const {
  const auto here = [&](const std::optional<MotionSample>& sample) { return sample && is_undecided(*sample); };
  switch (request_.kind) {
    case MeasureKind::first:
      return here(first_);
    case MeasureKind::final:
      return here(last_);
    case MeasureKind::integral:
    case MeasureKind::mean:
    case MeasureKind::rms:
      return undecided_;
    default:
      return std::any_of(instants_.begin(), instants_.end(), [&](const Instant& one) { return here(one.sample); }) ||
             std::any_of(extremes_.begin(), extremes_.end(),
                         [&](const Extreme& one) { return !one.empty() && is_undecided(one.best()); });
  }
}

// Why a gradient is missing at a switch; where a jump moves with a parameter is not known.
void MeasureSet::Account::tell_switches(MeasureResult& result) const {
  if (jumps_at_ && is_integral()) {
    std::fill(result.gradient.begin(), result.gradient.end(), std::numeric_limits<double>::quiet_NaN());
    result.trouble = fmt::format(
        "its column jumps at t = {:.9g} s, where it switches from one branch to another: how that instant moves with "
        "the parameters is not known",
        *jumps_at_);
  }
  if (!is_undecided() || !result.trouble.empty()) return;
  if (std::any_of(result.gradient.begin(), result.gradient.end(), [](double d) { return std::isnan(d); }))
    result.trouble =
        "both branches of an abs, min or max in its column are equal, with different derivatives: which of them counts "
        "changes with the parameters";
}

}  // namespace catena
