// What measures are made of: pulses of columns at instants.
#include "catena/analysis/measures/measure_account.hpp"

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

}  // namespace catena
