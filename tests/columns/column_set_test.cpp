#include "catena/columns/column_set.hpp"

#include <gtest/gtest.h>

#include "columns/two_bodies.hpp"

namespace catena::testing {
namespace {

using Names = std::vector<std::string>;

Names names_of(const ColumnSet& columns) {
  Names names;
  for (const ColumnInfo& info : columns.info()) names.push_back(info.name);
  return names;
}

ColumnSet resolve(const TwoBodies& m, const Names& names, const ColumnSources& sources) {
  return ColumnSet::resolve(m.model, *m.plan, names, sources);
}

TEST(ColumnSet, ShowsPositionsAndAnglesByDefault) {
  const TwoBodies m;
  EXPECT_EQ(
      names_of(resolve(m, {}, {.analysis = "assemble"})),
      (Names{"crank.x", "crank.y", "crank.angle", "rod.x", "rod.y", "rod.angle", "tool.x", "tool.y", "tool.angle"}));
}

TEST(ColumnSet, TimeIsFirstInTimedAnalysesAndNowhereTwice) {
  const TwoBodies m;
  const ColumnSources timed{.analysis = "kinematics", .timed = true};
  EXPECT_EQ(names_of(resolve(m, {"crank.x", "t", "crank.x", "crank.y"}, timed)), (Names{"t", "crank.x", "crank.y"}));
  EXPECT_EQ(names_of(resolve(m, {"crank.x", "t"}, {.analysis = "equilibrium"})), (Names{"crank.x", "t"}));
}

TEST(ColumnSet, AsksForNothingThatNoColumnNeeds) {
  const TwoBodies m;
  const auto needs = [&](const Names& names) { return resolve(m, names, everything).needs(); };
  EXPECT_FALSE(needs({}).velocity || needs({}).acceleration || needs({}).multipliers || needs({}).work);
  EXPECT_TRUE(needs({"crank.tip.vx"}).velocity);
  EXPECT_FALSE(needs({"crank.tip.vx"}).acceleration);
  EXPECT_TRUE(needs({"crank.alpha"}).acceleration);
  EXPECT_TRUE(needs({"A.fx"}).multipliers);
  EXPECT_TRUE(needs({"drive.load"}).multipliers);
  EXPECT_FALSE(needs({"A.fx", "drive.value", "energy.potential"}).velocity);
  EXPECT_TRUE(needs({"energy.kinetic"}).velocity);
  EXPECT_FALSE(needs({"energy.total"}).work);
  EXPECT_TRUE(needs({"energy.balance"}).work);
}

TEST(ColumnSet, LeavesOutWhatTheAnalysisCannotGiveAndSaysSo) {
  const TwoBodies m;
  const ColumnSet columns = resolve(m, {"rod", "A.reaction", "energy"}, {.analysis = "equilibrium"});
  EXPECT_EQ(names_of(columns), (Names{"rod.x", "rod.y", "rod.angle", "energy.potential"}));
  ASSERT_EQ(columns.notes().size(), 4u);
  EXPECT_EQ(columns.notes()[0], "left out rod.vx and 5 more: equilibrium gives no velocities");
  EXPECT_EQ(columns.notes()[1], "left out rod.ax and 2 more: equilibrium gives no accelerations");
  EXPECT_EQ(columns.notes()[2], "left out A.fx and 7 more: equilibrium gives no reactions and loads");
  EXPECT_EQ(columns.notes()[3], "left out energy.dissipated: equilibrium does not sum up work");
}

TEST(ColumnSet, EnergiesNeedTheMassesOfAllBodiesThatMove) {
  TwoBodies m;
  m.model.bodies[1].has_mass = false;
  ColumnSet columns = resolve(m, {"energy.kinetic", "energy.potential", "rod.x"}, everything);
  EXPECT_EQ(names_of(columns), Names{"rod.x"});
  ASSERT_EQ(columns.notes().size(), 1u);
  EXPECT_NE(columns.notes()[0].find("body \"rod\""), std::string::npos) << columns.notes()[0];
  m.model.gravity = {0, 0};  // nothing weighs anything now
  EXPECT_EQ(names_of(resolve(m, {"energy.potential"}, everything)), Names{"energy.potential"});
  m.model.bodies[1].fixed = true;
  m.make_plan();
  EXPECT_EQ(resolve(m, {"energy.kinetic"}, everything).size(), 1u);
}

TEST(ColumnSet, AnUnknownNameIsAnError) {
  const TwoBodies m;
  try {
    resolve(m, {"crank.x", "crank.colour"}, everything);
    FAIL();
  } catch (const ColumnError& error) {
    EXPECT_NE(std::string(error.what()).find("crank.colour"), std::string::npos);
    EXPECT_FALSE(error.unknown.candidates.empty());
  }
}

}  // namespace
}  // namespace catena::testing
