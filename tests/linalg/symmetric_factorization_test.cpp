#include "catena/linalg/factorization/symmetric_factorization.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "linalg/matrices.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

std::span<double> span_of(Eigen::VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

Matrix lower_triangle(const Eigen::MatrixXd& full) {
  return sparse(Eigen::MatrixXd(full.triangularView<Eigen::Lower>()));
}

/// A A^T + I of a sparse random matrix.
Eigen::MatrixXd positive_definite(int n, Random& random) {
  const Eigen::MatrixXd a = dense(random_matrix(n, n, 2, random));
  return a * a.transpose() + Eigen::MatrixXd::Identity(n, n);
}

/// [H, B^T; B, -eps I] with H positive definite, n bodies' columns and m joints' rows.
Eigen::MatrixXd quasi_definite(int n, int m, double eps, Random& random) {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n + m, n + m);
  k.topLeftCorner(n, n) = positive_definite(n, random);
  const Eigen::MatrixXd b = dense(random_matrix(m, n, 3, random));
  k.bottomLeftCorner(m, n) = b;
  k.topRightCorner(n, m) = b.transpose();
  k.bottomRightCorner(m, m) = -eps * Eigen::MatrixXd::Identity(m, m);
  return k;
}

Inertia inertia_by_eigenvalues(const Eigen::MatrixXd& full) {
  const Eigen::VectorXd values = symmetric_eigenvalues<double>(full);
  return {static_cast<int>((values.array() > 0).count()), static_cast<int>((values.array() < 0).count()), 0};
}

/// The regularised saddle-point matrix of a chain of `bodies` unit masses joined end to end, as a list of triplets of
/// its lower triangle, and the groups that keep bodies before joints.
struct ChainSystem {
  Matrix lower;
  std::vector<int> groups;
};

ChainSystem chain_system(int bodies, double eps) {
  const int n = 3 * bodies;
  std::vector<Triplet> triplets;
  for (int k = 0; k < n; ++k) triplets.push_back({k, k, k % 3 == 2 ? 0.1 : 1.0});
  Random random(5);
  for (int joint = 0; joint < bodies; ++joint) {
    for (int axis = 0; axis < 2; ++axis) {
      const int row = n + 2 * joint + axis;
      triplets.push_back({row, row, -eps});
      for (int side = 0; side < 2; ++side) {
        const int body = joint - 1 + side;
        if (body < 0) continue;
        triplets.push_back({row, 3 * body + axis, side == 0 ? 1.0 : -1.0});
        triplets.push_back({row, 3 * body + 2, random.uniform(-0.5, 0.5)});
      }
    }
  }
  ChainSystem system{assemble(n + 2 * bodies, n + 2 * bodies, triplets), std::vector<int>(n + 2 * bodies, 1)};
  std::fill_n(system.groups.begin(), n, 0);
  return system;
}

TEST(SymmetricFactorization, SolvesPositiveDefiniteSystemsInEveryFormAndOrder) {
  Random random(31);
  for (int n : {1, 2, 9, 80}) {
    const Eigen::MatrixXd a = positive_definite(n, random);
    const Matrix lower = lower_triangle(a);
    std::vector<int> reversed(n), groups(n);
    for (int k = 0; k < n; ++k) reversed[k] = n - 1 - k, groups[k] = k % 3 == 0 ? std::min(1, n - 1) : 0;
    for (SymmetricForm form : {SymmetricForm::ldl, SymmetricForm::ll}) {
      for (SymmetricOrdering ordering :
           {SymmetricOrdering::amd, SymmetricOrdering::natural, SymmetricOrdering::given, SymmetricOrdering::grouped}) {
        Counters counters;
        SymmetricFactorization factorization;
        ASSERT_TRUE(factorization.analyze(lower.pattern, {form, ordering, reversed, groups}, counters).ok());
        ASSERT_TRUE(factorization.factorize(lower.values, 0, counters).ok());
        const Eigen::VectorXd expected = random_vector(n, random);
        Eigen::VectorXd x = a * expected;
        factorization.solve(span_of(x), counters);
        EXPECT_LT((x - expected).lpNorm<Eigen::Infinity>(), 1e-12) << n;
        EXPECT_EQ(factorization.inertia(), (Inertia{n, 0, 0}));
        EXPECT_EQ(counters.symbolic, 1);
        EXPECT_EQ(counters.factorizations, 1);
        EXPECT_EQ(counters.refactorizations, 0);
        EXPECT_EQ(counters.solves, 1);
      }
    }
  }
}

TEST(SymmetricFactorization, UsesTheOrderItIsGiven) {
  Random random(32);
  const Matrix lower = lower_triangle(positive_definite(12, random));
  std::vector<int> permutation{3, 1, 4, 11, 5, 9, 2, 6, 0, 8, 7, 10};
  Counters counters;
  SymmetricFactorization factorization;
  SymmetricOptions options{.ordering = SymmetricOrdering::given, .permutation = permutation};
  ASSERT_TRUE(factorization.analyze(lower.pattern, options, counters).ok());
  EXPECT_TRUE(std::equal(permutation.begin(), permutation.end(), factorization.order().begin()));
  options = {.ordering = SymmetricOrdering::natural};
  ASSERT_TRUE(factorization.analyze(lower.pattern, options, counters).ok());
  for (int k = 0; k < 12; ++k) EXPECT_EQ(factorization.order()[k], k);
}

TEST(SymmetricFactorization, GroupsKeepEveryBodyBeforeItsJoints) {
  const ChainSystem system = chain_system(200, 1e-12);
  Counters counters;
  SymmetricFactorization factorization;
  const SymmetricOptions options{.ordering = SymmetricOrdering::grouped, .groups = system.groups};
  ASSERT_TRUE(factorization.analyze(system.lower.pattern, options, counters).ok());
  std::vector<int> place(factorization.size());
  for (int k = 0; k < factorization.size(); ++k) place[factorization.order()[k]] = k;
  const SparsePattern& pattern = system.lower.pattern;
  for (int j = 0; j < pattern.columns; ++j) {
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row_index[k];
      if (system.groups[i] > system.groups[j]) {
        EXPECT_LT(place[j], place[i]);
      }
    }
  }
  // Fill-in stays linear: the joints' Schur complement of a chain is block tridiagonal.
  EXPECT_LT(factorization.factor_entries(), 20 * 200);
}

TEST(SymmetricFactorization, GroupsSaveTheDigitsThatAFreeOrderLoses) {
  const ChainSystem system = chain_system(200, 1e-12);
  const int n = system.lower.pattern.columns;
  Random random(33);
  const Eigen::VectorXd b = random_vector(n, random);
  const Eigen::MatrixXd lower = dense(system.lower);
  const Eigen::MatrixXd full = lower + lower.transpose() - Eigen::MatrixXd(lower.diagonal().asDiagonal());
  const auto residual_with = [&](const SymmetricOptions& options) {
    Counters counters;
    SymmetricFactorization factorization;
    EXPECT_TRUE(factorization.analyze(system.lower.pattern, options, counters).ok());
    EXPECT_TRUE(factorization.factorize(system.lower.values, 0, counters).ok());
    Eigen::VectorXd x = b;
    factorization.solve(span_of(x), counters);
    return (b - full * x).lpNorm<Eigen::Infinity>() / x.lpNorm<Eigen::Infinity>();
  };
  EXPECT_LT(residual_with({.ordering = SymmetricOrdering::grouped, .groups = system.groups}), 1e-12);
  std::vector<int> joints_first(n);
  for (int k = 0; k < n; ++k) joints_first[k] = (k + 600) % n;
  EXPECT_GT(residual_with({.ordering = SymmetricOrdering::given, .permutation = joints_first}), 1e-9);
}

TEST(SymmetricFactorization, InertiaAgreesWithTheEigenvalues) {
  Random random(34);
  for (int round = 0; round < 20; ++round) {
    const int n = 5 + random.below(25), m = random.below(n);
    const Eigen::MatrixXd k = quasi_definite(n, m, std::pow(10, random.uniform(-6, 0)), random);
    const Matrix lower = lower_triangle(k);
    std::vector<int> groups(n + m, 0);
    std::fill(groups.begin() + n, groups.end(), 1);
    Counters counters;
    SymmetricFactorization factorization;
    const SymmetricOptions options{.ordering = SymmetricOrdering::grouped, .groups = groups};
    ASSERT_TRUE(factorization.analyze(lower.pattern, options, counters).ok());
    ASSERT_TRUE(factorization.factorize(lower.values, 0, counters).ok());
    EXPECT_EQ(factorization.inertia(), (Inertia{n, m, 0}));
    EXPECT_EQ(factorization.inertia(), inertia_by_eigenvalues(k));
    // Shifted into the middle of the spectrum the form is indefinite, still with the signs of the eigenvalues.
    const double shift = random.uniform(-3, 3);
    ASSERT_TRUE(factorization.factorize(lower.values, shift, counters).ok());
    EXPECT_EQ(factorization.inertia(), inertia_by_eigenvalues(k + shift * Eigen::MatrixXd::Identity(n + m, n + m)));
    EXPECT_EQ(counters.refactorizations, 1);
  }
}

TEST(SymmetricFactorization, NamesTheRowOfABreakdown) {
  // Row 2 repeats row 0, in numbers whose arithmetic is exact.
  Eigen::MatrixXd a(3, 3);
  a << 4, 2, 4, 2, 5, 2, 4, 2, 4;
  const Matrix lower = lower_triangle(a);
  for (SymmetricForm form : {SymmetricForm::ldl, SymmetricForm::ll}) {
    Counters counters;
    SymmetricFactorization factorization;
    const SymmetricOptions options{.form = form, .ordering = SymmetricOrdering::natural};
    ASSERT_TRUE(factorization.analyze(lower.pattern, options, counters).ok());
    const FactorResult result = factorization.factorize(lower.values, 0, counters);
    EXPECT_EQ(result.status, FactorStatus::singular);
    EXPECT_EQ(result.index, 2);
    std::vector<double> x(3, 1.0);
    EXPECT_THROW(factorization.solve(x, counters), std::logic_error);
    EXPECT_EQ(factorization.rcond(), 0);
    // A shift mends it, in the same object.
    ASSERT_TRUE(factorization.factorize(lower.values, 1, counters).ok());
    Eigen::VectorXd b = (a + Eigen::MatrixXd::Identity(3, 3)) * Eigen::Vector3d(1, -2, 3);
    factorization.solve(span_of(b), counters);
    EXPECT_LT((b - Eigen::Vector3d(1, -2, 3)).norm(), 1e-14);
  }
}

TEST(SymmetricFactorization, RefusesAnIndefiniteMatrixForCholesky) {
  Eigen::MatrixXd a(2, 2);
  a << 1, 2, 2, 1;
  const Matrix lower = lower_triangle(a);
  Counters counters;
  SymmetricFactorization factorization;
  ASSERT_TRUE(factorization
                  .analyze(lower.pattern, {.form = SymmetricForm::ll, .ordering = SymmetricOrdering::natural}, counters)
                  .ok());
  const FactorResult result = factorization.factorize(lower.values, 0, counters);
  EXPECT_EQ(result.status, FactorStatus::singular);
  EXPECT_EQ(result.index, 1);
}

TEST(SymmetricFactorization, ReportsValuesThatAreNotFinite) {
  const Matrix lower =
      assemble(3, 3, {{0, 0, 1}, {1, 1, std::numeric_limits<double>::quiet_NaN()}, {2, 1, 1}, {2, 2, 4}});
  for (SymmetricForm form : {SymmetricForm::ldl, SymmetricForm::ll}) {
    Counters counters;
    SymmetricFactorization factorization;
    ASSERT_TRUE(
        factorization.analyze(lower.pattern, {.form = form, .ordering = SymmetricOrdering::natural}, counters).ok());
    const FactorResult result = factorization.factorize(lower.values, 0, counters);
    EXPECT_EQ(result.status, FactorStatus::not_finite);
    EXPECT_EQ(result.index, 1);
    // Nothing of it is left behind.
    ASSERT_TRUE(factorization.factorize(std::vector<double>{1, 2, 1, 4}, 0, counters).ok());
    std::vector<double> x{1, 3, 5};
    factorization.solve(x, counters);
    EXPECT_NEAR(x[1], 1, 1e-15);
    EXPECT_NEAR(x[2], 1, 1e-15);
  }
}

TEST(SymmetricFactorization, PivotRatioIsTheSquaredSineBetweenRows) {
  // Rows of a Jacobian with a small angle between the last one and the plane of the others.
  const double angle = 1e-4;
  Eigen::MatrixXd rows(3, 3);
  rows << 1, 0, 0, 0.6, 0.8, 0, std::cos(angle) * 0.28, std::cos(angle) * 0.96, std::sin(angle);
  const Eigen::MatrixXd schur = 7.0 * rows * rows.transpose();
  const Matrix lower = lower_triangle(schur);
  for (SymmetricForm form : {SymmetricForm::ldl, SymmetricForm::ll}) {
    Counters counters;
    SymmetricFactorization factorization;
    ASSERT_TRUE(
        factorization.analyze(lower.pattern, {.form = form, .ordering = SymmetricOrdering::natural}, counters).ok());
    ASSERT_TRUE(factorization.factorize(lower.values, 0, counters).ok());
    const PivotRatio smallest = factorization.smallest_pivot_ratio();
    EXPECT_EQ(smallest.row, 2);
    EXPECT_NEAR(smallest.ratio, std::pow(std::sin(angle), 2), 1e-14);
    EXPECT_NEAR(factorization.pivot(2), 7 * std::pow(std::sin(angle), 2), 1e-13);
    EXPECT_DOUBLE_EQ(factorization.pivot_ratio(0), 1);
    EXPECT_NEAR(factorization.pivot_ratio(1), 0.64, 1e-14);
    EXPECT_EQ(factorization.inertia(1e-7), (Inertia{2, 0, 1}));
    EXPECT_EQ(factorization.inertia(1e-9), (Inertia{3, 0, 0}));
    EXPECT_NEAR(factorization.rcond(), std::pow(std::sin(angle), 2), 1e-12);
  }
}

TEST(SymmetricFactorization, PivotRatioMeasuresCancellationOfMixedSigns) {
  // [1, 0, 1; 0, -1, 1; 1, 1, e]: the last pivot is e - 1 + 1 = e, left over from terms of size 1.
  const double e = 1e-6;
  const Matrix lower = assemble(3, 3, {{0, 0, 1}, {2, 0, 1}, {1, 1, -1}, {2, 1, 1}, {2, 2, e}});
  Counters counters;
  SymmetricFactorization factorization;
  ASSERT_TRUE(factorization.analyze(lower.pattern, {.ordering = SymmetricOrdering::natural}, counters).ok());
  ASSERT_TRUE(factorization.factorize(lower.values, 0, counters).ok());
  EXPECT_EQ(factorization.smallest_pivot_ratio().row, 2);
  EXPECT_NEAR(factorization.smallest_pivot_ratio().ratio, e / (2 + e), 1e-15);
  EXPECT_EQ(factorization.pivot_ratio(1), 1);
}

TEST(SymmetricFactorization, RefinesAgainstTheTrueMatrix) {
  // The factored matrix carries -1e-6 I in its constraint block, the true one zero.
  Random random(35);
  const int n = 40, m = 15;
  Eigen::MatrixXd k = quasi_definite(n, m, 0, random);
  for (int i = 0; i < m; ++i) k(n + i, i) = k(i, n + i) = 2;  // full row rank
  Eigen::MatrixXd regularised = k;
  regularised.bottomRightCorner(m, m).diagonal().array() = -1e-6;
  const Matrix lower = lower_triangle(regularised);
  std::vector<int> groups(n + m, 0);
  std::fill(groups.begin() + n, groups.end(), 1);
  Counters counters;
  SymmetricFactorization factorization;
  const SymmetricOptions options{.ordering = SymmetricOrdering::grouped, .groups = groups};
  ASSERT_TRUE(factorization.analyze(lower.pattern, options, counters).ok());
  ASSERT_TRUE(factorization.factorize(lower.values, 0, counters).ok());
  const Eigen::VectorXd b = random_vector(n + m, random);
  Eigen::VectorXd plain = b, x = b;
  factorization.solve(span_of(plain), counters);
  const auto residual = [&](std::span<const double> at, std::span<double> r) {
    const Eigen::Map<const Eigen::VectorXd> point(at.data(), static_cast<int>(at.size()));
    Eigen::Map<Eigen::VectorXd> out(r.data(), static_cast<int>(r.size()));
    out = b - k * point;
    return out.lpNorm<Eigen::Infinity>();
  };
  const Refinement outcome =
      factorization.solve_refined(span_of(x), residual, {.tolerance = 1e-13, .max_steps = 5}, counters);
  EXPECT_TRUE(outcome.met);
  EXPECT_GE(outcome.steps, 1);
  EXPECT_LE((b - k * x).lpNorm<Eigen::Infinity>(), 1e-13);
  EXPECT_GT((b - k * plain).lpNorm<Eigen::Infinity>(), 1e-9) << "else nothing was to be refined";
  EXPECT_EQ(counters.solves, 2 + outcome.steps);
}

TEST(Refine, TakesBackACorrectionThatHarms) {
  // x = 3 of 1 x = 4 is corrected with the wrong sign: the residual doubles, so the step is undone.
  std::vector<double> x{3}, work(1), correction(1);
  const auto flipped = [](std::span<double> v) { v[0] = -v[0]; };
  const auto residual = [](std::span<const double> at, std::span<double> r) {
    r[0] = 4 - at[0];
    return std::abs(r[0]);
  };
  const Refinement outcome = refine(flipped, residual, x, work, correction, {.max_steps = 3});
  EXPECT_EQ(x[0], 3);
  EXPECT_EQ(outcome.steps, 0);
  EXPECT_EQ(outcome.residual, 1);
  EXPECT_FALSE(outcome.met);
}

TEST(SymmetricFactorization, SolvesSeveralRightHandSidesAtOnce) {
  Random random(36);
  const int n = 25, count = 6;
  const Eigen::MatrixXd a = positive_definite(n, random);
  const Matrix lower = lower_triangle(a);
  Counters counters;
  SymmetricFactorization factorization;
  ASSERT_TRUE(factorization.analyze(lower.pattern, {}, counters).ok());
  ASSERT_TRUE(factorization.factorize(lower.values, 0, counters).ok());
  const Eigen::VectorXd expected = random_vector(n * count, random);
  Eigen::VectorXd x(n * count);
  for (int k = 0; k < count; ++k) x.segment(k * n, n) = a * expected.segment(k * n, n);
  factorization.solve(span_of(x), counters);
  EXPECT_LT((x - expected).lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_EQ(counters.solves, count);
}

TEST(SymmetricFactorization, AcceptsTheEmptyMatrixAndRefusesMisuse) {
  Counters counters;
  SymmetricFactorization factorization;
  ASSERT_TRUE(factorization.analyze(SparsePattern{}, {}, counters).ok());
  ASSERT_TRUE(factorization.factorize({}, 0, counters).ok());
  factorization.solve({}, counters);
  EXPECT_EQ(factorization.inertia(), Inertia{});
  EXPECT_EQ(factorization.rcond(), 1);
  EXPECT_EQ(factorization.factor_entries(), 0);
  EXPECT_EQ(counters, Counters{});

  const SparsePattern upper = build_pattern(2, 2, std::vector<MatrixEntry>{{0, 0}, {0, 1}, {1, 1}}).pattern;
  EXPECT_THROW((void)factorization.analyze(upper, {}, counters), std::invalid_argument);
  EXPECT_THROW((void)factorization.analyze(build_pattern(2, 1, {}).pattern, {}, counters), std::invalid_argument);
  const SparsePattern diagonal = build_pattern(2, 2, std::vector<MatrixEntry>{{0, 0}, {1, 1}}).pattern;
  const std::vector<int> twice{0, 0}, outside{0, 5};
  EXPECT_THROW(
      (void)factorization.analyze(diagonal, {.ordering = SymmetricOrdering::given, .permutation = twice}, counters),
      std::invalid_argument);
  EXPECT_THROW(
      (void)factorization.analyze(diagonal, {.ordering = SymmetricOrdering::grouped, .groups = outside}, counters),
      std::invalid_argument);
  ASSERT_TRUE(factorization.analyze(diagonal, {}, counters).ok());
  EXPECT_THROW((void)factorization.factorize(std::vector<double>{1}, 0, counters), std::invalid_argument);
  EXPECT_THROW((void)factorization.inertia(), std::logic_error);
}

}  // namespace
}  // namespace catena::testing
