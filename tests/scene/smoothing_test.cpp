// Smoothing against dense algebra of the defining problem, and known limits.
#include "catena/scene/reading/smoothing.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <random>

#include "catena/base/spline.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

using Columns = std::vector<std::vector<double>>;

/// The integral of the squared second derivative of the spline through the values: linear in each piece.
double bending(const std::vector<double>& x, const std::vector<double>& y, SplineEnd end) {
  const Spline<double> spline(x, y, end);
  double sum = 0;
  for (std::size_t k = 1; k < x.size(); ++k) {
    const double h = x[k] - x[k - 1], a = spline.continue_from(x[k - 1], true, x[k - 1]).d2,
                 b = spline.continue_from(x[k], false, x[k]).d2;
    sum += h * (a * a + a * b + b * b) / 3;
  }
  return sum;
}

std::vector<double> uneven(int n, std::mt19937_64& random) {
  std::vector<double> x{0.3};
  std::uniform_real_distribution<double> step(0.01, 0.2);
  while (static_cast<int>(x.size()) < n) x.push_back(x.back() + step(random));
  return x;
}

// No neighbour with as small a misfit bends less: the found curve is the least of its kind.
TEST(Smoothing, BendsLeastOfAllThatAreAsClose) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  for (const bool periodic : {false, true}) {
    SCOPED_TRACE(periodic);
    const SplineEnd end = periodic ? SplineEnd::periodic : SplineEnd::natural;
    const std::vector<double> x = uneven(40, random);
    std::vector<double> y;
    for (const double at : x)
      y.push_back(std::sin(2 * std::numbers::pi * (at - x.front()) / (x.back() - x.front())) + noise(random));
    if (periodic) y.back() = y.front();
    const Smoothed smoothed = smooth_values(x, Columns{y}, 0.015, periodic);
    EXPECT_NEAR(smoothed.rms, 0.015, 1e-10);
    const std::size_t n = periodic ? x.size() - 1 : x.size();
    const std::vector<double>& f = smoothed.values.front();
    double sum = 0, largest = 0;
    for (std::size_t k = 0; k < n; ++k) {
      sum += (f[k] - y[k]) * (f[k] - y[k]);
      largest = std::max(largest, std::abs(f[k] - y[k]));
    }
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(n)), 0.015, 1e-10);
    EXPECT_NEAR(smoothed.largest, largest, 1e-15);
    const double least = bending(x, f, end);
    EXPECT_LT(least, bending(x, y, end));
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<double> other = f;
      for (std::size_t k = 0; k < n; ++k) other[k] += 1e-4 * noise(random);
      double off = 0;
      for (std::size_t k = 0; k < n; ++k) off += (other[k] - y[k]) * (other[k] - y[k]);
      const double back = std::sqrt(sum / off);
      for (std::size_t k = 0; k < n; ++k) other[k] = y[k] + back * (other[k] - y[k]);
      if (periodic) other.back() = other.front();
      EXPECT_GE(bending(x, other, end), least * (1 - 1e-9));
    }
  }
}

TEST(Smoothing, EndsAtTheStraightLineOfLeastSquares) {
  std::mt19937_64 random(9);
  const std::vector<double> x = uneven(25, random);
  std::vector<double> y;
  for (std::size_t k = 0; k < x.size(); ++k) y.push_back(2 - 3 * x[k] + (k % 2 ? 0.1 : -0.1));
  Eigen::MatrixXd a(25, 2);
  Eigen::VectorXd b(25);
  for (int k = 0; k < 25; ++k) {
    a.row(k) << 1, x[static_cast<std::size_t>(k)];
    b[k] = y[static_cast<std::size_t>(k)];
  }
  const Eigen::VectorXd line = LeastSquares<double>(a).solve(b);
  const Smoothed smoothed = smooth_values(x, Columns{y}, 10, false);
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(smoothed.values[0][k], line[0] + line[1] * x[k], 1e-9);
  EXPECT_LT(smoothed.rms, 0.11);
}

TEST(Smoothing, OfNothingLeavesValuesAsTheyAre) {
  const std::vector<double> x{0, 1, 2, 3}, y{1, -1, 4, 0};
  EXPECT_EQ(smooth_values(x, Columns{y}, 0, false).values[0], y);
  EXPECT_THROW(smooth_values(x, Columns{{1, 2}}, 0.1, false), std::invalid_argument);
  EXPECT_THROW(smooth_values(x, Columns{y}, 0.1, true), std::invalid_argument);
  EXPECT_THROW(smooth_values(std::vector<double>{0, 0, 1, 2}, Columns{y}, 0.1, false), std::invalid_argument);
  EXPECT_THROW(smooth_values(x, Columns{{1, std::nan(""), 2, 3}}, 0.1, false), std::invalid_argument);
}

// Two coordinates along a closed curve: a noisy circle becomes rounder, and stays closed.
TEST(Smoothing, OfAClosedCurveKeepsItClosed) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 1e-3);
  std::vector<double> u;
  std::vector<std::vector<double>> points(2);
  for (int k = 0; k <= 72; ++k) {
    const double angle = k * std::numbers::pi / 36;
    u.push_back(angle);
    points[0].push_back(std::cos(angle) + noise(random));
    points[1].push_back(std::sin(angle) + noise(random));
  }
  points[0].back() = points[0].front();
  points[1].back() = points[1].front();
  double noisy = 0;
  for (std::size_t k = 0; k + 1 < u.size(); ++k)
    noisy += std::pow(points[0][k] - std::cos(u[k]), 2) + std::pow(points[1][k] - std::sin(u[k]), 2);
  const Smoothed smoothed = smooth_values(u, points, std::sqrt(noisy / 72), true);
  // The radius becomes even; that it shrinks by about the noise is the price of the least bending.
  const auto unevenness = [&](const std::vector<std::vector<double>>& of) {
    double sum = 0, squares = 0;
    for (std::size_t k = 0; k + 1 < u.size(); ++k) {
      const double off = std::hypot(of[0][k], of[1][k]) - 1;
      sum += off;
      squares += off * off;
    }
    return squares / 72 - sum * sum / (72 * 72);
  };
  EXPECT_LT(unevenness(smoothed.values), unevenness(points) / 4);
  EXPECT_EQ(smoothed.values[0].front(), smoothed.values[0].back());
}

}  // namespace
}  // namespace catena::testing
