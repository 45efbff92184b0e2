// ConstraintSolver against dense algebra: least changes with held coordinates, dependent rows, damping and compliance;
// accelerations with unequal and zero masses and with rows left out. Random linkages, trees of pinned bodies with
// loops.
#include "catena/assembly/systems/constraint_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/systems/seen_mass.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"
#include "references/dense.hpp"

namespace catena {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Values of Phi_q of a random linkage; `twice`: every third joint is there a second time.
struct Linkage {
  std::mt19937 engine;
  Model model;
  std::shared_ptr<const Plan> plan;
  std::vector<double> values;
  MatrixXd phi;  // rows x coordinates

  double random(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }

  Linkage(unsigned seed, bool twice) : engine(seed) {
    const int bodies = 3 + static_cast<int>(seed % 5);
    for (int b = 0; b < bodies; ++b) {
      const double x = random(-1, 1), y = random(-1, 1), angle = random(-3, 3);
      model.add_body("b" + std::to_string(b), {.mass = 1, .inertia = 1, .position = {x, y}, .angle = angle});
    }
    int joints = 0;
    const auto join = [&](int i, int j) {
      const double x = random(-1, 1), y = random(-1, 1), u = random(-1, 1), v = random(-1, 1);
      model.add("j" + std::to_string(joints++), Revolute<>{{x, y}, {u, v}}, i, j);
      if (twice && joints % 3 == 0) model.add("again" + std::to_string(joints), Revolute<>{{x, y}, {u, v}}, i, j);
    };
    for (int b = 0; b < bodies; ++b) join(b == 0 ? ground : static_cast<int>(engine() % static_cast<unsigned>(b)), b);
    for (int loop = 0; loop < (bodies - 1) / 2; ++loop) join(ground, bodies - 1 - loop);
    plan = Plan::make(model);
    EvaluationWork work;
    Evaluator evaluator(plan, model, work);
    evaluator.set_configuration(evaluator.given_configuration());
    values.resize(at(plan->trash_slot()) + 1);
    evaluator.start_jacobian(values);
    evaluator.jacobian(values);
    phi = MatrixXd::Zero(plan->rows, 3 * plan->moving);
    for (int c = 0; c < plan->columns; ++c) {
      for (int k = plan->jacobian.column_start[at(c)]; k < plan->jacobian.column_start[at(c) + 1]; ++k)
        phi(plan->jacobian.row_index[at(k)], plan->coordinate[at(c)]) += values[at(k)];
    }
  }
  VectorXd any(Eigen::Index size) {
    VectorXd x(size);
    for (double& value : x) value = random(-1, 1);
    return x;
  }
  /// Weights over some powers of ten, one in `held` of them zero.
  VectorXd weights(double powers, unsigned held = 0) {
    VectorXd w(phi.cols());
    for (double& value : w) {
      const double power = random(-powers, powers);
      value = held > 0 && engine() % held == 0 ? 0 : std::pow(10.0, power);
    }
    return w;
  }
};

std::span<const double> view(const VectorXd& x) { return {x.data(), at(static_cast<int>(x.size()))}; }
std::span<double> view(VectorXd& x) { return {x.data(), at(static_cast<int>(x.size()))}; }

VectorXd inverse(const VectorXd& w) {
  return w.unaryExpr([](double value) { return value > 0 ? 1 / value : 0.0; });
}

/// The least change by singular values, and the ratio of the largest to the least that is not zero; infinite where the
/// rank is not clear.
struct Least {
  VectorXd x;
  double condition = 0;
  Eigen::Index rank = 0;
};
Least least_by_svd(const MatrixXd& phi, const VectorXd& w, const VectorXd& b) {
  const VectorXd root = inverse(w).cwiseSqrt();
  const testing::SingularValues svd = testing::singular_values(phi * root.asDiagonal());
  const Eigen::Index rank = svd.rank(1e-10);
  const double least = rank > 0 ? svd.values[rank - 1] : 1;
  return {root.asDiagonal() * svd.solve(b, rank), least > 1e-4 * svd.values[0] ? svd.values[0] / least : INFINITY,
          rank};
}

TEST(ConstraintSolver, TheLeastChangeIsThatOfSingularValues) {
  int compared = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    Linkage linkage(seed, seed % 3 == 0);
    const VectorXd w = linkage.weights(1, seed % 2 == 0 ? 8 : 0);
    ConstraintSolver solver(linkage.plan);
    Counters counters;
    solver.set_metric(view(w));
    ASSERT_TRUE(solver.factorize(linkage.values, counters));
    VectorXd reached = linkage.any(w.size()).cwiseProduct(w.unaryExpr([](double v) { return v > 0 ? 1.0 : 0.0; }));
    const VectorXd b = linkage.phi * reached;
    const Least least = least_by_svd(linkage.phi, w, b);
    if (!std::isfinite(least.condition)) continue;
    ++compared;
    VectorXd x(w.size()), once(w.size()), lambda(b.size());
    solver.solve(view(b), view(x), view(lambda), counters);
    EXPECT_LE((x - least.x).norm(), 1e-13 * least.condition * (1 + least.x.norm())) << seed;
    EXPECT_LE((x - VectorXd(inverse(w).asDiagonal() * (linkage.phi.transpose() * lambda))).norm(), 1e-12 * x.norm());
    solver.least_change(view(b), view(once), view(lambda), counters);
    EXPECT_LE((once - least.x).norm(), 1e-14 * std::pow(least.condition, 2) * (1 + least.x.norm())) << seed;
    EXPECT_EQ(counters.symbolic, 1);
    EXPECT_EQ(solver.is_regularised(), least.rank < b.size()) << seed;
    // Damped: no longer, and the shorter the more.
    double before = x.cwiseAbs2().dot(w);
    for (double damping : {1e-6, 1e-2, 1e2, 1e6}) {
      ASSERT_TRUE(solver.factorize_damped(linkage.values, damping, counters));
      solver.solve(view(b), view(once), view(lambda), counters);
      const double now = once.cwiseAbs2().dot(w);
      EXPECT_LE(now, before * (1 + 1e-9)) << seed << " " << damping;
      before = now;
    }
    EXPECT_LE(before, 1e-6 * x.cwiseAbs2().dot(w)) << seed;
  }
  EXPECT_GE(compared, 100);
}

TEST(ConstraintSolver, CompliantRowsAreMetInPart) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Linkage linkage(seed, seed % 2 == 0);
    const VectorXd w = linkage.weights(1, seed % 3 == 0 ? 8 : 0), b = linkage.any(linkage.phi.rows());
    VectorXd compliance(b.size());
    for (double& value : compliance) {
      const double power = linkage.random(-3, 1);
      value = std::pow(10.0, power);
    }
    ConstraintSolver solver(linkage.plan);
    Counters counters;
    solver.set_metric(view(w));
    ASSERT_TRUE(solver.factorize_compliant(linkage.values, view(compliance), counters));
    VectorXd x(w.size()), lambda(b.size());
    solver.solve(view(b), view(x), view(lambda), counters);
    const MatrixXd transposed = inverse(w).asDiagonal() * linkage.phi.transpose();
    const MatrixXd full = linkage.phi * transposed + MatrixXd(compliance.asDiagonal());
    const VectorXd expected = testing::solve<double>(full, b);
    EXPECT_LE((lambda - expected).norm(), 1e-9 * expected.norm()) << seed;
    EXPECT_LE((x - transposed * expected).norm(), 1e-9 * x.norm()) << seed;
    // What is asked for without compliance afterwards has none.
    ASSERT_TRUE(solver.factorize(linkage.values, counters));
    const VectorXd met = linkage.phi * linkage.any(w.size()).cwiseProduct(w.cwiseSign());
    solver.solve(view(met), view(x), view(lambda), counters);
    EXPECT_LE((linkage.phi * x - met).norm(), 1e-8 * met.norm()) << seed;
  }
}

/// qdd of [M, Phi_q^T; Phi_q, 0] by least squares of the full system; empty where it is not determined well.
VectorXd dense_motion(const Linkage& linkage, const VectorXd& mass, const VectorXd& Q, const VectorXd& gamma) {
  const Eigen::Index n = mass.size(), rows = gamma.size();
  MatrixXd full = MatrixXd::Zero(n + rows, n + rows);
  full.topLeftCorner(n, n) = mass.asDiagonal();
  full.topRightCorner(n, rows) = linkage.phi.transpose();
  full.bottomLeftCorner(rows, n) = linkage.phi;
  VectorXd right(n + rows);
  right << Q, gamma;
  const testing::SingularValues svd = testing::singular_values(full);
  const Eigen::Index rank = svd.rank(1e-11);
  if (svd.values[rank - 1] < 1e-4 * svd.values[0]) return {};
  return svd.solve(right, rank).head(n);
}

TEST(ConstraintSolver, AccelerationsAreThoseOfTheFullSystem) {
  int compared = 0, massless_ones = 0, left_out = 0, regular = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    Linkage linkage(seed, seed % 3 == 0);
    VectorXd mass = linkage.weights(0.5, seed % 2 == 0 ? 6 : 0);
    const VectorXd Q = linkage.any(mass.size());
    const VectorXd gamma = linkage.phi * linkage.any(mass.size());
    const VectorXd expected = dense_motion(linkage, mass, Q, gamma);
    if (expected.size() == 0) continue;
    const std::vector<double> seen = seen_masses(*linkage.plan, view(mass), linkage.values);
    VectorXd substitute(mass.size());
    for (Eigen::Index c = 0; c < mass.size(); ++c) substitute[c] = 1e-4 * seen[at(static_cast<int>(c))];
    ConstraintSolver solver(linkage.plan);
    Counters counters;
    solver.set_metric(view(mass), view(substitute));
    ASSERT_TRUE(solver.factorize(linkage.values, counters));
    if (seed % 3 == 0) {
      // The second of two joints at one place: its rows are left out.
      SparseVectors directions;
      const std::vector<double> sizes = solver.row_sizes();
      for (int row = 0; row < linkage.plan->rows; ++row) {
        if (!linkage.model.element_name(linkage.plan->row_element[at(row)]).starts_with("again")) continue;
        directions.index.push_back(row);
        directions.value.push_back(sizes[at(row)]);
        directions.start.push_back(static_cast<int>(directions.index.size()));
      }
      left_out += directions.count();
      solver.leave_out(std::move(directions));
      ASSERT_TRUE(solver.factorize(linkage.values, counters));
      // Bodies with two pins in the ground still have dependent rows.
      const Eigen::Index rank = least_by_svd(linkage.phi, mass + substitute, gamma).rank;
      EXPECT_EQ(solver.is_regularised(), rank < gamma.size() - solver.left_out().count()) << seed;
      regular += !solver.is_regularised();
    }
    VectorXd qdd(mass.size()), lambda(gamma.size());
    solver.solve_motion(view(Q), view(gamma), view(qdd), view(lambda), counters);
    ++compared;
    massless_ones += (mass.array() == 0).any();
    EXPECT_LE((qdd - expected).norm(), 1e-8 * (1 + expected.norm())) << seed;
    EXPECT_LE(solver.massless_residual(), 1e-9) << seed;
  }
  EXPECT_GE(compared, 60);
  EXPECT_GE(massless_ones, 10);
  EXPECT_GE(left_out, 30);
  EXPECT_GE(regular, 10);
}

TEST(ConstraintSolver, UnequalMassesKeepTheirDigits) {
  int compared = 0;
  for (unsigned seed = 0; seed < 120; ++seed) {
    Linkage linkage(seed, false);
    const VectorXd mass = linkage.weights(4), Q = linkage.any(mass.size());
    ConstraintSolver solver(linkage.plan);
    Counters counters;
    solver.set_metric(view(mass));
    ASSERT_TRUE(solver.factorize(linkage.values, counters));
    if (solver.smallest_pivot_ratio() < 1e-4) continue;
    ++compared;
    VectorXd qdd(mass.size()), lambda(linkage.phi.rows());
    const VectorXd gamma = linkage.any(lambda.size());
    solver.solve_motion(view(Q), view(gamma), view(qdd), view(lambda), counters);
    const VectorXd forces = mass.asDiagonal() * qdd, pull = linkage.phi.transpose() * lambda;
    for (Eigen::Index c = 0; c < mass.size(); ++c) {
      double size = std::abs(forces[c]) + std::abs(Q[c]);
      for (Eigen::Index r = 0; r < lambda.size(); ++r) size += std::abs(linkage.phi(r, c) * lambda[r]);
      EXPECT_LE(std::abs(forces[c] - Q[c] + pull[c]), 1e-12 * size) << seed << " " << c;
    }
    EXPECT_LE((linkage.phi * qdd - gamma).norm(), 1e-11 * (gamma.norm() + qdd.norm())) << seed;
  }
  EXPECT_GE(compared, 10);
}

// Those that are refined, each by itself, are among them.
TEST(ConstraintSolver, SolvesRowsAsOneByOne) {
  constexpr std::size_t width = 8;
  SchurRows scratch;
  int at_once = 0, refined = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    Linkage linkage(seed, seed % 3 == 0);
    const VectorXd mass = linkage.weights(seed % 2 == 0 ? 0.5 : 4);
    ConstraintSolver solver(linkage.plan);
    Counters counters;
    solver.set_metric(view(mass));
    ASSERT_TRUE(solver.factorize(linkage.values, counters));
    if (solver.is_regularised()) continue;
    ++(seed % 2 == 0 && solver.smallest_pivot_ratio() > 1e-2 ? at_once : refined);
    const auto coordinates = static_cast<std::size_t>(mass.size()), rows = at(linkage.plan->rows);
    std::vector<double> x(coordinates * width), lambda(rows * width);
    std::vector<VectorXd> qdd, multipliers;
    for (std::size_t p = 0; p < width; ++p) {
      const VectorXd Q = linkage.any(mass.size()), gamma = linkage.any(static_cast<Eigen::Index>(rows));
      for (std::size_t c = 0; c < coordinates; ++c) x[c * width + p] = Q[static_cast<Eigen::Index>(c)];
      for (std::size_t r = 0; r < rows; ++r) lambda[r * width + p] = -gamma[static_cast<Eigen::Index>(r)];
      qdd.emplace_back(mass.size());
      multipliers.emplace_back(gamma.size());
      solver.solve_motion(view(Q), view(gamma), view(qdd.back()), view(multipliers.back()), counters);
    }
    solver.solve_motion_rows(x, lambda, width, scratch, counters);
    for (std::size_t p = 0; p < width; ++p) {
      for (const int c : linkage.plan->coordinate)
        EXPECT_NEAR(x[at(c) * width + p], qdd[p][c], 1e-14 * qdd[p].lpNorm<Eigen::Infinity>()) << seed;
      for (std::size_t r = 0; r < rows; ++r)
        EXPECT_NEAR(lambda[r * width + p], multipliers[p][static_cast<Eigen::Index>(r)],
                    1e-14 * multipliers[p].lpNorm<Eigen::Infinity>())
            << seed;
    }
  }
  EXPECT_GE(at_once, 5);
  EXPECT_GE(refined, 5);
}

}  // namespace
}  // namespace catena
