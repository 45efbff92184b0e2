// Scaling of the matrix that is factored: units of columns, rows that change their size.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "catena/linalg/factorization/factorization.hpp"
#include "linalg/matrices.hpp"

namespace catena::testing {
namespace {

// Columns in other units, told so: the same solution, pivots and margins.
TEST(FactorizationScaling, ColumnUnitsMakePivotsIndependentOfUnits) {
  Random random(19);
  const Matrix matrix = dyad_chain(12, random);
  const int n = matrix.pattern.columns;
  const Eigen::VectorXd b = random_vector(n, random);
  Counters counters;
  Factorization reference;
  ASSERT_TRUE(reference.analyze(matrix.pattern, Kernel::klu, counters).ok());
  reference.set_column_units(std::vector<double>(static_cast<std::size_t>(n), 1.0));
  ASSERT_TRUE(reference.factorize(matrix.values, counters).ok());
  Eigen::VectorXd expected = b;
  reference.solve({expected.data(), expected.data() + n}, counters);
  for (double unit : {1e-6, 1e3}) {
    Matrix other = matrix;
    std::vector<double> units(static_cast<std::size_t>(n), 1.0);
    for (int c = 0; c < n; c += 3) {
      units[static_cast<std::size_t>(c)] = unit;
      for (int k = matrix.pattern.column_start[c]; k < matrix.pattern.column_start[c + 1]; ++k) other.values[k] /= unit;
    }
    Factorization factorization;
    ASSERT_TRUE(factorization.analyze(other.pattern, Kernel::klu, counters).ok());
    factorization.set_column_units(units);
    ASSERT_TRUE(factorization.factorize(other.values, counters).ok());
    EXPECT_NEAR(factorization.rcond() / reference.rcond(), 1, 1e-12);
    const auto margins = factorization.block_margins(), known = reference.block_margins();
    ASSERT_EQ(margins.size(), known.size());
    for (std::size_t k = 0; k < margins.size(); ++k) {
      EXPECT_NEAR(margins[k].determinant, known[k].determinant, 1e-12 * std::abs(known[k].determinant));
    }
    // Refactored, too, and with the transposed matrix.
    for (double& value : other.values) value *= 2;
    ASSERT_TRUE(factorization.factorize(other.values, counters).ok());
    const Eigen::MatrixXd a = dense(other);
    Eigen::VectorXd x = b, z = b;
    factorization.solve({x.data(), x.data() + n}, counters);
    factorization.solve_transposed({z.data(), z.data() + n}, counters);
    for (int c = 0; c < n; ++c) {
      EXPECT_NEAR(2 * x[c] / units[static_cast<std::size_t>(c)], expected[c],
                  1e-11 * expected.lpNorm<Eigen::Infinity>());
    }
    EXPECT_LT((a.transpose() * z - b).lpNorm<Eigen::Infinity>(),
              1e-13 * (a.cwiseAbs().transpose() * z.cwiseAbs()).maxCoeff());
  }
  EXPECT_THROW(reference.set_column_units({}), std::invalid_argument);
}

// Rows that grow far beyond what they were scaled by get new pivots, not wrong ones.
TEST(FactorizationScaling, RowsThatOutgrowTheirScaleAreScaledAnew) {
  Random random(20);
  Matrix matrix = dyad_chain(6, random);
  const int n = matrix.pattern.columns;
  const std::vector<double> values = matrix.values;
  Counters counters;
  Factorization factorization;
  ASSERT_TRUE(factorization.analyze(matrix.pattern, Kernel::klu, counters).ok());
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (matrix.pattern.row_index[k] == 4) matrix.values[k] *= 1e-9;
  }
  ASSERT_TRUE(factorization.factorize(matrix.values, counters).ok());
  ASSERT_TRUE(factorization.factorize(values, counters).ok());
  EXPECT_EQ(counters.factorizations, 3);
  EXPECT_GT(factorization.rcond(), 1e-4);
  matrix.values = values;
  const Eigen::MatrixXd a = dense(matrix);
  const Eigen::VectorXd b = random_vector(n, random);
  Eigen::VectorXd x = b;
  factorization.solve({x.data(), x.data() + n}, counters);
  EXPECT_LT((a * x - b).lpNorm<Eigen::Infinity>(), 1e-12 * a.cwiseAbs().maxCoeff() * x.lpNorm<Eigen::Infinity>());
}

}  // namespace
}  // namespace catena::testing
