#include <gtest/gtest.h>

#include "catena/elements/constraints/displacement.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/model/model_add.hpp"
#include "columns/two_bodies.hpp"

namespace catena::testing {
namespace {

TEST(ColumnValues, BodyColumnsReferToTheAuthorsOrigin) {
  TwoBodies m;
  m.q = m.evaluator->given_configuration();
  EXPECT_NEAR(m.value("crank.x"), 0.1, 1e-15);
  EXPECT_NEAR(m.value("crank.y"), 0.2, 1e-15);
  EXPECT_EQ(m.value("crank.angle"), 0.4);
  EXPECT_NEAR(m.value("crank.tip.x"), 0.1 + 0.6 * std::cos(0.4) - 0.1 * std::sin(0.4), 1e-15);
  EXPECT_NEAR(m.value("crank.tip.y"), 0.2 + 0.6 * std::sin(0.4) + 0.1 * std::cos(0.4), 1e-15);
  EXPECT_EQ(m.value("rod.x"), 0.9);
  EXPECT_EQ(m.value("ground.pivot.x"), 0.1);
  EXPECT_EQ(m.value("ground.pivot.vx"), 0.0);
}

TEST(ColumnValues, VelocitiesAndAccelerationsAreTheDerivativesOfPositions) {
  TwoBodies m;
  for (const std::string owner : {"crank", "crank.tip", "rod", "tool"}) {
    for (const std::string axis : {"x", "y"}) {
      EXPECT_NEAR(m.value(owner + ".v" + axis), m.slope(owner + "." + axis), 1e-9) << owner << axis;
      EXPECT_NEAR(m.value(owner + ".a" + axis), m.slope(owner + ".v" + axis), 1e-9) << owner << axis;
    }
  }
  EXPECT_NEAR(m.value("rod.omega"), m.slope("rod.angle"), 1e-9);
  EXPECT_NEAR(m.value("rod.alpha"), m.slope("rod.omega"), 1e-9);
}

TEST(ColumnValues, AnglesAreNeverWrapped) {
  TwoBodies m;
  m.q[2] += 100;
  const double angle = m.value("crank.angle");
  EXPECT_GT(angle, 99);
  EXPECT_NEAR(m.value("A.angle"), angle, 1e-13);  // the ground is i, its angle 0
}

TEST(ColumnValues, JointsMeasureBodyJFromBodyI) {
  TwoBodies m;
  EXPECT_NEAR(m.value("B.angle"), m.value("rod.angle") - m.value("crank.angle"), 1e-15);
  EXPECT_NEAR(m.value("B.omega"), m.slope("B.angle"), 1e-9);
  EXPECT_NEAR(m.value("drive.value"), m.value("crank.angle"), 1e-15);
  EXPECT_NEAR(m.value("drive.rate"), m.value("crank.omega"), 1e-15);
}

TEST(ColumnValues, ScalarConstraintsMeasureWhatTheirValuePrescribes) {
  TwoBodies m;
  m.model.add_point(1, "P", {0.3, -0.2});
  const double dx = m.value("rod.P.x") - 2.0, dy = m.value("rod.P.y") + 1.0;
  EXPECT_NEAR(m.value("D.value"), std::hypot(dx, dy), 1e-15);
  EXPECT_NEAR(m.value("D.rate"), m.slope("D.value"), 1e-9);
  EXPECT_NEAR(m.value("X.rate"), m.slope("X.value"), 1e-9);
  EXPECT_NEAR(m.value("absolute_angle#1.value"), m.value("tool.angle"), 1e-15);
}

TEST(ColumnValues, SlidesAreMeasuredAlongTheAxisOfI) {
  TwoBodies m;
  m.model.add("L", Translational<double>{{0.1, 0.0}, {0.0, 0.2}, {3.0, 4.0}, {}}, 0, 1);
  m.model.add("E", Displacement<double>{{0.1, 0.0}, {0.0, 0.2}, {3.0, 4.0}}, 0, 1);
  m.model.add_point(0, "P", {0.1, 0.0});
  m.model.add_point(1, "P", {0.0, 0.2});
  m.lambda.clear();
  m.make_plan();
  const double angle = m.value("crank.angle"), x = 0.6 * std::cos(angle) - 0.8 * std::sin(angle),
               y = 0.6 * std::sin(angle) + 0.8 * std::cos(angle);
  const double along =
      x * (m.value("rod.P.x") - m.value("crank.P.x")) + y * (m.value("rod.P.y") - m.value("crank.P.y"));
  EXPECT_NEAR(m.value("L.slide"), along, 1e-14);
  EXPECT_NEAR(m.value("E.slide"), m.value("E.value"), 1e-14);
  EXPECT_NEAR(m.value("L.slide_rate"), m.slope("L.slide"), 1e-9);
}

TEST(ColumnValues, EnergiesAndMomentaAreSumsOverTheBodies) {
  TwoBodies m;
  // Points at the centroids say what the sums must be.
  m.model.add_point(0, "c", {0.25, -0.05});
  double kinetic = 0, potential = 0, px = 0, py = 0, angular = 0;
  const auto add = [&](const std::string& body, const std::string& c, double mass, double inertia) {
    const double x = m.value(c + ".x"), y = m.value(c + ".y"), vx = m.value(c + ".vx"), vy = m.value(c + ".vy");
    const double omega = m.value(body + ".omega");
    kinetic += (mass * (vx * vx + vy * vy) + inertia * omega * omega) / 2;
    potential -= mass * (0.5 * x - 9.81 * y);
    px += mass * vx;
    py += mass * vy;
    angular += mass * (x * vy - y * vx) + inertia * omega;
  };
  add("crank", "crank.c", 2.0, 0.3);
  add("rod", "rod", 1.5, 0.2);
  add("tool", "tool", 0.5, 0.1);
  EXPECT_NEAR(m.value("energy.kinetic"), kinetic, 1e-13);
  EXPECT_NEAR(m.value("energy.potential"), potential, 1e-13);
  EXPECT_NEAR(m.value("energy.total"), kinetic + potential, 1e-13);
  EXPECT_NEAR(m.value("momentum.x"), px, 1e-13);
  EXPECT_NEAR(m.value("momentum.y"), py, 1e-13);
  EXPECT_NEAR(m.value("momentum.angular"), angular, 1e-13);
}

TEST(ColumnValues, BalanceComparesTheTotalWithWhatCameInAndWentOut) {
  TwoBodies m;
  Snapshot s = m.snapshot();
  s.initial_energy = 3;
  s.work = 2;
  s.dissipated = 0.25;
  const std::vector<std::string> names{"energy"};
  const ColumnSet columns = ColumnSet::resolve(m.model, *m.plan, names, everything);
  std::vector<double> out(columns.size());
  columns.evaluate(s, out);
  ASSERT_EQ(out.size(), 5u);  // kinetic potential total dissipated balance
  EXPECT_EQ(out[2], out[0] + out[1]);
  EXPECT_EQ(out[3], 0.25);
  EXPECT_NEAR(out[4], out[2] - 3 - 2 + 0.25, 1e-14);
}

TEST(ColumnValues, ChangedParametersKeepTheColumns) {
  TwoBodies m;
  const std::vector<std::string> names{"crank.tip.x", "energy.kinetic"};
  const ColumnSet columns = ColumnSet::resolve(m.model, *m.plan, names, everything);
  std::vector<double> before(2), after(2);
  columns.evaluate(m.snapshot(), before);
  m.model.points[0].local.x += 0.5;
  for (auto& body : m.model.bodies) {
    body.mass *= 2;
    body.inertia *= 2;
  }
  m.evaluator->set_model(m.model);
  columns.evaluate(m.snapshot(), after);
  EXPECT_NEAR(after[0] - before[0], 0.5 * std::cos(m.value("crank.angle")), 1e-15);
  EXPECT_NEAR(after[1], 2 * before[1], 1e-13);
}

}  // namespace
}  // namespace catena::testing
