// Paths of equilibria against closed forms: through limit points, past branch points and onto the branches.
#include "catena/analysis/stability/path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/analysis/stability/path_system.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/torsion_spring.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_reference.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using namespace testing;

struct Row {
  double p;
  std::vector<double> q;  // absolute, model order
};

struct Followed {
  PathReport report;
  std::vector<Row> rows;
};

Followed follow(const ModelAt& model_at, const PathOptions& options) {
  Followed run;
  Path path(model_at(options.from), model_at, options);
  run.report = path.run([&](double p, const Snapshot& snapshot) {
    Row row{p, {}};
    const Plan& plan = snapshot.evaluator.plan();
    for (int b = 0; b < plan.bodies; ++b) {
      const Frame<double> frame = snapshot.evaluator.ground_frame(plan.plan_body[static_cast<std::size_t>(b)]);
      row.q.insert(row.q.end(), {frame.x, frame.y, frame.phi});
    }
    run.rows.push_back(std::move(row));
    return true;
  });
  return run;
}

// A rod on a spring at its pin, pushed along itself: motions that are not found are not those of a stable place.
TEST(PathSystem, SaysNothingOfStabilityWhereTheSpectrumIsNotFound) {
  bool has_first = true;
  const ModelAt model_at = [&](double load) {
    if (load == 1 && !has_first) return std::shared_ptr<const Model>();
    auto model = std::make_shared<Model>();
    const int rod = model->add_body("rod", {.mass = 1, .inertia = 0.1, .position = {0.5, 0}});
    Revolute<> pin;
    pin.s_j = {-0.5, 0};
    model->add("pin", pin, ground, rod);
    TorsionSpring<> spring;
    spring.k = 10;
    model->add_force("spring", spring, ground, rod);
    PointForce<> push;
    push.s_i = {0.5, 0};
    push.in_body_axes = true;
    model->add_force("push", push, rod, ground, {TimeFunction<double>(-load), TimeFunction<double>(0.0)});
    return std::shared_ptr<const Model>(model);
  };
  const std::shared_ptr<const Model> first = model_at(1);
  EvaluationWork work;
  Evaluator evaluator(Plan::make(*first), *first, work);
  StaticSystem system(evaluator);
  PathSystem path(system, model_at, 1, 1);
  PathPoint x{evaluator.given_configuration(), std::vector<double>(2, 0.0), 1};
  ASSERT_TRUE(path.is_circulatory());
  ASSERT_TRUE(path.factorize(x));
  EXPECT_EQ(path.stability(), PathStability{});
  PathPoint beside = x;
  beside.p = 2;
  ASSERT_TRUE(path.move_to(beside));
  has_first = false;
  EXPECT_EQ(path.stability(), std::nullopt);
}

TEST(Path, GoesThroughTheLimitPointsOfTheTruss) {
  const auto reference = reference_values("von_mises_truss");
  const double limit = reference.at("P_limit"), y_limit = reference.at("y_limit"), length = reference.at("L0");
  const Followed run = follow([](double load) { return von_mises_truss(load, 0.3); }, {.from = 0, .to = 12});
  ASSERT_TRUE(run.report.ok()) << run.report.message;
  EXPECT_TRUE(run.report.warnings.empty()) << run.report.warnings.front();
  // Every row lies on P(y) = 2 k (L0 / sqrt(b^2 + y^2) - 1) y.
  for (const Row& row : run.rows) {
    const double y = row.q[1];
    EXPECT_NEAR(row.p, 2000 * (length / std::sqrt(1 + y * y) - 1) * y, 1e-9) << y;
  }
  ASSERT_EQ(run.report.critical.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const PathCritical& critical = run.report.critical[k];
    const double side = k == 0 ? 1 : -1;
    EXPECT_FALSE(critical.branch);
    EXPECT_NEAR(critical.value, side * limit, 1e-10);
    EXPECT_NEAR(run.rows.at(static_cast<std::size_t>(critical.row)).q[1], side * y_limit, 1e-8);
    EXPECT_EQ(critical.modes, 1);
  }
  EXPECT_EQ(run.rows.front().p, 0);
  EXPECT_EQ(run.rows.back().p, 12);
  EXPECT_LT(run.rows.back().q[1], -0.3);
  // Stable, unstable between the limits, stable.
  ASSERT_EQ(run.report.negative_modes.size(), run.rows.size());
  for (std::size_t k = 0; k < run.rows.size(); ++k) {
    const double y = run.rows[k].q[1];
    if (std::abs(std::abs(y) - y_limit) < 1e-6) continue;
    EXPECT_EQ(run.report.negative_modes[k], std::abs(y) < y_limit ? 1 : 0) << y;
  }
}

TEST(Path, EndsWhereTheParameterReachesItsValueFirst) {
  const auto value = reference_values("von_mises_truss").at("equilibria").at("P=0.9*Plim");
  const Followed run = follow([](double load) { return von_mises_truss(load, 0.3); },
                              {.from = 0, .to = value.at("P").get<double>(), .arc = 0.3});
  ASSERT_TRUE(run.report.ok()) << run.report.message;
  EXPECT_NEAR(run.rows.back().q[1], value.at("y_pre").get<double>(), 1e-11);
  EXPECT_TRUE(run.report.critical.empty());
  // Backwards from beyond the snap: past the other limit point and up.
  const Followed back = follow([](double load) { return von_mises_truss(load, -0.35); }, {.from = 12, .to = -12});
  ASSERT_TRUE(back.report.ok()) << back.report.message;
  ASSERT_EQ(back.report.critical.size(), 2u);
  EXPECT_NEAR(back.report.critical[0].value, -reference_values("von_mises_truss").at("P_limit").get<double>(), 1e-10);
}

TEST(Path, LeavesThePitchforkOnRequest) {
  const auto reference = reference_values("inverted_pendulum_torsion_spring");
  const auto model_at = [](double weight) { return inverted_pendulum(weight); };
  for (const int branch : {0, 1, 2, 3}) {
    const Followed run = follow(model_at, {.from = 0.5, .to = 2, .branch = branch});
    ASSERT_TRUE(run.report.ok()) << run.report.message;
    ASSERT_EQ(run.report.critical.size(), 1u) << branch;
    EXPECT_TRUE(run.report.critical[0].branch);
    EXPECT_NEAR(run.report.critical[0].value, 1, 1e-9);
    const double theta = run.rows.back().q[2];
    if (branch < 2) {
      EXPECT_NEAR(theta, 0, 1e-12);
      EXPECT_EQ(run.report.negative_modes.back(), 1);
      continue;
    }
    EXPECT_EQ(run.report.negative_modes.back(), 0);
    EXPECT_NEAR(std::abs(theta), reference.at("mgl_over_k=2").at("theta").get<double>(), 1e-10);
    EXPECT_EQ(run.report.warnings.size(), 0u);
    for (const Row& row : run.rows) {
      if (row.p > 1 + 1e-6) {
        EXPECT_NEAR(row.q[2], row.p * std::sin(row.q[2]), 1e-10);
      }
    }
  }
  const double up = follow(model_at, {.from = 0.5, .to = 2, .branch = 2}).rows.back().q[2];
  const double down = follow(model_at, {.from = 0.5, .to = 2, .branch = 3}).rows.back().q[2];
  EXPECT_NEAR(up, -down, 1e-10);
}

TEST(Path, CountsTheBucklingLoadsOfAColumnThatStaysStraight) {
  // N rods pressed along their line, springs at the joints: P_j l / c = 4 sin^2(j pi / 2 N), a branch point each.
  const int count = 5;
  const double c = 3, l = 0.2;
  const auto column = [&](double load) {
    auto model = std::make_shared<Model>();
    for (int k = 0; k < count; ++k) {
      model->add_body("rod" + std::to_string(k), {.mass = 1, .inertia = 1, .position = {(k + 0.5) * l, 0}});
      model->add("", Revolute<double>{.s_i = {k == 0 ? 0 : l / 2, 0}, .s_j = {-l / 2, 0}}, k - 1, k);
      if (k > 0) model->add_force("", torsion_spring(c, 0), k - 1, k);
    }
    model->add("", AbsoluteY<double>{.s_i = {l / 2, 0}}, count - 1, ground, 0.0);
    model->add_force("", PointForce<double>{.s_i = {l / 2, 0}}, count - 1, ground, {-load, 0.0});
    return model;
  };
  const Followed run = follow(column, {.from = 0, .to = 60});
  ASSERT_TRUE(run.report.ok()) << run.report.message;
  ASSERT_EQ(run.report.critical.size(), static_cast<std::size_t>(count - 1));
  for (int j = 1; j < count; ++j) {
    const PathCritical& critical = run.report.critical[static_cast<std::size_t>(j - 1)];
    EXPECT_TRUE(critical.branch);
    EXPECT_NEAR(critical.value, 4 * c / l * std::pow(std::sin(j * std::numbers::pi / 2 / count), 2), 1e-8);
  }
  EXPECT_EQ(run.report.negative_modes.back(), count - 1);
}

/// A rod of 2 m and 3 kg upright on a torsion spring that is slack there.
std::shared_ptr<Model> spring_held_rod(double k) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  model->add_body("rod", {.mass = 3, .inertia = 1, .position = {0, 1}, .angle = std::numbers::pi / 2});
  model->add("", Revolute<double>{.s_j = {-1, 0}}, ground, 0);
  model->add_force("", torsion_spring(k, std::numbers::pi / 2), ground, 0);
  return model;
}

TEST(Path, TellsABranchWhereTheParameterDoesNothingToThePath) {
  // Upright the spring holds nothing: no residual depends on k, wherever the path begins.
  const double critical = 3 * 9.81;
  for (const double from : {29.5, 30.0, 35.0, 40.0, 50.0}) {
    for (const int branch : {0, 2}) {
      const Followed run = follow(spring_held_rod, {.from = from, .to = 20, .branch = branch});
      ASSERT_TRUE(run.report.ok()) << run.report.message;
      ASSERT_EQ(run.report.critical.size(), 1u) << from;
      EXPECT_TRUE(run.report.critical[0].branch) << from;
      EXPECT_NEAR(run.report.critical[0].value, critical, 1e-7) << from;
      // k theta = m g l sin(theta) on the branch.
      const double theta = run.rows.back().q[2] - std::numbers::pi / 2;
      EXPECT_NEAR(20 * theta, critical * std::sin(theta), 1e-8);
      EXPECT_EQ(std::abs(theta) > 0.5, branch == 2) << from;
    }
  }
  EXPECT_TRUE(follow(spring_held_rod, {.from = 20, .to = 50}).report.critical.at(0).branch);
}

TEST(Path, FindsPitchforksOfColumnsInEveryDirection) {
  // A strut on a torsion spring pressed along its line, P = c / l.
  for (const double direction : {0.0, 0.3, std::numbers::pi / 2, -2.0}) {
    const Vec2<double> along{std::cos(direction), std::sin(direction)};
    const auto strut = [&](double load) {
      auto model = std::make_shared<Model>();
      model->add_body("strut", {.mass = 1, .inertia = 1, .position = 0.5 * along, .angle = direction});
      model->add("", Revolute<double>{.s_j = {-0.5, 0}}, ground, 0);
      model->add_force("", torsion_spring(10, direction), ground, 0);
      model->add_force("", PointForce<double>{.s_i = {0.5, 0}}, 0, ground, {-load * along.x, -load * along.y});
      return model;
    };
    for (const int branch : {0, 2, 3}) {
      const Followed run = follow(strut, {.from = 0, .to = 12, .branch = branch});
      ASSERT_TRUE(run.report.ok()) << run.report.message;
      ASSERT_EQ(run.report.critical.size(), 1u) << direction;
      EXPECT_TRUE(run.report.critical[0].branch) << direction;
      EXPECT_NEAR(run.report.critical[0].value, 10, 1e-8) << direction;
      const double theta = run.rows.back().q[2] - direction;
      EXPECT_NEAR(10 * theta, 12 * std::sin(theta), 1e-8);
      EXPECT_EQ(std::abs(theta) > 0.5, branch > 0) << direction;
    }
  }
}

TEST(Path, RaisesTheSideForceOfAHangingChain) {
  const auto references = reference_values("hanging_chain_side_force");
  for (const auto& [name, reference] : references.items()) {
    const int count = std::stoi(name.substr(1));
    if (count > 100) continue;
    const Followed run = follow([&](double force) { return chain_with_side_force(count, 1, 1, force); },
                                {.from = 0, .to = 5, .arc = 0.5});
    ASSERT_TRUE(run.report.ok()) << name << run.report.message;
    EXPECT_NEAR(run.rows.back().q[2], reference.at("phi_1").get<double>(), 1e-10) << name;
    EXPECT_TRUE(run.report.critical.empty());
  }
}

TEST(Path, MovesSupportsAndTakesStiffnessAsWell) {
  // The support of a pendulum on a spring is moved: the chain of places follows, whatever the given configuration says.
  const auto model_at = [](double x) {
    auto model = std::make_shared<Model>();
    model->gravity = {0, -10};
    model->add_body("bob", {.mass = 2, .position = {x, -1}, .particle = true});
    model->add_force("", spring({x, 0}, {0, 0}, 100, 1), ground, 0);
    return model;
  };
  const Followed run = follow(model_at, {.from = 0, .to = 3});
  ASSERT_TRUE(run.report.ok()) << run.report.message;
  for (const Row& row : run.rows) {
    EXPECT_NEAR(row.q[0], row.p, 1e-10);
    EXPECT_NEAR(row.q[1], -1.2, 1e-10);
  }
}

TEST(Path, SaysWhereItEnds) {
  const Followed few =
      follow([](double load) { return von_mises_truss(load, 0.3); }, {.from = 0, .to = 12, .max_steps = 3});
  EXPECT_EQ(few.report.status, Status::not_converged);
  EXPECT_EQ(few.rows.size(), 4u);
  EXPECT_NE(few.report.message.find("3 steps"), std::string::npos) << few.report.message;
  // A scene without a model beyond 5.
  const auto fenced = [](double load) -> std::shared_ptr<const Model> {
    return load > 5 ? nullptr : von_mises_truss(load, 0.3);
  };
  const Followed inside = follow(fenced, {.from = 0, .to = 5});
  ASSERT_TRUE(inside.report.ok()) << inside.report.message;
  EXPECT_EQ(inside.rows.back().p, 5);
  const Followed outside = follow(fenced, {.from = 0, .to = 6});
  EXPECT_EQ(outside.report.status, Status::refused);
  EXPECT_NE(outside.report.message.find("does not allow"), std::string::npos) << outside.report.message;
  EXPECT_GT(outside.rows.back().p, 4.9);
  const Followed nowhere = follow(fenced, {.from = 3, .to = 3});
  EXPECT_EQ(nowhere.report.status, Status::refused);
}

TEST(Path, AsksForABranchWhereItStartsBetweenSeveral) {
  // The pendulum's spring lets go at m g l = k: k theta = m g l sin(theta) beyond it.
  const auto model_at = [](double weight) { return inverted_pendulum(weight); };
  const Followed undecided = follow(model_at, {.from = 1, .to = 2});
  EXPECT_EQ(undecided.report.status, Status::bifurcation) << undecided.report.message;
  EXPECT_TRUE(undecided.rows.empty());
  for (const int branch : {1, 2, 3}) {
    const Followed run = follow(model_at, {.from = 1, .to = 2, .branch = branch});
    ASSERT_TRUE(run.report.ok()) << run.report.message;
    ASSERT_EQ(run.report.critical.size(), 1u);
    EXPECT_TRUE(run.report.critical[0].branch);
    EXPECT_EQ(run.report.critical[0].row, 0);
    EXPECT_EQ(run.rows.back().p, 2);
    EXPECT_EQ(run.report.negative_modes.back(), branch == 1 ? 1 : 0);
    for (const Row& row : run.rows) EXPECT_NEAR(row.q[2], row.p * std::sin(row.q[2]), 1e-10);
    const double theta = run.rows.back().q[2];
    EXPECT_EQ(theta == 0, branch == 1) << theta;
    EXPECT_EQ(theta > 0, branch == 2) << theta;
  }
  // Downwards nothing is to be chosen but the same holds: two paths go on, and one of them is the upright one.
  EXPECT_EQ(follow(model_at, {.from = 1, .to = 0.5}).report.status, Status::bifurcation);
  EXPECT_EQ(follow(model_at, {.from = 1, .to = 0.5, .branch = 1}).rows.back().q[2], 0);
}

TEST(Path, NamesAFreeMotionWhereItStarts) {
  // A rod on a pin at its middle: nothing ever holds it.
  const auto loose = [](double load) {
    auto model = std::make_shared<Model>();
    model->add_body("rod", {.mass = 1, .inertia = 1});
    model->add("", Revolute<double>{}, ground, 0);
    model->add_force("", PointForce<double>{}, 0, ground, {-load, 0.0});
    return model;
  };
  const Followed free = follow(loose, {.from = 1, .to = 2});
  EXPECT_EQ(free.report.status, Status::singular) << free.report.message;
  EXPECT_NE(free.report.message.find("nothing resists"), std::string::npos) << free.report.message;
}

TEST(Path, KeepsOneSymbolicAnalysis) {
  const Followed run =
      follow([](double force) { return chain_with_side_force(200, 1, 1, force); }, {.from = 0, .to = 5});
  ASSERT_TRUE(run.report.ok());
  EXPECT_EQ(run.report.counters.symbolic, 1);
  EXPECT_LT(run.report.counters.factorizations, 6 * run.report.steps + 12);
}

}  // namespace
}  // namespace catena
