// A mechanism that comes to rest: rows, velocities and accelerations go on being found where all of them are zero.
#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/linkages.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

TEST(Rest, IsReachedByAStepAndKept) {
  for (const int order : {3, 5}) {
    auto model = std::make_shared<Model>();
    const int crank = model->add_body("crank", {.mass = 1, .inertia = 1, .position = {0.5, 0}});
    model->add("O", Revolute<>{{0, 0}, {-0.5, 0}}, ground, crank);
    model->add_driver("drive", AbsoluteAngle<>{}, crank, ground, TimeFunction<double>::step(0.2, 1, 0, 1.5, order));
    Kinematics kinematics(model);
    int rows = 0;
    RowFunction look([&](const Snapshot& s) {
      ++rows;
      if (s.t < 0.2 || s.t > 1) {
        for (double rate : s.qd) EXPECT_EQ(rate, 0) << s.t;
        for (double rate : s.qdd) EXPECT_EQ(rate, 0) << s.t;
      }
      return true;
    });
    const AnalysisReport report =
        kinematics.run(TimeGrid::range(0, 1.5, 0.05), {.velocity = true, .acceleration = true}, look);
    EXPECT_TRUE(report.ok()) << report.message;
    EXPECT_EQ(rows, 31);
    EXPECT_NEAR(kinematics.q()[2], 1.5, 1e-15);
  }
}

}  // namespace
}  // namespace catena::testing
