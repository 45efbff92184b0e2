#include "catena/linalg/rank/nonnegative_least_squares.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <vector>

namespace catena {
namespace {

// |A x + b| <= c eps |A| |x| of a stable solution of some dozen equations (Golub, Van Loan, Matrix Computations, 5.3).
constexpr double rounding_of_solution = 16 * std::numeric_limits<double>::epsilon();

}  // namespace

double nonnegative_least_squares(std::span<const double> entries, std::span<const double> right,
                                 std::span<double> coefficients) {
  const auto rows = static_cast<Eigen::Index>(right.size()), n = static_cast<Eigen::Index>(coefficients.size());
  const Eigen::Map<const Eigen::MatrixXd> A(entries.data(), rows, n);
  const Eigen::Map<const Eigen::VectorXd> b(right.data(), rows);
  Eigen::Map<Eigen::VectorXd> x(coefficients.data(), n);
  x.setZero();
  std::vector<char> used(static_cast<std::size_t>(n), 0);
  const auto solve_used = [&](Eigen::VectorXd& s) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index c = 0; c < n; ++c)
      if (used[static_cast<std::size_t>(c)]) columns.push_back(c);
    Eigen::MatrixXd part(A.rows(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) part.col(static_cast<Eigen::Index>(k)) = A.col(columns[k]);
    const Eigen::VectorXd solution = part.completeOrthogonalDecomposition().solve(-b);
    s.setZero(n);
    for (std::size_t k = 0; k < columns.size(); ++k) s(columns[k]) = solution(static_cast<Eigen::Index>(k));
  };
  const double size = A.norm(), of_right = 1e-13 * size * b.norm();
  for (Eigen::Index outer = 0; outer < 3 * n; ++outer) {
    // Of large coefficients, as columns have that nearly depend on each other, the residual is known less exactly.
    const double rounding = of_right + rounding_of_solution * size * size * x.norm();
    const Eigen::VectorXd slope = -(A.transpose() * (A * x + b));
    Eigen::Index enters = -1;
    for (Eigen::Index c = 0; c < n; ++c) {
      if (!used[static_cast<std::size_t>(c)] && slope(c) > rounding && (enters < 0 || slope(c) > slope(enters)))
        enters = c;
    }
    if (enters < 0) break;
    used[static_cast<std::size_t>(enters)] = 1;
    Eigen::VectorXd s;
    for (Eigen::Index inner = 0; inner <= n; ++inner) {
      solve_used(s);
      double part = 1;
      for (Eigen::Index c = 0; c < n; ++c) {
        if (used[static_cast<std::size_t>(c)] && s(c) < 0) part = std::min(part, x(c) / (x(c) - s(c)));
      }
      x += part * (s - x);
      if (part == 1) break;
      for (Eigen::Index c = 0; c < n; ++c) {
        if (used[static_cast<std::size_t>(c)] && x(c) <= 1e-15 * x.lpNorm<Eigen::Infinity>()) {
          used[static_cast<std::size_t>(c)] = 0;
          x(c) = 0;
        }
      }
    }
  }
  return (A * x + b).norm();
}

}  // namespace catena
