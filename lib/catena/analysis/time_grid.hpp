// The instants at which an analysis gives rows.
//
// Row k is at first + k every (multiplied, never accumulated), one more at `until` if that is no multiple; or the
// instants are listed. Units: s.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace catena {

class TimeGrid {
 public:
  /// One row at t.
  static TimeGrid instant(double t) { return TimeGrid({t}); }
  static TimeGrid list(std::vector<double> times) { return TimeGrid(std::move(times)); }
  /// Rows at k every for k = 0, 1, ... within [from, until], and at `from` and `until` themselves. every > 0.
  static TimeGrid range(double from, double until, double every) {
    TimeGrid grid({});
    grid.from_ = from;
    grid.until_ = until;
    grid.every_ = every;
    // A multiple that misses an end by rounding only counts as the end itself.
    const double slack = 1e-9;
    grid.first_ = static_cast<std::int64_t>(std::floor(from / every + slack)) + 1;
    grid.last_ = static_cast<std::int64_t>(std::ceil(until / every - slack)) - 1;
    return grid;
  }

  /// The instants from number `first` on.
  TimeGrid from_row(std::int64_t first) const {
    TimeGrid rest = *this;
    rest.skipped_ += first;
    return rest;
  }

  std::int64_t size() const { return all() - skipped_; }
  double operator[](std::int64_t k) const { return at(k + skipped_); }
  double last() const { return at(all() - 1); }
  /// The first and the last instant in time; lists may be in any order.
  double earliest() const { return every_ == 0 ? *std::min_element(times_.begin(), times_.end()) : from_; }
  double latest() const { return every_ == 0 ? *std::max_element(times_.begin(), times_.end()) : until_; }

 private:
  explicit TimeGrid(std::vector<double> times) : times_(std::move(times)) {}
  std::int64_t all() const {
    if (every_ == 0) return static_cast<std::int64_t>(times_.size());
    if (until_ <= from_) return 1;
    return (last_ >= first_ ? last_ - first_ + 1 : 0) + 2;
  }
  double at(std::int64_t k) const {
    if (every_ == 0) return times_[static_cast<std::size_t>(k)];
    if (k == 0) return from_;
    if (k == all() - 1) return until_;
    return static_cast<double>(first_ + k - 1) * every_;
  }

  std::vector<double> times_;
  double from_ = 0, until_ = 0, every_ = 0;
  std::int64_t first_ = 0, last_ = 0, skipped_ = 0;
};

}  // namespace catena
