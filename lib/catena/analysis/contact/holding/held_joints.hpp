// Friction of joints among the forces that may hold a position (holding.hpp).
//
//   |T| <= u mu_static N        revolute: N = radius |(F_1, F_2)|        translational: N = |F_1| + |F_2| / (length /
//   2)
//
// What a joint can do is no convex cone, but it is made of such: with a slope g of N, N >= g . F everywhere, and equal
// where F lies along g, so that
//
//   |T| <= u mu_static g . F        edges: d + u mu_static T, d - u mu_static T, l, -l        g . d = 1, g . l = 0
//
// lies inside of it and touches it along F. The forces found with one g give the next one, with which u is not larger
// (A. Beck, A. Ben-Tal, L. Tetruashvili, Journal of Global Optimization 47 (2010), 29-51, on such inner cones). Units:
// N, N m; forces as columns of the plan.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "catena/analysis/contact/contact_points.hpp"

namespace catena {

/// A force over the plan's columns.
using ForceColumn = std::vector<double>;

/// a x + b y.
inline ForceColumn sum_of(double a, const ForceColumn& x, double b, const ForceColumn& y) {
  ForceColumn sum(x.size());
  for (std::size_t c = 0; c < sum.size(); ++c) sum[c] = a * x[c] + b * y[c];
  return sum;
}

class HeldJoint {
 public:
  /// Of the cone of its forces: along the slope with friction to either side, and across it both ways.
  static constexpr std::size_t edges = 4;
  /// Slopes from which a search begins.
  static constexpr int slopes = 8;

  /// `first`, `second`: of a multiplier of one; `along`: of a friction of one.
  HeldJoint(ForceColumn first, ForceColumn second, ForceColumn along, const ContactPoint& point, bool guide)
      : part_{std::move(first), std::move(second)},
        along_(std::move(along)),
        friction_(point.mu_static),
        radius_(point.radius),
        half_length_(point.half_length),
        guide_(guide) {
    press({0, 0});
  }

  const ForceColumn& part(std::size_t k) const { return part_[k]; }
  const ForceColumn& along() const { return along_; }

  /// The slope is that of N at this force.
  void press(const std::array<double, 2>& force) {
    if (guide_) {
      const double a = std::copysign(1.0, force[0]), b = std::copysign(1.0, force[1]);
      // Of a guide without a length the moment presses nothing.
      const bool turns = std::isfinite(half_length_);
      across_ = turns ? std::array{a / 2, b * half_length_ / 2} : std::array{a, 0.0};
      beside_ = turns ? std::array{a, -b * half_length_} : std::array{0.0, 1.0};
      return;
    }
    const double size = std::hypot(force[0], force[1]);
    const std::array<double, 2> e = size > 0 ? std::array{force[0] / size, force[1] / size} : std::array{1.0, 0.0};
    across_ = {e[0] / radius_, e[1] / radius_};
    beside_ = {-e[1], e[0]};
  }
  /// The slope number k of those from which a search begins.
  void press_at(int k) {
    const double angle = 2 * std::numbers::pi * (k % slopes + 0.5) / slopes;
    press({std::cos(angle), std::sin(angle)});
  }

  /// Without friction a joint takes any force.
  ForceColumn edge(std::size_t k, double u) const {
    const double side = k % 2 == 0 ? 1 : -1;
    if (k >= 2) return sum_of(side * beside_[0], part_[0], side * beside_[1], part_[1]);
    const double sense = u == 0 ? side : 1;
    return sum_of(1, sum_of(sense * across_[0], part_[0], sense * across_[1], part_[1]), side * u * friction_, along_);
  }
  /// The multipliers of so much of each edge, u > 0.
  std::array<double, 2> force(std::span<const double, edges> sizes) const {
    const double a = sizes[0] + sizes[1], b = sizes[2] - sizes[3];
    return {a * across_[0] + b * beside_[0], a * across_[1] + b * beside_[1]};
  }

 private:
  std::array<ForceColumn, 2> part_;
  ForceColumn along_;
  double friction_, radius_, half_length_;
  bool guide_;
  std::array<double, 2> across_{}, beside_{};  // d, l
};

}  // namespace catena
