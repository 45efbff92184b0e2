// Least squares with coefficients that are not negative: the least |A x + b| over x >= 0.
//
// The active set method of Lawson and Hanson: columns enter by the steepest slope, and leave where their coefficient
// would become negative. A may have dependent columns. Dense, for some dozen columns. Source: Lawson and Hanson,
// Solving Least Squares Problems (1974), chapter 23.
#pragma once

#include <Eigen/Core>

namespace catena {

/// Returns |A x + b|; x has A.cols() entries.
double nonnegative_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, Eigen::VectorXd& x);

}  // namespace catena
