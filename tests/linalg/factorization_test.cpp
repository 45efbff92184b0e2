#include "catena/linalg/factorization/factorization.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "linalg/matrices.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

std::vector<Kernel> square_kernels() {
  std::vector<Kernel> kernels{Kernel::automatic, Kernel::klu};
  if (is_compiled_in(Kernel::umfpack)) kernels.push_back(Kernel::umfpack);
  return kernels;
}

TEST(Factorization, SolvesRandomSystemsWithEveryKernel) {
  Random random(11);
  for (Kernel kernel : square_kernels()) {
    for (int n : {1, 2, 5, 40, 150}) {
      const Matrix matrix = random_matrix(n, n, 3, random);
      const Eigen::MatrixXd a = dense(matrix);
      Counters counters;
      Factorization factorization;
      ASSERT_TRUE(factorization.analyze(matrix.pattern, kernel, counters).ok());
      ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
      const Eigen::VectorXd b = random_vector(n, random);
      Eigen::VectorXd x = b, z = b;
      factorization.solve({x.data(), x.data() + n}, counters);
      factorization.solve_transposed({z.data(), z.data() + n}, counters);
      // KLU's threshold pivoting lets entries grow where UMFPACK's does not.
      EXPECT_LT(backward_error(a, x, b), 1e-12) << to_string(kernel) << ' ' << n;
      EXPECT_LT(backward_error(a.transpose(), z, b), 1e-12) << to_string(kernel) << ' ' << n;
      EXPECT_EQ(counters.symbolic, 1);
      EXPECT_EQ(counters.factorizations, 1);
      EXPECT_EQ(counters.solves, 2);
    }
  }
}

TEST(Factorization, SolvesSeveralRightHandSidesAtOnce) {
  Random random(12);
  const int n = 30, count = 7;
  const Matrix matrix = random_matrix(n, n, 3, random);
  for (Kernel kernel : square_kernels()) {
    Counters counters;
    Factorization factorization;
    ASSERT_TRUE(factorization.analyze(matrix.pattern, kernel, counters).ok());
    ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
    const Eigen::VectorXd b = random_vector(n * count, random);
    Eigen::VectorXd x = b;
    factorization.solve({x.data(), x.data() + x.size()}, counters);
    for (int k = 0; k < count; ++k)
      EXPECT_LT(backward_error(dense(matrix), x.segment(k * n, n), b.segment(k * n, n)), 1e-13);
    EXPECT_EQ(counters.solves, count);
  }
}

TEST(Factorization, FindsTheBlocksOfADrivenMechanism) {
  Random random(13);
  const int dyads = 50;
  const Matrix matrix = dyad_chain(dyads, random);
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::automatic, counters).ok());
  EXPECT_EQ(factorization.structural_rank(), factorization.size());
  // A dyad solves for its two angles and positions together; the crank's three columns stand alone.
  EXPECT_LE(factorization.largest_block(), 6);
  EXPECT_GE(factorization.blocks(), dyads + 3);
  // The permuted matrix is block upper triangular: no entry below its column's block.
  for (int j = 0; j < matrix.pattern.columns; ++j)
    for (int k = matrix.pattern.column_start[j]; k < matrix.pattern.column_start[j + 1]; ++k)
      EXPECT_LE(factorization.block_of_row()[matrix.pattern.row_index[k]], factorization.block_of_column()[j]);
}

TEST(Factorization, ReportsTheSmallestPivotOfEveryBlock) {
  // Two independent 2 x 2 blocks; the second nears singularity as its rows become parallel.
  const double angle = 1e-5;
  const Matrix matrix =
      assemble(4, 4, {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, -1}, {2, 2, 1}, {2, 3, 1}, {3, 2, 1}, {3, 3, 1 - angle}});
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::klu, counters).ok());
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  ASSERT_EQ(factorization.blocks(), 2);
  const int sound = factorization.block_of_column()[0], weak = factorization.block_of_column()[3];
  EXPECT_GE(factorization.smallest_pivot(sound).magnitude, 0.5);
  EXPECT_NEAR(factorization.smallest_pivot(weak).magnitude, angle, 1e-10);
  EXPECT_GE(factorization.smallest_pivot(weak).column, 2);
  EXPECT_LE(factorization.rcond(), angle);
  EXPECT_GE(factorization.rcond(), 0.1 * angle);
}

TEST(Factorization, DeterminantSignsFollowEveryBlockThroughChangesOfPivots) {
  // Three full blocks of different sizes, redrawn at random: whatever pivots are used, a block's sign changes exactly
  // when its determinant does.
  const std::vector<int> sizes{1, 3, 4};
  std::vector<MatrixEntry> entries;
  for (int block = 0, first = 0; block < 3; first += sizes[block++])
    for (int i = 0; i < sizes[block]; ++i)
      for (int j = 0; j < sizes[block]; ++j) entries.push_back({first + i, first + j});
  Matrix matrix{build_pattern(8, 8, entries).pattern, std::vector<double>(entries.size())};
  Random random(21);
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::klu, counters).ok());
  ASSERT_EQ(factorization.blocks(), 3);
  std::vector<int> factor(3, 0);  // sign of the determinant / reported sign, fixed by the first round
  for (int round = 0; round < 200; ++round) {
    for (double& value : matrix.values) value = std::pow(10, random.uniform(-5, 0)) * (random.below(2) ? 1 : -1);
    ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
    const Eigen::MatrixXd a = dense(matrix);
    const std::span<const BlockMargin> margins = factorization.block_margins();
    ASSERT_EQ(margins.size(), 3u);
    for (int block = 0, first = 0; block < 3; first += sizes[block++]) {
      const double determinant =
          ReferenceFactors<double>(a.block(first, first, sizes[block], sizes[block])).determinant();
      const double margin = margins[factorization.block_of_column()[first]].determinant;
      const int sign = (margin > 0) == (determinant > 0) ? 1 : -1;
      if (round == 0) factor[block] = sign;
      EXPECT_EQ(sign, factor[block]) << "round " << round << " block " << block;
    }
  }
  EXPECT_GT(counters.factorizations - counters.refactorizations, 1) << "pivots must have changed on the way";
}

TEST(Factorization, RefactorsWithKeptPivotsWhileTheySuit) {
  Random random(14);
  Matrix matrix = dyad_chain(20, random);
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::automatic, counters).ok());
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  for (int round = 0; round < 10; ++round) {
    for (double& value : matrix.values) value *= random.uniform(0.99, 1.01);
    ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  }
  EXPECT_EQ(counters.symbolic, 1);
  EXPECT_EQ(counters.factorizations, 11);
  EXPECT_EQ(counters.refactorizations, 10);
}

TEST(Factorization, ChoosesNewPivotsWhenTheOldOnesGrow) {
  // A full 2 x 2 block whose first pivot shrinks to 1e-12: with the pivot kept, the residual would be near 1e-4.
  Matrix matrix = assemble(2, 2, {{0, 0, 2}, {0, 1, 1}, {1, 0, 1}, {1, 1, 3}});
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::klu, counters).ok());
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  for (int weak_row = 0; weak_row < 2; ++weak_row) {
    Eigen::MatrixXd a(2, 2);
    a << 2, 1, 1, 3;
    a(weak_row, weak_row) = 1e-12;
    matrix.values = sparse(a).values;
    ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
    Eigen::VectorXd b(2);
    b << 0.3, 0.7;
    Eigen::VectorXd x = b;
    factorization.solve({x.data(), x.data() + 2}, counters);
    EXPECT_LT(backward_error(a, x, b), 1e-15);
  }
  // Whichever diagonal entry is the first pivot, one of the two rounds had to give it up.
  EXPECT_GE(counters.factorizations - counters.refactorizations, 2);
}

TEST(Factorization, KeepsPivotsOnlyWhileMultipliersStayBounded) {
  // Values redrawn entirely at each round over five decades, the worst that can happen to kept pivots. Unchecked they
  // lose all digits; multipliers of 1e4 can still compound over a few columns.
  Random random(15);
  Matrix matrix = random_matrix(60, 60, 4, random);
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::klu, counters).ok());
  for (int round = 0; round < 200; ++round) {
    for (double& value : matrix.values) value = std::pow(10, random.uniform(-5, 0)) * (random.below(2) ? 1 : -1);
    ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
    const Eigen::VectorXd b = random_vector(60, random);
    Eigen::VectorXd x = b;
    factorization.solve({x.data(), x.data() + 60}, counters);
    EXPECT_LT(backward_error(dense(matrix), x, b), 1e-7);
  }
  EXPECT_GT(counters.factorizations - counters.refactorizations, 1);
  EXPECT_GT(counters.refactorizations, 1);
}

TEST(Factorization, NamesTheColumnOfASingularMatrix) {
  // Column 2 is the sum of columns 0 and 1 in numbers, not in pattern.
  const Matrix matrix = assemble(
      3, 3, {{0, 0, 1}, {1, 0, 2}, {2, 0, 4}, {0, 1, 8}, {1, 1, 1}, {2, 1, 2}, {0, 2, 9}, {1, 2, 3}, {2, 2, 6}});
  for (Kernel kernel : square_kernels()) {
    Counters counters;
    Factorization factorization;
    ASSERT_TRUE(factorization.analyze(matrix.pattern, kernel, counters).ok());
    const FactorResult result = factorization.factorize(matrix.values, counters);
    // Rounding may leave a pivot of 1e-16 instead of zero; either way the matrix must not pass as regular.
    if (result.ok()) {
      EXPECT_LT(factorization.rcond(), 1e-15);
      continue;
    }
    EXPECT_EQ(result.status, FactorStatus::singular);
    if (kernel != Kernel::umfpack) {
      EXPECT_GE(result.index, 0);
    }
    std::vector<double> x{1, 2, 3};
    EXPECT_THROW(factorization.solve(x, counters), std::logic_error);
    EXPECT_EQ(factorization.rcond(), 0);
  }
}

TEST(Factorization, RecoversFromASingularRound) {
  const SparsePattern pattern = build_pattern(2, 2, std::vector<MatrixEntry>{{0, 0}, {0, 1}, {1, 0}, {1, 1}}).pattern;
  const std::vector<double> regular{2, 1, 1, 3}, singular{1, 1, 1, 1};
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(pattern, Kernel::automatic, counters).ok());
  ASSERT_TRUE(factorization.factorize(regular, counters).ok());
  const FactorResult result = factorization.factorize(singular, counters);
  EXPECT_EQ(result.status, FactorStatus::singular);
  EXPECT_NE(factorization.describe(result).find("column " + std::to_string(result.index)), std::string::npos);
  ASSERT_TRUE(factorization.factorize(regular, counters).ok());
  std::vector<double> x{4, 7};
  factorization.solve(x, counters);
  EXPECT_NEAR(x[0], 1, 1e-15);
  EXPECT_NEAR(x[1], 2, 1e-15);
}

TEST(Factorization, ASinglePivotThatVanishesIsSingular) {
  // KLU's refactorization does not look at 1 x 1 blocks itself.
  const SparsePattern pattern = build_pattern(2, 2, std::vector<MatrixEntry>{{0, 0}, {1, 1}}).pattern;
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(pattern, Kernel::klu, counters).ok());
  ASSERT_TRUE(factorization.factorize(std::vector<double>{1, 2}, counters).ok());
  const FactorResult result = factorization.factorize(std::vector<double>{1, 0}, counters);
  EXPECT_EQ(result.status, FactorStatus::singular);
  EXPECT_EQ(result.index, 1);
}

TEST(Factorization, ReportsAStructurallySingularPattern) {
  // Columns 1 and 3 both live on row 2 alone.
  const Matrix matrix = assemble(4, 4, {{0, 0, 1}, {1, 2, 1}, {2, 1, 1}, {2, 3, 1}, {3, 0, 1}, {3, 2, 1}});
  for (Kernel kernel : {Kernel::automatic, Kernel::klu}) {
    Counters counters;
    Factorization factorization;
    const FactorResult analysis = factorization.analyze(matrix.pattern, kernel, counters);
    EXPECT_EQ(analysis.status, FactorStatus::singular);
    EXPECT_EQ(factorization.structural_rank(), 3);
    ASSERT_EQ(factorization.unmatched_columns().size(), 1u);
    ASSERT_EQ(factorization.unmatched_rows().size(), 1u);
    EXPECT_TRUE(analysis.index == 1 || analysis.index == 3);
    EXPECT_EQ(factorization.factorize(matrix.values, counters).status, FactorStatus::singular);
    EXPECT_NE(factorization.describe(analysis).find("rank at most 3 of 4"), std::string::npos);
    EXPECT_EQ(counters.factorizations, 0);
  }
}

TEST(Factorization, ReportsValuesThatAreNotFinite) {
  const SparsePattern pattern = build_pattern(2, 2, std::vector<MatrixEntry>{{0, 0}, {0, 1}, {1, 0}, {1, 1}}).pattern;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(pattern, Kernel::automatic, counters).ok());
  EXPECT_FALSE(factorization.factorize(std::vector<double>{nan, 1, 1, 3}, counters).ok());
  ASSERT_TRUE(factorization.factorize(std::vector<double>{2, 1, 1, 3}, counters).ok());
  EXPECT_FALSE(factorization.factorize(std::vector<double>{nan, 1, 1, 3}, counters).ok());
}

TEST(Factorization, ABadNumberOutsideTheBlocksShowsInTheCheckedSolve) {
  const SparsePattern pattern = build_pattern(2, 2, std::vector<MatrixEntry>{{0, 0}, {1, 0}, {1, 1}}).pattern;
  std::vector<double> values{1, std::numeric_limits<double>::quiet_NaN(), 1};
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(pattern, Kernel::automatic, counters).ok());
  ASSERT_TRUE(factorization.factorize(values, counters).ok());
  std::vector<double> x{1, 1};
  EXPECT_EQ(factorization.solve_checked(values, x, counters).status, FactorStatus::not_finite);
  EXPECT_EQ(counters.fallbacks, 0);
}

TEST(Factorization, AcceptsTheEmptyAndTheSmallestMatrix) {
  for (Kernel kernel : square_kernels()) {
    Counters counters;
    Factorization factorization;
    EXPECT_TRUE(factorization.analyze(SparsePattern{}, kernel, counters).ok());
    EXPECT_TRUE(factorization.factorize({}, counters).ok());
    EXPECT_EQ(factorization.rcond(), 1);
    EXPECT_EQ(factorization.blocks(), 0);
    factorization.solve(std::span<double>{}, counters);
    EXPECT_TRUE(factorization.solve_checked({}, {}, counters).ok());
    EXPECT_EQ(counters, Counters{});

    const Matrix one = assemble(1, 1, {{0, 0, -4}});
    ASSERT_TRUE(factorization.analyze(one.pattern, kernel, counters).ok());
    ASSERT_TRUE(factorization.factorize(one.values, counters).ok());
    std::vector<double> x{2};
    factorization.solve(x, counters);
    EXPECT_EQ(x[0], -0.5);
    EXPECT_EQ(factorization.blocks(), 1);
  }
}

TEST(Factorization, RefusesMisuse) {
  Counters counters;
  Factorization factorization;
  EXPECT_THROW((void)factorization.analyze(build_pattern(2, 3, {}).pattern, Kernel::klu, counters),
               std::invalid_argument);
  const Matrix one = assemble(1, 1, {{0, 0, 1}});
  ASSERT_TRUE(factorization.analyze(one.pattern, Kernel::klu, counters).ok());
  std::vector<double> x{1};
  EXPECT_THROW(factorization.solve(x, counters), std::logic_error);
  EXPECT_THROW((void)factorization.factorize(std::vector<double>{1, 2}, counters), std::invalid_argument);
}

TEST(Factorization, SaysWhichKernelsDoNotServe) {
  const Matrix one = assemble(1, 1, {{0, 0, 1}});
  for (Kernel kernel : {Kernel::cholmod, Kernel::spqr}) {
    Counters counters;
    Factorization factorization;
    const FactorResult result = factorization.analyze(one.pattern, kernel, counters);
    EXPECT_EQ(result.status, FactorStatus::unavailable);
    EXPECT_NE(factorization.describe(result).find("KLU"), std::string::npos);
  }
  Counters counters;
  Factorization factorization;
  EXPECT_EQ(factorization.analyze(one.pattern, Kernel::umfpack, counters).ok(), is_compiled_in(Kernel::umfpack));
}

TEST(Factorization, MovesWithItsFactors) {
  Random random(16);
  const Matrix matrix = random_matrix(20, 20, 3, random);
  Counters counters;
  Factorization first;
  ASSERT_TRUE(first.analyze(matrix.pattern, Kernel::klu, counters).ok());
  ASSERT_TRUE(first.factorize(matrix.values, counters).ok());
  Factorization second = std::move(first);
  const Eigen::VectorXd b = random_vector(20, random);
  Eigen::VectorXd x = b;
  second.solve({x.data(), x.data() + 20}, counters);
  EXPECT_LT(backward_error(dense(matrix), x, b), 1e-13);
}

}  // namespace
}  // namespace catena::testing
