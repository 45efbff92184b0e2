// Least squares with coefficients that are not negative: the least |A x + b| over x >= 0.
//
// The active set method of Lawson and Hanson: columns enter by the steepest slope, and leave where their coefficient
// would become negative. A may have dependent columns. Dense, for some dozen columns. Source: Lawson and Hanson,
// Solving Least Squares Problems (1974), chapter 23.
#pragma once

#include <span>

namespace catena {

/// Returns |A x + b|. A: column by column, b.size() rows, x.size() columns.
double nonnegative_least_squares(std::span<const double> A, std::span<const double> b, std::span<double> x);

}  // namespace catena
