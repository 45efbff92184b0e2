// After the first round, factorizing and solving must leave the heap alone.
#include <gtest/gtest.h>

#include <cmath>

#include "catena/linalg/factorization/factorization.hpp"
#include "catena/linalg/factorization/symmetric_factorization.hpp"
#include "linalg/counted_heap.hpp"
#include "linalg/matrices.hpp"

namespace catena::testing {
namespace {

TEST(Allocations, AreSeenByTheWatch) {
  Random random(41);
  const Matrix matrix = dyad_chain(5, random);
  Counters counters;
  Factorization factorization;
  HeapWatch watch;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::klu, counters).ok());
  const long by_analysis = watch.count();
  EXPECT_GT(by_analysis, 10);
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  EXPECT_GT(watch.count(), by_analysis) << "KLU's first factorization allocates";
}

TEST(Allocations, NoneInAFactorizationWithKeptPivotsNorInASolve) {
  Random random(42);
  Matrix matrix = dyad_chain(40, random);
  const int n = matrix.pattern.columns;
  Counters counters;
  Factorization factorization;
  std::vector<double> x(static_cast<std::size_t>(3 * n));
  std::span<double> one(x.data(), static_cast<std::size_t>(n));
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::automatic, counters).ok());
  const auto round = [&] {
    for (double& value : matrix.values) value *= random.uniform(0.999, 1.001);
    for (double& value : x) value = random.uniform(-1, 1);
    EXPECT_TRUE(factorization.factorize(matrix.values, counters).ok());
    factorization.solve(x, counters);
    factorization.solve_transposed(x, counters);
    EXPECT_TRUE(factorization.solve_checked(matrix.values, one, counters).ok());
    EXPECT_GT(factorization.rcond(), 0);
    EXPECT_GT(factorization.smallest_pivot(0).magnitude, 0);
  };
  round();
  HeapWatch watch;
  for (int k = 0; k < 20; ++k) round();
  EXPECT_EQ(watch.count(), 0);
  EXPECT_EQ(counters.refactorizations, 20);
}

// UMFPACK enlarges what it reserves by its symbolic analysis; from the second factorization on it need not.
TEST(Allocations, OfUmfpackAreWhatItsLastFactorizationNeeded) {
  if (!is_compiled_in(Kernel::umfpack)) GTEST_SKIP() << "this build has no UMFPACK";
  Random random(44);
  const int n = 80;
  Matrix matrix = random_matrix(n, n, 25, random);
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::umfpack, counters).ok());
  const auto bytes_of_a_round = [&] {
    HeapWatch watch;
    EXPECT_TRUE(factorization.factorize(matrix.values, counters).ok());
    return watch.bytes();
  };
  const long first = bytes_of_a_round(), second = bytes_of_a_round();
  EXPECT_LT(second, first);
  // Other values choose other pivots and other fill: UMFPACK takes more where it must, and solves as well as before.
  for (int round = 0; round < 20; ++round) {
    for (double& value : matrix.values) value = random.uniform(-1, 1) * std::pow(10, random.uniform(-6, 0));
    bytes_of_a_round();
    const Eigen::VectorXd b = random_vector(n, random);
    Eigen::VectorXd x = b;
    factorization.solve({x.data(), x.data() + n}, counters);
    EXPECT_LT(backward_error(dense(matrix), x, b), 1e-12) << round;
  }
}

TEST(Allocations, NoneInASymmetricRoundAfterTheFirst) {
  Random random(43);
  const int n = 60;
  std::vector<Triplet> triplets;
  for (int k = 0; k < n; ++k) {
    triplets.push_back({k, k, k % 2 == 0 ? 4.0 : -4.0});
    if (k > 0) triplets.push_back({k, k - 1, 1});
    if (k > 6) triplets.push_back({k, k - 7, 0.5});
  }
  Matrix lower = assemble(n, n, triplets);
  Counters counters;
  SymmetricFactorization factorization;
  std::vector<double> x(static_cast<std::size_t>(n), 1.0);
  ASSERT_TRUE(factorization.analyze(lower.pattern, {}, counters).ok());
  const auto half_residual = [](std::span<const double> at, std::span<double> r) {
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = 1 - at[i];
    return 1.0;
  };
  const auto round = [&] {
    for (double& value : lower.values) value *= random.uniform(0.99, 1.01);
    EXPECT_TRUE(factorization.factorize(lower.values, 1e-9, counters).ok());
    factorization.solve(x, counters);
    (void)factorization.solve_refined(x, half_residual, {.max_steps = 2}, counters);
    EXPECT_GT(factorization.smallest_pivot_ratio().ratio, 0);
    EXPECT_EQ(factorization.inertia(1e-12).zero, 0);
  };
  round();
  HeapWatch watch;
  for (int k = 0; k < 20; ++k) round();
  EXPECT_EQ(watch.count(), 0);
}

}  // namespace
}  // namespace catena::testing
