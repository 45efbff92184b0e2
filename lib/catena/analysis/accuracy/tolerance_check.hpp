// How far a motion is off as a whole, in parts of its tolerance, from a second run with another one.
//
//   n = largest |q(asked) - q(other)| / |tolerance - other tolerance|      of all rows; lengths in length scales, rad
//
// Errors of places grow in proportion to the tolerance, so that n is the error in tolerances. Implicit methods judge
// each step by itself: errors of phase add up with the length of the motion, and n is not bounded. Of alpha on a spring
// it was 12.4 after 16 periods, and 280 after one turn of a Kepler ellipse, at all tolerances. Units: m, rad.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace catena {

class ToleranceCheck {
 public:
  /// Places of a row, three a body.
  void take(std::span<const double> q) {
    width_ = q.size();
    places_.insert(places_.end(), q.begin(), q.end());
  }
  std::size_t numbers() const { return places_.size(); }
  /// Every other row is left, from the first on.
  void thin_out() {
    const std::size_t left = width_ > 0 ? (places_.size() / width_ + 1) / 2 : 0;
    for (std::size_t row = 1; row < left; ++row)
      std::copy_n(places_.begin() + static_cast<std::ptrdiff_t>(2 * row * width_), width_,
                  places_.begin() + static_cast<std::ptrdiff_t>(row * width_));
    places_.resize(left * width_);
  }
  /// The largest difference of places, in length scales and rad, in rows that both runs have.
  double largest_difference(const ToleranceCheck& other, double length) const {
    double largest = 0;
    for (std::size_t k = 0; k < std::min(places_.size(), other.places_.size()); ++k) {
      const double unit = k % width_ % 3 == 2 ? 1 : length;
      const double difference = std::abs(places_[k] - other.places_[k]) / unit;
      if (!(difference <= largest)) largest = difference;
    }
    return largest;
  }

 private:
  std::size_t width_ = 0;
  std::vector<double> places_;
};

}  // namespace catena
