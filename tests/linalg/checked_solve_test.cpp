// Solves that are checked: refined, or made again by another kernel, where the residual is not good enough.
#include <gtest/gtest.h>

#include "catena/linalg/factorization/factorization.hpp"
#include "linalg/matrices.hpp"

namespace catena::testing {
namespace {

TEST(CheckedSolve, CostsOneSolveWhenTheResidualIsGood) {
  Random random(17);
  const Matrix matrix = dyad_chain(10, random);
  const int n = matrix.pattern.columns;
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::automatic, counters).ok());
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  const Eigen::VectorXd b = random_vector(n, random);
  Eigen::VectorXd x = b;
  const CheckedSolve outcome = factorization.solve_checked(matrix.values, {x.data(), x.data() + n}, counters);
  EXPECT_TRUE(outcome.ok());
  EXPECT_LE(outcome.residual, 1e-13);
  EXPECT_EQ(outcome.refinements, 0);
  EXPECT_FALSE(outcome.fell_back);
  EXPECT_EQ(counters.solves, 1);
  EXPECT_EQ(counters.fallbacks, 0);
}

/// A lower-triangular cascade within one block: with diagonal pivots of `pivot` every step of elimination multiplies
/// entries by 1 / pivot, so that threshold pivoting loses all digits while the matrix itself is well conditioned.
Matrix growing_matrix(int n, double pivot) {
  std::vector<Triplet> triplets;
  for (int i = 0; i < n; ++i) {
    triplets.push_back({i, i, pivot});
    triplets.push_back({i, (i + 1) % n, 1});
    triplets.push_back({(i + 1) % n, i, 1});
  }
  return assemble(n, n, triplets);
}

TEST(CheckedSolve, RefinesOrFallsBackWhenPivotsWereWeak) {
  const Matrix matrix = growing_matrix(41, 1.01e-3);
  const Eigen::MatrixXd a = dense(matrix);
  const int n = matrix.pattern.columns;
  Random random(18);
  const Eigen::VectorXd b = random_vector(n, random);
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::automatic, counters).ok());
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  Eigen::VectorXd plain = b;
  factorization.solve({plain.data(), plain.data() + n}, counters);
  Eigen::VectorXd x = b;
  const CheckedSolve outcome =
      factorization.solve_checked(matrix.values, {x.data(), x.data() + n}, counters, {.tolerance = 1e-15});
  EXPECT_LE(outcome.residual, 1e-14);
  EXPECT_GT(backward_error(a, plain, b), 1e-15) << "else there is nothing to mend";
  EXPECT_LT(backward_error(a, x, b), 1e-14);
  EXPECT_TRUE(outcome.refinements > 0 || outcome.fell_back);
  EXPECT_EQ(counters.fallbacks, outcome.fell_back ? 1 : 0);
}

TEST(CheckedSolve, CountsTheFallbackAndReturnsToKluAfterwards) {
  Random random(19);
  const Matrix matrix = random_matrix(50, 50, 3, random);
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::automatic, counters).ok());
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  const Eigen::VectorXd b = random_vector(50, random);
  Eigen::VectorXd x = b;
  // No kernel can meet a tolerance of zero for such a system: every rung of the ladder is climbed.
  const SolveCheck impossible{.tolerance = 0, .max_refinements = 1};
  const CheckedSolve outcome =
      factorization.solve_checked(matrix.values, {x.data(), x.data() + 50}, counters, impossible);
  EXPECT_EQ(outcome.status, FactorStatus::inaccurate);
  EXPECT_TRUE(outcome.fell_back);
  EXPECT_EQ(counters.fallbacks, 1);
  EXPECT_EQ(counters.factorizations, 2);
  EXPECT_LT(outcome.residual, 1e-14) << "the solution itself is as good as can be";
  const bool with_umfpack = is_compiled_in(Kernel::umfpack);
  EXPECT_EQ(factorization.kernel_in_use(), with_umfpack ? Kernel::umfpack : Kernel::klu);
  EXPECT_EQ(counters.symbolic, with_umfpack ? 2 : 1);

  x = b;
  factorization.solve({x.data(), x.data() + 50}, counters);
  EXPECT_LT(backward_error(dense(matrix), x, b), 1e-14);
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  EXPECT_EQ(factorization.kernel_in_use(), Kernel::klu);
}

TEST(CheckedSolve, AForcedKernelNeverFallsBack) {
  Random random(20);
  const Matrix matrix = random_matrix(50, 50, 3, random);
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::klu, counters).ok());
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  Eigen::VectorXd x = random_vector(50, random);
  const CheckedSolve outcome =
      factorization.solve_checked(matrix.values, {x.data(), x.data() + 50}, counters, {.tolerance = 0});
  EXPECT_EQ(outcome.status, FactorStatus::inaccurate);
  EXPECT_FALSE(outcome.fell_back);
  EXPECT_EQ(counters.fallbacks, 0);
}

}  // namespace
}  // namespace catena::testing
