// Ipopt alone on a hanging chain of 1000 links from far-off starts, seconds to minutes each: all end in the discrete
// catenary. The long waits are why this is no test of every day.
#include <gtest/gtest.h>

#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/elements/all.hpp"
#include "oracles/static_reference.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using testing::ChainStart;

class IpoptFromAfar : public ::testing::TestWithParam<ChainStart> {};

TEST_P(IpoptFromAfar, EndsInTheCatenary) {
  if (!ipopt_is_built_in()) GTEST_SKIP() << "built without Ipopt";
  const double tension = testing::reference_values("discrete_catenary").at("N1000").at("horizontal_tension_H");
  const auto model = testing::hanging_chain(1000, GetParam());
  const auto plan = Plan::make(*model);
  EvaluationWork work;
  Evaluator evaluator(plan, *model, work);
  evaluator.set_time(0);
  StaticSystem system(evaluator);
  std::vector<double> q = evaluator.given_configuration(), lambda(static_cast<std::size_t>(plan->rows));
  const StaticOutcome outcome = solve_by_ipopt(system, q, lambda, {.tolerance = 1e-10});
  ASSERT_TRUE(outcome.converged());
  EXPECT_NEAR(std::abs(lambda[0]) / tension, 1, 1e-7);
  EXPECT_LE(outcome.residual, 1e-7 * tension);
  EXPECT_LE(system.phi_norm() * system.length(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Starts, IpoptFromAfar,
                         ::testing::Values(ChainStart::zigzag, ChainStart::above, ChainStart::straight,
                                           ChainStart::random_walk));

}  // namespace
}  // namespace catena
