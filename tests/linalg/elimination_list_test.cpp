// Factors of small blocks by a list of products, against dense algebra.
#include "catena/linalg/kernels/elimination_list.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "catena/base/at.hpp"
#include "catena/linalg/factorization/factorization.hpp"
#include "linalg/counted_heap.hpp"
#include "linalg/matrices.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

void shuffle(std::vector<int>& order, int first, int end, Random& random) {
  for (int k = end - 1; k > first; --k) std::swap(order[at(k)], order[at(first + random.below(k - first + 1))]);
}

/// An upper block triangular matrix whose diagonal blocks have dominant pivots where `order` puts them; rows and
/// columns are shuffled.
struct Blocks {
  Matrix matrix;
  std::vector<int> row, column, start{0};

  Blocks(int blocks, int most, Random& random) {
    for (int b = 0; b < blocks; ++b) start.push_back(start.back() + 1 + random.below(most));
    const int n = start.back();
    row.resize(at(n));
    std::iota(row.begin(), row.end(), 0);
    column = row;
    shuffle(row, 0, n, random);
    shuffle(column, 0, n, random);
    std::vector<Triplet> triplets;
    for (int b = 0; b < blocks; ++b) {
      for (int p = start[at(b)]; p < start[at(b) + 1]; ++p) {
        triplets.push_back({row[at(p)], column[at(p)], random.uniform(1, 2) * (random.below(2) ? 1 : -1)});
        for (int j = start[at(b)]; j < n; ++j) {
          const bool inside = j < start[at(b) + 1];
          if (j != p && random.below(inside ? 3 : 2 * n) == 0)
            triplets.push_back({row[at(p)], column[at(j)], random.uniform(-0.6, 0.6)});
        }
      }
    }
    matrix = assemble(n, n, triplets);
  }
};

TEST(EliminationList, SolvesRandomBlocksAsDenseAlgebraDoes) {
  Random random(41);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const Blocks blocks(1 + random.below(6), 1 + random.below(trial % 10 == 0 ? 64 : 9), random);
    const int n = blocks.matrix.pattern.columns;
    const std::vector<double> ones(at(n), 1.0);
    EliminationList list(blocks.matrix.pattern, {blocks.row, blocks.column, blocks.start},
                         std::vector<double>(blocks.matrix.values.size(), 1.0));
    for (int turn = 0; turn < 2; ++turn) {
      Matrix matrix = blocks.matrix;
      for (double& value : matrix.values) value *= random.uniform(0.9, 1.1);
      const Eigen::MatrixXd a = dense(matrix);
      const Eigen::VectorXd b = random_vector(n, random);
      Eigen::VectorXd x = b, z = b;
      const HeapWatch watch;
      list.factor(matrix.values);
      list.solve({x.data(), at(n)}, ones, {});
      list.solve_transposed({z.data(), at(n)}, ones, ones);
      EXPECT_EQ(watch.count(), 0);
      const double growth = 1e-15 * n * ReferenceFactors<double>(a).inverse().cwiseAbs().rowwise().sum().maxCoeff();
      const Eigen::VectorXd ax = solve<double>(a, b), az = solve<double>(a.transpose(), b);
      EXPECT_LT((x - ax).lpNorm<Eigen::Infinity>(), 10 * growth * (1 + ax.lpNorm<Eigen::Infinity>()));
      EXPECT_LT((z - az).lpNorm<Eigen::Infinity>(), 10 * growth * n * (1 + az.lpNorm<Eigen::Infinity>()));
    }
  }
}

// Four right-hand sides side by side are rounded as each by itself.
TEST(EliminationList, SolvesInLanesWhatItSolvesOneByOne) {
  Random random(43);
  for (int trial = 0; trial < 50; ++trial) {
    const Blocks blocks(1 + random.below(4), 1 + random.below(9), random);
    const auto n = at(blocks.matrix.pattern.columns);
    std::vector<double> rows(n), columns(n);
    for (std::size_t k = 0; k < n; ++k) rows[k] = random.uniform(0.5, 2);
    for (std::size_t k = 0; k < n; ++k) columns[k] = random.uniform(0.5, 2);
    EliminationList list(blocks.matrix.pattern, {blocks.row, blocks.column, blocks.start},
                         std::vector<double>(blocks.matrix.values.size(), 1.0));
    list.factor(blocks.matrix.values);
    std::vector<Lanes> together(n);
    std::array<std::vector<double>, Lanes::count> alone;
    for (int lane = 0; lane < Lanes::count; ++lane) {
      for (std::size_t k = 0; k < n; ++k) {
        alone[at(lane)].push_back(random.uniform(-1, 1));
        together[k].set(lane, alone[at(lane)][k]);
      }
    }
    for (const bool scaled : {false, true}) {
      const std::span<const double> factor = scaled ? std::span<const double>(columns) : std::span<const double>();
      list.solve(std::span<Lanes>(together), rows, factor);
      for (int lane = 0; lane < Lanes::count; ++lane) {
        list.solve(std::span<double>(alone[at(lane)]), rows, factor);
        for (std::size_t k = 0; k < n; ++k) EXPECT_EQ(together[k][lane], alone[at(lane)][k]);
      }
    }
  }
}

// The pivots multiply to the determinant, block by block: branches of a mechanism are told apart by its sign.
TEST(EliminationList, PivotsAndMultipliersAreThoseOfElimination) {
  const Matrix matrix = assemble(3, 3, {{0, 0, 2}, {1, 0, -6}, {0, 1, 4}, {1, 1, 1}, {0, 2, 5}, {1, 2, 7}, {2, 2, -3}});
  const std::vector<int> order{0, 1, 2}, start{0, 2, 3};
  EliminationList list(matrix.pattern, {order, order, start}, std::vector<double>(matrix.values.size(), 1.0));
  list.factor(matrix.values);
  ASSERT_EQ(list.pivots().size(), 3u);
  EXPECT_EQ(list.pivots()[0], 2);
  EXPECT_EQ(list.pivots()[1], 13);
  EXPECT_EQ(list.pivots()[2], -3);
  EXPECT_EQ(list.largest_multiplier(0), 3);
  EXPECT_EQ(list.largest_multiplier(1), 0);
  std::vector<double> wrong = matrix.values;
  wrong[0] = std::nan("");
  list.factor(wrong);
  EXPECT_FALSE(std::isfinite(list.pivots()[0]));
  EXPECT_FALSE(list.largest_multiplier(0) <= 1e4);
  list.factor(matrix.values);
  EXPECT_EQ(list.pivots()[1], 13);
}

TEST(EliminationList, ServesBlocksUpToTheBitsOfAWord) {
  EXPECT_TRUE(EliminationList::serves(std::vector<int>{0, 64, 65, 129}));
  EXPECT_FALSE(EliminationList::serves(std::vector<int>{0, 1, 66}));
}

// Pivots that no longer suit are chosen anew, whichever kernel keeps the factors.
TEST(EliminationList, GivesWayWhereItsPivotsVanish) {
  Matrix matrix = assemble(2, 2, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, -1}});
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::klu, counters).ok());
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  for (const double small : {0.0, 1e-9}) {
    for (int k = 0; k < 2; ++k) {
      Matrix other = matrix;
      other.values[at(k == 0 ? 0 : 3)] = small;
      ASSERT_TRUE(factorization.factorize(other.values, counters).ok());
      Eigen::VectorXd b(2);
      b << 0.3, -0.7;
      Eigen::VectorXd x = b;
      factorization.solve({x.data(), 2}, counters);
      EXPECT_LT((dense(other) * x - b).lpNorm<Eigen::Infinity>(), 1e-14);
    }
  }
}

}  // namespace
}  // namespace catena::testing
