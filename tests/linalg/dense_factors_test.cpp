// Small matrices that are factored in full, against Eigen; right-hand sides in lanes, against numbers one by one.
#include "catena/linalg/kernels/dense_factors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

#include "catena/base/at.hpp"
#include "catena/linalg/kernels/lanes.hpp"
#include "linalg/counted_heap.hpp"
#include "linalg/matrices.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

/// Sparse, its rows of very different sizes, and no diagonal to speak of.
Eigen::MatrixXd scattered(int n, Random& random) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    const double size = std::pow(10.0, random.uniform(-6, 6));
    for (int j = 0; j < n; ++j) {
      const double value = random.uniform(-1, 1);
      if (random.uniform(0, 1) < 0.4 || j == (i + 1) % n) a(i, j) = size * value;
    }
  }
  return a;
}

bool factor(const Eigen::MatrixXd& a, DenseFactors& factors) {
  const int n = static_cast<int>(a.rows());
  const std::span<double> entries = factors.begin(n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) entries[at(n * i + j)] = a(i, j);
  }
  return factors.factorize();
}

Eigen::VectorXd drawn(int n, Random& random) {
  Eigen::VectorXd x(n);
  for (int k = 0; k < n; ++k) x[k] = random.uniform(-1, 1);
  return x;
}

TEST(DenseFactors, SolveBothWaysAsEigenDoes) {
  Random random(311);
  DenseFactors factors;
  int regular = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int n = 1 + random.below(24);
    const Eigen::MatrixXd a = scattered(n, random);
    // Eigen takes rows of very different sizes for dependent ones: it is given the scaled rows.
    const Eigen::VectorXd size = a.cwiseAbs().rowwise().maxCoeff().cwiseMax(1e-300);
    const Eigen::MatrixXd scaled = size.cwiseInverse().asDiagonal() * a;
    const double condition = 1 / ReferenceFactors<double>(scaled).reciprocal_condition();
    if (!(condition < 1e6)) continue;
    ++regular;
    ASSERT_TRUE(factor(a, factors)) << trial;
    EXPECT_GT(factors.rcond(), 1e-9) << trial;
    const Eigen::VectorXd b = drawn(n, random);
    Eigen::VectorXd x(n), y(n), side = b;
    factors.solve<double>(std::span<const double>(b.data(), at(n)), std::span<double>(x.data(), at(n)));
    factors.solve_transposed<double>(std::span<double>(side.data(), at(n)), std::span<double>(y.data(), at(n)));
    const Eigen::VectorXd found = solve<double>(scaled, b.cwiseQuotient(size));
    EXPECT_LE((x - found).cwiseAbs().maxCoeff(), 1e-14 * condition * found.cwiseAbs().maxCoeff()) << trial;
    const Eigen::VectorXd exact = size.cwiseInverse().asDiagonal() * solve<double>(scaled.transpose(), b);
    EXPECT_LE((y - exact).cwiseProduct(size).cwiseAbs().maxCoeff(),
              1e-14 * condition * exact.cwiseProduct(size).cwiseAbs().maxCoeff())
        << trial;
  }
  EXPECT_GT(regular, 100);
}

TEST(DenseFactors, RoundLanesAsNumbers) {
  Random random(312);
  DenseFactors factors;
  ASSERT_TRUE(factor(scattered(9, random) + Eigen::MatrixXd::Identity(9, 9), factors));
  std::array<Eigen::VectorXd, Lanes::count> sides;
  for (Eigen::VectorXd& side : sides) side = drawn(9, random);
  std::vector<Lanes> b(9), x(9);
  for (int lane = 0; lane < Lanes::count; ++lane) {
    for (std::size_t k = 0; k < 9; ++k) b[k].set(lane, sides[at(lane)][static_cast<Eigen::Index>(k)]);
  }
  factors.solve<Lanes>(b, x);
  for (int lane = 0; lane < Lanes::count; ++lane) {
    std::vector<double> own(9);
    factors.solve<double>(std::span<const double>(sides[at(lane)].data(), 9), own);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_EQ(x[k][lane], own[k]);
  }
}

TEST(DenseFactors, SayThatAMatrixIsSingular) {
  DenseFactors factors;
  Eigen::MatrixXd a(3, 3);
  a << 1, 2, 3, 2, 4, 6, 1, 0, 1;
  EXPECT_TRUE(!factor(a, factors) || factors.rcond() < 1e-15);
  EXPECT_FALSE(factor(Eigen::MatrixXd::Zero(2, 2), factors));
  a.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(factor(a, factors));
}

TEST(DenseFactors, AllocateNothingForMatricesNoLarger) {
  Random random(313);
  DenseFactors factors;
  const Eigen::MatrixXd a = scattered(12, random) + Eigen::MatrixXd::Identity(12, 12);
  factor(a, factors);
  HeapWatch watch;
  factor(a, factors);
  EXPECT_EQ(watch.count(), 0);
}

}  // namespace
}  // namespace catena::testing
