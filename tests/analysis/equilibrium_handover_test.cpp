// What `automatic` does where Newton does not get there: Ipopt takes over, or the way downhill; the answer is polished
// and certified as any other.
#include <gtest/gtest.h>

#include "catena/analysis/equilibrium.hpp"
#include "catena/analysis/static_ipopt.hpp"
#include "catena/elements/all.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

// Fifty links thrown about, with springs between them that want to coil the chain up.
std::shared_ptr<Model> coiling_chain() {
  const int count = 50;
  auto model = testing::hanging_chain(count, testing::ChainStart::scattered, 3);
  for (int k = 1; k < count; ++k) model->add_force("", testing::torsion_spring(0.5, -3), k - 1, k);
  return model;
}

double largest_residual(Equilibrium& analysis) {
  StaticSystem system(analysis.evaluator());
  system.move_to(analysis.q());
  std::vector<double> residual(static_cast<std::size_t>(analysis.plan().columns));
  system.residual(analysis.lambda(), residual);
  return system.force_norm(residual) / system.force_scale(analysis.lambda());
}

TEST(Handover, NewtonAloneDoesNotFindTheCoil) {
  Equilibrium alone(coiling_chain(), {}, {.solver = StaticSolver::newton});
  EXPECT_FALSE(alone.solve().ok());
}

TEST(Handover, IpoptTakesOver) {
  if (!ipopt_is_built_in()) GTEST_SKIP() << "built without Ipopt";
  Equilibrium analysis(coiling_chain());
  const EquilibriumReport report = analysis.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.solver, "ipopt");
  EXPECT_TRUE(report.certified);
  EXPECT_TRUE(report.stable);
  EXPECT_LE(largest_residual(analysis), 1e-11);
}

}  // namespace
}  // namespace catena
