// Motions of mechanisms with more constraints than they need: which rows determine them changes on the way.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "analysis/linkages.hpp"
#include "analysis/parallelogram.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

using std::numbers::pi;

// A parallelogram with a third crank: of more rows than needed some determine nothing where the cranks stand upright or
// lie flat; others must take their place, whatever the unit of length is.
TEST(KinematicsRedundant, ARedundantParallelogramTurnsInEveryUnit) {
  for (double scale : {1e-3, 0.0254, 1.0, 30.0, 1e3, 1e4}) {
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
      ASSERT_EQ(kinematics.singular_points().size(), 2u) << scale << " " << every;
      EXPECT_NEAR(kinematics.singular_points()[0].t, pi - 0.7, 1e-10);
      EXPECT_NEAR(kinematics.singular_points()[1].t, 2 * pi - 0.7, 1e-10);
    }
  }
}

// A crank whose end is driven in x and in y: neither alone determines it all the way round.
TEST(KinematicsRedundant, RowsAreChosenAnewWhereTheyBecomeDependent) {
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

// One or two cranks more than it needs, or joints twice: all flat positions are found, and none besides, whatever the
// unit of length, the speed, the direction and the rows.
TEST(KinematicsRedundant, EveryFlatPositionOfRedundantParallelogramsIsFound) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 1);
  for (int run = 0; run < 300; ++run) {
    const double scale = std::pow(10, -3 + 6 * any(random)), start = 0.1 + 2.9 * any(random);
    const double every = std::pow(10, -2 + 2.5 * any(random));  // rad
    const double a = scale * (0.3 + any(random)), d = scale * (1 + 3 * any(random));
    const double rate = (any(random) < 0.5 ? -1 : 1) * std::pow(10, 2 * any(random) - 1), span = 8 / std::abs(rate);
    const FourBar f{a, d, a, d};
    auto model = driven_four_bar(f, ramp(start, rate));
    const int cranks = run % 3;
    for (int k = 0; k < cranks; ++k) {
      const double place = any(random) * d;
      const Vec2<double> foot{place, 0}, tip = foot + a * Vec2<double>{std::cos(start), std::sin(start)};
      const std::string n = std::to_string(k);
      const int crank = add_rod(*model, "more" + n, foot, tip);
      pin(*model, "D" + n, foot, crank, "from");
      model->add("E" + n, Revolute<>{{place - d / 2, 0}, *model->find_point(crank, "to")}, model->find_body("coupler"),
                 crank);
    }
    if (cranks == 0) {
      pin(*model, "A again", model->find_body("crank"), "to", model->find_body("coupler"), "from");
      pin(*model, "C again", {d, 0}, model->find_body("rocker"), "from");
    }
    Kinematics kinematics(model);
    double worst = 0;
    RowFunction check([&](const Snapshot& s) {
      worst = std::max(worst, std::abs(wrapped(s.q[angle_place(s, "rocker")] - start - rate * s.t)));
      return true;
    });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, span, every / std::abs(rate)), everything, check);
    ASSERT_TRUE(report.ok()) << run << ": " << report.message;
    EXPECT_LT(worst, 1e-10) << run;
    std::vector<double> instants;
    for (int k = -4; k <= 4; ++k) {
      const double t = ((rate > 0 ? k : -k) * pi - start) / rate;
      if (t > 0 && t <= span) instants.push_back(t);
    }
    const auto& found = kinematics.singular_points();
    ASSERT_EQ(found.size(), instants.size()) << run << " scale " << scale << " every " << every;
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k].t, instants[k], 1e-10 * span) << run;
  }
}

// A second driver that has the first one's values at all rows, and other speeds there; or the same at all rows and
// other places in between.
TEST(KinematicsRedundant, DriversThatAgreeAtRowsAloneContradictEachOther) {
  for (const double phase : {0.0, pi / 2}) {
    auto model = std::make_shared<Model>();
    const int crank = add_rod(*model, "crank", {0, 0}, {1, 0});
    pin(*model, "O", Vec2<double>{0, 0}, crank, "from");
    model->add_driver("d1", AbsoluteAngle<>{}, crank, ground, ramp(0, 1));
    const TimeFunction<double> sway = TimeFunction<double>::harmonic(0.01, 20 * pi, phase, phase > 0 ? -0.01 : 0);
    model->add_driver("d2", AbsoluteAngle<>{}, crank, ground, TimeFunction<double>::sum({ramp(0, 1), sway}));
    Kinematics kinematics(model);
    RowFunction nothing([](const Snapshot&) { return true; });
    const AnalysisReport report = kinematics.run(TimeGrid::range(0, 1, 0.1), {}, nothing);
    EXPECT_EQ(report.status, Status::inconsistent) << report.message;
    EXPECT_NE(report.message.find("d2"), std::string::npos) << report.message;
  }
}

}  // namespace
}  // namespace catena::testing
