// What kinematics must not do: work that the scene or the question does not ask for.
#include <gtest/gtest.h>

#include "analysis/linkages.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/model/model_add.hpp"
#include "economy/allocations.hpp"

namespace catena {
namespace {

using testing::add_rod;
using testing::allocations;
using testing::driven_four_bar;
using testing::FourBar;
using testing::pin;
using testing::ramp;

Counters counters_of(Kinematics& kinematics, const Needs& needs, double until, double every) {
  RowFunction none([](const Snapshot&) { return true; });
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, until, every), needs, none);
  EXPECT_TRUE(report.ok()) << report.message;
  return report.counters;
}

TEST(KinematicsEconomy, NoGammaAndNoRatesUnlessAskedFor) {
  Kinematics positions(driven_four_bar(FourBar{}, ramp(0.3, 1)));
  const Counters p = counters_of(positions, {}, 1, 0.01);
  EXPECT_EQ(p.gammas, 0);
  EXPECT_EQ(p.nus, 0);
  EXPECT_EQ(p.forces, 0);
  Kinematics velocities(driven_four_bar(FourBar{}, ramp(0.3, 1)));
  const Counters v = counters_of(velocities, {.velocity = true}, 1, 0.01);
  EXPECT_EQ(v.gammas, 0);
  EXPECT_EQ(v.nus, 101);
  Kinematics accelerations(driven_four_bar(FourBar{}, ramp(0.3, 1)));
  const Counters a = counters_of(accelerations, {.acceleration = true}, 1, 0.01);
  EXPECT_EQ(a.gammas, 101);
  EXPECT_EQ(a.forces, 0);
}

TEST(KinematicsEconomy, OneSymbolicAnalysis) {
  Kinematics kinematics(driven_four_bar(FourBar{}, ramp(0.3, 1)));
  EXPECT_EQ(counters_of(kinematics, {.velocity = true, .acceleration = true}, 1, 0.01).symbolic, 1);
}

// Linear constraints: angle relations and drivers only. Phi_q never changes, one factorization serves all rows.
TEST(KinematicsEconomy, AConstantJacobianIsFactoredOnce) {
  auto model = std::make_shared<Model>();
  for (int k = 0; k < 5; ++k) {
    const int body = model->add_body("disc" + std::to_string(k), {.position = {1.0 * k, 0}});
    model->add("", AbsoluteX<>{}, body);
    model->add("", AbsoluteY<>{}, body);
    if (k > 0) model->add("", RelativeAngle<>{}, body - 1, body);
  }
  model->add_driver("drive", AbsoluteAngle<>{}, 0, ground, ramp(0, 2));
  Kinematics kinematics(model);
  const Counters c = counters_of(kinematics, {.velocity = true, .acceleration = true}, 10, 0.1);
  EXPECT_EQ(c.factorizations, 1);
  EXPECT_EQ(c.symbolic, 1);
}

TEST(KinematicsEconomy, WeldedAndFixedBodiesAreNotSolvedFor) {
  auto model = driven_four_bar(FourBar{}, ramp(0.3, 1));
  const int frame = model->add_body("frame", {.position = {1, 1}});
  const int bracket = model->add_body("bracket", {.position = {2, 1}});
  model->add("w1", Weld<>{{1, 1}, {0, 0}}, ground, frame);
  model->add("w2", Weld<>{{0.5, 0}, {-0.5, 0}}, frame, bracket);
  model->add_body("wall", {.position = {3, 1}, .fixed = true});
  const auto plan = Plan::make(*model);
  EXPECT_EQ(plan->bodies, 6);
  EXPECT_EQ(plan->moving, 3);
  EXPECT_EQ(plan->columns, 9);
  EXPECT_EQ(plan->rows, 9);
}

TEST(KinematicsEconomy, BlocksOfTheTriangularFormAreSolvedOneByOne) {
  // A crank that drives ten four-bars in a row: the blocks are the crank's coordinates and one dyad after the other.
  auto model = std::make_shared<Model>();
  Vec2<double> tip{0.1, 0};
  int previous = add_rod(*model, "crank", {0, 0}, tip);
  pin(*model, "O", {0, 0}, previous, "from");
  for (int k = 0; k < 10; ++k) {
    const Vec2<double> pivot{tip.x + 0.3, 0}, joint{tip.x + 0.25, 0.2};
    const int coupler = add_rod(*model, "c" + std::to_string(k), tip, joint);
    const int rocker = add_rod(*model, "r" + std::to_string(k), pivot, joint);
    pin(*model, "", previous, "to", coupler, "from");
    pin(*model, "", coupler, "to", rocker, "to");
    pin(*model, "", pivot, rocker, "from");
    previous = rocker;
    tip = joint;
  }
  model->add_driver("drive", AbsoluteAngle<>{}, 0, ground, TimeFunction<double>::harmonic(0.05, 1));
  Kinematics kinematics(model);
  counters_of(kinematics, {}, 1, 0.1);
  EXPECT_GE(kinematics.solver().factorization().blocks(), 11);
  EXPECT_EQ(kinematics.solver().factorization().largest_block(), 6);
}

/// How much is allocated after the first rows of a run of 201.
long allocated_later(const std::shared_ptr<Model>& model) {
  Kinematics kinematics(model);
  long after_first = 0;
  int rows = 0;
  RowFunction watch([&](const Snapshot&) {
    if (++rows == 3) after_first = allocations;
    return true;
  });
  const AnalysisReport report =
      kinematics.run(TimeGrid::range(0, 2, 0.01), {.velocity = true, .acceleration = true, .multipliers = true}, watch);
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(rows, 201);
  return allocations - after_first;
}

TEST(KinematicsEconomy, NoAllocationAStepAfterTheFirst) {
  EXPECT_LE(allocated_later(driven_four_bar(FourBar{}, ramp(0.3, 1))), 8);  // the report itself
}

// With more rows than needed those left over are checked and the least reactions chosen at every row.
TEST(KinematicsEconomy, NoAllocationAStepWithRedundantRows) {
  auto model = driven_four_bar(FourBar{}, ramp(0.3, 1));
  pin(*model, "A again", model->find_body("crank"), "to", model->find_body("coupler"), "from");
  EXPECT_LE(allocated_later(model), 12);  // the report itself
}

}  // namespace
}  // namespace catena
