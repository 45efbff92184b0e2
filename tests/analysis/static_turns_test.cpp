// Whole turns that a static search has made: taken back where nothing counts them, and nothing else is changed.
#include "catena/analysis/balance/static_turns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using namespace testing;

constexpr double turn = 2 * std::numbers::pi;

/// Ties bodies i and j, i may be the ground, by something that counts their turns, or not.
void tie(Model& model, int what, int i, int j, bool counts) {
  if (!counts) {
    if (what % 2 == 0) {
      model.add("", Revolute<double>{.s_i = {1, 0}, .s_j = {-1, 0}}, i, j);
    } else {
      model.add("", Coupler<double>{.s_i = {1, 0}, .s_j = {-1, 0.5}}, i, j, 1.5);
    }
    return;
  }
  switch (what % 6) {
    case 0:
      model.add("", RelativeAngle<double>{}, i, j, 0.3);
      return;
    case 1:
      model.add("", Weld<double>{.s_i = {1, 0}, .s_j = {-1, 0}}, i, j);
      return;
    case 2:
      model.add("", Gear<double>{.radius_i = 0.4, .radius_j = 1.1}, i, j);
      return;
    case 3:
      model.add("", Belt<double>{.radius_i = 0.4, .radius_j = 1.1}, i, j);
      return;
    case 4:
      model.add_force("", torsion_spring(3, 0.2), i, j);
      return;
    default:
      model.add("", RackPinion<double>{.axis_i = {1, 0}, .radius = 0.7}, i, j);
  }
}

/// A row of bodies, `group` says which of them are tied so that turns count; group 0 is tied to the ground.
struct Row {
  std::shared_ptr<Model> model = std::make_shared<Model>();
  std::vector<int> group;
  std::vector<double> turns;  // by body, what a search has added
};

Row random_row(unsigned seed) {
  std::mt19937 random(seed);
  Row row;
  const int count = 2 + static_cast<int>(random() % 8);
  int group = static_cast<int>(random() % 2);
  for (int b = 0; b < count; ++b) {
    row.model->add_body("b" + std::to_string(b), {.mass = 1,
                                                  .inertia = 1,
                                                  .position = {3.0 * (b + 1), 0.1 * (random() % 10)},
                                                  .angle = (random() % 600) / 100.0 - 3});
    const bool counts = b == 0 ? group == 0 : random() % 2 == 0;
    if (b > 0 && !counts) ++group;
    row.group.push_back(group);
    // Bodies of one group have made the same turns; what the ground counts has wound up and may be anything.
    const bool first = b == 0 || !counts;
    row.turns.push_back(first || group == 0 ? static_cast<int>(random() % 9) - 4 : row.turns.back());
    tie(*row.model, static_cast<int>(random() % 60), b - 1, b, counts);
  }
  return row;
}

TEST(StaticTurns, AreTakenBackTogetherAndChangeNothing) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    const Row row = random_row(seed);
    EvaluationWork work;
    Evaluator evaluator(Plan::make(*row.model), *row.model, work);
    StaticSystem system(evaluator);
    const Plan& plan = system.plan();
    std::mt19937 random(seed);
    std::vector<double> start = evaluator.given_configuration(), q = start;
    for (int p = 0; p < plan.moving; ++p) {
      const int body = plan.model_body[at(p)];
      q[at(3 * p)] += (random() % 100) / 1000.0;
      q[at(3 * p + 2)] += (random() % 600) / 100.0 - 3 + turn * row.turns[at(body)];
    }
    system.move_to(q);
    const std::vector<double> phi(system.phi().begin(), system.phi().end()), before = q;
    const double energy = system.energy();
    drop_whole_turns(system, start, q);
    std::vector<double> taken(row.group.size());
    for (int p = 0; p < plan.moving; ++p) {
      EXPECT_EQ(q[at(3 * p)], before[at(3 * p)]);
      EXPECT_EQ(q[at(3 * p + 1)], before[at(3 * p + 1)]);
      const double turns = (before[at(3 * p + 2)] - q[at(3 * p + 2)]) / turn;
      EXPECT_NEAR(turns, std::round(turns), 1e-12) << seed;
      taken[at(plan.model_body[at(p)])] = std::round(turns);
    }
    for (std::size_t b = 0; b < taken.size(); ++b) {
      if (row.group[b] == 0) {
        EXPECT_EQ(taken[b], 0) << seed;
      } else if (b == 0 || row.group[b] != row.group[b - 1]) {
        // Alone in its group the body ends within half a turn of the start; with others the first of them in the plan.
        const bool alone = b + 1 == taken.size() || row.group[b + 1] != row.group[b];
        if (alone) {
          EXPECT_EQ(taken[b], row.turns[b]) << seed;
        }
      } else {
        EXPECT_EQ(taken[b], taken[b - 1]) << seed;
      }
    }
    // The system is there, and what it holds is what it held.
    for (std::size_t r = 0; r < phi.size(); ++r) EXPECT_NEAR(system.phi()[r], phi[r], 1e-9) << seed;
    EXPECT_NEAR(system.energy(), energy, 1e-8 * (1 + std::abs(energy))) << seed;
  }
}

TEST(StaticTurns, AnglesWithinHalfATurnStay) {
  const Row row = random_row(5);
  EvaluationWork work;
  Evaluator evaluator(Plan::make(*row.model), *row.model, work);
  StaticSystem system(evaluator);
  const std::vector<double> start = evaluator.given_configuration();
  std::vector<double> q = start;
  for (std::size_t k = 2; k < q.size(); k += 3) q[k] += k % 2 ? 3.1 : -3.1;
  const std::vector<double> before = q;
  drop_whole_turns(system, start, q);
  EXPECT_EQ(q, before);
}

// Whatever finds an equilibrium, and from wherever it starts: no angle is more than half a turn away.
TEST(StaticTurns, AnswersOfAllSolversHaveNone) {
  const StaticSolver solvers[] = {StaticSolver::automatic, StaticSolver::newton, StaticSolver::ipopt};
  for (const StaticSolver solver : solvers) {
    if (solver == StaticSolver::ipopt && !ipopt_is_built_in()) continue;
    for (const double lean : {0.1, 1.5, 3.0}) {
      auto model = std::make_shared<Model>();
      model->gravity = {0, -earth};
      // Links that stand on each other, leaning: they fall over, and search steps turn them round.
      Vec2<double> foot{};
      for (int k = 0; k < 6; ++k) {
        const double angle = std::numbers::pi / 2 + (k % 2 ? lean : -lean);
        const Vec2<double> half{0.5 * std::cos(angle), 0.5 * std::sin(angle)};
        model->add_body("link" + std::to_string(k),
                        {.mass = 1, .inertia = 0.1, .position = foot + half, .angle = angle});
        model->add("", Revolute<double>{.s_i = {k == 0 ? 0 : 0.5, 0}, .s_j = {-0.5, 0}}, k - 1, k);
        foot += 2 * half;
      }
      Equilibrium analysis(model, {}, {.solver = solver});
      const EquilibriumReport report = analysis.solve();
      ASSERT_TRUE(report.ok()) << report.message;
      const SystemState state = analysis.state();
      for (std::size_t k = 0; k < model->bodies.size(); ++k) {
        const double angle = state.q[3 * k + 2];
        EXPECT_LE(std::abs(angle - model->bodies[k].angle), std::numbers::pi * (1 + 1e-9)) << k << " " << lean;
        EXPECT_NEAR(std::remainder(angle + std::numbers::pi / 2, turn), 0, 1e-6) << k << " " << lean;
      }
    }
  }
}

}  // namespace
}  // namespace catena
