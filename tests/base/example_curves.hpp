// Curves that several tests share.
#pragma once

#include <limits>
#include <numbers>
#include <vector>

#include "catena/base/curve.hpp"

namespace catena::test_curves {

inline constexpr double pi = std::numbers::pi, infinity = std::numeric_limits<double>::infinity();
using C = Curve<double>;
using D = Dual<double, 4>;
using Points = std::vector<Vec2<double>>;

inline C through(const Points& points, SplineEnd end) { return C::spline(points, end); }
inline C egg(const std::vector<double>& angles, const std::vector<double>& radii) { return C::polar(angles, radii); }

inline C open_curve() { return through({{0, 0}, {1, 0.5}, {1.5, 2}, {3, 2.5}, {4, 1}}, SplineEnd::natural); }
inline C closed_curve() { return through({{1, 0}, {0.25, 1}, {-1, 0.3}, {-0.4, -0.8}}, SplineEnd::periodic); }
inline C cam() { return egg({-0.5, 0.5, 1.7, 3.0, 4.4}, {1.0, 1.3, 1.1, 0.9, 0.95}); }

}  // namespace catena::test_curves
