// The parallelogram of the tests of singular configurations: crank and rocker 0.1 m, coupler and ground 0.3 m. It lies
// flat where its crank points along the ground; there it may become an antiparallelogram.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/linkages.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"

namespace catena::testing {

inline constexpr Needs everything{.velocity = true, .acceleration = true};
inline constexpr FourBar parallelogram{.a = 0.1, .b = 0.3, .c = 0.1, .d = 0.3};

inline std::size_t angle_place(const Snapshot& s, const char* body) {
  const int b = s.evaluator.model().find_body(body);
  return static_cast<std::size_t>(3 * s.evaluator.plan().plan_body[static_cast<std::size_t>(b)] + 2);
}

inline double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// Rates of the rocker and the coupler along a tangent.
inline std::array<double, 2> rates(Kinematics& kinematics, const Model& model, const std::vector<double>& tangent) {
  const auto rate = [&](const char* name) {
    return tangent[static_cast<std::size_t>(
        3 * kinematics.plan().plan_body[static_cast<std::size_t>(model.find_body(name))] + 2)];
  };
  return {rate("rocker"), rate("coupler")};
}

/// Largest error of q, qd, qdd of a parallelogram's rocker and coupler that stays one, its crank turning as `crank`.
struct Errors {
  double position = 0, velocity = 0, acceleration = 0;

  void add(const Snapshot& s, const Taylor<double>& crank) {
    const std::size_t rocker = angle_place(s, "rocker"), coupler = angle_place(s, "coupler");
    position = std::max({position, std::abs(wrapped(s.q[rocker] - crank.f)), std::abs(wrapped(s.q[coupler]))});
    if (s.qd.empty()) return;
    velocity = std::max({velocity, std::abs(s.qd[rocker] - crank.d), std::abs(s.qd[coupler])});
    // The coupler's middle moves like the crank's end.
    const double a = parallelogram.a, x = -a * (crank.dd * std::sin(crank.f) + crank.d * crank.d * std::cos(crank.f));
    acceleration = std::max({acceleration, std::abs(s.qdd[rocker] - crank.dd), std::abs(s.qdd[coupler]),
                             std::abs(s.qdd[coupler - 2] - x) / a});
  }
};

}  // namespace catena::testing
