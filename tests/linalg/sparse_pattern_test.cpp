#include "catena/linalg/patterns/sparse_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "linalg/matrices.hpp"

namespace catena::testing {
namespace {

TEST(SparsePattern, SortsAndMergesPairsAndReturnsTheirSlots) {
  const std::vector<MatrixEntry> entries{{2, 1}, {0, 0}, {1, 1}, {2, 1}, {0, 2}, {0, 1}};
  const SlottedPattern built = build_pattern(3, 3, entries);
  EXPECT_EQ(built.pattern.column_start, (std::vector<int>{0, 1, 4, 5}));
  EXPECT_EQ(built.pattern.row_index, (std::vector<int>{0, 0, 1, 2, 0}));
  EXPECT_EQ(built.slot, (std::vector<int>{3, 0, 2, 3, 4, 1}));
}

TEST(SparsePattern, EverySlotLeadsToItsPair) {
  Random random(1);
  std::vector<MatrixEntry> entries;
  for (int k = 0; k < 5000; ++k) entries.push_back({random.below(97), random.below(53)});
  const SlottedPattern built = build_pattern(97, 53, entries);
  const SparsePattern& pattern = built.pattern;
  for (int j = 0; j < pattern.columns; ++j) {
    const auto begin = pattern.row_index.begin() + pattern.column_start[j];
    const auto end = pattern.row_index.begin() + pattern.column_start[j + 1];
    EXPECT_EQ(std::adjacent_find(begin, end, std::greater_equal<>()), end) << "column " << j << " ascends strictly";
  }
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const int slot = built.slot[k];
    EXPECT_EQ(pattern.row_index[slot], entries[k].row);
    EXPECT_GE(slot, pattern.column_start[entries[k].column]);
    EXPECT_LT(slot, pattern.column_start[entries[k].column + 1]);
  }
}

TEST(SparsePattern, HandlesEmptyMatricesAndEmptyColumns) {
  const SlottedPattern nothing = build_pattern(0, 0, {});
  EXPECT_EQ(nothing.pattern, SparsePattern{});
  const SlottedPattern hollow = build_pattern(2, 4, std::vector<MatrixEntry>{{1, 2}});
  EXPECT_EQ(hollow.pattern.column_start, (std::vector<int>{0, 0, 0, 1, 1}));
  EXPECT_EQ(transpose(hollow.pattern).pattern.column_start, (std::vector<int>{0, 0, 1}));
}

TEST(SparsePattern, RefusesEntriesOutsideTheMatrix) {
  EXPECT_THROW(build_pattern(2, 2, std::vector<MatrixEntry>{{2, 0}}), std::out_of_range);
  EXPECT_THROW(build_pattern(2, 2, std::vector<MatrixEntry>{{0, -1}}), std::out_of_range);
  EXPECT_THROW(build_pattern(-1, 2, {}), std::out_of_range);
}

TEST(SparsePattern, TransposeCarriesTheValues) {
  Random random(2);
  const Matrix a = random_matrix(31, 17, 4, random);
  const SlottedPattern turned = transpose(a.pattern);
  Matrix b{turned.pattern, std::vector<double>(a.values.size())};
  for (std::size_t k = 0; k < a.values.size(); ++k) b.values[turned.slot[k]] = a.values[k];
  EXPECT_EQ(dense(b), dense(a).transpose());
}

TEST(SparsePattern, ProductsAgreeWithDenseOnes) {
  Random random(3);
  const Matrix a = random_matrix(40, 25, 5, random);
  const Eigen::VectorXd x = random_vector(25, random), u = random_vector(40, random);
  Eigen::VectorXd y = random_vector(40, random), v = random_vector(25, random);
  const Eigen::VectorXd y_expected = y + dense(a) * x, v_expected = v + dense(a).transpose() * u;
  multiply_add(a.pattern, a.values, {x.data(), 25}, {y.data(), 40});
  multiply_transposed_add(a.pattern, a.values, {u.data(), 40}, {v.data(), 25});
  EXPECT_LT((y - y_expected).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((v - v_expected).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace
}  // namespace catena::testing
