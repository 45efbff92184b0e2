#include "catena/columns/spring.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "catena/columns/column_names.hpp"
#include "catena/elements/forces/bushing.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torsion_spring.hpp"
#include "catena/model/model_add.hpp"
#include "columns/two_bodies.hpp"

namespace catena::testing {
namespace {

/// TwoBodies with a spring from the crank's tip to a point of the tool and a torsion spring between crank and rod.
struct Springs : TwoBodies {
  Springs() {
    model.add_point(2, "hook", {0.2, 0.5});
    const double growing[] = {1.0, 2.0};
    model.add_force("S", SpringDamper<double>{{0.6, 0.1}, {0.2, 0.5}, 30, 4, 0.7}, 0, 2,
                    {TimeFunction<double>::polynomial(growing)});
    model.add_force("T", TorsionSpring<double>{{}, {}, 5, 0.3, 0.2}, 0, 1, {TimeFunction<double>(1.5)});
    lambda.clear();
    make_plan();
  }
};

TEST(Spring, LengthIsTheDistanceOfItsEndsAndRateItsDerivative) {
  Springs m;
  const double dx = m.value("tool.hook.x") - m.value("crank.tip.x");
  const double dy = m.value("tool.hook.y") - m.value("crank.tip.y");
  EXPECT_NEAR(m.value("S.length"), std::hypot(dx, dy), 1e-15);
  EXPECT_NEAR(m.value("S.rate"), m.slope("S.length"), 1e-9);
}

TEST(Spring, ForceIsTheTension) {
  Springs m;
  // k (l - l0) + c ld + F(t)
  const double expected = 30 * (m.value("S.length") - 0.7) + 4 * m.value("S.rate") + 1.0 + 2.0 * m.t;
  EXPECT_NEAR(m.value("S.force"), expected, 1e-12);
  const double torque = 5 * (m.value("B.angle") - 0.2) + 0.3 * m.value("B.omega") + 1.5;
  EXPECT_NEAR(m.value("T.torque"), torque, 1e-13);
  EXPECT_EQ(m.value("T.angle"), m.value("B.angle"));
}

TEST(Spring, WithoutVelocitiesItIsSeenAtRest) {
  Springs m;
  const std::vector<std::string> names{"S.force"};
  const ColumnSet columns = ColumnSet::resolve(m.model, *m.plan, names, {.analysis = "equilibrium"});
  ASSERT_EQ(columns.size(), 1u);
  EXPECT_FALSE(columns.needs().velocity);
  EXPECT_TRUE(ColumnSet::resolve(m.model, *m.plan, names, everything).needs().velocity);
  Snapshot s = m.snapshot();
  s.qd = {};
  double force = 0;
  columns.evaluate(s, {&force, 1});
  EXPECT_NEAR(force, 30 * (m.value("S.length") - 0.7) + 1.0 + 2.0 * m.t, 1e-12);
}

TEST(Spring, PotentialEnergyIncludesIt) {
  Springs with;
  TwoBodies without;
  const double stretch = with.value("S.length") - 0.7, turn = with.value("B.angle") - 0.2;
  const double expected = 30 * stretch * stretch / 2 + (1.0 + 2.0 * with.t) * with.value("S.length") +
                          5 * turn * turn / 2 + 1.5 * with.value("B.angle");
  EXPECT_NEAR(with.value("energy.potential") - without.value("energy.potential"), expected, 1e-12);
}

/// In the axes of the crank, whose angle is `angle`.
Vec2<double> in_axes(double angle, double x, double y) {
  return {std::cos(angle) * x + std::sin(angle) * y, std::cos(angle) * y - std::sin(angle) * x};
}

TEST(Bushing, ExertsItsForceOnBodyJAtItsPoint) {
  Springs m;
  m.model.add_force("M", Bushing<double>{{0.6, 0.1}, {0.2, 0.5}, 30, 50, 7, 2, 3, 0.5, 0.2}, 0, 2);
  m.make_plan();
  const double angle = m.value("crank.angle");
  const Vec2<double> d =
      in_axes(angle, m.value("tool.hook.x") - m.value("crank.tip.x"), m.value("tool.hook.y") - m.value("crank.tip.y"));
  EXPECT_NEAR(m.value("M.dx"), d.x, 1e-14);
  EXPECT_NEAR(m.value("M.dy"), d.y, 1e-14);
  EXPECT_NEAR(m.value("M.angle"), m.value("tool.angle") - angle, 1e-14);
  const double fx = -(30 * d.x + 2 * m.slope("M.dx")), fy = -(50 * d.y + 3 * m.slope("M.dy"));
  EXPECT_NEAR(m.value("M.joint.fx"), fx, 1e-7);
  EXPECT_NEAR(m.value("M.joint.fy"), fy, 1e-7);
  const Vec2<double> ground = in_axes(-angle, fx, fy);
  EXPECT_NEAR(m.value("M.fx"), ground.x, 1e-7);
  EXPECT_NEAR(m.value("M.fy"), ground.y, 1e-7);
  EXPECT_NEAR(m.value("M.torque"), -(7 * (m.value("M.angle") - 0.2) + 0.5 * m.slope("M.angle")), 1e-7);
}

TEST(Bushing, ReactionStandsForItsLoads) {
  Springs m;
  m.model.add_force("M", Bushing<double>{{}, {}, 30, 50, 7, 2, 3, 0.5, 0.2}, 0, 2);
  std::vector<NamedColumn> found;
  EXPECT_FALSE(find_columns(m.model, "M.reaction", found));
  std::string names;
  for (const NamedColumn& column : found) names += column.info.name + " ";
  EXPECT_EQ(names, "M.fx M.fy M.torque M.joint.fx M.joint.fy ");
  const std::string name[] = {"M.fx"};
  EXPECT_TRUE(elements_with_reactions(m.model, name).empty()) << "nothing is solved for";
}

TEST(Spring, WhereTheEndsMeetTheDirectionIsLostAndNothingIsMadeUp) {
  Model model;
  model.add_body("b", BodyValues{});
  model.add_force("S", SpringDamper<double>{{}, {}, 30, 4, 0.5}, ground, 0);
  EvaluationWork work;
  Evaluator evaluator(Plan::make(model), model, work);
  const std::vector<double> q = evaluator.given_configuration();
  std::vector<double> qd(q.size(), 0.0);
  qd[0] = 1;
  evaluator.set_configuration(q);
  Snapshot s{evaluator};
  s.q = q;
  s.qd = qd;
  const std::vector<std::string> names{"S.length", "S.rate", "S.force"};
  std::vector<double> out(3, 1.0);
  ColumnSet::resolve(model, evaluator.plan(), names, everything).evaluate(s, out);
  EXPECT_EQ(out, (std::vector<double>{0, 0, 0}));
}

}  // namespace
}  // namespace catena::testing
