#include "catena/analysis/kinematics/kinematics.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "analysis/linkages.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/belt.hpp"
#include "catena/elements/constraints/cam_flat.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

using testing::add_rod;
using testing::driven_four_bar;
using testing::FourBar;
using testing::pin;
using testing::ramp;

constexpr Needs everything{.velocity = true, .acceleration = true};

double angle_of(const Snapshot& s, const char* body) {
  const int b = s.evaluator.model().find_body(body);
  return s.q[static_cast<std::size_t>(3 * s.evaluator.plan().plan_body[static_cast<std::size_t>(b)] + 2)];
}

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

TEST(Kinematics, FourBarFollowsItsClosedForm) {
  const FourBar f;
  Kinematics kinematics(driven_four_bar(f, ramp(0.3, 10)));
  double worst = 0;
  RowFunction check([&](const Snapshot& s) {
    const FourBar::Angles exact = f.at(0.3 + 10 * s.t);
    worst = std::max(worst, std::abs(wrapped(angle_of(s, "coupler") - exact.coupler)));
    worst = std::max(worst, std::abs(wrapped(angle_of(s, "rocker") - exact.rocker)));
    return true;
  });
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 5, 0.01), everything, check);
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_LT(worst, 1e-12);
}

// Velocities and accelerations against differences of exact positions in time.
TEST(Kinematics, RatesAreTheDerivativesOfPositions) {
  const FourBar f;
  Kinematics kinematics(driven_four_bar(f, ramp(0.3, 10)));
  const double h = 1e-4;
  double worst_rate = 0, worst_acceleration = 0;
  RowFunction check([&](const Snapshot& s) {
    const auto rocker = [&](double t) { return f.at(0.3 + 10 * t).rocker; };
    const auto b = static_cast<std::size_t>(3 * s.evaluator.plan().plan_body[2] + 2);
    const double rate = (rocker(s.t + h) - rocker(s.t - h)) / (2 * h);
    const double acceleration = (rocker(s.t + h) - 2 * rocker(s.t) + rocker(s.t - h)) / (h * h);
    worst_rate = std::max(worst_rate, std::abs(s.qd[b] - rate));
    worst_acceleration = std::max(worst_acceleration, std::abs(s.qdd[b] - acceleration));
    return true;
  });
  EXPECT_TRUE(kinematics.run(TimeGrid::range(0, 0.6, 0.05), everything, check).ok());
  // The differences are of order h^2 f''' / 6 (rates of some 10^3) and rounding / h^2.
  EXPECT_LT(worst_rate, 1e-5);
  EXPECT_LT(worst_acceleration, 2e-3);
}

// The links nearly align twice a turn (a + d = b + c - 1e-4): the two branches come within 0.02 rad of each other, and
// rows a third of a turn apart must still lie on the one that the motion started on.
TEST(Kinematics, CoarseRowsKeepTheBranchThroughNearlyAlignedLinks) {
  for (int side : {1, -1}) {
    const FourBar f{.a = 0.1, .b = 0.25, .c = 0.2, .d = 0.35 - 1e-4};
    Kinematics kinematics(driven_four_bar(f, ramp(0.3, 2 * std::numbers::pi), side));
    double worst = 0;
    RowFunction check([&](const Snapshot& s) {
      worst = std::max(worst,
                       std::abs(wrapped(angle_of(s, "rocker") - f.at(0.3 + 2 * std::numbers::pi * s.t, side).rocker)));
      return true;
    });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 5, 0.37), {}, check);
    EXPECT_TRUE(report.ok()) << report.message;
    EXPECT_LT(worst, 1e-9) << "side " << side;
  }
}

TEST(Kinematics, RowsAreMultiplesOfEveryAndTheEnd) {
  Kinematics kinematics(driven_four_bar(FourBar{}, ramp(0, 1)));
  std::vector<double> times;
  RowFunction note([&](const Snapshot& s) {
    times.push_back(s.t);
    return true;
  });
  kinematics.run(TimeGrid::range(0, 0.35, 0.1), {}, note);
  EXPECT_EQ(times, (std::vector<double>{0, 0.1, 0.2, 3 * 0.1, 0.35}));
}

TEST(Kinematics, CancelKeepsTheRowsSoFar) {
  Kinematics kinematics(driven_four_bar(FourBar{}, ramp(0, 1)));
  int rows = 0;
  RowFunction stop([&](const Snapshot&) { return ++rows < 4; });
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 1, 0.1), {}, stop);
  EXPECT_EQ(report.status, Status::cancelled);
  EXPECT_EQ(rows, 4);
}

TEST(Kinematics, UnderDrivenNamesWhatIsFree) {
  auto model = std::make_shared<Model>();
  const int a = add_rod(*model, "a", {0, 0}, {1, 0});
  const int b = add_rod(*model, "b", {1, 0}, {2, 0});
  pin(*model, "O", {0, 0}, a, "from");
  pin(*model, "A", a, "to", b, "from");
  model->add_driver("drive", AbsoluteAngle<>{}, a, ground, ramp(0, 1));
  Kinematics kinematics(model);
  RowFunction none([](const Snapshot&) { return true; });
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 1, 0.1), {}, none);
  EXPECT_EQ(report.status, Status::under_driven);
  EXPECT_NE(report.message.find("\"b\""), std::string::npos) << report.message;
}

TEST(Kinematics, LoopsThatCannotCloseAreRankedByMisfit) {
  auto model = std::make_shared<Model>();
  const int a = add_rod(*model, "a", {0, 0}, {1, 0});
  const int b = add_rod(*model, "b", {1, 0}, {2, 0});
  pin(*model, "O", {0, 0}, a, "from");
  pin(*model, "A", a, "to", b, "from");
  pin(*model, "far", {3, 0}, b, "to");
  Kinematics kinematics(model);
  const AssemblyOutcome outcome = kinematics.assemble();
  EXPECT_EQ(outcome.status, Status::not_assembled);
  // One metre is missing; the nearest configuration shares it out among the three pins.
  ASSERT_EQ(outcome.misfits.size(), 3u);
  double total = 0;
  for (const Misfit& m : outcome.misfits) total += m.size;
  EXPECT_NEAR(total, 1, 1e-3);
  EXPECT_NE(outcome.message.find("\"far\""), std::string::npos) << outcome.message;
}

// A doubled joint and a third crank of a parallelogram: redundant, consistent, and the motion goes on.
TEST(Kinematics, RedundantConstraintsAreLeftOutOfTheSolution) {
  const FourBar f;
  auto model = driven_four_bar(f, ramp(0.3, 10));
  const int coupler = model->find_body("coupler"), rocker = model->find_body("rocker");
  pin(*model, "B again", coupler, "to", rocker, "to");
  Kinematics kinematics(model);
  double worst = 0;
  RowFunction check([&](const Snapshot& s) {
    worst = std::max(worst, std::abs(wrapped(angle_of(s, "rocker") - f.at(0.3 + 10 * s.t).rocker)));
    return true;
  });
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 1, 0.01), everything, check);
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_LT(worst, 1e-12);
  EXPECT_EQ(report.redundant.size(), 1u);
}

TEST(Kinematics, AnEstimateWholeTurnsOffIsTurnedBack) {
  auto model = driven_four_bar(FourBar{}, ramp(0.3, 10));
  model->bodies[0].angle += 4 * std::numbers::pi;
  Kinematics kinematics(model);
  ASSERT_TRUE(kinematics.assemble().ok());
  EXPECT_NEAR(kinematics.q()[2], 0.3, 1e-12);
}

// Wheels on fixed pins, geared or belted to a body that is turned back: none of them need change its pose.
TEST(Kinematics, WholeTurnsGoThroughGearsAndBelts) {
  for (int turns : {1, 2, -3}) {
    for (double ratio : {1.0, 2.0, 1.5, 0.75}) {
      auto model = std::make_shared<Model>();
      const auto wheel = [&](const char* name, Vec2<double> place, double angle) {
        const int body = model->add_body(name, {.mass = 1, .inertia = 1, .position = place, .angle = angle});
        model->add("", Revolute<>{place, {0, 0}}, ground, body);
        return body;
      };
      const double r = 0.1;
      const int first = wheel("first", {0, 0}, 0.3), second = wheel("second", {r * (1 + ratio), 0}, -0.7);
      const int third = wheel("third", {0, 1}, 1.1), fourth = wheel("fourth", {1, 1}, 0.2);
      model->add("gear", Gear<>{{}, {}, r, ratio * r, false, 0}, first, second);
      model->add("belt", Belt<>{{}, {}, r, ratio * r, false, 0}, second, third);
      model->add("crossed belt", Belt<>{{}, {}, r, r, true, 0}, third, fourth);
      model->add_driver("drive", AbsoluteAngle<>{}, first, ground, ramp(0.3 + turns * 2 * std::numbers::pi, 1));
      Kinematics kinematics(model);
      const AssemblyOutcome outcome = kinematics.assemble();
      ASSERT_TRUE(outcome.ok()) << outcome.message;
      for (int body : {first, second, third, fourth}) {
        const auto place =
            static_cast<std::size_t>(3 * kinematics.plan().plan_body[static_cast<std::size_t>(body)] + 2);
        const double given = model->bodies[static_cast<std::size_t>(body)].angle;
        EXPECT_NEAR(wrapped(kinematics.q()[place] - given), 0, 1e-12)
            << body << " turns " << turns << " ratio " << ratio;
      }
      EXPECT_NEAR(kinematics.q()[2], 0.3 + turns * 2 * std::numbers::pi, 1e-12);
    }
  }
}

// A cam whose arc ends: the contact leaves it, and from there on the row says nothing.
TEST(Kinematics, AContactThatLeavesItsCurveIsReported) {
  std::vector<Vec2<double>> quarter;
  for (int k = 0; k <= 8; ++k) {
    quarter.push_back({std::cos(std::numbers::pi * k / 16), std::sin(std::numbers::pi * k / 16)});
  }
  auto model = std::make_shared<Model>();
  const int cam = model->add_body("cam", {.angle = 0.5}), follower = model->add_body("follower", {.position = {0, 1}});
  model->add("O", Revolute<>{}, ground, cam);
  model->add_driver("drive", AbsoluteAngle<>{}, cam, ground, ramp(0.5, -1));
  model->add("guide", AbsoluteX<>{}, follower, ground, 0.0);
  model->add("upright", AbsoluteAngle<>{}, follower, ground, 0.0);
  model->add("lift", CamFlat<>{.axis_j = {-1, 0}, .curve = Curve<double>::spline(quarter, SplineEnd::natural)}, cam,
             follower);
  Kinematics kinematics(model);
  RowFunction none([](const Snapshot&) { return true; });
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 1, 0.05), {}, none);
  EXPECT_EQ(report.status, Status::singular);
  EXPECT_NE(report.message.find("\"lift\""), std::string::npos) << report.message;
  EXPECT_NE(report.message.find("no curvature where it should touch"), std::string::npos) << report.message;
  EXPECT_LT(kinematics.time(), 0.6);
  EXPECT_GT(kinematics.time(), 0.4);
}

// Flat at crank angles 0 and pi: the parallelogram and the antiparallelogram meet there, and the motion stays what it
// was.
TEST(Kinematics, AParallelogramStaysOneThroughItsFlatPositions) {
  for (double every : {0.01, 0.3, 2.0}) {
    const FourBar f{.a = 0.1, .b = 0.3, .c = 0.1, .d = 0.3};
    Kinematics kinematics(driven_four_bar(f, ramp(1, 1)));
    double worst = 0;
    RowFunction check([&](const Snapshot& s) {
      worst = std::max(worst, std::abs(angle_of(s, "rocker") - (1 + s.t)));
      return true;
    });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 12, every), {}, check);
    EXPECT_TRUE(report.ok()) << report.message;
    EXPECT_LT(worst, 1e-9) << "every " << every;
    ASSERT_EQ(report.warnings.size(), 4u) << "flat at crank angles pi, 2 pi, 3 pi and 4 pi";
  }
}

// The rocker as driver: at its dead points crank and coupler are in line, and the driver asks for the impossible.
TEST(Kinematics, DeadPointsAreLocatedAndCalledLockUp) {
  const FourBar f;
  for (double rate : {1.0, -1.0}) {
    auto model = driven_four_bar(f, ramp(1, 0));
    const double start = model->bodies[2].angle;
    auto driven = std::make_shared<Model>();
    for (const auto& body : model->bodies) {
      driven->add_body(model->names[body.name], {.position = body.position, .angle = body.angle});
    }
    const std::array<double, 3> half = {f.a / 2, f.b / 2, f.c / 2};
    driven->add("O", Revolute<>{{0, 0}, {-half[0], 0}}, ground, 0);
    driven->add("A", Revolute<>{{half[0], 0}, {-half[1], 0}}, 0, 1);
    driven->add("B", Revolute<>{{half[1], 0}, {half[2], 0}}, 1, 2);
    driven->add("C", Revolute<>{{f.d, 0}, {-half[2], 0}}, ground, 2);
    driven->add_driver("drive", AbsoluteAngle<>{}, 2, ground, ramp(start, rate));
    Kinematics kinematics(driven);
    RowFunction none([](const Snapshot&) { return true; });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 3, 0.1), {}, none);
    EXPECT_EQ(report.status, Status::lock_up) << report.message;
    // The rocker's angle where the pivots and the joint B form a triangle with the side b + a, or b - a.
    const double reach = rate > 0 ? f.b - f.a : f.b + f.a;
    const double limit = std::numbers::pi - std::acos((f.c * f.c + f.d * f.d - reach * reach) / (2 * f.c * f.d));
    EXPECT_NEAR(kinematics.time(), (limit - start) / rate, 1e-10);
  }
}

// The first thing asked for assembles, whichever it is: the rocker is sketched 0.2 rad off.
TEST(Kinematics, MovesAndRatesBeginWithAnAssembly) {
  const FourBar f;
  for (const bool moves : {true, false}) {
    auto model = std::make_shared<Model>(*driven_four_bar(f, ramp(0.3, 10)));
    model->bodies[2].angle += 0.2;
    Kinematics kinematics(model);
    const double t = moves ? 0.1 : 0;
    for (const double instant : {t / 4, t / 2, t}) {
      if (moves) {
        ASSERT_TRUE(kinematics.move_to(instant).ok());
      }
      ASSERT_TRUE(kinematics.solve_rates(everything).ok());
    }
    const FourBar::Angles exact = f.at(0.3 + 10 * t);
    EXPECT_NEAR(wrapped(kinematics.q()[8] - exact.rocker), 0, 1e-12);
    const double h = 1e-6;
    EXPECT_NEAR(kinematics.qd()[8], (f.at(0.3 + 10 * (t + h)).rocker - f.at(0.3 + 10 * (t - h)).rocker) / (2 * h),
                1e-7);
  }
}

TEST(Kinematics, WithoutADriverNothingMoves) {
  auto model = std::make_shared<Model>();
  const int crank = add_rod(*model, "crank", {0, 0}, {1, 0});
  pin(*model, "O", Vec2<double>{0, 0}, crank, "from");
  const auto expect_under_driven = [](const Report& report) {
    EXPECT_EQ(report.status, Status::under_driven) << report.message;
    EXPECT_NE(report.message.find("crank"), std::string::npos) << report.message;
  };
  expect_under_driven(Kinematics(model).move_to(1));
  expect_under_driven(Kinematics(model).solve_rates({.velocity = true}));
  Kinematics assembled(model);
  EXPECT_TRUE(assembled.assemble().ok());
  expect_under_driven(assembled.solve_rates({.velocity = true}));
  expect_under_driven(assembled.move_to(1));
}

}  // namespace
}  // namespace catena
