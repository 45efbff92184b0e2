// The other solvers of static equilibrium, alone and through the analysis: Ipopt and NLopt against the same closed
// forms as Newton's method.
#include <gtest/gtest.h>

#include <cmath>

#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/analysis/statics/solvers/static_nlopt.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_reference.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using testing::ChainStart;
using testing::reference_values;

class IpoptCatenary : public ::testing::TestWithParam<int> {};

TEST_P(IpoptCatenary, FindsTheHorizontalForceByItself) {
  if (!ipopt_is_built_in()) GTEST_SKIP() << "built without Ipopt";
  const int count = GetParam();
  const double tension =
      reference_values("discrete_catenary").at("N" + std::to_string(count)).at("horizontal_tension_H");
  for (const ChainStart start : {ChainStart::sag, ChainStart::zigzag, ChainStart::above, ChainStart::random_walk}) {
    // From farther off a long chain takes up to minutes: ipopt_far_test.cpp.
    if (count == 1000 && start != ChainStart::sag && start != ChainStart::zigzag) continue;
    const auto model = testing::hanging_chain(count, start);
    const auto plan = Plan::make(*model);
    EvaluationWork work;
    Evaluator evaluator(plan, *model, work);
    evaluator.set_time(0);
    StaticSystem system(evaluator);
    std::vector<double> q = evaluator.given_configuration(), lambda(static_cast<std::size_t>(plan->rows));
    const StaticOutcome outcome = solve_by_ipopt(system, q, lambda, {.tolerance = 1e-10});
    ASSERT_TRUE(outcome.converged()) << static_cast<int>(start);
    EXPECT_NEAR(std::abs(lambda[0]), tension, 1e-7 * tension) << static_cast<int>(start);
    EXPECT_LE(outcome.residual, 1e-8 * tension);
    EXPECT_LE(system.phi_norm() * system.length(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Links, IpoptCatenary, ::testing::Values(4, 10, 100, 1000));

TEST(IpoptEquilibrium, IsPolishedAndCertified) {
  if (!ipopt_is_built_in()) GTEST_SKIP() << "built without Ipopt";
  const double tension = reference_values("discrete_catenary").at("N100").at("horizontal_tension_H");
  for (const ChainStart start : {ChainStart::zigzag, ChainStart::above, ChainStart::scattered}) {
    Equilibrium chain(testing::hanging_chain(100, start), {}, {.solver = StaticSolver::ipopt});
    const EquilibriumReport report = chain.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_EQ(report.solver, "ipopt");
    EXPECT_TRUE(report.stable);
    EXPECT_NEAR(chain.lambda()[0], tension, 1e-12 * tension);
  }
}

TEST(IpoptEquilibrium, LeavesTheUprightPendulum) {
  if (!ipopt_is_built_in()) GTEST_SKIP() << "built without Ipopt";
  Equilibrium upright(testing::inverted_pendulum(2), {}, {.solver = StaticSolver::ipopt});
  const EquilibriumReport report = upright.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.stable);
  const double theta = reference_values("inverted_pendulum_torsion_spring").at("mgl_over_k=2").at("theta");
  EXPECT_NEAR(std::abs(upright.q()[2]), theta, 1e-10);
}

TEST(IpoptEquilibrium, WorksWhereNothingCanMoveAndWhereConstraintsAreRedundant) {
  if (!ipopt_is_built_in()) GTEST_SKIP() << "built without Ipopt";
  const EquilibriumOptions by_ipopt{.solver = StaticSolver::ipopt};
  auto frame = testing::three_hinged_frame(0.5);
  EXPECT_TRUE(Equilibrium(frame, {}, by_ipopt).solve().ok());
  frame->add("B again", Revolute<double>{.s_i = {4 * std::cos(0.5), 0}, .s_j = {1, 0}}, ground, 1);
  Equilibrium redundant(frame, {}, by_ipopt);
  const EquilibriumReport report = redundant.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_FALSE(report.redundant.empty());
}

TEST(NloptEquilibrium, AgreesWithTheReferencesOfSmallScenes) {
  if (!nlopt_is_built_in()) GTEST_SKIP() << "built without NLopt";
  const EquilibriumOptions by_nlopt{.solver = StaticSolver::nlopt};
  Equilibrium chain(testing::hanging_chain(10, ChainStart::sag), {}, by_nlopt);
  EquilibriumReport report = chain.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.solver, "nlopt");
  EXPECT_TRUE(report.stable);
  const double tension = reference_values("discrete_catenary").at("N10").at("horizontal_tension_H");
  EXPECT_NEAR(chain.lambda()[0], tension, 1e-12 * tension);

  const auto truss = reference_values("von_mises_truss").at("equilibria");
  for (const auto& [name, value] : truss.items()) {
    Equilibrium below(testing::von_mises_truss(value.at("P"), -0.35), {}, by_nlopt);
    report = below.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_NEAR(below.state().q[1], value.at("y_post").get<double>(), 1e-11) << name;
  }
}

TEST(NloptEquilibrium, NeedsNoDerivatives) {
  if (!nlopt_is_built_in()) GTEST_SKIP() << "built without NLopt";
  const auto model = testing::inverted_pendulum(2, 0.3);
  const auto plan = Plan::make(*model);
  EvaluationWork work;
  Evaluator evaluator(plan, *model, work);
  evaluator.set_time(0);
  StaticSystem system(evaluator);
  std::vector<double> q = evaluator.given_configuration(), lambda(static_cast<std::size_t>(plan->rows));
  const StaticOutcome outcome = solve_by_nlopt(system, q, lambda, {.tolerance = 1e-9, .derivatives = false});
  ASSERT_TRUE(outcome.converged());
  const double theta = reference_values("inverted_pendulum_torsion_spring").at("mgl_over_k=2").at("theta");
  EXPECT_NEAR(q[2], theta, 1e-6);
}

}  // namespace
}  // namespace catena
