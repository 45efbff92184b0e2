// Smoothing splines: measured values replaced by those of the smoothest curve that keeps close to them.
//
//   min sum_c integral f_c''(x)^2 dx      such that      sum_k sum_c (f_c(x_k) - y_kc)^2 = n s^2
//
// f is the natural (or periodic) cubic spline through the values found, so that the interpolating spline of the result
// is the smoothing spline itself. For a weight w of the misfits
//
//   (R + w Q^T Q) M = Q^T y        f = y - w Q M
//
// with M the second derivatives at the knots, Q^T the second divided differences (times 6, see spline.hpp) and R the
// spline's matrix; w is found such that the misfit is s. Where the straight line of least squares (periodic: the mean)
// misses by less than s it is the answer. Source: C. Reinsch, Smoothing by spline functions, Numer. Math. 10 (1967);
// P. Green, B. Silverman, Nonparametric Regression (1994), sections 2.3 and 2.5.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace catena {

struct Smoothed {
  std::vector<std::vector<double>> values;  ///< per column
  double rms = 0;                           ///< root mean square of the distances from what was given
  double largest = 0;                       ///< largest distance
  std::size_t worst = 0;                    ///< of this point
};

/// Columns over the same knots, smoothed together: a distance is that over all columns. `rms` >= 0: what is allowed,
/// in the unit of the columns; 0 leaves them as they are. Periodic: the last point is the first one again. Throws
/// std::invalid_argument for knots that do not increase, numbers that are not finite, lengths that differ, fewer than 3
/// points or periodic ends that differ.
Smoothed smooth_values(std::span<const double> knots, std::span<const std::vector<double>> columns, double rms,
                       bool periodic);

}  // namespace catena
