// Measures whose instants move with the parameters: where a run ends, and where one is taken.
#include <fmt/format.h>

#include "catena/analysis/measures/measure_account.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace

bool MeasureSet::Account::is_at_end(const Extreme& extreme) const {
  return !extreme.empty() && last_ && extreme.best().t >= last_->t;
}

// Whether the extreme is reached at the end of the run and before, too.
bool MeasureSet::Account::ties_with_end(const Extreme& extreme) const {
  if (extreme.empty() || !last_) return false;
  const auto ends = [this](const MotionSample& sample) { return sample.t >= last_->t; };
  const bool best = ends(extreme.best());
  return std::any_of(extreme.others().begin(), extreme.others().end(),
                     [&](const MotionSample& other) { return ends(other) != best; });
}

// A run that an event ended did so at an instant that moves with the parameters, and with it all that is measured up to
// there; what it had passed before stays.
void MeasureSet::Account::leave_out_early_end(MeasureResult& result) const {
  if (rows_ > 0 || !result.value || result.by_last_instant == 0) return;
  std::fill(result.gradient.begin(), result.gradient.end(), no_value);
  if (result.trouble.empty()) result.trouble = "the run ended early, at an instant that changes with the parameters";
}

// The motion goes on over an instant later: integrals grow by what is there, values by their rates; extremes stay
// unless they are at the end.
double MeasureSet::Account::by_last_instant(const MeasureResult& result, const End* end) const {
  if (!result.value || !last_ || rows_ > 0) return no_value;
  const bool at_end = std::any_of(extremes_.begin(), extremes_.end(), [&](const Extreme& e) { return is_at_end(e); });
  const double value = *result.value;
  double sum = 0;
  switch (request_.kind) {
    case MeasureKind::first:
    case MeasureKind::at:
      return 0;
    case MeasureKind::integral:
      return end ? end->sample.value[column_] : no_value;
    case MeasureKind::mean:
      return end ? (end->sample.value[column_] - value) / duration_ : no_value;
    case MeasureKind::rms:
      // What grows from zero adds |c'| T^-1/2 (dT)^3/2 / 3^1/2.
      if (end && value == 0 && end->sample.value[column_] == 0) return 0;
      return end ? (std::pow(end->sample.value[column_], 2) - value * value) / (2 * value * duration_) : no_value;
    case MeasureKind::final:
      return end ? end->rate[column_] : no_value;
    case MeasureKind::maximum:
    case MeasureKind::minimum:
    case MeasureKind::range:
      if (!at_end) return 0;
      if (!end) return no_value;
      for (std::size_t k = 0; k < extremes_.size(); ++k)
        sum += is_at_end(extremes_[k]) ? (k == 0 ? 1 : -1) * end->rate[column_] : 0;
      return sum;
    case MeasureKind::path:
      break;
    case MeasureKind::field:
      return no_value;
  }
  if (!request_.timed && !at_end) return 0;
  for (std::size_t k = 0; k < request_.points.size(); ++k) {
    const bool moves = request_.timed ? k > 0 : is_at_end(extremes_[k]);
    if (!moves) continue;
    const bool last = !request_.timed || k + 1 == request_.points.size();
    if (last && !end) return no_value;
    const std::vector<double>& rate = last ? end->rate : instants_[k].rate;
    if (rate.empty()) return no_value;
    const MotionSample& sample = request_.timed ? *instants_[k].sample : extremes_[k].best();
    const double part = last ? 1 : static_cast<double>(k) / static_cast<double>(request_.points.size() - 1);
    sum += part * ((sample.value[column_] - request_.points[k].x) * rate[column_] +
                   (sample.value[second_] - request_.points[k].y) * rate[second_]);
  }
  return sum / (static_cast<double>(request_.points.size()) * value);
}

// Whether a jump at the end of the run makes a difference to it.
bool MeasureSet::Account::is_touched_by(const End& end) const {
  if (end.change.empty()) return false;
  const bool jumps = end.change[column_] != 0 || (request_.kind == MeasureKind::path && end.change[second_] != 0);
  if (is_integral()) return jumps;
  if (request_.kind == MeasureKind::path && request_.timed) return true;
  return std::any_of(extremes_.begin(), extremes_.end(), [&](const Extreme& e) { return is_at_end(e); });
}

void MeasureSet::Account::take_out(MeasureResult& result, std::size_t p, const std::string& why) const {
  result.gradient[p] = no_value;
  if (result.trouble.empty()) result.trouble = why;
}

// The instants stay: where the path is nearest to a point its distance does not change with the instant.
void MeasureSet::Account::move_points(MeasureResult& result, std::span<const MovingPoint> points) const {
  const double n = static_cast<double>(request_.points.size());
  for (const MovingPoint& moving : points) {
    const MotionSample& sample = request_.timed ? *instants_[moving.point].sample : extremes_[moving.point].best();
    const Vec2<double>& point = request_.points[moving.point];
    const double apart = moving.axis == 0 ? sample.value[column_] - point.x : sample.value[second_] - point.y;
    result.gradient[moving.parameter] -= apart * moving.rate / (n * *result.value);
  }
}

void MeasureSet::Account::move(MeasureResult& result, const End* end, const MovingInstants& moving, std::size_t measure,
                               bool given) const {
  if (!result.value || rows_ > 0) return;
  const bool jump_moves = end && !end->moving.empty(), early = last_->t != run_.last;
  const bool is_final = request_.kind == MeasureKind::final;
  if (early && is_final && !given) {
    for (std::size_t p = 0; p < parameters_; ++p)
      result.gradient[p] = end ? gradient_of(end->sample, column_, p) : no_value;
  }
  for (std::size_t p = 0; p < parameters_; ++p) {
    const double by = moving.last.empty() ? 0 : moving.last[p], jump = jump_moves ? end->moving[p] : 0;
    const bool apart =
        early || !(std::abs(by - jump) <= thresholds::same_rate * std::max(std::abs(by), std::abs(jump)));
    if (jump != 0 && is_final && !apart && end->change[column_] == 0) {
      result.gradient[p] = gradient_of(end->sample, column_, p) + end->rate[column_] * by;
      continue;
    }
    if (jump != 0 && apart && (is_touched_by(*end) || (early && is_final))) {
      take_out(
          result, p,
          fmt::format("at t = {:.9g} s, where the run ends, a function of time jumps at an instant that moves with "
                      "the parameters, but not with the end",
                      end->t));
      continue;
    }
    if (by != 0 && (!end || end->rate[column_] != 0) &&
        std::any_of(extremes_.begin(), extremes_.end(), [&](const Extreme& e) { return ties_with_end(e); })) {
      take_out(result, p,
               "its extreme is reached before the end of the run, too, which moves with the parameters: which of them "
               "counts changes with them");
      continue;
    }
    if (by != 0 && result.by_last_instant != 0) {
      result.gradient[p] += result.by_last_instant * by;
      if (std::isfinite(result.gradient[p])) continue;
      take_out(result, p,
               std::isnan(by) ? moving.why_unknown
                              : "it is taken up to the end of the run, which moves with the parameters, and its "
                                "derivative by that instant is not known");
    }
  }
  if (request_.kind == MeasureKind::path && measure < moving.points.size()) move_points(result, moving.points[measure]);
  if (request_.kind != MeasureKind::at || measure >= moving.taken.size() || moving.taken[measure].empty()) return;
  const Instant& instant = instants_.front();
  for (std::size_t p = 0; p < parameters_; ++p) {
    const double by = moving.taken[measure][p], jump = instant.moving.empty() ? 0 : instant.moving[p];
    if (by == 0) continue;
    const bool with_jump = jump != 0 && std::abs(by - jump) <= thresholds::same_rate * std::abs(by);
    if (with_jump && instant.before && instant.sample->change[column_] == 0 && !instant.rate_before.empty())
      result.gradient[p] = gradient_of(*instant.before, column_, p) + instant.rate_before[column_] * by;
    else
      result.gradient[p] += instant.rate.empty() ? no_value : instant.rate[column_] * by;
    if (!std::isfinite(result.gradient[p]))
      take_out(
          result, p,
          fmt::format("at t = {:.9g} s, which moves with the parameters, its column has no derivative", instant.t));
  }
}

}  // namespace catena
