// What dynamics must not do: work that the scene or the question does not ask for.
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::rod_chain;
using testing::run_dynamics;

AnalysisReport run_chain(const TimeGrid& grid, const Needs& needs) {
  Dynamics dynamics(rod_chain(10));
  return run_dynamics(dynamics, grid, needs, [](const Snapshot&) {});
}

TEST(DynamicsEconomy, RowsDoNotShortenSteps) {
  const Counters one = run_chain(TimeGrid::instant(1), {}).counters;
  const Counters many = run_chain(TimeGrid::range(0, 1, 0.001), {}).counters;
  EXPECT_EQ(many.steps, one.steps);
}

TEST(DynamicsEconomy, RowsOfPositionsNeedNoAccelerations) {
  const Counters positions = run_chain(TimeGrid::range(0, 1, 0.001), {}).counters;
  const Counters accelerations = run_chain(TimeGrid::range(0, 1, 0.001), {.acceleration = true}).counters;
  EXPECT_LT(positions.gammas + 900, accelerations.gammas);
}

// One for the assembly of the given configuration where it is needed, one for velocities, one for the motion: none of
// them again while it runs.
TEST(DynamicsEconomy, SymbolicAnalysesDoNotGrowWithTheRun) {
  const std::int64_t brief = run_chain(TimeGrid::instant(0.01), {}).counters.symbolic;
  const std::int64_t long_run = run_chain(TimeGrid::instant(2), {}).counters.symbolic;
  EXPECT_EQ(brief, long_run);
}

TEST(DynamicsEconomy, NothingIsFactoredWhereNothingIsConstrained) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  model->add_body("ball", {.mass = 1, .inertia = 0.1});
  Dynamics dynamics(model);
  const Counters c =
      run_dynamics(dynamics, TimeGrid::range(0, 1, 0.1), {.acceleration = true}, [](const auto&) {}).counters;
  EXPECT_EQ(c.symbolic, 0);
  EXPECT_EQ(c.factorizations, 0);
  EXPECT_EQ(c.solves, 0);
  EXPECT_EQ(c.jacobians, 0);
  EXPECT_EQ(c.gammas, 0);
}

// Only rows whose Jacobian never changes: a slide along an axis of the ground.
TEST(DynamicsEconomy, AConstantJacobianIsFactoredOnce) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int body = model->add_body("block", {.mass = 1, .inertia = 0.1});
  model->add("angle", AbsoluteAngle<>{}, body, ground, 0.0);
  Dynamics dynamics(model);
  const Counters c = run_dynamics(dynamics, TimeGrid::range(0, 1, 0.1), {}, [](const auto&) {}).counters;
  EXPECT_LE(c.factorizations, 2);  // velocities at the start, and the motion
}

}  // namespace
}  // namespace catena
