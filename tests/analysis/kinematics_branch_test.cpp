// Branches that meet at a singular configuration: which there are, and which one is taken.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/linkages.hpp"
#include "analysis/parallelogram.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

using std::numbers::pi;

TEST(KinematicsBranch, BranchChoosesTheAntiparallelogram) {
  auto model = driven_four_bar(parallelogram, ramp(1, 1));
  for (double every : {0.01, 0.3, pi - 1}) {
    Kinematics kinematics(model, {}, {.branch = 2});
    double worst_before = 0, worst_after = 0, worst_rate = 0;
    RowFunction check([&](const Snapshot& s) {
      const double crank = 1 + s.t, h = 1e-5;
      const std::size_t rocker = angle_place(s, "rocker");
      if (crank < pi + 1e-9) {
        worst_before = std::max(worst_before, std::abs(wrapped(s.q[rocker] - crank)));
      } else {
        worst_after = std::max(worst_after, std::abs(wrapped(s.q[rocker] - parallelogram.at(crank, 1).rocker)));
        const double difference =
            wrapped(parallelogram.at(crank + h, 1).rocker - parallelogram.at(crank - h, 1).rocker) / (2 * h);
        if (crank > pi + 1e-3) worst_rate = std::max(worst_rate, std::abs(s.qd[rocker] - difference));
      }
      return true;
    });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 5, every), everything, check);
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_LT(worst_before, 1e-12);
    EXPECT_LT(worst_after, 2e-8) << "the closed form has an arc cosine of nearly one near the branch point";
    EXPECT_LT(worst_rate, 1e-4) << every;
    EXPECT_NEAR(kinematics.q()[angle_place({.evaluator = kinematics.evaluator()}, "rocker")],
                parallelogram.at(6, 1).rocker - 2 * pi, 2 * pi + 1e-12);
  }
  Kinematics third(model, {}, {.branch = 3});
  RowFunction none([](const Snapshot&) { return true; });
  const AnalysisReport report = third.run(TimeGrid::range(0, 5, 0.1), everything, none);
  EXPECT_EQ(report.status, Status::bifurcation);
  EXPECT_NE(report.message.find("2 meet"), std::string::npos) << report.message;
}

TEST(KinematicsBranch, AStartWhereBranchesMeetAsksForAChoice) {
  auto model = std::make_shared<Model>();
  const double a = parallelogram.a, d = parallelogram.d;
  const int crank = add_rod(*model, "crank", {0, 0}, {a, 0}), coupler = add_rod(*model, "coupler", {a, 0}, {a + d, 0});
  const int rocker = add_rod(*model, "rocker", {d, 0}, {a + d, 0});
  pin(*model, "O", {0, 0}, crank, "from");
  pin(*model, "A", crank, "to", coupler, "from");
  pin(*model, "B", coupler, "to", rocker, "to");
  pin(*model, "C", {d, 0}, rocker, "from");
  model->add_driver("drive", AbsoluteAngle<>{}, crank, ground, ramp(0, 1));
  RowFunction none([](const Snapshot&) { return true; });
  Kinematics undecided(model);
  const AnalysisReport asked = undecided.run(TimeGrid::range(0, 2, 0.1), everything, none);
  EXPECT_EQ(asked.status, Status::bifurcation);
  EXPECT_NE(asked.message.find("branch 2"), std::string::npos) << asked.message;
  ASSERT_EQ(undecided.singular_points().size(), 1u);
  ASSERT_EQ(undecided.singular_points()[0].tangents.size(), 2u);
  for (int branch : {1, 2}) {
    const double rate = rates(undecided, *model, undecided.singular_points()[0].tangents[branch - 1u])[0];
    Kinematics kinematics(model, {}, {.branch = branch});
    double first_rate = 0, last = 0;
    RowFunction note([&](const Snapshot& s) {
      if (s.t == 0) first_rate = s.qd[angle_place(s, "rocker")];
      last = s.q[angle_place(s, "rocker")];
      return true;
    });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 2, 0.1), everything, note);
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_NEAR(first_rate, rate, 1e-9);
    EXPECT_NEAR(wrapped(last - (rate > 0 ? 2 : parallelogram.at(2, -1).rocker)), 0, 1e-9) << branch;
  }
}

// The driver's velocity vanishes at the flat position: it goes through, or turns back there.
TEST(KinematicsBranch, DriversThatRestAtAFlatPositionPassIt) {
  const std::array through = {pi - 1, 3.0, -3.0, 1.0};  // pi + (t - 1)^3
  const std::array back = {pi - 1, 2.0, -1.0};          // pi - (t - 1)^2
  for (bool turns_back : {false, true}) {
    const auto angle = turns_back ? TimeFunction<double>::polynomial(back) : TimeFunction<double>::polynomial(through);
    for (double every : {0.1, 0.07}) {
      Kinematics kinematics(driven_four_bar(parallelogram, angle));
      Errors errors;
      RowFunction check([&](const Snapshot& s) {
        errors.add(s, angle.evaluate(s.t));
        return true;
      });
      const AnalysisReport report = kinematics.run(TimeGrid::range(0, 2, every), everything, check);
      ASSERT_TRUE(report.ok()) << report.message << " turns back " << turns_back << " every " << every;
      ASSERT_EQ(kinematics.singular_points().size(), 1u) << turns_back;
      EXPECT_EQ(kinematics.singular_points()[0].kind, SingularPoint::Kind::rest);
      EXPECT_NEAR(kinematics.singular_points()[0].t, 1, turns_back ? 1e-10 : 1e-7);
      // A row at a distance s of the instant lies s^3, or s^2, from a singular matrix.
      EXPECT_LT(errors.position, 1e-9) << turns_back << every;
      EXPECT_LT(errors.velocity, 1e-7) << turns_back << every;
    }
  }
}

// The branches at rest are those of the moving mechanism, for a crank that turns at 1 rad/s once it turns.
TEST(KinematicsBranch, BranchesAreListedWhereTheDriversRest) {
  RowFunction none([](const Snapshot&) { return true; });
  Kinematics moving(driven_four_bar(parallelogram, ramp(pi - 1, 1)));
  ASSERT_TRUE(moving.run(TimeGrid::range(0, 2, 0.1), {}, none).ok());
  const SingularPoint& reference = moving.singular_points().at(0);
  ASSERT_EQ(reference.tangents.size(), 2u);
  const std::array through = {pi - 1, 3.0, -3.0, 1.0}, back = {pi - 1, 2.0, -1.0, 0.0};
  for (const auto& [function, sign] : {std::pair(through, 1.0), std::pair(back, -1.0)}) {
    Kinematics kinematics(driven_four_bar(parallelogram, TimeFunction<double>::polynomial(function)));
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 2, 0.1), {}, none);
    ASSERT_TRUE(report.ok()) << report.message;
    const SingularPoint& point = kinematics.singular_points().at(0);
    ASSERT_EQ(point.tangents.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t c = 0; c < 9; ++c) EXPECT_NEAR(point.tangents[k][c], sign * reference.tangents[k][c], 1e-5);
    }
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_NE(report.warnings[0].find("branch 2"), std::string::npos) << report.warnings[0];
  }
}

TEST(KinematicsBranch, BranchesAreListedWhereTheMotionStartsAtRest) {
  RowFunction none([](const Snapshot&) { return true; });
  auto model = driven_four_bar(parallelogram, TimeFunction<double>::polynomial(std::array{pi, 0.0, 0.5}));
  Kinematics kinematics(model);
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 2, 0.1), {}, none);
  EXPECT_EQ(report.status, Status::bifurcation);
  EXPECT_NE(report.message.find("the drivers rest"), std::string::npos) << report.message;
  EXPECT_NE(report.message.find("branch 2"), std::string::npos) << report.message;
  ASSERT_EQ(kinematics.singular_points().size(), 1u);
  ASSERT_EQ(kinematics.singular_points()[0].tangents.size(), 2u);
  for (const auto& tangent : kinematics.singular_points()[0].tangents) EXPECT_NEAR(tangent[2], 1, 1e-9);
}

// The driver rests at the flat position, goes on or turns back, and the other branch is asked for.
TEST(KinematicsBranch, BranchIsTakenWhereTheDriversRest) {
  const std::array through = {pi - 1, 3.0, -3.0, 1.0};  // pi + (t - 1)^3
  const std::array back = {pi - 1, 2.0, -1.0, 0.0};     // pi - (t - 1)^2
  for (bool turns_back : {false, true}) {
    const auto angle = TimeFunction<double>::polynomial(turns_back ? back : through);
    const int side = turns_back ? -1 : 1;  // of the antiparallelogram
    for (double every : {0.1, 0.07, 0.5}) {
      Kinematics kinematics(driven_four_bar(parallelogram, angle), {}, {.branch = 2});
      double before = 0, after = 0, rate = 0;
      RowFunction check([&](const Snapshot& s) {
        const Taylor<double> crank = angle.evaluate(s.t);
        const double rocker = s.q[angle_place(s, "rocker")], h = 1e-5;
        if (s.t <= 1) {
          before = std::max(before, std::abs(wrapped(rocker - crank.f)));
          return true;
        }
        after = std::max(after, std::abs(wrapped(rocker - parallelogram.at(crank.f, side).rocker)));
        if (s.t < 1.3) return true;
        const double slope =
            wrapped(parallelogram.at(crank.f + h, side).rocker - parallelogram.at(crank.f - h, side).rocker) / (2 * h);
        rate = std::max(rate, std::abs(s.qd[angle_place(s, "rocker")] - slope * crank.d));
        return true;
      });
      const AnalysisReport report = kinematics.run(TimeGrid::range(0, 2, every), everything, check);
      ASSERT_TRUE(report.ok()) << report.message << " turns back " << turns_back << " every " << every;
      EXPECT_LT(before, 1e-9) << turns_back << every;
      EXPECT_LT(after, 1e-7) << turns_back << every;
      EXPECT_LT(rate, 1e-6) << turns_back << every;
      ASSERT_EQ(report.warnings.size(), 1u);
      EXPECT_NE(report.warnings[0].find("takes branch 2"), std::string::npos) << report.warnings[0];
    }
  }
  Kinematics third(driven_four_bar(parallelogram, TimeFunction<double>::polynomial(through)), {}, {.branch = 3});
  RowFunction none([](const Snapshot&) { return true; });
  EXPECT_EQ(third.run(TimeGrid::range(0, 2, 0.1), {}, none).status, Status::bifurcation);
}

// Started at rest on the flat position: accelerations are the tangents times that of the driver.
TEST(KinematicsBranch, AMotionThatStartsAtRestWhereBranchesMeetTakesTheOneChosen) {
  for (double acceleration : {0.5, -2.0}) {
    const auto angle = TimeFunction<double>::polynomial(std::array{pi, 0.0, acceleration / 2});
    auto model = driven_four_bar(parallelogram, angle);
    for (int branch : {1, 2}) {
      Kinematics kinematics(model, {}, {.branch = branch});
      double first = 0, first_rate = 1, worst = 0;
      RowFunction check([&](const Snapshot& s) {
        const std::size_t rocker = angle_place(s, "rocker");
        if (s.t == 0) first = s.qdd[rocker], first_rate = s.qd[rocker];
        const double crank = angle.evaluate(s.t).f;
        const double parallel = crank, crossed = parallelogram.at(crank, acceleration > 0 ? 1 : -1).rocker;
        const double off =
            std::min(std::abs(wrapped(s.q[rocker] - parallel)), std::abs(wrapped(s.q[rocker] - crossed)));
        worst = std::max(worst, off);
        return true;
      });
      const AnalysisReport report = kinematics.run(TimeGrid::range(0, 1, 0.1), everything, check);
      ASSERT_TRUE(report.ok()) << report.message;
      EXPECT_LT(worst, 1e-7);
      EXPECT_NEAR(first_rate, 0, 1e-9);
      const double tangent = rates(
          kinematics, *model, kinematics.singular_points().at(0).tangents.at(static_cast<std::size_t>(branch - 1)))[0];
      EXPECT_NEAR(first, std::abs(acceleration) * tangent, 1e-6) << branch;
    }
  }
}

// A smooth step away from the flat position: nothing moves before it.
TEST(KinematicsBranch, AStepThatBeginsWhereBranchesMeetTakesTheOneChosen) {
  for (int order : {3, 5}) {
    const auto angle = TimeFunction<double>::step(0, 1, pi, pi + 1, order);
    auto model = driven_four_bar(parallelogram, angle);
    for (int branch : {1, 2}) {
      Kinematics kinematics(model, {}, {.branch = branch});
      double last = 0;
      RowFunction note([&](const Snapshot& s) {
        last = s.q[angle_place(s, "rocker")];
        return true;
      });
      const AnalysisReport report = kinematics.run(TimeGrid::range(0, 1, 0.25), everything, note);
      ASSERT_TRUE(report.ok()) << order << " " << report.message;
      const double rate = rates(
          kinematics, *model, kinematics.singular_points().at(0).tangents.at(static_cast<std::size_t>(branch - 1)))[0];
      EXPECT_NEAR(wrapped(last - (rate > 0 ? pi + 1 : parallelogram.at(pi + 1, 1).rocker)), 0, 1e-9) << order;
    }
  }
}

}  // namespace
}  // namespace catena::testing
