// The tangent of the equations of rest: against differences of forces and constraints at random places, with any rows,
// transposed, with compliance; and the symmetric one, of forces with a potential, against the same.
#include "catena/assembly/systems/tangent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "assembly/built_scene.hpp"
#include "catena/assembly/systems/kkt_matrix.hpp"

namespace catena::testing {
namespace {

// A particle, a body that does not move, laws that read bodies on which they do not act, one of them twice.
constexpr const char* mechanism = R"--({"catena": 1, "gravity": [0, -9],
  "bodies": {"a": {"mass": 1, "inertia": 1, "position": [0.2, 0.1], "points": {"tip": [0.4, 0.3]}},
             "b": {"mass": 2, "inertia": 1, "position": [1.3, 0.4], "angle": 0.3, "centroid": [0.1, 0.2]},
             "c": {"mass": 2, "particle": true, "position": [2, -1]}, "wall": {"fixed": true, "position": [5, 5]},
             "d": {"mass": 1, "inertia": 1, "position": [3, 1]}},
  "constraints": [{"type": "slot", "i": "a", "j": "b", "axis_i": [1, 2]},
                  {"type": "revolute", "i": "a.tip", "j": "b"},
                  {"type": "coupler", "i": "b", "j": "c", "length": 2},
                  {"type": "relative_distance", "i": ["wall", [0.1, 0.2]], "j": ["d", [0.3, -0.1]], "value": 3}],
  "forces": [
    {"type": "spring_damper", "i": "a.tip", "j": ["d", [0.1, 0.7]], "k": 3, "c": 0.4, "length": 0.3},
    {"type": "spring_damper", "i": "c", "j": "d", "k": 5, "length": 0.6},
    {"type": "torsion_spring", "i": "ground", "j": "a", "k": 2, "angle": 0.1},
    {"type": "point_force", "i": "a.tip", "force": [1.5, -0.5]}WITHOUT_ENERGY]})--";
constexpr const char* without_energy = R"--(,
    {"type": "point_force", "i": "d", "frame": "body", "force": [0.7, 0.4]},
    {"type": "torque", "i": "b", "j": "a", "torque": "=0.3*d.angle*c.x - a.angle^2"},
    {"type": "point_force", "i": "a.tip", "force": ["=c.x*d.y + sin(t)", "=b.y^2 - a.tip.x*d.x"]})--";

class TangentTest : public ::testing::Test {
 protected:
  void build(const char* added) {
    std::string text = mechanism;
    text.replace(text.find("WITHOUT_ENERGY"), 14, added);
    evaluator = testing::evaluator_of(text, model, work);
    ASSERT_TRUE(evaluator);
    columns = static_cast<std::size_t>(evaluator->plan().columns);
    rows = static_cast<std::size_t>(evaluator->plan().rows);
  }
  void draw() {
    q = evaluator->given_configuration();
    for (const int c : evaluator->plan().coordinate) q[static_cast<std::size_t>(c)] += 0.3 * random(engine);
    lambda.assign(rows, 0.0);
    for (double& l : lambda) l = random(engine);
  }
  std::vector<double> jacobian() {
    std::vector<double> values(static_cast<std::size_t>(evaluator->plan().trash_slot()) + 1);
    evaluator->start_jacobian(values);
    evaluator->jacobian(values);
    values.pop_back();
    return values;
  }
  /// -Q + Phi_q^T lambda by columns, then Phi.
  std::vector<double> residual(const std::vector<double>& place) {
    const Plan& plan = evaluator->plan();
    evaluator->set_configuration(place);
    std::vector<double> Q(static_cast<std::size_t>(plan.coordinates())), rest(Q.size(), 0.0), r(columns), phi(rows);
    evaluator->applied_forces(rest, Q);
    for (std::size_t c = 0; c < columns; ++c) r[c] = -Q[static_cast<std::size_t>(plan.coordinate[c])];
    multiply_transposed_add(plan.jacobian, jacobian(), lambda, r);
    evaluator->phi(phi);
    r.insert(r.end(), phi.begin(), phi.end());
    return r;
  }
  /// Column after column: derivatives of the residual at q, where the evaluator is left.
  std::vector<std::vector<double>> differences() {
    std::vector<std::vector<double>> by;
    constexpr double h = 1e-5;
    for (const int c : evaluator->plan().coordinate) {
      std::vector<double> up = q, down = q;
      up[static_cast<std::size_t>(c)] += h;
      down[static_cast<std::size_t>(c)] -= h;
      by.push_back(residual(up));
      const std::vector<double> below = residual(down);
      for (std::size_t k = 0; k < below.size(); ++k) by.back()[k] = (by.back()[k] - below[k]) / (2 * h);
    }
    evaluator->set_configuration(q);
    return by;
  }

  Model model;
  EvaluationWork work;
  std::unique_ptr<Evaluator> evaluator;
  std::size_t columns = 0, rows = 0;
  std::mt19937 engine{5};
  std::uniform_real_distribution<double> random{-1, 1};
  std::vector<double> q, lambda;
};

TEST_F(TangentTest, IsTheDerivativeOfForcesAndConstraints) {
  ASSERT_NO_FATAL_FAILURE(build(without_energy));
  for (int trial = 0; trial < 20; ++trial) {
    draw();
    std::vector<int> chosen;
    for (int r = 0; r < static_cast<int>(rows); ++r) {
      if (random(engine) > -0.5) chosen.push_back(r);
    }
    Tangent tangent(evaluator->shared_plan(), SaddleBlock::elements);
    tangent.arrange(chosen, true);
    const std::vector<std::vector<double>> by = differences();
    for (const bool transposed : {false, true}) {
      tangent.begin(jacobian());
      tangent.add_stiffness(*evaluator, lambda, transposed);
      tangent.set_compliance(7);
      std::vector<double> x(columns + chosen.size()), y(x.size()), back(x.size()), top(columns);
      for (double& v : x) v = random(engine);
      tangent.multiply(x, y);
      tangent.multiply(x, back, true);
      tangent.multiply(std::span(x).first(columns), top);
      for (std::size_t i = 0; i < x.size(); ++i) {
        double expected = 0, of_transpose = 0, alone = 0;
        for (std::size_t j = 0; j < x.size(); ++j) {
          if (std::min(i, j) >= columns) continue;
          const auto row = [&](std::size_t k) { return columns + static_cast<std::size_t>(chosen[k - columns]); };
          const double a = i >= columns   ? by[j][row(i)]
                           : j >= columns ? by[i][row(j)]
                           : transposed   ? by[i][j]
                                          : by[j][i];
          const double b = i < columns && j < columns ? (transposed ? by[j][i] : by[i][j]) : a;
          expected += a * x[j];
          of_transpose += b * x[j];
          if (j < columns) alone += a * x[j];
        }
        EXPECT_NEAR(y[i], expected, 1e-6) << i;
        EXPECT_NEAR(back[i], of_transpose, 1e-6) << i;
        if (i < columns) {
          EXPECT_NEAR(top[i], alone, 1e-6) << i;
        }
      }
      const double sum = std::accumulate(tangent.values().begin(), tangent.values().end(), 0.0);
      tangent.set_compliance(0);
      EXPECT_NEAR(std::accumulate(tangent.values().begin(), tangent.values().end(), 0.0) - sum,
                  7 * static_cast<double>(chosen.size()), 1e-9);
    }
  }
}

TEST_F(TangentTest, IsTheSymmetricOneWhereForcesHaveAPotential) {
  ASSERT_NO_FATAL_FAILURE(build(""));
  for (int trial = 0; trial < 20; ++trial) {
    draw();
    evaluator->set_configuration(q);
    Tangent tangent(evaluator->shared_plan(), SaddleBlock::elements);
    tangent.arrange({});
    tangent.begin(jacobian());
    tangent.add_stiffness(*evaluator, lambda);
    KktMatrix symmetric(evaluator->shared_plan(), evaluator->attachment_radii());
    symmetric.set_hessian(*evaluator, lambda, Curvature::exact);
    symmetric.complete(jacobian(), 0);
    std::vector<double> x(columns), y(columns), other(columns);
    for (double& v : x) v = random(engine);
    tangent.multiply(x, y);
    symmetric.multiply_stiffness(x, other);
    for (std::size_t c = 0; c < columns; ++c) EXPECT_NEAR(y[c], other[c], 1e-12) << c;
  }
}

}  // namespace
}  // namespace catena::testing
