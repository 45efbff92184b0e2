// Equations as functions of plan, numbers and pose: the same bits from any thread and after any other evaluation, those
// of an evaluator, and the balance of energy along a motion through functions of time, laws, ropes and curves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "assembly/built_scene.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena::testing {
namespace {

/// A linkage that hangs on a rope, springs and laws of state, a cam with its foot and drivers, with numbers at random.
struct RandomScene {
  std::mt19937 random;
  Model model;
  EvaluationWork work;
  std::unique_ptr<Evaluator> evaluator;

  explicit RandomScene(unsigned seed) : random(seed) { evaluator = evaluator_of(text(), model, work); }

  double between(double low, double high) { return low + (high - low) * (random() / 4294967296.0); }
  std::string number(double low, double high) { return std::to_string(between(low, high)); }

  std::string text() {
    std::string scene = R"--({"catena": 1, "gravity": [G, -9], "bodies": {
      "a": {"mass": M, "inertia": 1, "position": [0.5, 0], "points": {"root": [-0.5, 0], "tip": [0.5, 0.1]}},
      "b": {"mass": M, "inertia": 1, "position": [1.4, 0.3], "angle": 0.3,
            "points": {"root": [-0.4, 0], "tip": [0.3, 0.2]}},
      "c": {"mass": M, "particle": true, "position": [2, -1]}, "cam": {"mass": M, "inertia": 1, "position": [4, 0]},
      "foot": {"mass": M, "inertia": 1, "position": [4, 0.9]}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "a.root"},
        {"type": "revolute", "i": "a.tip", "j": "b.root"}, {"type": "relative_distance", "i": "b.tip", "j": "foot"},
        {"type": "cam_flat", "i": "cam", "j": "foot", "axis_j": [1, 0],
         "curve": {"circle": {"centre": [0.1, G], "radius": 0.6}}}],
      "drivers": [{"type": "relative_angle", "i": "ground", "j": "a", "value": {"polynomial": [0.1, G, G]}},
        {"type": "absolute_x", "i": "c", "value": {"polynomial": [2, 0, G]}},
        {"type": "relative_distance", "i": "c", "j": "ground", "value": {"polynomial": [2.3, G]}}],
      "forces": [{"type": "spring_damper", "name": "s", "i": "a.tip", "j": "foot", "k": M, "c": 0.4, "length": 0.3,
         "force": "=b.omega*a.angle - c.y*t"},
        {"type": "spring_damper", "i": "b.tip", "j": "cam", "k": M, "c": 0.2, "length": 0.3,
         "force": {"polynomial": [1, G]}},
        {"type": "torque", "i": "b", "j": "a", "torque": "=s.force*s.length + sin(t)"},
        {"type": "point_force", "i": "a.tip", "force": ["=a.tip.vy + sin(t)", {"polynomial": [G, 2, -0.5]}]},
        {"type": "rope", "i": "a.tip", "over": [{"at": "b.tip", "radius": 0.05, "side": 1}], "j": "foot", "k": 30,
         "length": 0.5}]})--";
    for (std::size_t k; (k = scene.find_first_of("GM")) != std::string::npos;)
      scene.replace(k, 1, scene[k] == 'G' ? number(0.05, 0.5) : number(0.5, 9));
    return scene;
  }
};

/// A time, a place and velocities; about one in three has angles of whole turns.
struct Instant {
  double t;
  std::vector<double> q, qd;

  explicit Instant(RandomScene& scene) : t(scene.between(0, 2)), q(scene.evaluator->given_configuration()), qd(q) {
    const auto moving = static_cast<std::size_t>(3 * scene.evaluator->plan().moving);
    const double turns = scene.random() % 3 == 0 ? 6.283185307179586 * 4 : 0;
    for (std::size_t c = 0; c < moving; ++c) {
      q[c] += scene.between(-0.1, 0.1) + (c % 3 == 2 ? turns : 0);
      qd[c] = scene.between(-1, 1);
    }
    for (std::size_t c = moving; c < q.size(); ++c) qd[c] = 0;
  }
  /// Contacts are searched for from the given ones: the bits depend on where a search begins.
  void set(const Equations& equations, Pose& pose) const {
    pose.turns.clear();
    std::vector<double> rest = q;
    equations.take_turns(pose, rest);
    equations.set_time(pose, t);
    equations.go_to_given_curve_places(pose);
    equations.set_configuration(pose, rest);
  }
};

void append(std::vector<double>& numbers, const auto& more) {
  numbers.insert(numbers.end(), std::begin(more), std::end(more));
}

struct Loads {
  std::vector<double> laws, Q;
  double power, loss;

  Loads(const Equations& e, const Pose& pose, const std::vector<double>& qd) : laws(e.laws().size()), Q(qd.size()) {
    e.law_values(pose, qd, laws);
    const MovingPose at{pose, qd.data(), laws.data()};
    e.applied_forces(at, Q);
    power = e.load_power(at);
    loss = e.dissipation(at);
  }
};

/// All that equations say of a pose.
std::vector<double> said(const Equations& e, const Pose& pose, const std::vector<double>& qd) {
  const Plan& plan = e.plan();
  std::vector<double> numbers, rows(static_cast<std::size_t>(plan.rows)), lambda(rows.size(), 1.3);
  std::vector<double> jacobian(static_cast<std::size_t>(plan.jacobian.entries()) + 1);
  const auto add_matrix = [&](int, int, const ElementMatrix& m) { append(numbers, m); };
  const Loads loads(e, pose, qd);
  append(numbers, loads.Q);
  append(numbers, std::vector{loads.power, loads.loss, e.potential_energy(pose)});
  e.visit_stiffness({pose, qd.data(), loads.laws.data()}, add_matrix);
  e.gamma(pose, qd, rows);
  append(numbers, rows);
  e.start_jacobian(jacobian);
  e.jacobian(pose, jacobian);
  append(numbers, jacobian);
  e.visit_constraint_hessians(pose, lambda, add_matrix);
  e.nu(pose, rows);
  append(numbers, rows);
  e.phi(pose, rows);
  append(numbers, rows);
  for (int element = 0; element < static_cast<int>(e.model().elements.size()); ++element) {
    const Measured m = e.measure(pose, element, qd, {});
    append(numbers, std::vector{m.value, m.rate, m.second, e.element_value(pose, element).d});
    append(numbers, e.element_jacobian(pose, element).entries);
  }
  return numbers;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

constexpr unsigned scenes = 6, instants = 40;

class PureEvaluation : public ::testing::Test {
 protected:
  /// Calls test(equations, instants) for random scenes.
  template <class Test>
  void for_random_scenes(const Test& test) {
    for (unsigned seed = 0; seed < scenes; ++seed) {
      SCOPED_TRACE(seed);
      RandomScene scene(seed);
      ASSERT_TRUE(scene.evaluator);
      std::vector<Instant> way;
      for (unsigned k = 0; k < instants; ++k) way.emplace_back(scene);
      test(*scene.evaluator, way);
    }
  }
};

TEST_F(PureEvaluation, EightThreadsWithEightPosesSayTheSame) {
  for_random_scenes([](const Equations& equations, const std::vector<Instant>& way) {
    std::vector<std::vector<double>> alone;
    for (const Instant& at : way) {
      Pose pose = equations.given_pose();
      at.set(equations, pose);
      alone.push_back(said(equations, pose, at.qd));
    }
    EXPECT_FALSE(same_bits(alone[0], alone[1]));
    std::vector<int> same(8, 0);
    std::vector<std::thread> threads;
    for (std::size_t thread = 0; thread < same.size(); ++thread) {
      threads.emplace_back([&, thread] {
        Pose pose = equations.given_pose();
        for (std::size_t k = 0; k < 3 * way.size(); ++k) {
          const std::size_t next = (k * (2 * thread + 1) + thread) % way.size();
          way[next].set(equations, pose);
          same[thread] += same_bits(said(equations, pose, way[next].qd), alone[next]);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const int count : same) EXPECT_EQ(count, static_cast<int>(3 * way.size()));
  });
}

TEST_F(PureEvaluation, OtherPosesLeaveNoTrace) {
  for_random_scenes([](const Equations& equations, const std::vector<Instant>& way) {
    Pose here = equations.given_pose();
    way[0].set(equations, here);
    const std::vector<double> once = said(equations, here, way[0].qd);
    Pose elsewhere = here;
    for (const Instant& at : way) {
      at.set(equations, elsewhere);
      static_cast<void>(said(equations, elsewhere, at.qd));
      EXPECT_TRUE(same_bits(said(equations, here, way[0].qd), once));
    }
  });
}

TEST_F(PureEvaluation, EvaluatorsCountWhatTheySayOfTheirPose) {
  for (unsigned seed = 0; seed < scenes; ++seed) {
    RandomScene scene(seed);
    ASSERT_TRUE(scene.evaluator);
    Evaluator& e = *scene.evaluator;
    const Instant at(scene);
    Pose pose = e.given_pose();
    at.set(e, pose);
    e.set_time(at.t);
    std::vector<double> q = at.q;
    e.take_turns(q);
    e.set_configuration(q);
    EXPECT_TRUE(same_bits(said(e, e.pose(), at.qd), said(e, pose, at.qd)));
    std::vector<double> kept(q.size()), given(static_cast<std::size_t>(e.plan().rows)), found = given;
    const Counters before = e.counters;
    e.applied_forces(at.qd, kept);
    EXPECT_TRUE(same_bits(kept, Loads(e, pose, at.qd).Q));
    e.gamma(at.qd, given);
    static_cast<const Equations&>(e).gamma(pose, at.qd, found);
    EXPECT_TRUE(same_bits(given, found));
    Counters after = before;
    ++after.forces;
    ++after.gammas;
    EXPECT_EQ(e.counters, after);
  }
}

// Q^T qd + dissipation + dV/dt is the power that functions of time and laws give, dV/dt by differences along the
// motion.
TEST_F(PureEvaluation, PowersAreInBalance) {
  for_random_scenes([](const Equations& equations, const std::vector<Instant>& way) {
    Pose pose = equations.given_pose();
    constexpr double h = 1e-5;
    for (const Instant& at : way) {
      const auto potential = [&](double later) {
        Instant moved = at;
        moved.t += later;
        for (std::size_t c = 0; c < at.q.size(); ++c) moved.q[c] += later * at.qd[c];
        moved.set(equations, pose);
        return equations.potential_energy(pose);
      };
      const double slope = (potential(h) - potential(-h)) / (2 * h);
      at.set(equations, pose);
      const Loads loads(equations, pose, at.qd);
      double work = 0;
      for (std::size_t c = 0; c < at.qd.size(); ++c) work += loads.Q[c] * at.qd[c];
      EXPECT_NEAR(loads.power, work + loads.loss + slope, 1e-5);
    }
  });
}

}  // namespace
}  // namespace catena::testing
