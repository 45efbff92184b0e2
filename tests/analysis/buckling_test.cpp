// Buckling loads against closed forms: columns of rods and torsion springs, the inverted pendulum, and what is refused.
#include "catena/analysis/stability/buckling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using namespace testing;

BucklingReport buckle(const ModelAt& model_at, double present, int count) {
  Buckling buckling(model_at(present), model_at, {.present = present, .count = count});
  return buckling.run();
}

// N rods of 0.2 m along x between a pin and a slide, springs of 3 N m/rad at the joints, pressed by the load.
std::shared_ptr<Model> column(int count, double load) {
  auto model = std::make_shared<Model>();
  const double l = 0.2;
  for (int k = 0; k < count; ++k) {
    model->add_body("rod" + std::to_string(k), {.mass = 1, .inertia = 1, .position = {(k + 0.5) * l, 0}});
    model->add("", Revolute<double>{.s_i = {k == 0 ? 0 : l / 2, 0}, .s_j = {-l / 2, 0}}, k - 1, k);
    if (k > 0) model->add_force("", torsion_spring(3, 0), k - 1, k);
  }
  model->add("", AbsoluteY<double>{.s_i = {l / 2, 0}}, count - 1, ground, 0.0);
  model->add_force("", PointForce<double>{.s_i = {l / 2, 0}}, count - 1, ground, {-load, 0.0});
  return model;
}

double euler_load(int j, int count) { return 4 * 3 / 0.2 * std::pow(std::sin(j * std::numbers::pi / 2 / count), 2); }

TEST(Buckling, OfADiscreteColumnPinnedAtBothEnds) {
  for (const int count : {2, 5, 40, 600}) {
    const int wanted = std::min(count - 1, 6);
    const BucklingReport report = buckle([&](double load) { return column(count, load); }, 0, wanted);
    ASSERT_TRUE(report.ok()) << report.message;
    ASSERT_EQ(report.loads.size(), static_cast<std::size_t>(wanted));
    EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
    for (int j = 1; j <= wanted; ++j) {
      EXPECT_NEAR(report.loads[static_cast<std::size_t>(j - 1)], euler_load(j, count), 1e-9 * euler_load(j, count))
          << count << " " << j;
    }
    EXPECT_EQ(report.counters.symbolic, 1);
    // Multipliers at the first steps, and at the sides of every load that is confirmed.
    EXPECT_LE(report.counters.factorizations, count > 500 ? 8 : 30);
  }
}

TEST(Buckling, StartsFromAnyStableLoad) {
  // Already pressed, or pulled: the same loads, the nearest first.
  for (const double present : {3.0, -50.0}) {
    const BucklingReport report = buckle([](double load) { return column(5, load); }, present, 2);
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_NEAR(report.loads.at(0), euler_load(1, 5), 1e-9);
    EXPECT_NEAR(report.loads.at(1), euler_load(2, 5), 1e-9);
  }
  const BucklingReport beyond = buckle([](double load) { return column(5, load); }, 10, 2);
  EXPECT_EQ(beyond.status, Status::refused);
  EXPECT_NE(beyond.message.find("not stable"), std::string::npos) << beyond.message;
}

TEST(Buckling, HasTheShapeOfASine) {
  const int count = 10;
  const BucklingReport report = buckle([](double load) { return column(count, load); }, 0, 1);
  ASSERT_EQ(report.shapes.size(), 1u);
  // Angles of the rods go as the cosine at their middles; the largest is 1.
  for (int k = 0; k < count; ++k) {
    const double wanted = std::cos((k + 0.5) * std::numbers::pi / count) / std::cos(0.5 * std::numbers::pi / count);
    EXPECT_NEAR(std::abs(report.shapes[0][static_cast<std::size_t>(3 * k + 2)]), std::abs(wanted), 1e-9);
  }
}

TEST(Buckling, OfTheInvertedPendulumIsThePitchfork) {
  const BucklingReport report = buckle([](double weight) { return inverted_pendulum(weight); }, 0.3, 1);
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_NEAR(report.loads.at(0), 1, 1e-12);
}

TEST(Buckling, IteratesWhatDoesNotEnterLinearly) {
  // The length of the standing rod: m g l = k at l = 1 / (2 * 9.81), though K holds l in products of its own.
  const auto model_at = [](double cube) {
    auto model = std::make_shared<Model>();
    model->gravity = {0, -earth};
    model->add_body("bar", {.mass = std::cbrt(cube), .inertia = 1, .position = {0, 1}});
    model->add("", Revolute<double>{.s_i = {0, 0}, .s_j = {0, -1}}, ground, 0);
    model->add_force("", torsion_spring(40, 0), ground, 0);
    return model;
  };
  const BucklingReport report = buckle(model_at, 1, 1);
  ASSERT_TRUE(report.ok()) << report.message;
  const double wanted = std::pow(40 / earth, 3);
  EXPECT_NEAR(report.loads.at(0), wanted, 1e-9 * wanted);
}

TEST(Buckling, FindsLoadsOfAnySize) {
  // Stiff columns in millinewtons: loads of 1e13.
  const auto model_at = [](double load) { return inverted_pendulum(1e-13 * load); };
  const BucklingReport report = buckle(model_at, 0, 1);
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_NEAR(report.loads.at(0), 1e13, 1e3);
}

TEST(Buckling, SaysWhenTheLoadMovesTheEquilibrium) {
  // A side force bends the pendulum before it falls.
  const auto model_at = [](double load) {
    auto model = inverted_pendulum(0.5);
    model->add_force("", PointForce<double>{}, 0, ground, {0.01 * load, -load});
    return model;
  };
  const BucklingReport report = buckle(model_at, 0, 1);
  ASSERT_TRUE(report.ok()) << report.message;
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("moves the equilibrium"), std::string::npos) << report.warnings[0];
  // In place, the weight and the load take what the spring gives: 1 - 0.5 - P.
  EXPECT_NEAR(report.loads.at(0), 0.5, 1e-9);
}

TEST(Buckling, SaysThatAParameterDoesNothing) {
  const BucklingReport report = buckle([](double) { return column(3, 1); }, 0, 2);
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.loads.empty());
  ASSERT_EQ(report.warnings.size(), 1u);
  const BucklingReport moved = buckle(
      [](double x) {
        auto model = column(3, 1);
        model->add("", AbsoluteDistance<double>{.ground = {-1, 0}}, 0, ground, 1.1 + x);
        return model;
      },
      0, 1);
  EXPECT_EQ(moved.status, Status::refused);
  EXPECT_NE(moved.message.find("moves constraints"), std::string::npos) << moved.message;
}

}  // namespace
}  // namespace catena
