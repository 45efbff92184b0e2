// Reactions (apps/manual/dynamics.md#reactions) against values by hand and against virtual work.
#include <gtest/gtest.h>

#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/model/model_add.hpp"
#include "columns/two_bodies.hpp"

namespace catena::testing {
namespace {

/// Multiplier of the solver's row k of an element.
double& lambda(TwoBodies& m, const std::string& element, int row) {
  const int e = m.model.find_element(element);
  return m.lambda[static_cast<std::size_t>(m.plan->element_row[static_cast<std::size_t>(e)] + row)];
}

TEST(Reaction, OfAPinIsMinusTheMultiplierOnJAndPlusOnI) {
  TwoBodies m;
  lambda(m, "B", 0) = 3;
  lambda(m, "B", 1) = -5;
  // fx, fy, torque on j, the same on i, fx and fy in the joint's axes
  const std::vector<double> r = m.values({"B.reaction"});
  ASSERT_EQ(r.size(), 8u);
  const double c = std::cos(m.value("crank.angle")), s = std::sin(m.value("crank.angle"));
  const double expected[] = {-3, 5, 0, 3, -5, 0, c * -3 + s * 5, -s * -3 + c * 5};
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(r[k], expected[k], 1e-13) << k;
  EXPECT_EQ(m.value("B.lambda1"), 3);
  EXPECT_EQ(m.value("B.lambda2"), -5);
}

TEST(Reaction, OnTheGroundIsGivenWhereTheGroundIsJ) {
  TwoBodies m;
  lambda(m, "G", 0) = 2;
  lambda(m, "G", 1) = 7;
  const std::vector<double> on_ground = m.values({"G.fx", "G.fy", "G.torque", "G.i.fx", "G.i.fy", "G.i.torque"});
  const double expected[] = {-2, -7, 0, 2, 7, 0};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(on_ground[k], expected[k], 1e-13) << k;
}

TEST(Reaction, OfAWeldHasATorqueAboutEachBodysOwnPoint) {
  TwoBodies m;
  lambda(m, "W", 0) = 2;
  lambda(m, "W", 1) = -1;
  lambda(m, "W", 2) = 4;
  // The points are apart here, h != 0, yet each reaction is about its own point: the moment of the force about it is 0.
  EXPECT_NEAR(m.value("W.torque"), -4, 1e-13);
  EXPECT_NEAR(m.value("W.i.torque"), 4, 1e-13);
  EXPECT_NEAR(m.value("W.fx"), -2, 1e-13);
  EXPECT_NEAR(m.value("W.i.fy"), -1, 1e-13);
}

TEST(Reaction, OfAnAbsoluteConstraintActsOnTheOnlyBody) {
  TwoBodies m;
  lambda(m, "X", 0) = 6;
  EXPECT_NEAR(m.value("X.fx"), -6, 1e-14);
  EXPECT_NEAR(m.value("X.fy"), 0, 1e-14);
  EXPECT_NEAR(m.value("X.torque"), 0, 1e-14);
}

TEST(Reaction, OfADistanceBelongsToTheSquaredForm) {
  TwoBodies m;
  lambda(m, "D", 0) = 2.6;  // the solver's row is Phi / (2 c), c = 1.3
  EXPECT_NEAR(m.value("D.lambda1"), 1.0, 1e-15);
  m.model.add_point(1, "P", {0.3, -0.2});
  EXPECT_NEAR(m.value("D.fx"), -2 * (m.value("rod.P.x") - 2.0), 1e-13);
  EXPECT_NEAR(m.value("D.fy"), -2 * (m.value("rod.P.y") + 1.0), 1e-13);
  EXPECT_NEAR(m.value("D.torque"), 0, 1e-13);
}

TEST(Reaction, WorkInAnyMotionIsMinusLambdaTimesTheRateOfTheRows) {
  // F.v_P + T omega summed over the bodies = -lambda^T Phi_q qd, whatever the motion; the driver's own rate is
  // separate.
  TwoBodies m;
  for (const std::string joint : {"B", "W"}) {
    const bool weld = joint == "W";
    const std::string i = weld ? "rod" : "crank", j = weld ? "tool" : "rod";
    m.model.add_point(m.model.find_body(i), "Pi" + joint, weld ? Vec2<double>{0.4, 0.1} : Vec2<double>{0.6, 0.1});
    m.model.add_point(m.model.find_body(j), "Pj" + joint, weld ? Vec2<double>{-0.2, 0.3} : Vec2<double>{-0.4, 0.02});
    const std::string pi = i + ".Pi" + joint, pj = j + ".Pj" + joint;
    const double work =
        m.value(joint + ".fx") * m.value(pj + ".vx") + m.value(joint + ".fy") * m.value(pj + ".vy") +
        m.value(joint + ".torque") * m.value(j + ".omega") + m.value(joint + ".i.fx") * m.value(pi + ".vx") +
        m.value(joint + ".i.fy") * m.value(pi + ".vy") + m.value(joint + ".i.torque") * m.value(i + ".omega");
    double rows = lambda(m, joint, 0) * (m.value(pj + ".vx") - m.value(pi + ".vx")) +
                  lambda(m, joint, 1) * (m.value(pj + ".vy") - m.value(pi + ".vy"));
    if (weld) rows += lambda(m, joint, 2) * (m.value(j + ".omega") - m.value(i + ".omega"));
    EXPECT_NEAR(work, -rows, 1e-13) << joint;
  }
}

TEST(Reaction, DriverLoadPushesTheValueUp) {
  TwoBodies m;
  lambda(m, "drive", 0) = 4;
  EXPECT_NEAR(m.value("drive.load"), -4, 1e-14);
  EXPECT_NEAR(m.value("drive.torque"), -4, 1e-14);               // on j, the crank
  EXPECT_NEAR(m.value("drive.power"), -4 * (3.0 - 0.7), 1e-13);  // c' = 3 - 2 0.5 t
  lambda(m, "reach", 0) = -3;
  // The scale was taken at t = 0, c = 0.8; at t = 0.7 c = 1.08, c' = 0.4.
  const double multiplier = -3 / (2 * 0.8);
  EXPECT_NEAR(m.value("reach.lambda1"), multiplier, 1e-14);
  EXPECT_NEAR(m.value("reach.load"), -2 * 1.08 * multiplier, 1e-14);
  EXPECT_NEAR(m.value("reach.power"), -2 * 1.08 * multiplier * 0.4, 1e-14);
  m.driver_work[static_cast<std::size_t>(m.model.find_element("reach"))] = 12;
  EXPECT_EQ(m.value("reach.work"), 12);
}

TEST(Reaction, OfGearsIsAForceAtThePitchPoint) {
  // Centres at the right distance on a slanted line, gears turned anyhow: the teeth push across that line, there alone.
  for (const bool internal : {false, true}) {
    for (const double radius_j : {0.2, 0.5}) {
      const double distance = internal ? std::abs(0.3 - radius_j) : 0.3 + radius_j;
      const Vec2<double> along{std::cos(0.7), std::sin(0.7)};
      Model model;
      model.add_body("a", BodyValues{.position = {1.0, 2.0}, .angle = 0.3});
      model.add_body("b", BodyValues{.position = Vec2<double>{1.0, 2.0} + distance * along, .angle = -0.8});
      model.add("G", Gear<double>{{}, {}, 0.3, radius_j, internal}, 0, 1);
      EvaluationWork work;
      Evaluator evaluator(Plan::make(model), model, work);
      const std::vector<double> q = evaluator.given_configuration(), lambda{2.5};
      evaluator.set_configuration(q);
      Snapshot s{evaluator};
      s.q = q;
      s.lambda = lambda;
      const std::vector<std::string> names{"G.fx", "G.fy", "G.torque", "G.i.fx", "G.i.fy", "G.i.torque"};
      std::vector<double> r(6);
      ColumnSet::resolve(model, evaluator.plan(), names, everything).evaluate(s, r);
      EXPECT_NEAR(std::hypot(r[0], r[1]), 2.5, 1e-13);
      EXPECT_NEAR(r[0] * along.x + r[1] * along.y, 0, 1e-13);
      EXPECT_NEAR(r[3], -r[0], 1e-13);
      EXPECT_NEAR(r[4], -r[1], 1e-13);
      EXPECT_NEAR(r[2], 0, 1e-13) << internal << radius_j;
      EXPECT_NEAR(r[5], 0, 1e-13) << internal << radius_j;
    }
  }
}

TEST(Reaction, InTheJointsAxesIsAlongAndAcrossTheSlide) {
  TwoBodies m;
  m.model.add("L", Translational<double>{{0.1, 0.0}, {0.0, 0.2}, {3.0, 4.0}, {}}, 0, 1);
  m.lambda.clear();
  m.make_plan();
  lambda(m, "L", 0) = 2;
  const std::vector<double> r = m.values({"L.joint.fx", "L.joint.fy", "L.fx", "L.fy"});
  EXPECT_NEAR(r[0], 0, 1e-13);  // nothing holds it along the slide
  EXPECT_NEAR(r[1], -2, 1e-13);
  EXPECT_NEAR(std::hypot(r[2], r[3]), 2, 1e-13);
}

TEST(Reaction, OfAWeldToTheGroundIsThereIfThePlanWasAskedToKeepIt) {
  TwoBodies m;
  m.model.add("V", Weld<double>{}, ground, 2);
  const std::vector<std::string> names{"V.fx", "rod.x", "V.torque"};
  EXPECT_EQ(elements_with_reactions(m.model, names), std::vector<int>{m.model.find_element("V")});
  const auto without = Plan::make(m.model);
  const ColumnSet columns = ColumnSet::resolve(m.model, *without, names, everything);
  ASSERT_EQ(columns.size(), 1u);
  ASSERT_EQ(columns.notes().size(), 1u);
  EXPECT_NE(columns.notes()[0].find("V.fx and 1 more"), std::string::npos) << columns.notes()[0];
  const auto with = Plan::make(m.model, {elements_with_reactions(m.model, names)});
  EXPECT_EQ(ColumnSet::resolve(m.model, *with, names, everything).size(), 3u);
}

}  // namespace
}  // namespace catena::testing
