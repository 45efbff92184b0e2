// A motion by different laws, one after the other, in long double: it steps to the instants at which they change, where
// a margin passes zero, found by bisection to rounding.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "stress/dense_mechanism.hpp"

namespace catena::testing {

/// A motion by different laws, one after the other: each ends where one of its margins is no longer positive.
struct MotionOfLaws {
  std::function<Vector(int law, const Vector& y)> slope;
  std::function<std::vector<Real>(int law, const Vector& y)> margins;
  /// The law that follows where margin `which` is zero; velocities may be told anew.
  std::function<int(int law, std::size_t which, Vector& y)> next;
  Vector scale, y;
  int law = 0;
  Real pace = 1;  ///< a stretch in which a law changes once at most, s
  Real t = 0;

  Vector after(Real h) const {
    const auto rate = [this](Real, const Vector& at) { return slope(law, at); };
    Extrapolation motion(rate, y, scale, pace, 1e-17L);
    return motion.go_to(h, 400) ? motion.y() : Vector::Constant(y.size(), std::nan(""));
  }
  std::size_t least(const Vector& at) const {
    const std::vector<Real> all = margins(law, at);
    return static_cast<std::size_t>(std::min_element(all.begin(), all.end()) - all.begin());
  }
  /// False where it is lost.
  bool go_to(Real end) {
    while (t < end) {
      const bool last = end - t <= pace;
      Real h = last ? end - t : pace;
      Vector there = after(h);
      if (!there.allFinite()) return false;
      const bool changes = margins(law, there)[least(there)] < 0;
      if (changes) {
        Real low = 0;
        for (int k = 0; k < 70; ++k) {
          const Real middle = (low + h) / 2;
          const Vector between = after(middle);
          (margins(law, between)[least(between)] < 0 ? h : low) = middle;
        }
        there = after(h);
      }
      y = there;
      t = last && !changes ? end : t + h;
      if (changes) law = next(law, least(there), y);
    }
    return y.allFinite();
  }
};

}  // namespace catena::testing
