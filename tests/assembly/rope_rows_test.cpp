// Random ropes over pulleys of several bodies: their length against tangents and arcs drawn one by one, derivatives of
// rows, forces and stiffnesses against differences; which bodies they tie.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/model/model_part.hpp"
#include "catena/model/rope_way.hpp"

namespace catena {
namespace {

constexpr double step = 1e-5, stiffness = 300;

/// A rope from body 0 to body 3, or back to the body of its last pulley, over three or four pulleys.
struct RandomRope {
  Model model;
  RopeWay<double> way;
  int element = -1;
  double least_contact = 0, most_contact = 0;
  std::mt19937 engine;

  double random(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }

  RandomRope(unsigned seed, bool elastic) : engine(seed) {
    // Angles of contact away from none and from whole turns, where they are told apart; beyond 4 pi / 3 the rope lies
    // beside the pulley where its ends cross.
    do {
      draw(seed);
      least_contact = 10;
      most_contact = 0;
      measure([&](int body) { return model.frame(body); });
    } while (least_contact < 0.5 || most_contact > 4);
    auto stretches = rope_stretches(model, way);
    // Taut throughout.
    RopeValues<double> values;
    if (elastic) values = {.length = 0.5 * stretches[0].way, .k = stiffness};
    element = add_rope(model, "rope", stretches, values);
  }

  void draw(unsigned seed) {
    model = {};
    way = {};
    for (int b = 0; b < 4; ++b) {
      const Vec2<double> position{2.0 * b + random(-0.3, 0.3), random(-1, 1)};
      model.add_body("body" + std::to_string(b),
                     {.mass = 1, .inertia = 1, .position = position, .angle = random(-3, 3)});
    }
    const auto place = [&](int body) {
      return RopePulley<double>{.body = body, .centre = {random(-.2, .2), random(-.2, .2)}};
    };
    way.i = place(0);
    const int order[] = {1, ground, 2, 2};
    const int pulleys = seed % 2 == 0 ? 3 : 4;
    for (int k = 0; k < pulleys; ++k) {
      RopePulley<double> pulley = place(order[k]);
      if (order[k] == ground) pulley.centre = {3 + random(-0.2, 0.2), random(-1, 1)};
      pulley.radius = random(0, 1) < 0.2 ? 0 : random(0.05, 0.15);
      pulley.side = random(0, 1) < 0.5 ? 1 : -1;
      way.over.push_back(pulley);
    }
    // Two pulleys of one body, apart.
    if (pulleys == 4) way.over[3].centre.x += 0.8;
    way.j = place(seed % 3 == 0 ? 2 : 3);
    if (seed % 3 == 0) way.j.centre.x -= 0.9;
  }

  /// The length of the way: tangents from circle to circle, and the arcs between the points of contact.
  double length(const Evaluator& evaluator) {
    const Plan& plan = evaluator.plan();
    return measure([&](int body) { return evaluator.ground_frame(body < 0 ? plan.bodies : plan.plan_body[at(body)]); });
  }
  template <class FrameOf>
  double measure(FrameOf&& frame_of) {
    std::vector<RopePulley<double>> nodes{way.i};
    nodes.insert(nodes.end(), way.over.begin(), way.over.end());
    nodes.push_back(way.j);
    const auto centre = [&](const RopePulley<double>& node) { return frame_of(node.body).point(node.centre); };
    double sum = 0, before = 0;
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      const double from = nodes[k].side * nodes[k].radius, to = nodes[k + 1].side * nodes[k + 1].radius;
      const Vec2<double> h = centre(nodes[k + 1]) - centre(nodes[k]);
      const double angle = std::atan2(h.y, h.x) - std::asin((to - from) / norm(h));
      const Vec2<double> n{-std::sin(angle), std::cos(angle)};
      sum += norm((centre(nodes[k + 1]) - to * n) - (centre(nodes[k]) - from * n));
      if (k > 0) {
        double arc = std::fmod(nodes[k].side * (angle - before), 2 * std::numbers::pi);
        if (arc < 0) arc += 2 * std::numbers::pi;
        sum += nodes[k].radius * arc;
        if (nodes[k].radius > 0) most_contact = std::max(most_contact, arc);
        if (nodes[k].radius > 0) least_contact = std::min({least_contact, arc, 2 * std::numbers::pi - arc});
      }
      before = angle;
    }
    return sum;
  }
};

struct Evaluated {
  EvaluationWork work;
  Evaluator evaluator;
  std::vector<double> q, qd;

  explicit Evaluated(RandomRope& rope)
      : evaluator(Plan::make(rope.model, {.one_sided = true}), rope.model, work),
        q(evaluator.given_configuration()),
        qd(q) {
    for (int c = 0; c < 3 * evaluator.plan().moving; ++c) {
      q[at(c)] += rope.random(-0.05, 0.05);
      qd[at(c)] = rope.random(-1, 1);
    }
    for (std::size_t c = at(3 * evaluator.plan().moving); c < q.size(); ++c) qd[c] = 0;
    evaluator.set_configuration(q);
  }
  int columns() const { return evaluator.plan().columns; }
  double phi(const std::vector<double>& place) {
    evaluator.set_configuration(place);
    double value = 0;
    evaluator.phi({&value, 1});
    return value;
  }
  std::vector<double> gradient(const std::vector<double>& place) {
    evaluator.set_configuration(place);
    const Plan& plan = evaluator.plan();
    std::vector<double> values(at(plan.trash_slot()) + 1), dense(at(columns()), 0.0);
    evaluator.start_jacobian(values);
    evaluator.jacobian(values);
    for (int c = 0; c < plan.columns; ++c) {
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
        dense[at(c)] += values[at(k)];
    }
    return dense;
  }
  std::vector<double> forces(const std::vector<double>& place) {
    evaluator.set_configuration(place);
    std::vector<double> Q(q.size()), rest(q.size(), 0.0);
    evaluator.applied_forces(rest, Q);
    return Q;
  }
  std::vector<double> moved(int coordinate, double by) const {
    std::vector<double> there = q;
    there[at(coordinate)] += by;
    return there;
  }
  /// A matrix over the moving coordinates from 6 x 6 parts.
  template <class Visit>
  std::vector<double> dense(Visit&& visit) {
    const int n = columns();
    std::vector<double> all(at(n * n), 0.0);
    visit([&](int i, int j, const ElementMatrix& part) {
      const int body[] = {i, j};
      for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) {
          const int row = 3 * body[r / 3] + r % 3, column = 3 * body[c / 3] + c % 3;
          if (row < n && column < n) all[at(n * row + column)] += part[at(6 * r + c)];
        }
      }
    });
    return all;
  }
};

TEST(RopeRows, AreTheLengthOfTheWayAndItsDerivatives) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomRope rope(seed, false);
    const double given =
        std::get<std::vector<ElementEntry<Rope<double>, double>>>(rope.model.constraints)[0].element.length;
    Evaluated at_q(rope);
    const int n = at_q.columns();
    ASSERT_EQ(at_q.evaluator.plan().rows, 1);
    ASSERT_EQ(n, 12);
    EXPECT_NEAR(at_q.phi(at_q.q), given - rope.length(at_q.evaluator), 1e-12);
    EXPECT_NEAR(at_q.evaluator.measure(rope.element, {}, {}).value, given - rope.length(at_q.evaluator), 1e-12);

    const std::vector<double> exact = at_q.gradient(at_q.q);
    double rate = 0;
    for (int c = 0; c < n; ++c) {
      EXPECT_NEAR(exact[at(c)], (at_q.phi(at_q.moved(c, step)) - at_q.phi(at_q.moved(c, -step))) / (2 * step), 1e-8);
      rate += exact[at(c)] * at_q.qd[at(c)];
    }
    // Phi along q + qd t.
    const auto along = [&](double t) {
      std::vector<double> there = at_q.q;
      for (int c = 0; c < n; ++c) there[at(c)] += t * at_q.qd[at(c)];
      return at_q.phi(there);
    };
    constexpr double dt = 1e-3;
    // Differences of fourth order.
    const double second =
        (-along(2 * dt) + 16 * along(dt) - 30 * along(0) + 16 * along(-dt) - along(-2 * dt)) / (12 * dt * dt);
    at_q.evaluator.set_configuration(at_q.q);
    double gamma = 0;
    at_q.evaluator.gamma(at_q.qd, {&gamma, 1});
    EXPECT_NEAR(gamma, -second, 1e-6 * (1 + std::abs(second)));

    const Evaluator::ScalarMotion motion = at_q.evaluator.scalar_motion(rope.element, at_q.qd);
    std::vector<double> sum(at_q.q.size(), 0.0);
    const auto add = [&](int i, int j, const double* parts) {
      for (int k = 0; k < 3; ++k) {
        sum[at(3 * i + k)] += parts[k];
        sum[at(3 * j + k)] += parts[3 + k];
      }
    };
    add(motion.body_i, motion.body_j, motion.gradient);
    for (const auto& part : motion.parts) add(part.body_i, part.body_j, part.gradient);
    for (int c = 0; c < n; ++c) EXPECT_NEAR(sum[at(c)], exact[at(c)], 1e-13);
    EXPECT_NEAR(motion.rate, rate, 1e-12);
    EXPECT_NEAR(motion.bend, -gamma, 1e-10 * (1 + std::abs(gamma)));
    EXPECT_NEAR(at_q.evaluator.measure(rope.element, at_q.qd, {}).rate, rate, 1e-12);

    const double lambda[] = {1};
    const std::vector<double> hessian =
        at_q.dense([&](auto&& f) { at_q.evaluator.visit_constraint_hessians(lambda, f); });
    for (int c = 0; c < n; ++c) {
      const std::vector<double> after = at_q.gradient(at_q.moved(c, step)),
                                before = at_q.gradient(at_q.moved(c, -step));
      for (int r = 0; r < n; ++r)
        EXPECT_NEAR(hessian[at(n * r + c)], (after[at(r)] - before[at(r)]) / (2 * step), 1e-7) << r << " " << c;
    }
  }
}

TEST(RopeRows, ElasticRopesHaveTheForcesAndStiffnessOfTheirEnergy) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomRope rope(seed, true);
    const double free =
        std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(rope.model.forces)[0].element.length;
    Evaluated at_q(rope);
    const int n = at_q.columns();
    ASSERT_EQ(at_q.evaluator.plan().rows, 0);
    const auto energy = [&](const std::vector<double>& place) {
      at_q.evaluator.set_configuration(place);
      return at_q.evaluator.potential_energy();
    };
    const double stretch = rope.length(at_q.evaluator) - free;
    EXPECT_NEAR(energy(at_q.q), stiffness * stretch * stretch / 2, 1e-10 * stiffness * stretch * stretch);
    const std::vector<double> Q = at_q.forces(at_q.q);
    const std::vector<double> K = at_q.dense([&](auto&& f) { at_q.evaluator.visit_stiffness({}, f); });
    for (int c = 0; c < n; ++c) {
      const double slope = (energy(at_q.moved(c, step)) - energy(at_q.moved(c, -step))) / (2 * step);
      EXPECT_NEAR(Q[at(c)], -slope, 1e-6 * stiffness);
      const std::vector<double> after = at_q.forces(at_q.moved(c, step)), before = at_q.forces(at_q.moved(c, -step));
      for (int r = 0; r < n; ++r)
        EXPECT_NEAR(K[at(n * r + c)], -(after[at(r)] - before[at(r)]) / (2 * step), 1e-6 * stiffness) << r << " " << c;
    }
  }
}

// A slack one does nothing.
TEST(RopeRows, SlackElasticRopesDoNothing) {
  RandomRope rope(4, true);
  auto& list = std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(rope.model.forces);
  for (auto& entry : list) entry.element.length = 100;
  Evaluated at_q(rope);
  for (const double force : at_q.forces(at_q.q)) EXPECT_EQ(force, 0);
  EXPECT_EQ(at_q.evaluator.potential_energy(), 0);
}

// Two weights on a rope over a pulley of the ground move together.
TEST(RopeRows, TieBodiesAcrossTheGround) {
  for (const double k : {0.0, 100.0}) {
    Model model;
    model.add_body("apart", {.mass = 1, .position = {9, 9}, .particle = true});
    model.add_body("a", {.mass = 1, .position = {-0.1, -1}, .particle = true});
    model.add_body("b", {.mass = 1, .position = {0.1, -1}, .particle = true});
    RopeWay<double> way{.i = {.body = 1}, .j = {.body = 2}, .over = {{.radius = 0.1}}};
    add_rope(model, "rope", rope_stretches(model, way), RopeValues<double>{.k = k});
    const auto groups = separate_groups(model);
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(groups[1], (std::vector<int>{1, 2}));
    const ModelPart part = part_of(model, groups[1]);
    EvaluationWork work;
    Evaluator whole(Plan::make(model, {.one_sided = true}), model, work);
    Evaluator alone(Plan::make(part.model, {.one_sided = true}), part.model, work);
    EXPECT_EQ(whole.plan().islands, k == 0 ? 2 : 3);
    if (k > 0) continue;
    ASSERT_EQ(alone.plan().rows, 1);
    std::vector<double> q = alone.given_configuration();
    q[1] += 0.3;
    alone.set_configuration(q);
    double phi = 0;
    alone.phi({&phi, 1});
    EXPECT_NEAR(phi, 0.3, 1e-14);
    // Released, it has no rows.
    EXPECT_EQ(Plan::make(model, {.released_elements = {0}})->rows, 0);
  }
}

TEST(RopeRows, WaysThatAreNone) {
  Model model;
  model.add_body("a", {.mass = 1, .position = {0, -1}, .particle = true});
  const auto message = [&](const RopeWay<double>& way) -> std::string {
    try {
      rope_stretches(model, way);
    } catch (const ModelError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message({.i = {.body = 0}, .j = {}, .over = {{.centre = {0.01, -1.05}, .radius = 0.1}}})
                .find("its end i and pulley 1"),
            std::string::npos);
  EXPECT_NE(message({.i = {.body = 0}, .j = {}, .over = {{.centre = {0, -0.5}, .radius = 0.1}}}).find("does not bend"),
            std::string::npos);
  EXPECT_NE(message({.i = {}, .j = {}, .over = {{.centre = {1, 1}}}}).find("does not move"), std::string::npos);
}

}  // namespace
}  // namespace catena
