// Linear complementarity and minima over polytopes by pivots: answers keep their own conditions, small ones are held
// against all choices there are.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <random>
#include <vector>

#include "catena/linalg/pivoting/lemke.hpp"
#include "catena/linalg/pivoting/vertex_minimum.hpp"
#include "references/dense.hpp"

namespace catena {
namespace {

std::vector<double> draw(std::mt19937& engine, std::size_t count, double from, double to) {
  std::uniform_real_distribution<double> number(from, to);
  std::vector<double> drawn(count);
  for (double& value : drawn) value = number(engine);
  return drawn;
}

/// B B^T, of the rank of B, row by row.
std::vector<double> semidefinite(std::mt19937& engine, std::size_t size, std::size_t rank) {
  const std::vector<double> B = draw(engine, size * rank, -1, 1);
  std::vector<double> M(size * size, 0.0);
  for (std::size_t r = 0; r < size; ++r) {
    for (std::size_t c = 0; c < size; ++c) {
      for (std::size_t k = 0; k < rank; ++k) M[r * size + c] += B[r * rank + k] * B[c * rank + k];
    }
  }
  return M;
}

TEST(Lemke, SolvesSemidefiniteProblemsThatHaveASolution) {
  std::mt19937 engine(1);
  for (int n = 0; n < 400; ++n) {
    SCOPED_TRACE(n);
    const std::size_t size = 1 + static_cast<std::size_t>(n) % 30, rank = 1 + static_cast<std::size_t>(n) % 7;
    const std::vector<double> M = semidefinite(engine, size, rank);
    // q = p - M y with p, y >= 0: w = p at z = y, so that it is feasible.
    std::vector<double> q = draw(engine, size, 0, 1);
    const std::vector<double> y = draw(engine, size, 0, 2);
    for (std::size_t r = 0; r < size; ++r) {
      for (std::size_t c = 0; c < size; ++c) q[r] -= M[r * size + c] * y[c];
    }
    std::vector<double> z(size);
    ASSERT_TRUE(lemke(M, q, z));
    for (std::size_t r = 0; r < size; ++r) {
      double w = q[r];
      for (std::size_t c = 0; c < size; ++c) w += M[r * size + c] * z[c];
      EXPECT_GE(z[r], 0);
      EXPECT_GE(w, -1e-9);
      EXPECT_NEAR(w * z[r], 0, 1e-8);
    }
  }
}

TEST(Lemke, EndsOnARayWhereNothingHelps) {
  // w_1 = z_1 - 1, w_2 = -z_1 - 1: never both positive.
  const std::vector<double> M{1, 0, -1, 0}, q{-1, -1};
  std::vector<double> z(2);
  EXPECT_FALSE(lemke(M, q, z));
}

TEST(Lemke, LeavesAloneWhatIsSolvedAtZero) {
  const std::vector<double> M{0, 1, -1, 0}, q{0, 2};
  std::vector<double> z(2, 1.0);
  ASSERT_TRUE(lemke(M, q, z));
  EXPECT_EQ(z, (std::vector<double>{0, 0}));
}

/// The least over all choices of columns; infinity: the polytope is empty.
double least_of_all(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, const std::vector<double>& a) {
  double least = std::numeric_limits<double>::infinity();
  const auto columns = static_cast<std::size_t>(A.cols());
  for (std::size_t choice = 0; choice < (std::size_t{1} << columns); ++choice) {
    std::vector<Eigen::Index> chosen;
    for (std::size_t c = 0; c < columns; ++c) {
      if (choice >> c & 1u) chosen.push_back(static_cast<Eigen::Index>(c));
    }
    if (static_cast<Eigen::Index>(chosen.size()) != A.rows()) continue;
    Eigen::MatrixXd square(A.rows(), A.rows());
    for (Eigen::Index c = 0; c < square.cols(); ++c) square.col(c) = A.col(chosen[static_cast<std::size_t>(c)]);
    if (std::abs(catena::testing::ReferenceFactors<double>(square).determinant()) < 1e-9) continue;
    const Eigen::VectorXd w = catena::testing::solve<double>(square, b);
    if (w.minCoeff() < -1e-10) continue;
    double value = 0;
    for (Eigen::Index c = 0; c < w.size(); ++c)
      value += a[static_cast<std::size_t>(chosen[static_cast<std::size_t>(c)])] * w(c);
    least = std::min(least, value);
  }
  return least;
}

TEST(VertexMinimum, IsThatOfAllCorners) {
  std::mt19937 engine(2);
  int empty = 0;
  for (int n = 0; n < 200; ++n) {
    SCOPED_TRACE(n);
    const Eigen::Index columns = 4 + n % 7, rows = 2 + n % 3;
    const std::vector<double> drawn = draw(engine, static_cast<std::size_t>((rows - 1) * columns), -1, 1);
    Eigen::MatrixXd A(rows, columns);
    for (Eigen::Index c = 0; c < columns; ++c) {
      for (Eigen::Index r = 0; r + 1 < rows; ++r) A(r, c) = drawn[static_cast<std::size_t>(c * (rows - 1) + r)];
      A(rows - 1, c) = 1;  // the sum of all is one
    }
    const Eigen::VectorXd b = Eigen::VectorXd::Unit(rows, rows - 1);
    VertexMinimum polytope({A.data(), static_cast<std::size_t>(A.size())},
                           {b.data(), static_cast<std::size_t>(b.size())});
    for (int search = 0; search < 5; ++search) {
      const std::vector<double> a = draw(engine, static_cast<std::size_t>(columns), -1, 1);
      const double least = least_of_all(A, b, a);
      ASSERT_EQ(polytope.empty(), std::isinf(least));
      if (polytope.empty()) break;
      EXPECT_NEAR(polytope.least(a).value(), least, 1e-9);
      EXPECT_LE(polytope.support().size(), static_cast<std::size_t>(rows));
    }
    empty += polytope.empty();
  }
  EXPECT_GT(empty, 10);
  EXPECT_LT(empty, 150);
}

TEST(VertexMinimum, MayHaveRowsThatRepeatEachOther) {
  const std::vector<double> A{1, 1, 2, 2, 1, 1}, b{1, 1};  // w_1 + 2 w_2 + w_3 = 1, twice
  VertexMinimum polytope(A, b);
  ASSERT_FALSE(polytope.empty());
  EXPECT_NEAR(polytope.least(std::vector<double>{3, 4, 5}).value(), 2, 1e-12);
  EXPECT_EQ(polytope.support(), std::vector<std::size_t>{1});
}

}  // namespace
}  // namespace catena
