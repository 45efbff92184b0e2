// Modes of more than five hundred freedoms with equal frequencies and free motions, against closed forms: discs on
// fixed axles with torsion springs between neighbours in a ring, a grid and a row, K the Laplacian of that graph.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "catena/analysis/stability/modes.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using testing::torsion_spring;
constexpr double pi = std::numbers::pi;

/// Discs of 0.1 kg m^2; springs of 40 N m/rad are added to it.
std::shared_ptr<Model> discs(int count) {
  auto model = std::make_shared<Model>();
  for (int k = 0; k < count; ++k) {
    model->add_body("disc" + std::to_string(k), {.mass = 1, .inertia = 0.1, .position = {0.2 * k, 0}});
    model->add("", Revolute<double>{.s_i = {0.2 * k, 0}, .s_j = {0, 0}}, ground, k);
  }
  return model;
}

void expect_lowest(const std::shared_ptr<Model>& model, std::vector<double> parts, int count) {
  std::sort(parts.begin(), parts.end());
  Modes modes(model, {}, {.count = count});
  const ModesReport report = modes.run();
  ASSERT_TRUE(report.ok()) << report.message;
  ASSERT_EQ(report.omega2.size(), static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < report.omega2.size(); ++k) {
    const double wanted = 1600 * parts[k];
    EXPECT_NEAR(report.omega2[k], wanted, 1e-9 * wanted) << k;
    EXPECT_EQ(report.omega2[k] == 0, wanted == 0) << k;
  }
  EXPECT_EQ(report.unstable, 0);
}

double part(int j, int n) { return j == 0 ? 0 : std::pow(std::sin(pi * j / n), 2); }

TEST(ModesOfManyDiscs, InARing) {
  const int n = 700;
  auto model = discs(n);
  std::vector<double> parts;
  for (int k = 0; k < n; ++k) {
    model->add_force("", torsion_spring(40, 0), k, (k + 1) % n);
    parts.push_back(part(k, n));
  }
  expect_lowest(model, parts, 12);
}

TEST(ModesOfManyDiscs, InAGrid) {
  const int n = 25;
  auto model = discs(n * n);
  std::vector<double> parts;
  for (int k = 0; k < n * n; ++k) {
    if (k % n + 1 < n) model->add_force("", torsion_spring(40, 0), k, k + 1);
    if (k / n + 1 < n) model->add_force("", torsion_spring(40, 0), k, k + n);
    parts.push_back(part(k % n, 2 * n) + part(k / n, 2 * n));
  }
  expect_lowest(model, parts, 20);
}

TEST(ModesOfManyDiscs, InSeveralEqualRows) {
  // Four rows of 600: every frequency four times, zero as well.
  const int n = 600, rows = 4;
  auto model = discs(n * rows);
  std::vector<double> parts;
  for (int k = 0; k < n * rows; ++k) {
    if (k % n + 1 < n) model->add_force("", torsion_spring(40, 0), k, k + 1);
    parts.push_back(part(k % n, 2 * n));
  }
  expect_lowest(model, parts, 14);
}

}  // namespace
}  // namespace catena
