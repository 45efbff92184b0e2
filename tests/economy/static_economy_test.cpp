// What static equilibrium must not do: orderings, factorizations and allocations beyond those that a solution needs.
#include <gtest/gtest.h>

#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/analysis/statics/solvers/static_newton.hpp"
#include "economy/allocations.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using testing::allocations;
using testing::ChainStart;

TEST(StaticEconomy, OneFactorizationForMultipliersOneAnIterationAndOneForTheCertificate) {
  for (const int count : {100, 1000, 10000}) {
    SCOPED_TRACE(count);
    Equilibrium chain(testing::hanging_chain(count, ChainStart::zigzag));
    const EquilibriumReport report = chain.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_TRUE(report.stable);
    EXPECT_LE(report.iterations, 9);
    EXPECT_EQ(report.counters.symbolic, 1);
    // Where the exact matrix comes too early one more is factored, once.
    EXPECT_LE(report.counters.factorizations, report.iterations + 3);
    EXPECT_EQ(report.counters.refactorizations, report.counters.factorizations - 1);
    // One solve an iteration; the rest are the first multipliers, the last corrections, the softest mode.
    EXPECT_LE(report.counters.solves, report.iterations + 13);
    EXPECT_EQ(report.counters.fallbacks, 0);
  }
}

TEST(StaticEconomy, TheCertificateTakesOneFactorization) {
  const auto model = testing::hanging_chain(300, ChainStart::sag);
  EvaluationWork work;
  Evaluator evaluator(Plan::make(*model), *model, work);
  StaticSystem system(evaluator);
  std::vector<double> q = evaluator.given_configuration();
  std::vector<double> lambda(static_cast<std::size_t>(system.plan().rows));
  ASSERT_EQ(solve_by_newton(system, q, lambda, {}).end, StaticEnd::minimum);
  const Counters before = evaluator.counters;
  EXPECT_TRUE(certify(system, lambda).stable);
  EXPECT_EQ(evaluator.counters.factorizations, before.factorizations + 1);
  EXPECT_EQ(evaluator.counters.hessians, before.hessians + 1);
  EXPECT_EQ(evaluator.counters.symbolic, 1);
}

TEST(StaticEconomy, IterationsDoNotAllocate) {
  const auto model = testing::hanging_chain(300, ChainStart::zigzag);
  EvaluationWork work;
  Evaluator evaluator(Plan::make(*model), *model, work);
  StaticSystem system(evaluator);
  const auto allocations_of = [&](int iterations) {
    std::vector<double> q = evaluator.given_configuration();
    std::vector<double> lambda(static_cast<std::size_t>(system.plan().rows));
    const long before = allocations;
    EXPECT_EQ(solve_by_newton(system, q, lambda, {.max_iterations = iterations}).end, StaticEnd::slow);
    return allocations - before;
  };
  allocations_of(1);
  EXPECT_EQ(allocations_of(5), allocations_of(1));
}

}  // namespace
}  // namespace catena
