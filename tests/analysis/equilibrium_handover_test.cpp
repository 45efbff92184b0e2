// What is done where Newton's full steps do not get there: on downhill, then Ipopt, then settling; the answer is
// polished and certified as any other.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/elements/all.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

double largest_residual(Equilibrium& analysis) {
  StaticSystem system(analysis.evaluator());
  system.move_to(analysis.q());
  std::vector<double> residual(static_cast<std::size_t>(analysis.plan().columns));
  system.residual(analysis.lambda(), residual);
  return system.force_norm(residual);
}

TEST(Handover, NewtonGoesOnDownhillToTheCoil) {
  // Fifty links thrown about, with springs between them that want to coil the chain up: full steps go back and forth.
  const int count = 50;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    auto model = testing::hanging_chain(count, testing::ChainStart::scattered, seed);
    for (int k = 1; k < count; ++k) model->add_force("", testing::torsion_spring(0.5, -3), k - 1, k);
    Equilibrium analysis(model, {}, {.solver = StaticSolver::newton});
    const EquilibriumReport report = analysis.solve();
    ASSERT_TRUE(report.ok()) << seed << ": " << report.message;
    EXPECT_TRUE(report.stable) << seed;
    EXPECT_LE(report.iterations, 150) << seed;
    EXPECT_LE(largest_residual(analysis), 1e-11 * analysis.evaluator().potential_energy()) << seed;
  }
}

TEST(Handover, NewtonGoesOnDownhillInALatticeOfSprings) {
  // A lattice of 20 by 20 particles on springs, laid out at 0.6 of its width: it crumples.
  const int side = 20;
  const double squeeze = 0.6;
  std::mt19937 random(1);
  const auto number = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  auto model = std::make_shared<Model>();
  model->gravity = {0, -testing::earth};
  const auto node = [](int x, int y) { return side * y + x; };
  for (int k = 0; k < side * side; ++k) {
    const int x = k % side, y = k / side;
    model->add_body("node" + std::to_string(k),
                    {.mass = 0.1, .inertia = 1e-3, .position = {squeeze * x + 0.05 * number(), y + 0.05 * number()}});
  }
  const auto tie = [&](int i, int j, double length) {
    model->add_force("", testing::spring({0, 0}, {0, 0}, 200, length), i, j);
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      if (x + 1 < side) tie(node(x, y), node(x + 1, y), 1);
      if (y + 1 < side) tie(node(x, y), node(x, y + 1), 1);
      if (x + 1 < side && y + 1 < side) tie(node(x, y), node(x + 1, y + 1), std::sqrt(2));
      model->add_force("", testing::torsion_spring(1, 0), ground, node(x, y));
    }
    model->add_force("", testing::spring({-1, 1.0 * y}, {0, 0}, 200, 1), ground, node(0, y));
    model->add_force("", testing::spring({squeeze * side, 1.0 * y}, {0, 0}, 200, 1), ground, node(side - 1, y));
  }
  Equilibrium analysis(model);
  const EquilibriumReport report = analysis.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.solver, "newton");
  EXPECT_TRUE(report.stable);
  EXPECT_LE(report.iterations, 200);
  EXPECT_LE(report.residual, 1e-10);
}

// A spring whose force saturates, strength x atan(x / reach), along x. Its energy is told in steps of `grain`, as from
// a coarse table: a search that follows the energy is misled.
struct Saturating {
  double strength, reach, grain;
  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    using std::atan2;
    const Vec2<T> pull{T(strength) * atan2((a.j.x - a.i.x) / T(reach), T(1.0)), T(0.0)};
    add_force_at(Vec2<T>{}, pull, on_i);
    add_force_at(Vec2<T>{}, -pull, on_j);
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    const double x = value_of(a.j.x - a.i.x) / reach;
    return T(grain * std::round(strength * reach * (x * std::atan(x) - 0.5 * std::log1p(x * x)) / grain));
  }
};

// Masses that such springs and a spring to the one before hold, each pulled by 1 N.
std::shared_ptr<Model> saturating_row(int count, double grain) {
  auto model = std::make_shared<Model>();
  for (int k = 0; k < count; ++k) {
    model->add_body("mass" + std::to_string(k), {.mass = 1, .inertia = 1, .position = {5 + 0.1 * k, 1.0 * k}});
    model->add("", AbsoluteAngle<double>{}, k, ground);
    model->add_force("", custom_force(Saturating{2, 0.5, grain}), k, ground);
    model->add_force("", testing::spring({0, 0}, {0, 0}, 1, 0.1), k, k == 0 ? ground : k - 1);
    model->add_force("", PointForce<double>{}, k, ground, {1, 0});
  }
  return model;
}

void expect_rest(Equilibrium& analysis, const EquilibriumReport& report) {
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.certified);
  EXPECT_TRUE(report.stable);
  EXPECT_LE(largest_residual(analysis), 1e-13);
  // The springs between neighbours pull along y alone, the first one is as long as it wants to be.
  const std::vector<double> q = analysis.state().q;
  for (std::size_t k = 3; k < q.size(); k += 3) {
    EXPECT_GT(q[k], 0) << k;
    EXPECT_LT(q[k], 0.5 * std::tan(0.5) + 1e-12) << k;
  }
}

TEST(Handover, IpoptTakesOver) {
  Equilibrium alone(saturating_row(2, 10), {}, {.solver = StaticSolver::newton});
  EXPECT_FALSE(alone.solve().ok());
  if (!ipopt_is_built_in()) GTEST_SKIP() << "built without Ipopt";
  Equilibrium analysis(saturating_row(2, 10));
  const EquilibriumReport report = analysis.solve();
  EXPECT_EQ(report.solver, "ipopt");
  expect_rest(analysis, report);
}

TEST(Handover, SettlingIsTheLastResort) {
  // No energy at all from this table: neither Newton nor Ipopt find the way.
  for (const StaticSolver solver : {StaticSolver::newton, StaticSolver::ipopt}) {
    if (solver == StaticSolver::ipopt && !ipopt_is_built_in()) continue;
    Equilibrium alone(saturating_row(5, 1e9), {}, {.solver = solver});
    EXPECT_FALSE(alone.solve().ok());
  }
  Equilibrium analysis(saturating_row(5, 1e9));
  const EquilibriumReport report = analysis.solve();
  EXPECT_EQ(report.solver, "settling");
  expect_rest(analysis, report);
}

}  // namespace
}  // namespace catena
