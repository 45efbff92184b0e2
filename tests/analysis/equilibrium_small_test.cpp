// Small mechanisms with springs and loads against closed forms; what is stable, unstable, neutral; what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/sanitized.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_reference.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using testing::reference_values;

TEST(Equilibrium, BendsTheElasticaChain) {
  const auto references = reference_values("elastica_chain_P10");
  for (const auto& [name, reference] : references.items()) {
    if (!reference.contains("N")) continue;
    const int count = reference.at("N");
    if (count > testing::size_of_test(count, 100)) continue;
    Equilibrium rods(testing::elastica_chain(count));
    const EquilibriumReport report = rods.solve();
    ASSERT_TRUE(report.ok()) << name << ": " << report.message;
    EXPECT_TRUE(report.stable);
    const std::vector<double> q = rods.state().q;
    const double* last = &q[q.size() - 3];
    const double half = 0.5 / count;
    EXPECT_NEAR(last[0] + half * std::cos(last[2]), reference.at("tip").at(0).get<double>(), 1e-10) << name;
    EXPECT_NEAR(last[1] + half * std::sin(last[2]), reference.at("tip").at(1).get<double>(), 1e-10) << name;
    EXPECT_NEAR(q[2], reference.at("phi_1").get<double>(), 1e-10) << name;
    EXPECT_NEAR(last[2], reference.at("phi_N").get<double>(), 1e-10) << name;
    EXPECT_NEAR(rods.lambda()[0], 0, 1e-8) << name;
    EXPECT_NEAR(rods.lambda()[1], -10, 1e-8) << name;
  }
}

TEST(Equilibrium, LeavesTheUprightPendulumForTheTiltedOne) {
  const auto reference = reference_values("inverted_pendulum_torsion_spring");
  for (const auto& [name, value] : reference.items()) {
    const double weight = std::stod(name.substr(name.find('=') + 1)), theta = value.at("theta");
    // Upright exactly: stationary, but no minimum.
    Equilibrium upright(testing::inverted_pendulum(weight));
    const EquilibriumReport left = upright.solve();
    ASSERT_TRUE(left.ok()) << left.message;
    EXPECT_TRUE(left.stable);
    EXPECT_NEAR(std::abs(upright.q()[2]), theta, 1e-10) << name;
    EXPECT_FALSE(left.warnings.empty());
    // From either side: the branch of that side.
    for (const double side : {-0.1, 0.1}) {
      Equilibrium tilted(testing::inverted_pendulum(weight, side));
      ASSERT_TRUE(tilted.solve().ok());
      EXPECT_NEAR(tilted.q()[2], std::copysign(theta, side), 1e-10) << name;
    }
    // On request it stays, and says what it is.
    Equilibrium stays(testing::inverted_pendulum(weight), {}, {.accept = Accept::stationary});
    const EquilibriumReport unstable = stays.solve();
    ASSERT_TRUE(unstable.ok());
    EXPECT_FALSE(unstable.stable);
    EXPECT_EQ(unstable.negative_modes, 1);
    EXPECT_NEAR(stays.q()[2], 0, 1e-12);
    // k v = (1 - m g l) theta over v^T W v, W = (1, 1, radius^2) at the bar's end and its pin 1 m away: 1 + 1.
    EXPECT_NEAR(unstable.softest_stiffness, (1 - weight) / 2, 1e-9);
    EXPECT_FALSE(unstable.warnings.empty());
  }
}

TEST(Equilibrium, UprightPendulumIsStableUnderAStifferSpring) {
  Equilibrium upright(testing::inverted_pendulum(0.5));
  const EquilibriumReport report = upright.solve();
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report.stable);
  EXPECT_NEAR(upright.q()[2], 0, 1e-12);
  EXPECT_NEAR(report.softest_stiffness, 0.25, 1e-9);
}

TEST(Equilibrium, RunsDownhillThroughTheFlatParallelogram) {
  const auto reference = reference_values("parallelogram_diagonal_spring");
  const double theta = reference.at("eq1").at("theta"), energy = reference.at("eq1").at("V");
  for (const double start : {-2.1, -0.7, 0.5, 0.82, 1.5, 2.5}) {
    Equilibrium linkage(testing::sprung_parallelogram(start));
    const EquilibriumReport report = linkage.solve();
    ASSERT_TRUE(report.ok()) << start << ": " << report.message;
    EXPECT_TRUE(report.stable);
    EXPECT_NEAR(std::remainder(linkage.q()[2] - theta, 2 * std::numbers::pi), 0, 1e-10) << start;
    EXPECT_NEAR(report.energy, energy, 1e-10 * std::abs(energy));
  }
  Equilibrium summit(testing::sprung_parallelogram(0.8), {}, {.accept = Accept::stationary});
  const EquilibriumReport unstable = summit.solve();
  ASSERT_TRUE(unstable.ok()) << unstable.message;
  EXPECT_EQ(unstable.negative_modes, 1);
  EXPECT_NEAR(summit.q()[2], reference.at("eq2").at("theta").get<double>(), 1e-10);
}

TEST(Equilibrium, StaysInTheValleyOfTheTrussOrSnapsThrough) {
  const auto reference = reference_values("von_mises_truss");
  const double limit = reference.at("P_limit");
  for (const auto& [name, value] : reference.at("equilibria").items()) {
    for (const bool up : {true, false}) {
      Equilibrium truss(testing::von_mises_truss(value.at("P"), up ? 0.3 : -0.35));
      const EquilibriumReport report = truss.solve();
      ASSERT_TRUE(report.ok()) << name << report.message;
      EXPECT_TRUE(report.stable);
      EXPECT_EQ(report.negative_modes, 0);
      const double y = up && value.contains("y_pre") ? value.at("y_pre") : value.at("y_post");
      EXPECT_NEAR(truss.state().q[1], y, 1e-12) << name;
    }
    if (!value.contains("y_unstable")) continue;
    const double y = value.at("y_unstable");
    Equilibrium between(testing::von_mises_truss(value.at("P"), y), {}, {.accept = Accept::stationary});
    const EquilibriumReport report = between.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_FALSE(report.stable);
    EXPECT_EQ(report.negative_modes, 1);
    EXPECT_NEAR(between.state().q[1], y, 1e-12);
    EXPECT_GT(limit, value.at("P").get<double>());
  }
}

TEST(Equilibrium, GivesReactionsWhereNothingCanMove) {
  const auto references = reference_values("three_hinged_frame");
  for (const auto& [name, value] : references.items()) {
    const double degrees = std::stod(name.substr(3)), h = value.at("H"), v = value.at("V");
    Equilibrium frame(testing::three_hinged_frame(degrees * std::numbers::pi / 180));
    const EquilibriumReport report = frame.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_TRUE(report.stable);
    EXPECT_TRUE(report.softest_mode.empty());
    const auto force_on_j = [&](const char* pin, std::size_t row) {
      const int element = frame.evaluator().model().find_element(pin);
      return -frame.lambda()[static_cast<std::size_t>(frame.plan().element_row[static_cast<std::size_t>(element)]) +
                             row];
    };
    EXPECT_NEAR(force_on_j("A", 0), h, 1e-10 * h) << name;
    EXPECT_NEAR(force_on_j("A", 1), v, 1e-10 * h) << name;
    EXPECT_NEAR(force_on_j("B", 0), -h, 1e-10 * h) << name;
    EXPECT_NEAR(force_on_j("B", 1), v, 1e-10 * h) << name;
  }
}

TEST(Equilibrium, RefusesWhatNothingHolds) {
  Model free;
  free.add_body("stone", {.mass = 1, .inertia = 1});
  EquilibriumReport report = Equilibrium(std::make_shared<Model>(free)).solve();
  EXPECT_EQ(report.status, Status::refused);
  EXPECT_NE(report.message.find("\"stone\""), std::string::npos) << report.message;
  free.gravity = {0, -testing::earth};
  report = Equilibrium(std::make_shared<Model>(free)).solve();
  EXPECT_EQ(report.status, Status::unbounded);
  EXPECT_NE(report.message.find("\"stone\""), std::string::npos) << report.message;
}

TEST(Equilibrium, NamesMotionsThatMeetNoResistance) {
  Model wheel;
  wheel.gravity = {0, -testing::earth};
  wheel.add_body("wheel", {.mass = 1, .inertia = 1});
  wheel.add("axle", Revolute<double>{}, ground, 0);
  for (const Accept accept : {Accept::stable, Accept::stationary}) {
    const EquilibriumReport report = Equilibrium(std::make_shared<Model>(wheel), {}, {.accept = accept}).solve();
    EXPECT_TRUE(report.ok()) << report.message;
    EXPECT_TRUE(report.neutral);
    EXPECT_FALSE(report.stable);
    EXPECT_EQ(report.free_motions, 1);
    EXPECT_EQ(report.free_bodies, std::vector<std::string>{"wheel"});
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_NE(report.warnings[0].find("body \"wheel\" turning"), std::string::npos) << report.warnings[0];
  }
}

TEST(Equilibrium, FindsMotionsFreeWhereNothingPulls) {
  // Neither load nor spring: every place of the bar is as good; where it is welded it stands.
  Model bar;
  bar.add_body("bar", {.mass = 1, .inertia = 1, .position = {0.5, 0}});
  Model welded = bar;
  bar.add("pin", Revolute<double>{{0, 0}, {-0.5, 0}}, ground, 0);
  EquilibriumReport report = Equilibrium(std::make_shared<Model>(bar)).solve();
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.neutral);
  EXPECT_FALSE(report.stable);
  EXPECT_EQ(report.free_bodies, std::vector<std::string>{"bar"});
  welded.add("weld", Weld<double>{.s_i = {0, 0}, .s_j = {-0.5, 0}}, ground, 0);
  report = Equilibrium(std::make_shared<Model>(welded)).solve();
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.stable);
}

TEST(Equilibrium, GivesUpWhereOnlyInfiniteForcesWouldDo) {
  // Two bars exactly as long as their span: nothing finite carries their weight.
  Model bars;
  bars.gravity = {0, -testing::earth};
  for (int k = 0; k < 2; ++k) {
    bars.add_body("bar" + std::to_string(k), {.mass = 1, .inertia = 1.0 / 12, .position = {k + 0.5, 0}});
    bars.add("", Revolute<double>{{k == 0 ? 0 : 0.5, 0}, {-0.5, 0}}, k == 0 ? ground : 0, k);
  }
  bars.add("", Revolute<double>{{2, 0}, {0.5, 0}}, ground, 1);
  const EquilibriumReport report = Equilibrium(std::make_shared<Model>(bars)).solve();
  EXPECT_EQ(report.status, Status::not_converged);
  EXPECT_FALSE(report.certified);
  EXPECT_FALSE(report.stable);
}

TEST(Equilibrium, SaysThatAnEnergyHasNoMinimum) {
  Model wheel;
  wheel.add_body("wheel", {.mass = 1, .inertia = 1});
  wheel.add("axle", Revolute<double>{}, ground, 0);
  wheel.add_force("motor", Torque<double>{}, 0, ground, {2.0});
  EquilibriumReport report = Equilibrium(std::make_shared<Model>(wheel)).solve();
  EXPECT_EQ(report.status, Status::unbounded);
  EXPECT_NE(report.message.find("\"wheel\" turns"), std::string::npos) << report.message;

  Model slope;
  slope.gravity = {1, -testing::earth};
  slope.add_body("sledge", {.mass = 1, .inertia = 1});
  Translational<double> rail;
  rail.axis_i = rail.axis_j = {1, 0};
  slope.add("rail", rail, ground, 0);
  report = Equilibrium(std::make_shared<Model>(slope)).solve();
  EXPECT_EQ(report.status, Status::unbounded);
  EXPECT_NE(report.message.find("\"sledge\" moves"), std::string::npos) << report.message;
}

TEST(Equilibrium, QuadraticEnergyWithLinearConstraintsTakesOneFactorization) {
  Model shafts;
  for (int k = 0; k < 5; ++k) {
    shafts.add_body("disc" + std::to_string(k), {.mass = 1, .inertia = 1, .position = {static_cast<double>(k), 0}});
    shafts.add("", AbsoluteX<double>{}, k, ground, static_cast<double>(k));
    shafts.add("", AbsoluteY<double>{}, k, ground, 0.0);
    shafts.add_force("", testing::torsion_spring(3, 0.1), k - 1, k);
    shafts.add_force("", Torque<double>{}, k, ground, {0.3});
  }
  Equilibrium line(std::make_shared<Model>(shafts));
  const EquilibriumReport report = line.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.stable);
  EXPECT_EQ(report.counters.factorizations, 1);
  // Torque in spring k: what the discs beyond it get, 0.3 (5 - k); its twist on top of the free angle.
  double angle = 0;
  for (int k = 0; k < 5; ++k) {
    angle += 0.1 + 0.3 * (5 - k) / 3;
    EXPECT_NEAR(line.state().q[3 * static_cast<std::size_t>(k) + 2], angle, 1e-13);
  }
}

TEST(Equilibrium, ASmallChangeOfParametersNeedsThreeFactorizationsAndNoAnalysis) {
  Equilibrium chain(testing::hanging_chain(200, testing::ChainStart::sag));
  const EquilibriumReport first = chain.solve();
  ASSERT_TRUE(first.ok());
  chain.set_model(testing::hanging_chain(200, testing::ChainStart::sag, 1, 1.501));
  const EquilibriumReport second = chain.solve();
  ASSERT_TRUE(second.ok()) << second.message;
  EXPECT_TRUE(second.stable);
  EXPECT_LE(second.counters.factorizations - first.counters.factorizations, 3);
  EXPECT_EQ(second.counters.symbolic, first.counters.symbolic);
  Equilibrium anew(testing::hanging_chain(200, testing::ChainStart::sag, 1, 1.501));
  ASSERT_TRUE(anew.solve().ok());
  EXPECT_NEAR(chain.lambda()[0], anew.lambda()[0], 1e-12 * anew.lambda()[0]);
}

}  // namespace
}  // namespace catena
