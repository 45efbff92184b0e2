// Singular configurations of driven mechanisms: where they are, and that none is missed or taken for another.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/linkages.hpp"
#include "analysis/parallelogram.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

using std::numbers::pi;

TEST(KinematicsSingular, FlatPositionsAreLocatedAndTheirBranchesListed) {
  auto model = driven_four_bar(parallelogram, ramp(1, 1));
  Kinematics kinematics(model);
  RowFunction none([](const Snapshot&) { return true; });
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 6, 0.1), {}, none);
  ASSERT_TRUE(report.ok()) << report.message;
  const auto& points = kinematics.singular_points();
  ASSERT_EQ(points.size(), 2u);
  for (const SingularPoint& point : points) {
    EXPECT_EQ(point.kind, SingularPoint::Kind::branch_point);
    EXPECT_EQ(point.nullity, 1);
    ASSERT_EQ(point.tangents.size(), 2u);
    EXPECT_NEAR(rates(kinematics, *model, point.tangents[0])[0], 1, 1e-9);
    EXPECT_NEAR(rates(kinematics, *model, point.tangents[0])[1], 0, 1e-9);
  }
  EXPECT_NEAR(points[0].t, pi - 1, 1e-10);
  EXPECT_NEAR(points[1].t, 2 * pi - 1, 1e-10);
  // Closure to second order: a + b s = c r and a + b s^2 = c r^2 at crank angle 0, a - b s = c r and
  // a - b s^2 = c r^2 at pi; s the coupler's and r the rocker's rate.
  EXPECT_NEAR(rates(kinematics, *model, points[0].tangents[1])[0], -0.5, 1e-8);
  EXPECT_NEAR(rates(kinematics, *model, points[0].tangents[1])[1], 0.5, 1e-8);
  EXPECT_NEAR(rates(kinematics, *model, points[1].tangents[1])[0], -2, 1e-8);
  EXPECT_NEAR(rates(kinematics, *model, points[1].tangents[1])[1], -1, 1e-8);
  ASSERT_EQ(report.warnings.size(), 2u);
  EXPECT_NE(report.warnings[0].find("\"rocker\" turns at -0.5 rad/s"), std::string::npos) << report.warnings[0];
  EXPECT_NE(report.warnings[0].find("\"coupler\" turns at 0.5 rad/s"), std::string::npos) << report.warnings[0];
}

// Rows on the flat positions themselves, where the equations do not determine velocities and accelerations.
TEST(KinematicsSingular, RowsOnFlatPositionsHaveTheirRates) {
  for (double every : {0.25, 1.0, 0.125 + 1e-7, 3.0}) {
    Kinematics kinematics(driven_four_bar(parallelogram, ramp(pi / 2, pi / 2)));
    Errors errors;
    RowFunction check([&](const Snapshot& s) {
      errors.add(s, {pi / 2 * (1 + s.t), pi / 2, 0});
      EXPECT_LT(s.residual, 1e-12);
      return true;
    });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 6, every), everything, check);
    EXPECT_TRUE(report.ok()) << report.message;
    EXPECT_EQ(kinematics.singular_points().size(), 3u) << every;
    EXPECT_LT(errors.position, 1e-12) << every;
    EXPECT_LT(errors.velocity, 1e-11) << every;
    EXPECT_LT(errors.acceleration, 1e-9) << every;
  }
}

// Two flat positions in one step would leave all signs as they were.
TEST(KinematicsSingular, NoFlatPositionIsSteppedOverHoweverCoarseTheRows) {
  Kinematics kinematics(driven_four_bar(parallelogram, ramp(1, 1)));
  Errors errors;
  RowFunction check([&](const Snapshot& s) {
    errors.add(s, {1 + s.t, 1, 0});
    return true;
  });
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 60, 20), everything, check);
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(kinematics.singular_points().size(), 19u);
  EXPECT_LT(errors.position, 1e-11);
  EXPECT_LT(errors.velocity, 1e-10);
}

// Two parallelograms in one loop of equations: rocker 1 turns crank 2, and the distance of two points, one on crank 1
// and one on rocker 2, is driven. Both are flat at the same instant: nullity two, and no determinant changes its sign.
TEST(KinematicsSingular, AnEvenNullityIsNotMissed) {
  const double start = 1, a = parallelogram.a, d = parallelogram.d, apart = 1;
  auto both = std::make_shared<Model>();
  for (int side = 0; side < 2; ++side) {
    const Vec2<double> pivot{side * apart, 0}, tip = pivot + a * Vec2<double>{std::cos(start), std::sin(start)};
    const std::string n = std::to_string(side + 1);
    const int crank = add_rod(*both, "crank" + n, pivot, tip);
    const int coupler = add_rod(*both, "coupler" + n, tip, tip + Vec2<double>{d, 0});
    const int rocker = add_rod(*both, "rocker" + n, pivot + Vec2<double>{d, 0}, tip + Vec2<double>{d, 0});
    pin(*both, "O" + n, pivot, crank, "from");
    pin(*both, "A" + n, crank, "to", coupler, "from");
    pin(*both, "B" + n, coupler, "to", rocker, "to");
    pin(*both, "C" + n, pivot + Vec2<double>{d, 0}, rocker, "from");
  }
  both->add("tie", RelativeAngle<>{}, both->find_body("rocker1"), both->find_body("crank2"), 0.0);
  // From the end of crank 1 to a point across rocker 2, in closed form along the parallelograms' motion.
  const Vec2<double> across{-a / 2, a};
  const auto distance = [=](double t) {
    const double angle = start + t, c = std::cos(angle), s = std::sin(angle);
    const Vec2<double> arm{a / 2 + across.x - a, across.y};  // in axes that turn
    const Vec2<double> base{apart + d, 0};
    const Vec2<double> turned{c * arm.x - s * arm.y, s * arm.x + c * arm.y}, rate = perpendicular(turned);
    const Vec2<double> h = base + turned;
    const double f = norm(h), f1 = dot(h, rate) / f, f2 = (dot(rate, rate) - dot(h, turned) - f1 * f1) / f;
    return Taylor<double>{f, f1, f2};
  };
  both->add_driver("drive", RelativeDistance<>{{a / 2, 0}, across}, both->find_body("crank1"),
                   both->find_body("rocker2"), TimeFunction<double>::custom(distance));
  for (double every : {0.1, 0.5, pi - 1}) {
    Kinematics kinematics(both);
    double worst = 0;
    RowFunction check([&](const Snapshot& s) {
      for (const char* body : {"crank1", "rocker1", "crank2", "rocker2"}) {
        worst = std::max(worst, std::abs(wrapped(s.q[angle_place(s, body)] - (start + s.t))));
      }
      return true;
    });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 2.6, every), everything, check);
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_LT(worst, 1e-10) << every;
    ASSERT_EQ(kinematics.singular_points().size(), 1u) << every;
    const SingularPoint& point = kinematics.singular_points()[0];
    EXPECT_NEAR(point.t, pi - start, 1e-10);
    EXPECT_EQ(point.nullity, 2);
    EXPECT_GE(point.tangents.size(), 2u);
  }
}

// Both dead points with the rocker as driver: values of the published reference.
TEST(KinematicsSingular, DeadPointsAgreeWithTheReference) {
  const FourBar f;
  const double outer = 1.6333370885913880100, inner = 2.6810992285307338182;
  const double crank_outer = 0.60688491067669530197, crank_inner = 3.7757764944138340676;
  for (double rate : {1.0, -1.0, 25.0, -0.01}) {
    auto model = driven_four_bar(f, ramp(1, 0));
    const double start = model->bodies[2].angle;
    auto driven = std::make_shared<Model>();
    for (const auto& body : model->bodies) {
      driven->add_body(model->names[body.name], {.position = body.position, .angle = body.angle});
    }
    driven->add("O", Revolute<>{{0, 0}, {-f.a / 2, 0}}, ground, 0);
    driven->add("A", Revolute<>{{f.a / 2, 0}, {-f.b / 2, 0}}, 0, 1);
    driven->add("B", Revolute<>{{f.b / 2, 0}, {f.c / 2, 0}}, 1, 2);
    driven->add("C", Revolute<>{{f.d, 0}, {-f.c / 2, 0}}, ground, 2);
    driven->add_driver("drive", AbsoluteAngle<>{}, 2, ground, ramp(start, rate));
    Kinematics kinematics(driven);
    RowFunction none([](const Snapshot&) { return true; });
    const AnalysisReport report =
        kinematics.run(TimeGrid::range(0, 3 / std::abs(rate), 0.1 / std::abs(rate)), {}, none);
    EXPECT_EQ(report.status, Status::lock_up) << report.message;
    ASSERT_EQ(kinematics.singular_points().size(), 1u);
    const double at = kinematics.singular_points()[0].t;
    EXPECT_NEAR(at, ((rate > 0 ? inner : outer) - start) / rate, 1e-10) << rate;
    EXPECT_NEAR(wrapped(kinematics.q()[2] - (rate > 0 ? crank_inner : crank_outer)), 0, 1e-4);
  }
}

// A change-point linkage that just fails to pass its flat position locks, whatever the unit of length is.
TEST(KinematicsSingular, LockUpIsToldInEveryUnit) {
  for (double scale : {1e-3, 1.0, 1e3}) {
    for (double excess : {1e-2, 1e-6}) {
      const FourBar f{scale, (3 + excess) * scale, scale, 3 * scale};
      Kinematics kinematics(driven_four_bar(f, ramp(0.7, 1), -1));
      RowFunction none([](const Snapshot&) { return true; });
      const AnalysisReport report = kinematics.run(TimeGrid::range(0, 12, 0.9), {}, none);
      EXPECT_EQ(report.status, Status::lock_up) << scale << " " << excess << ": " << report.message;
      // Cosine law: the distance of crank pin and rocker pivot is coupler - rocker, 2 + excess.
      const double angle = 2 * pi - std::acos((10 - (2 + excess) * (2 + excess)) / 6);
      EXPECT_NEAR(kinematics.singular_points().at(0).t, angle - 0.7, 1e-10);
    }
  }
}

}  // namespace
}  // namespace catena::testing
