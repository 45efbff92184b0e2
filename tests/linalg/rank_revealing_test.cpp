#include "catena/linalg/rank/rank_revealing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "linalg/matrices.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

std::vector<Kernel> rank_kernels() {
  std::vector<Kernel> kernels{Kernel::automatic, Kernel::cholmod};
  if (is_compiled_in(Kernel::spqr)) kernels.push_back(Kernel::spqr);
  return kernels;
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& a, const std::vector<int>& rows) {
  Eigen::MatrixXd part(rows.size(), a.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) part.row(static_cast<int>(k)) = a.row(rows[k]);
  return part;
}

int rank_by_singular_values(Eigen::MatrixXd a) {
  for (int i = 0; i < a.rows(); ++i)
    if (a.row(i).norm() > 0) a.row(i).normalize();
  if (a.size() == 0) return 0;
  const Eigen::VectorXd sigma = singular_values(a).values;
  return static_cast<int>((sigma.array() > 1e-9).count());
}

/// Everything that a report promises, checked on the dense matrix.
void expect_true_report(const Eigen::MatrixXd& a, const RankReport& report, double tolerance) {
  ASSERT_TRUE(report.ok());
  const int rows = static_cast<int>(a.rows()), columns = static_cast<int>(a.cols());
  EXPECT_EQ(report.rank, rank_by_singular_values(a));
  ASSERT_EQ(static_cast<int>(report.independent_rows.size()), report.rank);
  ASSERT_EQ(static_cast<int>(report.dependent_rows.size()), rows - report.rank);
  std::vector<int> all = report.independent_rows;
  all.insert(all.end(), report.dependent_rows.begin(), report.dependent_rows.end());
  std::sort(all.begin(), all.end());
  for (int i = 0; i < rows; ++i) EXPECT_EQ(all[i], i);
  EXPECT_EQ(rank_by_singular_values(rows_of(a, report.independent_rows)), report.rank);

  ASSERT_EQ(report.left_null_vectors.count(), rows - report.rank);
  for (int k = 0; k < report.left_null_vectors.count(); ++k) {
    Eigen::VectorXd w = Eigen::VectorXd::Zero(rows);
    double scale = 0;
    for (std::size_t e = 0; e < report.left_null_vectors.indices(k).size(); ++e) {
      const int row = report.left_null_vectors.indices(k)[e];
      w[row] = report.left_null_vectors.values(k)[e];
      scale = std::max(scale, std::abs(w[row]) * a.row(row).cwiseAbs().maxCoeff());
      EXPECT_EQ(e == 0, std::binary_search(report.dependent_rows.begin(), report.dependent_rows.end(), row));
    }
    EXPECT_EQ(report.left_null_vectors.indices(k)[0], report.dependent_rows[k]);
    EXPECT_EQ(w[report.dependent_rows[k]], 1);
    EXPECT_LE((a.transpose() * w).lpNorm<Eigen::Infinity>(), tolerance * scale);
  }

  ASSERT_EQ(static_cast<int>(report.free_columns.size()), columns - report.rank);
  ASSERT_EQ(report.right_null_vectors.count(), columns - report.rank);
  Eigen::VectorXd row_scale = a.cwiseAbs().rowwise().sum();
  for (int k = 0; k < report.right_null_vectors.count(); ++k) {
    Eigen::VectorXd v = Eigen::VectorXd::Zero(columns);
    for (std::size_t e = 0; e < report.right_null_vectors.indices(k).size(); ++e)
      v[report.right_null_vectors.indices(k)[e]] = report.right_null_vectors.values(k)[e];
    EXPECT_EQ(v[report.free_columns[k]], 1);
    const Eigen::VectorXd product = a * v;
    for (int i = 0; i < rows; ++i)
      EXPECT_LE(std::abs(product[i]), tolerance * row_scale[i] * v.lpNorm<Eigen::Infinity>());
  }
}

RankReport report_of(const Eigen::MatrixXd& a, Kernel kernel) {
  const Matrix matrix = sparse(a);
  return reveal_rank(matrix.pattern, matrix.values, {.kernel = kernel});
}

double tolerance_of(const RankReport& report) { return report.approximate ? 1e-5 : 1e-9; }

/// Without SPQR a report may be wrong, but then it must say so; true for one that claims nothing.
bool admits_doubt(const RankReport& report) {
  return report.approximate && !report.verified && report.warning.find("not definite") != std::string::npos;
}

/// A copy of a with one row added.
Eigen::MatrixXd with_row(const Eigen::MatrixXd& a, const Eigen::RowVectorXd& row) {
  Eigen::MatrixXd taller(a.rows() + 1, a.cols());
  taller << a, row;
  return taller;
}

TEST(RevealRank, RandomMatricesOfFullRank) {
  Random random(51);
  for (Kernel kernel : rank_kernels()) {
    for (auto [rows, columns] : {std::pair{12, 12}, {10, 25}, {25, 10}, {1, 1}, {1, 6}, {6, 1}}) {
      const Eigen::MatrixXd a = dense(random_matrix(rows, columns, 4, random));
      const RankReport report = report_of(a, kernel);
      if (admits_doubt(report)) continue;
      expect_true_report(a, report, tolerance_of(report));
      EXPECT_TRUE(report.verified) << report.warning;
      EXPECT_EQ(report.approximate, kernel == Kernel::cholmod || !is_compiled_in(Kernel::spqr));
    }
  }
}

TEST(RevealRank, FindsADuplicatedRowAtAnyScale) {
  Random random(52);
  const Eigen::MatrixXd a = dense(random_matrix(8, 15, 4, random));
  for (Kernel kernel : rank_kernels()) {
    for (double factor : {1.0, -1.0, 1e6, 1e-6}) {
      const Eigen::MatrixXd b = with_row(a, factor * a.row(3));
      const RankReport report = report_of(b, kernel);
      if (admits_doubt(report)) continue;
      expect_true_report(b, report, tolerance_of(report));
      ASSERT_EQ(report.rank, 8);
      EXPECT_TRUE(report.verified) << report.warning;
      // The two rows concerned, and no others, are named.
      ASSERT_EQ(report.left_null_vectors.count(), 1);
      std::vector<int> concerned(report.left_null_vectors.indices(0).begin(),
                                 report.left_null_vectors.indices(0).end());
      std::sort(concerned.begin(), concerned.end());
      EXPECT_EQ(concerned, (std::vector<int>{3, 8}));
    }
  }
}

TEST(RevealRank, FindsARowThatIsASumOfOthers) {
  Random random(53);
  const Eigen::MatrixXd a = dense(random_matrix(20, 40, 4, random));
  const Eigen::MatrixXd b = with_row(a, 2 * a.row(1) - 0.5 * a.row(7) + 3 * a.row(11));
  for (Kernel kernel : rank_kernels()) {
    const RankReport report = report_of(b, kernel);
    if (admits_doubt(report)) continue;
    expect_true_report(b, report, tolerance_of(report));
    ASSERT_EQ(report.left_null_vectors.count(), 1);
    std::vector<int> concerned(report.left_null_vectors.indices(0).begin(), report.left_null_vectors.indices(0).end());
    std::sort(concerned.begin(), concerned.end());
    EXPECT_EQ(concerned, (std::vector<int>{1, 7, 11, 20}));
  }
}

TEST(RevealRank, FindsEvenNullities) {
  // Copies of a block side by side, each with its own redundant row: the determinant's sign could not tell.
  Random random(54);
  const Eigen::MatrixXd block = dense(random_matrix(4, 5, 3, random));
  const Eigen::MatrixXd redundant = with_row(block, block.row(0) + block.row(2));
  for (int copies : {2, 4}) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(5 * copies, 5 * copies);
    for (int k = 0; k < copies; ++k) a.block(5 * k, 5 * k, 5, 5) = redundant;
    for (Kernel kernel : rank_kernels()) {
      const RankReport report = report_of(a, kernel);
      if (admits_doubt(report)) continue;
      expect_true_report(a, report, tolerance_of(report));
      EXPECT_EQ(report.rank, 4 * copies);
      EXPECT_TRUE(report.verified) << report.warning;
    }
  }
}

TEST(RevealRank, ManyDependenciesAmongRandomRows) {
  Random random(55);
  for (int round = 0; round < 20; ++round) {
    const int rank = 3 + random.below(10), rows = rank + 1 + random.below(12), columns = rank + random.below(12);
    const Eigen::MatrixXd basis = dense(random_matrix(rank, columns, 4, random));
    Eigen::MatrixXd a(rows, columns);
    for (int i = 0; i < rows; ++i) {
      a.row(i) = random.uniform(0.5, 2) * basis.row(random.below(rank));
      if (random.below(2)) a.row(i) += random.uniform(0.5, 2) * basis.row(random.below(rank));
    }
    for (Kernel kernel : rank_kernels()) {
      const RankReport report = report_of(a, kernel);
      if (admits_doubt(report)) continue;
      expect_true_report(a, report, tolerance_of(report));
    }
  }
}

TEST(RevealRank, ThePivotsOfTheGramMatrixSettleMostCases) {
  Random random(58);
  int settled = 0;
  const int rounds = 50;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::MatrixXd a = dense(random_matrix(10, 14, 3, random));
    const Eigen::MatrixXd b = with_row(a, a.row(0) - a.row(5));
    const RankReport report = report_of(b, Kernel::cholmod);
    EXPECT_TRUE(report.approximate);
    EXPECT_FALSE(report.warning.empty());
    if (!report.verified) continue;
    ++settled;
    expect_true_report(b, report, 1e-5);
  }
  EXPECT_GT(settled, rounds * 3 / 4);
}

TEST(RevealRank, ZeroRowsAndColumns) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(4, 5);
  a(0, 1) = 2;
  a(2, 3) = -1;
  a(2, 1) = 1;
  for (Kernel kernel : rank_kernels()) {
    const RankReport report = report_of(a, kernel);
    expect_true_report(a, report, 0);
    EXPECT_EQ(report.dependent_rows, (std::vector<int>{1, 3}));
    EXPECT_EQ(report.free_columns, (std::vector<int>{0, 2, 4}));
    EXPECT_EQ(report.left_null_vectors.indices(0).size(), 1u);
  }
}

TEST(RevealRank, EmptyMatrices) {
  for (Kernel kernel : rank_kernels()) {
    for (auto [rows, columns] : {std::pair{0, 0}, {3, 0}, {0, 3}, {2, 3}}) {
      const RankReport report = reveal_rank(build_pattern(rows, columns, {}).pattern, {}, {.kernel = kernel});
      ASSERT_TRUE(report.ok());
      EXPECT_EQ(report.rank, 0);
      EXPECT_EQ(static_cast<int>(report.dependent_rows.size()), rows);
      EXPECT_EQ(report.left_null_vectors.count(), rows);
      EXPECT_EQ(static_cast<int>(report.free_columns.size()), columns);
      EXPECT_EQ(report.right_null_vectors.count(), columns);
    }
  }
}

TEST(RevealRank, DoesNotDependOnUnits) {
  // Lengths in millimetres, metres or kilometres: angle columns scale against the others.
  Random random(56);
  const Matrix mechanism = dyad_chain(6, random);
  const Eigen::MatrixXd square = dense(mechanism);
  Eigen::MatrixXd a = with_row(square.topRows(square.rows() - 1), square.row(4) - square.row(9));
  for (double unit : {1e-3, 1.0, 1e3}) {
    Eigen::MatrixXd scaled = a;
    for (int body = 0; body < a.cols() / 3; ++body) scaled.col(3 * body + 2) *= unit;
    for (Kernel kernel : rank_kernels()) {
      const RankReport report = report_of(scaled, kernel);
      ASSERT_TRUE(report.ok());
      EXPECT_EQ(report.rank, a.rows() - 1);
      EXPECT_TRUE(report.verified) << report.warning;
    }
  }
}

TEST(RevealRank, AColumnOfRoundingErrorsIsNotAMotionHeldFast) {
  // A body joined at its own centroid may turn freely, even if its arm came out as 1e-17 instead of zero.
  Eigen::MatrixXd a(2, 3);
  a << 1, 0, 1e-17, 0, 1, -2e-17;
  const Eigen::MatrixXd b = with_row(a, Eigen::RowVector3d(1, 1, 3e-17));
  for (Kernel kernel : rank_kernels()) {
    const RankReport report = report_of(b, kernel);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.rank, 2);
    EXPECT_EQ(report.free_columns, (std::vector<int>{2}));
  }
}

TEST(RevealRank, SeparatesSmallAnglesFromNone) {
  if (!is_compiled_in(Kernel::spqr)) GTEST_SKIP() << "needs SPQR";
  for (double angle : {1e-3, 1e-6, 1e-8, 1e-12, 0.0}) {
    Eigen::MatrixXd a(3, 3);
    a << 1, 2, 0, 2, 1, 0, 1, 1, angle;
    // The column's own scale must come from elsewhere, else scaling would rightly restore the angle.
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(4, 4);
    b.topLeftCorner(3, 3) = a;
    b(3, 2) = b(3, 3) = 1;
    const RankReport report = report_of(b, Kernel::spqr);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.rank, angle > 1e-10 ? 4 : 3) << angle;
    EXPECT_TRUE(report.verified) << report.warning;
  }
}

TEST(RevealRank, ALongDriveTrainIsRegularStageByStage) {
  // Stages of ratio 10 in series: x_k = 10 x_(k-1). The smallest singular value is 1e-60, yet nothing is dependent.
  const int n = 60;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < n; ++k) {
    a(k, k) = 1;
    if (k > 0) a(k, k - 1) = -10;
  }
  for (bool reversed : {false, true}) {
    const Eigen::MatrixXd b = reversed ? Eigen::MatrixXd(a.colwise().reverse()) : a;
    for (Kernel kernel : rank_kernels()) {
      const RankReport report = report_of(b, kernel);
      ASSERT_TRUE(report.ok());
      EXPECT_EQ(report.rank, n);
      EXPECT_TRUE(report.verified) << report.warning;
    }
  }
}

TEST(RevealRank, ARankNearTheToleranceIsNotCertified) {
  if (!is_compiled_in(Kernel::spqr)) GTEST_SKIP() << "needs SPQR";
  Eigen::MatrixXd a(4, 4);
  a << 1, 2, 0, 0, 2, 1, 0, 0, 1, 1, 6e-10, 0, 0, 0, 1, 1;
  const RankReport report = report_of(a, Kernel::spqr);
  ASSERT_TRUE(report.ok());
  EXPECT_FALSE(report.verified);
  EXPECT_NE(report.warning.find("not definite"), std::string::npos);
}

TEST(RevealRank, LeavesOutNullVectorsBeyondTheLimits) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Ones(5, 7);
  const Matrix matrix = sparse(a);
  const RankReport report =
      reveal_rank(matrix.pattern, matrix.values, {.most_dependencies = 3, .most_null_vectors = 5});
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report.rank, 1);
  EXPECT_EQ(report.dependent_rows.size(), 4u);
  EXPECT_EQ(report.left_null_vectors.count(), 0);
  EXPECT_EQ(report.free_columns.size(), 6u);
  EXPECT_EQ(report.right_null_vectors.count(), 0);
}

TEST(RevealRank, ScalesToManyRowsWithLocalDependencies) {
  // 4000 dyads, every tenth of them with a duplicated joint: the combinations stay local, two rows each.
  Random random(57);
  const int dyads = 4000;
  Matrix base = dyad_chain(dyads, random);
  std::vector<Triplet> triplets;
  const SlottedPattern turned = transpose(base.pattern);
  std::vector<double> by_rows(base.values.size());
  for (std::size_t k = 0; k < base.values.size(); ++k) by_rows[turned.slot[k]] = base.values[k];
  int rows = base.pattern.rows, added = 0;
  for (int row = 0; row < base.pattern.rows; ++row) {
    const bool doubled = row % 60 == 5;
    for (int k = turned.pattern.column_start[row]; k < turned.pattern.column_start[row + 1]; ++k) {
      triplets.push_back({row, turned.pattern.row_index[k], by_rows[k]});
      if (doubled) triplets.push_back({rows, turned.pattern.row_index[k], -2 * by_rows[k]});
    }
    if (doubled) ++rows, ++added;
  }
  const Matrix matrix = assemble(rows, base.pattern.columns, triplets);
  const RankReport report = reveal_rank(matrix.pattern, matrix.values);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(static_cast<int>(report.dependent_rows.size()), added);
  EXPECT_EQ(report.rank, base.pattern.columns);
  for (int k = 0; k < report.left_null_vectors.count(); ++k) EXPECT_EQ(report.left_null_vectors.indices(k).size(), 2u);
}

TEST(RevealRank, RefusesBadInput) {
  const SparsePattern pattern = build_pattern(1, 1, std::vector<MatrixEntry>{{0, 0}}).pattern;
  EXPECT_THROW((void)reveal_rank(pattern, {}), std::invalid_argument);
  EXPECT_EQ(reveal_rank(pattern, std::vector<double>{std::numeric_limits<double>::infinity()}).status,
            FactorStatus::not_finite);
  EXPECT_EQ(reveal_rank(pattern, std::vector<double>{1}, {.kernel = Kernel::klu}).status, FactorStatus::unavailable);
  EXPECT_EQ(reveal_rank(pattern, std::vector<double>{1}, {.kernel = Kernel::spqr}).ok(), is_compiled_in(Kernel::spqr));
}

}  // namespace
}  // namespace catena::testing
