// The instants at which an analysis gives rows.
//
// Instants that are not finite, and steps that do not advance, throw std::invalid_argument; row numbers out of range
// throw std::out_of_range. Row k is at first + k every (multiplied, never accumulated), one more at `until` if that is
// no multiple; or the instants are listed. Units: s.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace catena {

class TimeGrid {
 public:
  /// One row at t.
  static TimeGrid instant(double t) { return list({t}); }
  static TimeGrid list(std::vector<double> times) {
    for (const double t : times) require_instant(t);
    return TimeGrid(std::move(times));
  }
  /// Rows at k every for k = 0, 1, ... within [from, until], and at `from` and `until` themselves. every > 0.
  static TimeGrid range(double from, double until, double every) {
    require_instant(from);
    require_instant(until);
    if (!(every > 0) || !std::isfinite(every)) throw std::invalid_argument("rows must be a time above zero apart");
    // More than a signed 64-bit number of rows cannot be counted, let alone computed.
    if (std::max(std::abs(from), std::abs(until)) / every > 1e18)
      throw std::invalid_argument("rows are too close together to be counted");
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
    if (first < 0 || first > size()) refuse_row(first);
    TimeGrid rest = *this;
    rest.skipped_ += first;
    return rest;
  }

  std::int64_t size() const { return all() - skipped_; }
  double operator[](std::int64_t k) const {
    if (k < 0 || k >= size()) refuse_row(k);
    return at(k + skipped_);
  }
  /// Of the rows there are; these three are for grids that have some.
  double last() const {
    require_rows();
    return at(all() - 1);
  }
  /// The first and the last instant in time; lists may be in any order.
  double earliest() const {
    require_rows();
    return every_ == 0 ? *std::min_element(times_.begin(), times_.end()) : from_;
  }
  double latest() const {
    require_rows();
    return every_ == 0 ? *std::max_element(times_.begin(), times_.end()) : until_;
  }

 private:
  explicit TimeGrid(std::vector<double> times) : times_(std::move(times)) {}
  static void require_instant(double t) {
    if (!std::isfinite(t)) throw std::invalid_argument("an instant at which a row is wanted is not finite");
  }
  void require_rows() const {
    if (all() < 1) throw std::out_of_range("there are no instants at which rows are wanted");
  }
  [[noreturn]] void refuse_row(std::int64_t k) const {
    throw std::out_of_range("there is no row number " + std::to_string(k) + " among " + std::to_string(size()));
  }
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
