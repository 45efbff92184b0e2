#include "catena/linalg/block/block_factorization.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "catena/linalg/factorization/symmetric_factorization.hpp"
#include "linalg/counted_heap.hpp"
#include "linalg/matrices.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

/// A random symmetric matrix of nodes of 1 to `widest` rows each: the diagonal dominates in size, with signs of both
/// kinds, so that factors exist in every order.
struct NodalMatrix {
  Matrix lower;
  std::vector<MatrixEntry> entries;
  Eigen::MatrixXd full;
  std::vector<int> order, node_start{0};
};

std::vector<MatrixEntry> entries_of(const SparsePattern& pattern) {
  std::vector<MatrixEntry> entries;
  for (int j = 0; j < pattern.columns; ++j) {
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      entries.push_back({pattern.row_index[k], j});
    }
  }
  return entries;
}

NodalMatrix nodal_matrix(int nodes, int widest, double neighbours, Random& random) {
  NodalMatrix result;
  std::vector<int> width;
  for (int k = 0; k < nodes; ++k) {
    width.push_back(1 + random.below(widest));
    result.node_start.push_back(result.node_start.back() + width.back());
  }
  const int n = result.node_start.back();
  result.order.resize(static_cast<std::size_t>(n));
  std::iota(result.order.begin(), result.order.end(), 0);
  for (int k = n - 1; k > 0; --k) std::swap(result.order[k], result.order[random.below(k + 1)]);
  std::vector<Triplet> triplets;
  const auto couple = [&](int a, int b, double chance) {
    for (int p = result.node_start[a]; p < result.node_start[a + 1]; ++p) {
      for (int q = result.node_start[b]; q < result.node_start[b + 1]; ++q) {
        if (p == q || random.uniform(0, 1) > chance) continue;
        const int i = result.order[p], j = result.order[q];
        triplets.push_back({std::max(i, j), std::min(i, j), random.uniform(-1, 1)});
      }
    }
  };
  for (int a = 0; a < nodes; ++a) {
    couple(a, a, 0.7);
    for (int b = 0; b < a; ++b) {
      if (random.uniform(0, nodes) < neighbours) couple(a, b, 0.6);
    }
  }
  for (int k = 0; k < n; ++k) triplets.push_back({k, k, (random.below(3) == 0 ? -1 : 1) * (2.0 * n + 1)});
  result.lower = assemble(n, n, triplets);
  result.entries = entries_of(result.lower.pattern);
  const Eigen::MatrixXd lower = dense(result.lower);
  result.full = Eigen::MatrixXd(lower.triangularView<Eigen::StrictlyLower>()) + lower.transpose();
  return result;
}

TEST(BlockFactorization, SolvesAndCountsSignsOnRandomNodalMatrices) {
  Random random(71);
  for (int trial = 0; trial < 300; ++trial) {
    const int nodes = 1 + random.below(40);
    const NodalMatrix m = nodal_matrix(nodes, 1 + random.below(9), random.uniform(0, 6), random);
    const int n = static_cast<int>(m.order.size());
    Counters counters;
    BlockFactorization factors;
    factors.analyze(m.entries, m.order, m.node_start, counters);
    ASSERT_TRUE(factors.factorize(m.lower.values, counters).ok());
    Eigen::VectorXd x(n), b(n);
    for (int k = 0; k < n; ++k) x[k] = random.uniform(-1, 1);
    b = m.full * x;
    factors.solve({b.data(), static_cast<std::size_t>(n)}, counters);
    EXPECT_LE((b - x).cwiseAbs().maxCoeff(), 1e-13) << trial;
    const Eigen::VectorXd values = symmetric_eigenvalues<double>(m.full);
    EXPECT_EQ(factors.negative_pivots(), (values.array() < 0).count()) << trial;
  }
}

TEST(BlockFactorization, HasThePivotsOfTheFactorizationRowByRow) {
  Random random(72);
  for (int trial = 0; trial < 50; ++trial) {
    const NodalMatrix m = nodal_matrix(30, 5, 3, random);
    Counters counters;
    BlockFactorization factors;
    factors.analyze(m.entries, m.order, m.node_start, counters);
    ASSERT_TRUE(factors.factorize(m.lower.values, counters).ok());
    SymmetricFactorization reference;
    ASSERT_TRUE(
        reference.analyze(m.lower.pattern, {.ordering = SymmetricOrdering::given, .permutation = m.order}, counters)
            .ok());
    ASSERT_TRUE(reference.factorize(m.lower.values, 0, counters).ok());
    for (int k = 0; k < factors.size(); ++k) {
      EXPECT_NEAR(factors.pivot(k), reference.pivot(k), 1e-12 * std::abs(reference.pivot(k)));
    }
    EXPECT_GE(factors.factor_entries(), static_cast<std::size_t>(reference.factor_entries()));
  }
}

TEST(BlockFactorization, TakesValuesWhereTheyAreFactored) {
  Random random(74);
  const NodalMatrix m = nodal_matrix(40, 4, 3, random);
  Counters counters;
  BlockFactorization factors, in_place;
  factors.analyze(m.entries, m.order, m.node_start, counters);
  in_place.analyze(m.entries, m.order, m.node_start, counters);
  for (double scale : {1.0, -2.0}) {
    std::vector<double> values = m.lower.values;
    for (double& value : values) value *= scale;
    ASSERT_TRUE(factors.factorize(values, counters).ok());
    std::fill(in_place.values().begin(), in_place.values().end(), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) in_place.values()[in_place.slots()[k]] += values[k];
    ASSERT_TRUE(in_place.factorize(counters).ok());
    for (int k = 0; k < factors.size(); ++k) EXPECT_EQ(in_place.pivot(k), factors.pivot(k));
    EXPECT_EQ(in_place.pivots().size(), m.order.size());
    EXPECT_EQ(in_place.pivots()[3], in_place.pivot(in_place.order()[3]));
  }
}

TEST(BlockFactorization, RoundsLanesAsNumbers) {
  Random random(75);
  std::vector<Lanes> work;
  for (int trial = 0; trial < 100; ++trial) {
    const int nodes = 1 + random.below(30), widest = 1 + random.below(9);
    const NodalMatrix m = nodal_matrix(nodes, widest, random.uniform(0, 6), random);
    Counters counters;
    BlockFactorization factors;
    factors.analyze(m.entries, m.order, m.node_start, counters);
    ASSERT_TRUE(factors.factorize(m.lower.values, counters).ok());
    std::vector<std::vector<double>> own(Lanes::count, std::vector<double>(m.order.size()));
    std::vector<Lanes> together(m.order.size());
    for (int lane = 0; lane < Lanes::count; ++lane) {
      for (std::size_t k = 0; k < together.size(); ++k) {
        own[lane][k] = random.uniform(-1, 1);
        together[k].set(lane, own[lane][k]);
      }
    }
    factors.solve(together, work, counters);
    EXPECT_EQ(counters.solves, Lanes::count);
    for (int lane = 0; lane < Lanes::count; ++lane) {
      factors.solve(own[lane], counters);
      for (std::size_t k = 0; k < together.size(); ++k) EXPECT_EQ(together[k][lane], own[lane][k]) << trial;
    }
  }
}

TEST(BlockFactorization, RoundsRowsAsNumbers) {
  Random random(76);
  std::vector<double> work;
  for (int trial = 0; trial < 100; ++trial) {
    const int nodes = 1 + random.below(30), widest = 1 + random.below(9);
    const NodalMatrix m = nodal_matrix(nodes, widest, random.uniform(0, 6), random);
    const std::size_t width = 4 * (1 + static_cast<std::size_t>(random.below(3)));
    Counters counters;
    BlockFactorization factors;
    factors.analyze(m.entries, m.order, m.node_start, counters);
    ASSERT_TRUE(factors.factorize(m.lower.values, counters).ok());
    std::vector<double> rows(m.order.size() * width), own(m.order.size());
    for (double& x : rows) x = random.uniform(-1, 1);
    std::vector<double> together = rows;
    factors.solve_rows(together.data(), width, work, counters);
    EXPECT_EQ(counters.solves, static_cast<std::int64_t>(width));
    for (std::size_t p = 0; p < width; ++p) {
      for (std::size_t k = 0; k < own.size(); ++k) own[k] = rows[k * width + p];
      factors.solve(own, counters);
      for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(together[k * width + p], own[k]) << trial;
    }
  }
}

TEST(BlockFactorization, NamesTheRowOfAVanishingPivot) {
  // Nodes {2, 0}, {1}: row 1 is left with 4 - 2 * 2 = 0.
  const Matrix lower = assemble(3, 3, {{0, 0, 1}, {1, 1, 4}, {2, 2, 3}, {1, 0, 2}, {2, 2, 0}});
  const std::vector<int> order{2, 0, 1}, node_start{0, 2, 3};
  Counters counters;
  BlockFactorization factors;
  factors.analyze(entries_of(lower.pattern), order, node_start, counters);
  const FactorResult result = factors.factorize(lower.values, counters);
  EXPECT_EQ(result.status, FactorStatus::singular);
  EXPECT_EQ(result.index, 1);
  EXPECT_FALSE(factors.is_factorized());
  std::vector<double> x(3, 1.0);
  EXPECT_THROW(factors.solve(x, counters), std::logic_error);
  std::vector<double> bad = lower.values;
  bad[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(factors.factorize(bad, counters).status, FactorStatus::not_finite);
  // What went wrong once does not stick.
  std::vector<double> good = lower.values;
  good[0] = 2;
  EXPECT_TRUE(factors.factorize(good, counters).ok());
}

TEST(BlockFactorization, AddsUpWhatBelongsToOnePlaceOfEitherTriangle) {
  // [4 1; 1 3] in parts.
  const std::vector<MatrixEntry> entries{{0, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 0}};
  Counters counters;
  BlockFactorization factors;
  factors.analyze(entries, std::vector<int>{1, 0}, std::vector<int>{0, 1, 2}, counters);
  ASSERT_TRUE(factors.factorize(std::vector<double>{1, 3, 3, 3, -2}, counters).ok());
  std::vector<double> x{6, 7};
  factors.solve(x, counters);
  EXPECT_NEAR(x[0], 1, 1e-15);
  EXPECT_NEAR(x[1], 2, 1e-15);
  EXPECT_THROW((void)factors.factorize(std::vector<double>{1, 2}, counters), std::invalid_argument);
}

TEST(BlockFactorization, RefusesWhatIsNoOrderOfTheRows) {
  Counters counters;
  BlockFactorization factors;
  const auto analyze = [&](std::vector<MatrixEntry> entries, std::vector<int> order, std::vector<int> nodes) {
    factors.analyze(entries, order, nodes, counters);
  };
  EXPECT_THROW(analyze({}, {0, 0}, {0, 1, 2}), std::invalid_argument);
  EXPECT_THROW(analyze({}, {0, 2}, {0, 1, 2}), std::invalid_argument);
  EXPECT_THROW(analyze({}, {0, 1}, {0, 1}), std::invalid_argument);
  EXPECT_THROW(analyze({}, {0, 1}, {0, 0, 2}), std::invalid_argument);
  EXPECT_THROW(analyze({{0, 2}}, {0, 1}, {0, 1, 2}), std::invalid_argument);
  EXPECT_THROW(analyze({{-1, 0}}, {0, 1}, {0, 1, 2}), std::invalid_argument);
}

TEST(BlockFactorization, AllocatesNothingAfterTheAnalysis) {
  Random random(73);
  const NodalMatrix m = nodal_matrix(60, 5, 3, random);
  Counters counters;
  BlockFactorization factors;
  factors.analyze(m.entries, m.order, m.node_start, counters);
  std::vector<double> x(m.order.size(), 1.0);
  HeapWatch watch;
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(factors.factorize(m.lower.values, counters).ok());
    factors.solve(x, counters);
  }
  EXPECT_EQ(watch.count(), 0);
  EXPECT_EQ(counters.symbolic, 1);
  EXPECT_EQ(counters.factorizations, 3);
  EXPECT_EQ(counters.refactorizations, 2);
  EXPECT_EQ(counters.solves, 3);
}

TEST(BlockFactorization, FactorsAnEmptyMatrix) {
  Counters counters;
  BlockFactorization factors;
  EXPECT_FALSE(factors.is_analyzed());
  factors.analyze({}, {}, std::vector<int>{0}, counters);
  EXPECT_TRUE(factors.is_analyzed());
  EXPECT_TRUE(factors.factorize({}, counters).ok());
  factors.solve({}, counters);
  EXPECT_EQ(factors.negative_pivots(), 0);
}

}  // namespace
}  // namespace catena::testing
