// Singular configurations of driven mechanisms: where they are, which branches meet there, and which one is taken.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/linkages.hpp"
#include "catena/analysis/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

using std::numbers::pi;
using testing::add_rod;
using testing::driven_four_bar;
using testing::FourBar;
using testing::pin;
using testing::ramp;

constexpr Needs everything{.velocity = true, .acceleration = true};
constexpr FourBar parallelogram{.a = 0.1, .b = 0.3, .c = 0.1, .d = 0.3};

std::size_t angle_place(const Snapshot& s, const char* body) {
  const int b = s.evaluator.model().find_body(body);
  return static_cast<std::size_t>(3 * s.evaluator.plan().plan_body[static_cast<std::size_t>(b)] + 2);
}

double wrapped(double angle) { return std::remainder(angle, 2 * pi); }

/// Rates of the rocker and the coupler along a tangent.
std::array<double, 2> rates(Kinematics& kinematics, const Model& model, const std::vector<double>& tangent) {
  const auto rate = [&](const char* name) {
    return tangent[static_cast<std::size_t>(
        3 * kinematics.plan().plan_body[static_cast<std::size_t>(model.find_body(name))] + 2)];
  };
  return {rate("rocker"), rate("coupler")};
}

/// Largest error of q, qd, qdd of a parallelogram's rocker and coupler that stays one, its crank turning as `crank`.
struct Errors {
  double position = 0, velocity = 0, acceleration = 0;

  void add(const Snapshot& s, const Taylor<double>& crank) {
    const std::size_t rocker = angle_place(s, "rocker"), coupler = angle_place(s, "coupler");
    position = std::max({position, std::abs(wrapped(s.q[rocker] - crank.f)), std::abs(wrapped(s.q[coupler]))});
    if (s.qd.empty()) return;
    velocity = std::max({velocity, std::abs(s.qd[rocker] - crank.d), std::abs(s.qd[coupler])});
    // The coupler's middle moves like the crank's end.
    const double a = parallelogram.a, x = -a * (crank.dd * std::sin(crank.f) + crank.d * crank.d * std::cos(crank.f));
    acceleration = std::max({acceleration, std::abs(s.qdd[rocker] - crank.dd), std::abs(s.qdd[coupler]),
                             std::abs(s.qdd[coupler - 2] - x) / a});
  }
};

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

TEST(KinematicsSingular, BranchChoosesTheAntiparallelogram) {
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

TEST(KinematicsSingular, AStartWhereBranchesMeetAsksForAChoice) {
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
TEST(KinematicsSingular, DriversThatRestAtAFlatPositionPassIt) {
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
TEST(KinematicsSingular, BranchesAreListedWhereTheDriversRest) {
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

TEST(KinematicsSingular, BranchesAreListedWhereTheMotionStartsAtRest) {
  RowFunction none([](const Snapshot&) { return true; });
  auto model = driven_four_bar(parallelogram, TimeFunction<double>::polynomial(std::array{pi, 0.0, 0.5}));
  Kinematics kinematics(model);
  const AnalysisReport report = kinematics.run(TimeGrid::range(0, 2, 0.1), {}, none);
  EXPECT_EQ(report.status, Status::singular);
  EXPECT_NE(report.message.find("the drivers rest"), std::string::npos) << report.message;
  EXPECT_NE(report.message.find("branch 2"), std::string::npos) << report.message;
  ASSERT_EQ(kinematics.singular_points().size(), 1u);
  ASSERT_EQ(kinematics.singular_points()[0].tangents.size(), 2u);
  for (const auto& tangent : kinematics.singular_points()[0].tangents) EXPECT_NEAR(tangent[2], 1, 1e-9);
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

// A parallelogram with a third crank: of more rows than needed some determine nothing where the cranks stand upright or
// lie flat; others must take their place, whatever the unit of length is.
TEST(KinematicsSingular, ARedundantParallelogramTurnsInEveryUnit) {
  for (double scale : {1e-3, 1.0, 30.0, 1e4}) {
    for (double every : {0.01, 0.1, 2.0}) {
      const FourBar f{scale, 3 * scale, scale, 3 * scale};
      auto model = driven_four_bar(f, ramp(0.7, 1));
      const Vec2<double> foot{1.5 * scale, 0}, tip = foot + scale * Vec2<double>{std::cos(0.7), std::sin(0.7)};
      const int middle = add_rod(*model, "middle", foot, tip);
      pin(*model, "D", foot, middle, "from");
      model->add("E", Revolute<>{{}, *model->find_point(middle, "to")}, model->find_body("coupler"), middle);
      Kinematics kinematics(model);
      double angle = 0, rate = 0;
      RowFunction check([&](const Snapshot& s) {
        // Within this of the flat position rows determine rates to few digits.
        const bool flat = std::abs(std::remainder(0.7 + s.t, pi)) < 0.01;
        for (const char* body : {"rocker", "middle"}) {
          const std::size_t place = angle_place(s, body);
          angle = std::max(angle, std::abs(wrapped(s.q[place] - 0.7 - s.t)));
          if (!flat) rate = std::max({rate, std::abs(s.qd[place] - 1), std::abs(s.qdd[place])});
        }
        return true;
      });
      const AnalysisReport report = kinematics.run(TimeGrid::range(0, 8, every), everything, check);
      ASSERT_TRUE(report.ok()) << scale << " " << every << ": " << report.message;
      EXPECT_LT(angle, 1e-10) << scale << " " << every;
      EXPECT_LT(rate, 1e-9) << scale << " " << every;
      if (scale > 1) continue;
      ASSERT_EQ(kinematics.singular_points().size(), 2u) << scale << " " << every;
      EXPECT_NEAR(kinematics.singular_points()[0].t, pi - 0.7, 1e-10);
      EXPECT_NEAR(kinematics.singular_points()[1].t, 2 * pi - 0.7, 1e-10);
    }
  }
}

// A crank whose end is driven in x and in y: neither alone determines it all the way round.
TEST(KinematicsSingular, RowsAreChosenAnewWhereTheyBecomeDependent) {
  auto model = std::make_shared<Model>();
  const double length = 0.2;
  const int crank = add_rod(*model, "crank", {0, 0}, {length * std::cos(0.3), length * std::sin(0.3)});
  pin(*model, "O", {0, 0}, crank, "from");
  model->add_driver("x", AbsoluteX<>{{length / 2, 0}}, crank, ground,
                    TimeFunction<double>::harmonic(length, 2, 0.3 + pi / 2));
  model->add_driver("y", AbsoluteY<>{{length / 2, 0}}, crank, ground, TimeFunction<double>::harmonic(length, 2, 0.3));
  for (double every : {0.01, 0.2, 1.0, 10.0}) {
    Kinematics kinematics(model);
    double worst = 0, worst_rate = 0;
    RowFunction check([&](const Snapshot& s) {
      worst = std::max(worst, std::abs(s.q[2] - (0.3 + 2 * s.t)));
      worst_rate = std::max({worst_rate, std::abs(s.qd[2] - 2), std::abs(s.qdd[2])});
      return true;
    });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 20, every), everything, check);
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_LT(worst, 1e-11) << every;
    EXPECT_LT(worst_rate, 1e-10) << every;
    EXPECT_TRUE(kinematics.singular_points().empty()) << every;
    EXPECT_EQ(report.redundant.size(), 1u);
  }
}

}  // namespace
}  // namespace catena
