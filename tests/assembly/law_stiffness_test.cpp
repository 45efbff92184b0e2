// Stiffness of laws of state: -dQ/dq over all bodies against differences of the forces, and the derivatives of laws by
// velocities.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "assembly/built_scene.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena::testing {
namespace {

// Laws of every kind of input; one reads a spring whose force is a law itself, and a body that it does not act on.
constexpr const char* text = R"--({"catena": 1, "gravity": [0, -9],
  "tables": {"p": {"points": [[-9, 1], [-1, 2], [0.5, -1], [9, 4]]}},
  "bodies": {"a": {"mass": 1, "inertia": 1, "position": [0.2, 0.1], "points": {"tip": [0.4, 0.3]}},
             "b": {"mass": 2, "inertia": 1, "position": [1.3, 0.4], "angle": 0.3, "centroid": [0.1, 0.2]},
             "c": {"mass": 2, "particle": true, "position": [2, -1]}, "wall": {"fixed": true, "position": [5, 5]}},
  "constraints": [{"type": "slot", "name": "g", "i": "a", "j": "b", "axis_i": [1, 2]},
                  {"type": "revolute", "name": "r", "i": "a.tip", "j": "b"}],
  "forces": [
    {"type": "point_force", "i": "a.tip", "force": ["=p(c.x)*a.tip.vy + sin(t)", "=b.y^2 - wall.x*a.tip.x*r.omega"]},
    {"type": "point_force", "i": "b", "frame": "body", "force": ["=g.slide*c.vy", "=g.slide_rate*r.angle"]},
    {"type": "spring_damper", "name": "s", "i": "a.tip", "j": "b", "k": 3, "c": 0.4, "length": 0.3,
     "force": "=b.omega*a.angle - c.y"},
    {"type": "torque", "i": "b", "j": "a", "torque": "=s.force*s.length - 0.3*s.rate*w.torque + w.angle"},
    {"type": "torsion_spring", "name": "w", "i": "ground", "j": "a", "k": 2, "c": 0.1, "angle": 0,
     "torque": "=0.2*b.vx*b.x"}]})--";

class LawStiffness : public ::testing::Test {
 protected:
  void SetUp() override {
    evaluator = testing::evaluator_of(text, model, work);
    ASSERT_TRUE(evaluator);
    n = static_cast<std::size_t>(evaluator->plan().coordinates());
    moving = static_cast<std::size_t>(3 * evaluator->plan().moving);
  }
  std::vector<double> forces(const std::vector<double>& q, const std::vector<double>& qd) {
    std::vector<double> Q(n);
    evaluator->set_configuration(q);
    evaluator->applied_forces(qd, Q);
    return Q;
  }

  Model model;
  EvaluationWork work;
  std::unique_ptr<Evaluator> evaluator;
  std::size_t n = 0, moving = 0;
};

TEST_F(LawStiffness, IsTheDerivativeOfTheForces) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> random(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> q = evaluator->given_configuration(), qd(n, 0.0);
    for (std::size_t c = 0; c < moving; ++c) {
      q[c] += 0.3 * random(engine);
      qd[c] = random(engine);
    }
    forces(q, qd);
    std::vector<double> stiffness(n * n, 0.0);
    evaluator->visit_stiffness(qd, [&](int i, int j, const ElementMatrix& m) {
      for (std::size_t row = 0; row < 6; ++row) {
        for (std::size_t c = 0; c < 6; ++c) {
          const auto of = [&](std::size_t k) { return static_cast<std::size_t>(3 * (k < 3 ? i : j)) + k % 3; };
          stiffness[of(row) * n + of(c)] += m[6 * row + c];
        }
      }
    });
    constexpr double h = 1e-5;
    for (std::size_t c = 0; c < moving; ++c) {
      std::vector<double> up = q, down = q;
      up[c] += h;
      down[c] -= h;
      const std::vector<double> above = forces(up, qd), below = forces(down, qd);
      for (std::size_t row = 0; row < moving; ++row)
        EXPECT_NEAR(stiffness[row * n + c], -(above[row] - below[row]) / (2 * h), 1e-7) << row << " by " << c;
    }
    evaluator->set_configuration(q);
    for (int law = 0; law < static_cast<int>(evaluator->laws().size()); ++law) {
      for (int body = 0; body < evaluator->plan().moving; ++body) {
        const std::array<double, 6> gradient = evaluator->law_gradient(law, body, qd);
        for (std::size_t k = 0; k < 3; ++k) {
          std::vector<double> up = qd, down = qd;
          up[static_cast<std::size_t>(3 * body) + k] += h;
          down[static_cast<std::size_t>(3 * body) + k] -= h;
          const double slope = (evaluator->law_value(law, up) - evaluator->law_value(law, down)) / (2 * h);
          EXPECT_NEAR(gradient[3 + k], slope, 1e-7) << law << " by " << body;
        }
      }
    }
  }
}

// What laws add to the forces of a spring has no potential; what they do is power from outside.
TEST_F(LawStiffness, LawsAreWorkAndNoEnergy) {
  EXPECT_FALSE(evaluator->conservative());
  std::vector<double> q = evaluator->given_configuration(), qd(n, 0.0), Q(n);
  for (std::size_t c = 0; c < moving; ++c) qd[c] = 0.1 * static_cast<double>(c) - 0.4;
  Q = forces(q, qd);
  double power = 0;
  for (std::size_t c = 0; c < moving; ++c) power += Q[c] * qd[c];
  constexpr double h = 1e-5;
  std::vector<double> up = q, down = q;
  for (std::size_t c = 0; c < moving; ++c) {
    up[c] += h * qd[c];
    down[c] -= h * qd[c];
  }
  evaluator->set_configuration(up);
  double rise = evaluator->potential_energy();
  evaluator->set_configuration(down);
  rise = (rise - evaluator->potential_energy()) / (2 * h);
  evaluator->set_configuration(q);
  EXPECT_NEAR(evaluator->load_power(qd), power + rise + evaluator->dissipation(qd), 1e-8);
}

}  // namespace
}  // namespace catena::testing
