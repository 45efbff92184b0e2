#include "catena/columns/column_names.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torsion_spring.hpp"
#include "catena/model/model_add.hpp"
#include "columns/two_bodies.hpp"

namespace catena::testing {
namespace {

std::vector<std::string> expand(const Model& model, const std::string& name) {
  std::vector<NamedColumn> columns;
  EXPECT_FALSE(find_columns(model, name, columns)) << name;
  std::vector<std::string> names;
  for (const NamedColumn& column : columns) names.push_back(column.info.name);
  return names;
}

UnitKind unit(const Model& model, const std::string& name) {
  std::vector<NamedColumn> columns;
  EXPECT_FALSE(find_columns(model, name, columns)) << name;
  return columns.at(0).info.unit;
}

UnknownColumn unknown(const Model& model, const std::string& name) {
  std::vector<NamedColumn> columns;
  const auto reason = find_columns(model, name, columns);
  EXPECT_TRUE(reason && columns.empty()) << name;
  return reason.value_or(UnknownColumn{});
}

bool offers(const UnknownColumn& reason, const std::string& candidate) {
  return std::find(reason.candidates.begin(), reason.candidates.end(), candidate) != reason.candidates.end();
}

using Names = std::vector<std::string>;

TEST(ColumnNames, BareNamesStandForAllTheirColumns) {
  const Model model = TwoBodies().model;
  EXPECT_EQ(expand(model, "rod"),
            (Names{"rod.x", "rod.y", "rod.angle", "rod.vx", "rod.vy", "rod.omega", "rod.ax", "rod.ay", "rod.alpha"}));
  EXPECT_EQ(expand(model, "crank.tip"),
            (Names{"crank.tip.x", "crank.tip.y", "crank.tip.vx", "crank.tip.vy", "crank.tip.ax", "crank.tip.ay"}));
  EXPECT_EQ(expand(model, "A.reaction"),
            (Names{"A.fx", "A.fy", "A.torque", "A.i.fx", "A.i.fy", "A.i.torque", "A.joint.fx", "A.joint.fy"}));
  EXPECT_EQ(expand(model, "X.reaction"), (Names{"X.fx", "X.fy", "X.torque", "X.joint.fx", "X.joint.fy"}));
  EXPECT_EQ(expand(model, "energy"),
            (Names{"energy.kinetic", "energy.potential", "energy.total", "energy.dissipated", "energy.balance"}));
  EXPECT_EQ(expand(model, "momentum"), (Names{"momentum.x", "momentum.y", "momentum.angular"}));
}

TEST(ColumnNames, OneNameIsOneColumn) {
  const Model model = TwoBodies().model;
  for (const std::string name :
       {"t", "residual", "crank.x", "crank.tip.ay", "ground.pivot.x", "A.i.torque", "A.lambda2", "W.lambda3", "A.angle",
        "drive.load", "drive.value", "energy.total", "momentum.angular", "absolute_angle#1.lambda1"}) {
    EXPECT_EQ(expand(model, name), Names{name});
  }
}

TEST(ColumnNames, UnitsFollowTheQuantity) {
  const Model model = TwoBodies().model;
  EXPECT_EQ(unit(model, "crank.omega"), UnitKind::angular_velocity);
  EXPECT_EQ(unit(model, "crank.tip.ax"), UnitKind::acceleration);
  EXPECT_EQ(unit(model, "drive.value"), UnitKind::angle);
  EXPECT_EQ(unit(model, "drive.load"), UnitKind::torque);
  EXPECT_EQ(unit(model, "reach.load"), UnitKind::force);
  EXPECT_EQ(unit(model, "reach.rate"), UnitKind::velocity);
  EXPECT_EQ(unit(model, "reach.lambda1"), UnitKind::stiffness);  // of h^T h - c^2: N/m
  EXPECT_EQ(unit(model, "W.lambda2"), UnitKind::force);
  EXPECT_EQ(unit(model, "W.lambda3"), UnitKind::torque);
  EXPECT_EQ(unit(model, "momentum.angular"), UnitKind::angular_momentum);
}

TEST(ColumnNames, SpringsHaveColumnsOfTheirOwn) {
  Model model = TwoBodies().model;
  model.add_force("S", SpringDamper<double>{}, 0, 1);
  model.add_force("T", TorsionSpring<double>{}, 0, 1);
  model.add_force("F", PointForce<double>{}, 0);
  for (const std::string name : {"S.length", "S.rate", "S.force", "T.angle", "T.torque", "T.power", "F.fx", "F.power"})
    EXPECT_EQ(expand(model, name), Names{name});
  EXPECT_EQ(unit(model, "S.force"), UnitKind::force);
  EXPECT_EQ(unit(model, "T.torque"), UnitKind::torque);
  for (const std::string name : {"S.reaction", "S.lambda1", "T.length", "F.torque", "F"}) unknown(model, name);
}

TEST(ColumnNames, WrongNamesSayWhatIsWrongAndOfferOthers) {
  const Model model = TwoBodies().model;
  UnknownColumn reason = unknown(model, "crnak.x");
  EXPECT_NE(reason.message.find("\"crnak\""), std::string::npos);
  EXPECT_TRUE(offers(reason, "crank.x"));

  reason = unknown(model, "crank.tpi.x");
  EXPECT_NE(reason.message.find("body \"crank\" has no point or column \"tpi\""), std::string::npos) << reason.message;
  EXPECT_TRUE(offers(reason, "crank.tip.x"));
  EXPECT_TRUE(offers(unknown(model, "crank.omgea"), "crank.omega"));
  EXPECT_TRUE(offers(unknown(model, "crank.tip.omega"), "crank.tip.x"));
  EXPECT_FALSE(offers(unknown(model, "crank.tip.omega"), "crank.tip.omega"));

  reason = unknown(model, "A.lambda3");
  EXPECT_NE(reason.message.find("revolute \"A\""), std::string::npos) << reason.message;
  EXPECT_TRUE(offers(reason, "A.lambda2"));
  EXPECT_TRUE(offers(unknown(model, "A.raection"), "A.reaction"));
  EXPECT_TRUE(offers(unknown(model, "energy.kintic"), "energy.kinetic"));
}

TEST(ColumnNames, NothingIsAColumnByAccident) {
  const Model model = TwoBodies().model;
  for (const std::string name :
       {"",       ".",         "crank.",   "crank.tip.", "crank..x",      "crank.x.x",           "A",      "A.",
        "A.i",    "A.joint",   "energy.",  "t.x",        "residual.x",    "ground.x.x",          "X.i.fx", "A.value",
        "X.load", "A.lambda0", "A.lambda", "A.slide",    "revolute#1.fx", "absolute_angle#2.fx", "Crank.x"}) {
    EXPECT_FALSE(unknown(model, name).message.empty()) << name;
  }
}

TEST(ColumnNames, AllUnknownNamesAreFoundAtOnce) {
  const Model model = TwoBodies().model;
  const Names names{"crank.x", "nobody.x", "A.fx", "energy.heat"};
  const std::vector<UnknownColumn> reasons = unknown_columns(model, names);
  ASSERT_EQ(reasons.size(), 2u);
  EXPECT_EQ(reasons[0].name, "nobody.x");
  EXPECT_EQ(reasons[1].name, "energy.heat");
}

}  // namespace
}  // namespace catena::testing
