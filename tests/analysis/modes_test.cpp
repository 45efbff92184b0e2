// Small oscillations against closed forms and reference values: hanging and standing chains, springs, shafts, equal and
// free bodies; shapes, refusals, and what it costs.
#include "catena/analysis/stability/modes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/sanitized.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/dense_modes.hpp"
#include "oracles/mode_scenes.hpp"
#include "oracles/random_statics.hpp"
#include "oracles/static_reference.hpp"

namespace catena {
namespace {

using namespace testing;
constexpr double pi = std::numbers::pi;

ModesReport modes_of(const std::shared_ptr<Model>& model, int count = 0) {
  Modes modes(model, {}, {.count = count});
  return modes.run();
}

void expect_near_all(const std::vector<double>& found, const std::vector<double>& wanted, double relative,
                     const std::string& what) {
  ASSERT_EQ(found.size(), wanted.size()) << what;
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k], wanted[k], relative * std::abs(wanted[k])) << what << ", mode " << k + 1;
  }
}

TEST(Modes, OfHangingChains) {
  const auto reference = reference_values("hanging_chain_modes");
  for (const int count : {1, 2, 3, 5, 10}) {
    const std::string number = std::to_string(count);
    const std::vector<double> rods = reference.at("rods_N" + number).at("omega");
    const std::vector<double> masses = reference.at("point_masses_N" + number).at("omega");
    expect_near_all(modes_of(vertical_chain(count, -1)).omega, rods, 1e-12, "rods " + number);
    expect_near_all(modes_of(hanging_masses(count)).omega, masses, 1e-12, "masses " + number);
  }
}

TEST(Modes, OfSpringMassChains) {
  const auto reference = reference_values("spring_mass_chain_modes");
  for (const int count : {1, 2, 10}) {
    const auto& values = reference.at("N" + std::to_string(count));
    expect_near_all(modes_of(spring_mass_chain(count, true)).omega, values.at("fixed_fixed"), 1e-12, "fixed");
    expect_near_all(modes_of(spring_mass_chain(count, false)).omega, values.at("fixed_free"), 1e-12, "free");
  }
}

TEST(Modes, OfSpringMassChainsOfAnyLength) {
  // omega = 2 sqrt(k/m) sin(j pi / (2 N + 2)); complete spectra, parts of large ones, and all of a large one.
  for (const auto& [count, wanted] : {std::pair{40, 40}, {299, 299}, {700, 12}, {700, 233}, {400, 400}, {5000, 5}}) {
    const ModesReport report = modes_of(spring_mass_chain(count, true), wanted);
    ASSERT_TRUE(report.ok()) << report.message;
    std::vector<double> omega(static_cast<std::size_t>(wanted));
    for (int j = 1; j <= wanted; ++j)
      omega[static_cast<std::size_t>(j - 1)] = 2 * std::sqrt(200 / 1.5) * std::sin(j * pi / (2 * count + 2));
    expect_near_all(report.omega, omega, 1e-10, std::to_string(count));
  }
}

TEST(Modes, OfAFreeShaftBeginWithZero) {
  const int count = 20;
  const ModesReport report = modes_of(torsion_chain(count), count);
  ASSERT_TRUE(report.ok()) << report.message;
  std::vector<double> omega2(count);
  for (int j = 0; j < count; ++j)
    omega2[static_cast<std::size_t>(j)] = 1600 * std::pow(std::sin(j * pi / 2 / count), 2);
  ASSERT_EQ(report.omega2.front(), 0);
  expect_near_all(report.omega2, omega2, 1e-11, "shaft");
  EXPECT_EQ(report.unstable, 0);
}

TEST(Modes, OfTwoFreeBodiesHaveTheReducedMass) {
  auto model = std::make_shared<Model>();
  model->add_body("a", {.mass = 2, .inertia = 0.3, .position = {0, 0}});
  model->add_body("b", {.mass = 3, .inertia = 0.4, .position = {1, 0}});
  model->add_force("", spring({0, 0}, {0, 0}, 100, 1), 0, 1);
  const ModesReport report = modes_of(model);
  ASSERT_TRUE(report.ok());
  // Five motions that nothing resists, and the stretching.
  ASSERT_EQ(report.omega2.size(), 6u);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(report.omega2[static_cast<std::size_t>(k)], 0) << k;
  EXPECT_NEAR(report.omega2[5], 100 * (1 / 2.0 + 1 / 3.0), 1e-9);
}

TEST(Modes, OfNothingButFreeBodiesAreZero) {
  auto model = std::make_shared<Model>();
  model->add_body("a", {.mass = 2, .inertia = 0.3});
  const ModesReport report = modes_of(model);
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.omega2, (std::vector<double>{0, 0, 0}));
}

TEST(Modes, OfTheInvertedPendulumGrowOrSwing) {
  for (const double weight : {0.2, 0.9, 1.1, 5.0}) {
    const ModesReport report = modes_of(inverted_pendulum(weight));
    ASSERT_TRUE(report.ok()) << report.message;
    ASSERT_EQ(report.omega2.size(), 1u);
    // (k - m g l) / (m l^2)
    EXPECT_NEAR(report.omega2[0], (1 - weight) / (weight / earth), 1e-11 * earth / weight);
    EXPECT_NEAR(report.omega[0], std::sqrt(std::abs(report.omega2[0])), 1e-14 * report.omega[0]);
    EXPECT_EQ(report.unstable, weight > 1 ? 1 : 0);
    EXPECT_EQ(report.warnings.empty(), weight < 1);
  }
}

TEST(Modes, OfACompoundPendulumHungOffItsCentroid) {
  auto model = std::make_shared<Model>();
  model->gravity = {3, -4};  // hangs along (0.6, -0.8)
  const double d = 0.35, inertia = 0.2, mass = 1.7;
  model->add_body("plate", {.mass = mass, .inertia = inertia, .position = {1 + 0.6 * d, 2 - 0.8 * d}, .angle = 0.4});
  const double c = std::cos(0.4), s = std::sin(0.4);
  const Vec2<double> arm{-0.6 * d, 0.8 * d};
  model->add("", Revolute<double>{.s_i = {1, 2}, .s_j = {c * arm.x + s * arm.y, -s * arm.x + c * arm.y}}, ground, 0);
  const ModesReport report = modes_of(model);
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
  EXPECT_NEAR(report.omega2.at(0), mass * 5 * d / (inertia + mass * d * d), 1e-12);
}

TEST(Modes, OfEqualPendulumsAreAllThere) {
  // 1.5 g / l, as often as there are pendulums: one start vector sees only one of them.
  for (const int count : {7, 350}) {
    const ModesReport report = modes_of(equal_pendulums(count), 5);
    ASSERT_TRUE(report.ok()) << report.message;
    expect_near_all(report.omega2, std::vector<double>(5, 1.5 * earth), 1e-12, std::to_string(count));
  }
}

TEST(Modes, FindEqualModesBelowOthers) {
  // Three slow pendulums among 400: found as three, though a single start vector shows one.
  auto model = equal_pendulums(400);
  for (int k = 0; k < 3; ++k) {
    model->add_body("slow" + std::to_string(k), {.mass = 1, .inertia = 1, .position = {0, -10.0}});
    model->add("", Revolute<double>{.s_i = {0, 0}, .s_j = {0, 10}}, ground, 400 + k);
  }
  const ModesReport report = modes_of(model, 4);
  ASSERT_TRUE(report.ok()) << report.message;
  const double slow = earth * 10 / 101;
  expect_near_all(report.omega2, {slow, slow, slow, 1.5 * earth}, 1e-12, "slow");
}

TEST(Modes, OfAStandingChainAreThoseOfAHangingOneNegated) {
  const int count = size_of_test(400, 100);
  const ModesReport hanging = modes_of(vertical_chain(count, -1), count);
  ASSERT_TRUE(hanging.ok()) << hanging.message;
  const ModesReport standing = modes_of(vertical_chain(count, 1), 6);
  ASSERT_TRUE(standing.ok()) << standing.message;
  EXPECT_EQ(standing.unstable, count);
  for (std::size_t k = 0; k < 6; ++k) {
    const double wanted = -hanging.omega2[static_cast<std::size_t>(count) - 1 - k];
    EXPECT_NEAR(standing.omega2[k], wanted, -1e-9 * wanted) << k;
  }
}

TEST(Modes, FindFewUnstableOnesInALargeScene) {
  const int links = size_of_test(500, 120);
  auto model = vertical_chain(links, -1);
  for (int k = 0; k < 2; ++k) {
    model->add_body("up" + std::to_string(k), {.mass = 1, .inertia = 0, .position = {5, 1.0}});
    model->add("", Revolute<double>{.s_i = {5, 0}, .s_j = {0, -1}}, ground, links + k);
    if (k == 1) model->add_force("", torsion_spring(5, 0), ground, links + 1);
  }
  const ModesReport report = modes_of(model, 5);
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.unstable, 2);
  EXPECT_NEAR(report.omega2[0], -earth, 1e-9);
  EXPECT_NEAR(report.omega2[1], 5 - earth, 1e-9);
  const ModesReport hanging = modes_of(vertical_chain(links, -1), 3);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(report.omega2[k + 2], hanging.omega2[k], 1e-9 * hanging.omega2[k]);
}

TEST(Modes, OfSpringsOverTwelveOrdersOfMagnitude) {
  // Masses on springs of 1 ... 1e12 N/m, each to the ground: omega2 = k / m.
  auto model = std::make_shared<Model>();
  std::vector<double> wanted;
  for (int k = 0; k <= 12; ++k) {
    model->add_body("m" + std::to_string(k), {.mass = 2, .position = {1.0 + k, 0}, .particle = true});
    model->add("", AbsoluteY<double>{}, k, ground, 0.0);
    model->add_force("", spring({0, 0}, {k + 0.5, 0}, std::pow(10.0, k), 0.5), k, ground);
    wanted.push_back(0.5 * std::pow(10.0, k));
  }
  expect_near_all(modes_of(model, 13).omega2, wanted, 1e-10, "springs");
}

TEST(Modes, AboutTheEquilibriumThatWasFound) {
  const auto reference = reference_values("parallelogram_diagonal_spring").at("eq1");
  auto model = sprung_parallelogram(-1.9);
  Equilibrium equilibrium(model);
  ASSERT_TRUE(equilibrium.solve().ok());
  Modes modes(model);
  modes.start_from(equilibrium.state());
  const ModesReport report = modes.run();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
  ASSERT_EQ(report.omega.size(), 1u);
  EXPECT_NEAR(report.omega[0], reference.at("omega_or_rate").get<double>(), 1e-10);
  // Elsewhere nothing is in balance, and that is said.
  const ModesReport elsewhere = modes_of(model);
  ASSERT_FALSE(elsewhere.warnings.empty());
  EXPECT_NE(elsewhere.warnings.front().find("no equilibrium"), std::string::npos);
}

TEST(Modes, OfRandomMechanismsAreThoseOfDenseAlgebra) {
  const unsigned last = size_of_test(400u, 120u);
  unsigned compared = 0;
  for (unsigned seed = 1; seed <= last; ++seed) {
    RandomStatics random(seed);
    const std::shared_ptr<Model> model = seed % 2 ? random.network() : random.linkage();
    Equilibrium equilibrium(model);
    if (!equilibrium.solve().ok()) continue;
    Modes modes(model, {}, {.count = 1000});
    modes.start_from(equilibrium.state());
    const ModesReport report = modes.run();
    ASSERT_TRUE(report.ok()) << seed << ": " << report.message;
    const std::vector<double> wanted = dense_omega2(modes.evaluator(), modes.q());
    ASSERT_EQ(report.omega2.size(), wanted.size()) << seed;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      EXPECT_NEAR(report.omega2[k], wanted[k], 1e-9 * std::abs(wanted[k]) + 1e-12 * wanted.back()) << seed << " " << k;
    }
    ++compared;
  }
  EXPECT_GT(compared, last * 19 / 20);
}

TEST(Modes, DoNotMindRedundantJoints) {
  auto model = vertical_chain(4, -1);
  model->add("again", Revolute<double>{.s_i = {0.5, 0}, .s_j = {-0.5, 0}}, 1, 2);
  model->add("once more", AbsoluteX<double>{.s_i = {-0.5, 0}}, 0, ground, 0.0);
  const std::vector<double> wanted = modes_of(vertical_chain(4, -1)).omega2;
  expect_near_all(modes_of(model).omega2, wanted, 1e-9, "redundant");
}

TEST(Modes, MeetMasslessBodiesThatMassDetermines) {
  // A pendulum of a massless rod and a mass without inertia, pinned to it at two points.
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  model->add_body("rod", {.mass = 0, .inertia = 0, .position = {0, -1}});
  model->add_body("bob", {.mass = 3, .inertia = 0, .position = {0, -2}});
  model->add("", Revolute<double>{.s_i = {0, 0}, .s_j = {0, 1}}, ground, 0);
  model->add("", Revolute<double>{.s_i = {0, -1}, .s_j = {0, 0}}, 0, 1);
  model->add("", RelativeAngle<double>{}, 0, 1, 0.0);
  const ModesReport report = modes_of(model);
  ASSERT_TRUE(report.ok()) << report.message;
  ASSERT_EQ(report.omega2.size(), 1u);
  EXPECT_NEAR(report.omega2[0], earth / 2, 1e-12);
}

TEST(Modes, RefuseWhatHasNoMassAtAll) {
  auto model = hanging_masses(2);
  model->add_body("ghost", {.mass = 0, .inertia = 1, .position = {3, 0}});
  model->add_force("", spring({0, 0}, {0, 0}, 10, 1), 0, 2);
  const ModesReport report = modes_of(model);
  EXPECT_EQ(report.status, Status::refused);
  EXPECT_NE(report.message.find("ghost"), std::string::npos) << report.message;
  auto untold = hanging_masses(2);
  untold->add_body("plate", {.mass = 1});
  const ModesReport missing = modes_of(untold);
  EXPECT_EQ(missing.status, Status::refused);
  EXPECT_NE(missing.message.find("plate"), std::string::npos) << missing.message;
}

TEST(Modes, AreNoMoreThanDegreesOfFreedom) {
  const ModesReport report = modes_of(vertical_chain(3, -1), 8);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report.omega2.size(), 3u);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0], "3 degrees of freedom: 3 modes instead of 8");
  auto held = std::make_shared<Model>();
  held->add_body("block", {.mass = 1, .inertia = 1});
  held->add("", Revolute<double>{}, ground, 0);
  held->add("", AbsoluteAngle<double>{}, 0, ground, 0.0);
  const ModesReport none = modes_of(held);
  ASSERT_TRUE(none.ok()) << none.message;
  EXPECT_TRUE(none.omega2.empty());
  EXPECT_EQ(none.warnings.size(), 1u);
}

TEST(Modes, HaveShapesOrthogonalInTheMassMetric) {
  const ModesReport report = modes_of(vertical_chain(30, -1), 30);
  for (std::size_t a = 0; a < 30; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      double sum = 0;
      for (std::size_t c = 0; c < 90; ++c)
        sum += (c % 3 == 2 ? 1 / 12.0 : 1) * report.shapes[a][c] * report.shapes[b][c];
      EXPECT_NEAR(sum, a == b, 1e-10) << a << " " << b;
    }
  }
  // The lowest: every rod leans to the same side, the last ones most.
  EXPECT_GT(report.shapes[0][2], 0);
  EXPECT_GT(report.shapes[0][89], report.shapes[0][2]);
}

TEST(Modes, SayThatDampingAndVelocitiesAreLeftOut) {
  auto model = spring_mass_chain(2, true);
  SpringDamper<double> damper = spring({0, 0}, {0, 0}, 0, 1);
  damper.c = 4;
  model->add_force("", damper, 0, 1);
  Modes modes(model);
  SystemState state;
  state.q = modes.state().q;
  state.qd.assign(state.q.size(), 0.1);
  modes.start_from(state);
  const ModesReport report = modes.run();
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report.warnings.size(), 2u);
  EXPECT_NEAR(report.omega2[0], 200 / 1.5, 1e-9);
}

TEST(Modes, CostOneSymbolicAnalysisAndThreeFactorizations) {
  // Multipliers, shifted stiffness, proof by inertia; complete spectra need no proof.
  const ModesReport large = modes_of(vertical_chain(2000, -1), 10);
  ASSERT_TRUE(large.ok()) << large.message;
  EXPECT_EQ(large.counters.symbolic, 1);
  EXPECT_EQ(large.counters.factorizations, 3);
  EXPECT_LT(large.counters.solves, 200);
  // Dense ones factor for the multipliers alone.
  const ModesReport small = modes_of(vertical_chain(20, -1));
  EXPECT_EQ(small.counters.symbolic, 1);
  EXPECT_EQ(small.counters.factorizations, 1);
}

TEST(Modes, StopWhenAsked) {
  Modes modes(vertical_chain(size_of_test(500, 100), -1), {}, {.count = 10});
  const ModesReport report = modes.run([] { return false; });
  EXPECT_EQ(report.status, Status::cancelled);
}

TEST(Modes, OfDenseAlgebraStopBetweenAnyTwoDecompositions) {
  int calls = 0;
  Modes whole(vertical_chain(20, -1), {}, {.count = 10});
  ASSERT_TRUE(whole.run([&] { return ++calls > 0; }).ok());
  EXPECT_GE(calls, 5);
  for (int last = 1; last <= calls; ++last) {
    Modes modes(vertical_chain(20, -1), {}, {.count = 10});
    int call = 0;
    EXPECT_EQ(modes.run([&] { return ++call < last; }).status, Status::cancelled) << last << " of " << calls;
  }
}

}  // namespace
}  // namespace catena
