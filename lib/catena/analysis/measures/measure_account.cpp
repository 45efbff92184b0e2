#include "catena/analysis/measures/measure_account.hpp"

#include <fmt/format.h>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// A root mean square is none where parameters of size 1 make a change of 1e14 times it: the column is zero but for
// rounding, 1e-16 of what it is a difference of.
constexpr double zero_but_for_rounding = 1e-14;

std::string not_a_number_at(double t) { return fmt::format("its column is not a number at t = {:.9g} s", t); }

}  // namespace

void MeasureSet::Account::prepare_path() {
  const std::size_t n = request_.points.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2<double> point = request_.points[k];
    if (request_.timed) {
      const double part = n > 1 ? static_cast<double>(k) / static_cast<double>(n - 1) : 0;
      instants_.push_back({k + 1 == n && n > 1 ? run_.last : run_.first + part * (run_.last - run_.first)});
    } else {
      extremes_.emplace_back([=, x = column_, y = second_](std::span<const double> v) {
        return -(v[x] - point.x) * (v[x] - point.x) - (v[y] - point.y) * (v[y] - point.y);
      });
    }
  }
}

// What an integral up to an instant that moves gains, and loses beyond it.
void MeasureSet::Account::add_jump(const MotionSamples& samples, double t, double before, double after) {
  const std::vector<double> moving = samples.moving(t);
  // Limits of columns that do not jump differ by rounding: where the rate is not known nothing is lost by them.
  const bool jumps = std::abs(before - after) > thresholds::no_jump * size_;
  if (keeps_nodes_ && moving.empty() && jumps) jumps_.push_back({t, before - after, before * before - after * after});
  for (std::size_t p = 0; p < moving.size(); ++p) {
    if (moving[p] == 0 || !jumps) continue;
    sum_gradient_[p] += (before - after) * moving[p];
    squares_gradient_[p] += (before * before - after * after) * moving[p];
  }
}

// Begun earlier or later than an instant at which the column jumps, the run has that jump in it or not.
void MeasureSet::Account::leave_out_start(const MotionSamples& samples, const MotionPiece& piece) {
  const std::vector<double> moving = samples.moving(run_.first);
  if (moving.empty()) return;
  const std::optional<MotionSample> start = samples.look({piece.stretch}, run_.first, true);
  for (std::size_t p = 0; p < moving.size(); ++p) {
    if (moving[p] != 0 && (!start || start->change[column_] != 0)) sum_gradient_[p] = squares_gradient_[p] = none;
  }
}

void MeasureSet::Account::add(const MotionSamples& samples, const MotionSamples::Part& part, const MotionPiece& piece) {
  for (Extreme& extreme : extremes_) extreme.add(samples, part, piece, parameters_ > 0);
  for (const MotionSample& sample : part) {
    if (std::isfinite(sample.value[column_])) size_ = std::max(size_, std::abs(sample.value[column_]));
  }
  if (!is_integral()) return;
  if (samples.switches() && parameters_ > 0) note_switches(part, piece);
  const double length = part.back().t - part.front().t;
  sum_gradient_.resize(parameters_, 0.0);
  squares_gradient_.resize(parameters_, 0.0);
  squared_slopes_.resize(parameters_, 0.0);
  duration_ += length;
  for (std::size_t k = 0; k < MotionSamples::nodes; ++k) {
    const MotionSample& sample = part[k + 1];
    const double weight = length * MotionSamples::weights()[k], v = sample.value[column_];
    sum_ += weight * v;
    squares_ += weight * v * v;
    if (keeps_nodes_) nodes_.push_back({sample.t, weight, v});
    for (std::size_t p = 0; p < parameters_ && !keeps_nodes_; ++p) {
      const double gradient = gradient_of(sample, column_, p);
      sum_gradient_[p] += weight * gradient;
      squares_gradient_[p] += weight * 2 * v * gradient;
      squared_slopes_[p] += weight * gradient * gradient;
    }
  }
  if (piece.breaks_before && before_break_ && part.front().t == before_break_->first)
    add_jump(samples, part.front().t, before_break_->second, part.front().value[column_]);
  if (piece.breaks_after && part.back().t == piece.to()) before_break_ = {piece.to(), part.back().value[column_]};
  if (piece.breaks_before && part.front().t == run_.first) leave_out_start(samples, piece);
}

void MeasureSet::Account::look_at_instants(const MotionSamples& samples, const MotionPiece& piece) {
  for (Instant& instant : instants_) {
    if ((instant.sample && !instant.of_row) || instant.t < piece.from() || instant.t > piece.to()) continue;
    const bool differentiated = parameters_ > 0;
    if (differentiated && piece.breaks_after && instant.t == piece.to()) {
      instant.moving = samples.moving(instant.t);
      if (!instant.moving.empty()) {
        instant.before = samples.limit(piece, instant.t, true);
        instant.rate_before = samples.rates(piece, instant.t).value_or(std::vector<double>{});
      }
    }
    // At a breakpoint the value is that after it, of the next piece, as that of a row.
    if (piece.breaks_after && instant.t == piece.to() && instant.t != run_.last) continue;
    instant.sample = samples.look({piece.stretch}, instant.t, differentiated);
    instant.of_row = false;
    if (differentiated && instants_move_)
      instant.rate = samples.rates(piece, instant.t).value_or(std::vector<double>{});
  }
}

void MeasureSet::Account::add_row(const MotionSample& sample, bool only_rows) {
  // Without derivatives extremes, and values at instants, are the same wherever the run ends. Rows may be listed in any
  // order of their instants.
  if (parameters_ > 0 || (extremes_.empty() && instants_.empty())) {
    if (!first_ || sample.t < first_->t) first_ = sample;
    if (!last_ || sample.t >= last_->t) last_ = sample;
  }
  for (Instant& instant : instants_) {
    if (instant.sample || instant.t != sample.t) continue;
    instant.sample = sample;
    instant.of_row = true;
  }
  if (!only_rows) return;
  for (Extreme& extreme : extremes_) extreme.add(sample);
  ++rows_;
  sum_gradient_.resize(parameters_, 0.0);
  squares_gradient_.resize(parameters_, 0.0);
  squared_slopes_.resize(parameters_, 0.0);
  const double v = sample.value[column_];
  sum_ += v;
  squares_ += v * v;
  for (std::size_t p = 0; p < parameters_; ++p) {
    sum_gradient_[p] += gradient_of(sample, column_, p);
    squares_gradient_[p] += 2 * v * gradient_of(sample, column_, p);
    squared_slopes_[p] += gradient_of(sample, column_, p) * gradient_of(sample, column_, p);
  }
}

void MeasureSet::Account::give(MeasureResult& result, const MotionSample& sample) const {
  result.value = sample.value[column_];
  result.t = sample.t;
  for (std::size_t p = 0; p < parameters_; ++p) result.gradient[p] = gradient_of(sample, column_, p);
}

// Which of several instants is the largest changes with the parameters: where their gradients differ there is none.
void MeasureSet::Account::check_ties(MeasureResult& result, const Extreme& extreme) const {
  for (const MotionSample& other : extreme.others()) {
    for (std::size_t p = 0; p < parameters_; ++p) {
      const double here = gradient_of(extreme.best(), column_, p), there = gradient_of(other, column_, p);
      // Gradients of two instants of a tie that differ by less than this part of their size are the same. Where they
      // vanish they are as good as those of the column elsewhere: of a swing that comes back the amplitude may not
      // depend on what its phase does.
      const double unit = std::max({std::abs(here), std::abs(there), extreme.slope_nearby(column_ * parameters_ + p)});
      const double allowed = thresholds::same_value * unit + thresholds::no_derivative * size_;
      if (std::abs(here - there) <= allowed) continue;
      result.gradient[p] = none;
      result.trouble = fmt::format(
          "its extreme is reached at t = {:.9g} s and at t = {:.9g} s with different derivatives: which of them counts "
          "changes with the parameters",
          extreme.best().t, other.t);
    }
  }
}

void MeasureSet::Account::give_extreme(MeasureResult& result, const Extreme& extreme, double factor) const {
  if (extreme.empty()) {
    if (extreme.undefined()) result.trouble = not_a_number_at(*extreme.undefined());
    return;
  }
  result.value = result.value.value_or(0) + factor * extreme.best().value[column_];
  result.t = extreme.best().t;
  for (std::size_t p = 0; p < parameters_; ++p) result.gradient[p] += factor * gradient_of(extreme.best(), column_, p);
  check_ties(result, extreme);
  if (extreme.undefined() && result.trouble.empty()) {
    result.trouble =
        fmt::format("it is taken where its column is a number, which it is not at t = {:.9g} s", *extreme.undefined());
  }
}

void MeasureSet::Account::give_integral(MeasureResult& result) const {
  const double duration = rows_ > 0 ? static_cast<double>(rows_) : duration_;
  if (request_.kind == MeasureKind::integral) {
    if (rows_ > 0) {
      result.trouble = "an integral over time needs the motion between its rows, where this one is not looked at";
      return;
    }
    result.value = sum_;
    if (!sum_gradient_.empty()) result.gradient = sum_gradient_;
    return;
  }
  if (!(duration > 0)) {
    if (last_) give(result, *last_);  // of an instant the value itself
    result.t.reset();
    return;
  }
  const bool mean = request_.kind == MeasureKind::mean;
  const double value = mean ? sum_ / duration : std::sqrt(squares_ / duration);
  result.value = value;
  if (!mean) return give_rms_gradient(result, value);
  for (std::size_t p = 0; p < parameters_ && p < sum_gradient_.size(); ++p)
    result.gradient[p] = sum_gradient_[p] / duration;
}

// Of a column v that is zero everywhere it is |dp| rms(v_p) beside: none, unless v_p is zero as well.
void MeasureSet::Account::give_rms_gradient(MeasureResult& result, double value) const {
  const double duration = rows_ > 0 ? static_cast<double>(rows_) : duration_;
  for (std::size_t p = 0; p < parameters_ && p < squares_gradient_.size(); ++p) {
    const double by_itself = std::sqrt(squared_slopes_[p] / duration);
    if (value == 0 && by_itself == 0) continue;
    result.gradient[p] = squares_gradient_[p] / (2 * value * duration);
    if (!(value <= zero_but_for_rounding * by_itself)) continue;
    result.gradient[p] = none;
    result.trouble = fmt::format(
        "its column is zero throughout, and grows on both sides of the present value of a parameter, by {:.3g} a unit: "
        "a root mean square has a kink there",
        by_itself);
  }
}

void MeasureSet::Account::give_path(MeasureResult& result) const {
  const double n = static_cast<double>(request_.points.size());
  double squares = 0;
  std::vector<double> gradient(parameters_, 0.0);
  for (std::size_t k = 0; k < request_.points.size(); ++k) {
    if (request_.timed ? !instants_[k].sample : extremes_[k].empty()) {
      const bool undefined = !request_.timed && extremes_[k].undefined();
      result.trouble = undefined ? not_a_number_at(*extremes_[k].undefined())
                                 : fmt::format("the motion ended before its point number {}", k + 1);
      return;
    }
    if (!request_.timed && extremes_[k].undefined() && result.trouble.empty())
      result.trouble = "it is taken where its columns are numbers: " + not_a_number_at(*extremes_[k].undefined());
    const MotionSample& sample = request_.timed ? *instants_[k].sample : extremes_[k].best();
    const double x = sample.value[column_] - request_.points[k].x, y = sample.value[second_] - request_.points[k].y;
    squares += x * x + y * y;
    for (std::size_t p = 0; p < parameters_; ++p)
      gradient[p] += x * gradient_of(sample, column_, p) + y * gradient_of(sample, second_, p);
  }
  result.value = std::sqrt(squares / n);
  for (std::size_t p = 0; p < parameters_; ++p) result.gradient[p] = gradient[p] / (n * *result.value);
  if (*result.value == 0 && parameters_ > 0)
    result.trouble = "all its points are met exactly: a distance has a kink there";
}

MeasureResult MeasureSet::Account::result(const ColumnInfo& column, bool looked) const {
  MeasureResult result;
  result.name = request_.name;
  result.unit = column.unit_text();
  result.times_second = request_.kind == MeasureKind::integral;
  result.gradient.resize(parameters_, 0.0);
  result.of_rows_alone = rows_ > 0;
  switch (request_.kind) {
    case MeasureKind::maximum:
    case MeasureKind::minimum:
      give_extreme(result, extremes_[0], 1);
      break;
    case MeasureKind::range:
      give_extreme(result, extremes_[0], 1);
      give_extreme(result, extremes_[1], -1);
      result.t.reset();
      break;
    case MeasureKind::first:
      if (first_) give(result, *first_);
      break;
    case MeasureKind::final:
      if (last_) give(result, *last_);
      break;
    case MeasureKind::at:
      if (instants_[0].sample)
        give(result, *instants_[0].sample);
      else
        result.trouble = fmt::format(
            "t = {:.9g} s is {}", instants_[0].t,
            rows_ > 0 ? "at none of its rows, and the motion is not looked at between them" : "not within the motion");
      break;
    case MeasureKind::path:
      give_path(result);
      break;
    case MeasureKind::mean:
    case MeasureKind::rms:
    case MeasureKind::integral:
      if (looked) give_integral(result);
      break;
    case MeasureKind::field:
      break;
  }
  if (parameters_ > 0 && result.value) tell_switches(result);
  if (!looked && wants_samples() && result.trouble.empty())
    result.trouble = "the motion could not be looked at everywhere between its rows";
  if (result.value && !std::isfinite(*result.value)) {
    if (result.trouble.empty()) {
      result.trouble = result.t ? not_a_number_at(*result.t) : "its column is not a number everywhere";
    }
    result.value.reset();
    result.t.reset();
  }
  if (!result.value) {
    std::fill(result.gradient.begin(), result.gradient.end(), none);
    if (result.trouble.empty()) result.trouble = "the run ended before there was anything to measure";
  }
  return result;
}

}  // namespace catena
