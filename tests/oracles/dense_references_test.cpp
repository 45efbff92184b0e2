// The dense algebra of the references: random scenes without constraints, or without free coordinates, give matrices
// without rows or columns.
#include <gtest/gtest.h>

#include "references/dense.hpp"

namespace catena::testing {
namespace {

TEST(DenseReferences, WithoutRowsAllVectorsAreTheNullSpace) {
  const DenseRows<long double> rows(DenseMatrix<long double>(0, 3), 1e-9L);
  EXPECT_EQ(rows.rank(), 0);
  EXPECT_TRUE(rows.independent().empty());
  EXPECT_EQ(rows.null_space(), (DenseMatrix<long double>::Identity(3, 3)));
  EXPECT_EQ(rows.multipliers(DenseVector<long double>::Ones(3)).size(), 0);
}

TEST(DenseReferences, TheShortestSolutionOfNoEquationIsZero) {
  EXPECT_EQ(LeastSquares<double>(DenseMatrix<double>(0, 2)).solve(DenseVector<double>(0)),
            (DenseVector<double>::Zero(2)));
  EXPECT_EQ(LeastSquares<double>(DenseMatrix<double>(2, 0)).solve(DenseVector<double>::Ones(2)).size(), 0);
}

TEST(DenseReferences, NullSpaceAndMultipliersAreThoseOfTheRows) {
  DenseMatrix<double> a(3, 3);
  a << 1, 2, 2, 2, 4, 4, 0, 1, -1;
  const DenseRows<double> rows(a, 1e-12);
  ASSERT_EQ(rows.rank(), 2);
  EXPECT_LT((a * rows.null_space()).norm(), 1e-14);
  EXPECT_LT((a.transpose() * rows.multipliers(a.row(1) + a.row(2)) - (a.row(1) + a.row(2)).transpose()).norm(), 1e-13);
}

}  // namespace
}  // namespace catena::testing
