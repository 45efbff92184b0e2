// Numbers of random signs and sizes with which equations are disturbed to see what their rounding does: the same in
// every run.
//
// Rounding errors of a sum of terms are spread over +-eps of them: uniform, with a standard deviation of 1/sqrt(3).
// Source of the recurrence: S. Vigna, "An experimental exploration of Marsaglia's xorshift generators" (2016).
#pragma once

#include <cstdint>
#include <limits>

namespace catena {

class Disturbance {
 public:
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  /// So many times their rounding equations are off, so that differences have six digits or more.
  static constexpr double amplification = 0x1p20;
  /// Standard deviations of the few disturbed values: the largest of a run's errors is about as far out.
  static constexpr double deviations = 2;
  static constexpr int disturbed_values = 3;
  /// Some dozens of solves and a few factorizations tell digits: up to so many columns, that is a millisecond or two,
  /// and what is kept for them little memory.
  static constexpr int most_columns = 3000;
  /// A place that a disturbance moves further, in length scales, rad or the measure of path_system.hpp, or rates by
  /// this part of the largest, is not judged by it: K changes along the way, and what is of second order shows.
  static constexpr double largest_way = 1e-5;
  /// How far places are moved along an error to see what that does, length scales or rad, and how far drivers go in a
  /// change of time: rounding then takes ten digits off.
  static constexpr double shift = 1e-6;
  /// Of the rounding of a balance, which is a bound: with all of it claims were optimistic by 1 at most, and half of
  /// them pessimistic by 92 and more, over 275 random mechanisms.
  static constexpr double usual_rounding = 0.5;

  /// Between -1 and 1.
  double next() {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return static_cast<double>(static_cast<std::int64_t>(state_ * 0x2545f4914f6cdd1dULL)) * 0x1p-63;
  }

 private:
  std::uint64_t state_ = 0x9e3779b97f4a7c15ULL;
};

}  // namespace catena
