// Pendulums against their independent solutions in data/reference.
#include "catena/columns/reaction.hpp"
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::frame_of;
using testing::rates_of;
using testing::reference_values;
using testing::rod_chain;
using testing::run_dynamics;

std::string key(const char* format, double t) {
  char text[32];
  std::snprintf(text, sizeof text, format, t);
  return text;
}

TEST(DynamicsPendulums, RodWithPinReaction) {
  const auto values = reference_values("rod_pendulum");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int rod = model->add_body("rod", {.mass = 2, .inertia = 2 * 1.5 * 1.5 / 12, .position = {0.75, 0}});
  const int pin = model->add("pin", Revolute<>{{0, 0}, {-0.75, 0}}, ground, rod);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::list({0.25, 0.5, 1.0}), {.acceleration = true, .multipliers = true},
               [&](const Snapshot& s) {
                 const auto& want = values.at(key(s.t == 0.25 ? "t=%.2f" : "t=%.1f", s.t));
                 const double size = 2 * 9.81;
                 EXPECT_NEAR(frame_of(s, rod).phi + std::numbers::pi / 2, want.at("theta").get<double>(), 1e-10);
                 EXPECT_NEAR(rates_of(s, s.qd, rod)[2], want.at("omega").get<double>(), 1e-9);
                 EXPECT_NEAR(rates_of(s, s.qdd, rod)[2], want.at("alpha").get<double>(), 1e-9);
                 const Reaction reaction = element_reactions(s, pin).on_j;
                 EXPECT_NEAR(reaction.force.x, want.at("reaction_on_rod_x").get<double>(), 1e-9 * size);
                 EXPECT_NEAR(reaction.force.y, want.at("reaction_on_rod_y").get<double>(), 1e-9 * size);
                 EXPECT_NEAR(reaction.torque, 0, 1e-12 * size);
               });
}

void check_spring_pendulum(const char* name, double mass, double k, double c, double length, Vec2<double> place,
                           Vec2<double> velocity, std::vector<double> times) {
  const auto values = reference_values(name);
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int body = model->add_body("ball", {.mass = mass, .position = place, .particle = true});
  model->bodies[0].velocity = velocity;
  model->bodies[0].velocity_given = true;
  SpringDamper<> spring;
  spring.k = k;
  spring.c = c;
  spring.length = length;
  model->add_force("spring", spring, ground, body);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  const AnalysisReport report =
      run_dynamics(dynamics, TimeGrid::list(times), {.velocity = true}, [&](const Snapshot& s) {
        const auto& want = values.at(key("t=%.1f", s.t));
        EXPECT_NEAR(frame_of(s, body).x, want.at("x").get<double>(), 2e-10);
        EXPECT_NEAR(frame_of(s, body).y, want.at("y").get<double>(), 2e-10);
        EXPECT_NEAR(rates_of(s, s.qd, body)[0], want.at("vx").get<double>(), 2e-9);
        EXPECT_NEAR(rates_of(s, s.qd, body)[1], want.at("vy").get<double>(), 2e-9);
      });
  EXPECT_EQ(report.counters.factorizations, 0) << "nothing is constrained";
  EXPECT_EQ(report.counters.symbolic, 0);
}

TEST(DynamicsPendulums, Spring) {
  check_spring_pendulum("spring_pendulum", 1, 50, 0, 1, {1, 0}, {0, 0}, {0.5, 1, 2, 5});
}
TEST(DynamicsPendulums, SpringWithDamper) {
  check_spring_pendulum("spring_damper_pendulum", 0.6, 180, 1.3, 0.8, {0.5, -0.9}, {1, 2}, {0.3, 1, 4});
}

// Point masses on massless links: particles held at distances.
TEST(DynamicsPendulums, DoubleOfPoints) {
  const auto values = reference_values("double_pendulum_points");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int first = model->add_body("first", {.mass = 1, .position = {1, 0}, .particle = true});
  const int second = model->add_body("second", {.mass = 1, .position = {2, 0}, .particle = true});
  model->add("upper", AbsoluteDistance<>{{0, 0}, {0, 0}}, first, ground, 1.0);
  model->add("lower", RelativeDistance<>{{0, 0}, {0, 0}}, first, second, 1.0);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::list({0.5, 1, 2, 3}), {}, [&](const Snapshot& s) {
    const auto tip = values.at(key("t=%.1f", s.t)).at("tip");
    // Chaotic: digits are lost as time goes on.
    const double tolerance = s.t < 2.5 ? 1e-9 : 1e-8;
    EXPECT_NEAR(frame_of(s, second).x, tip[0].get<double>(), tolerance);
    EXPECT_NEAR(frame_of(s, second).y, tip[1].get<double>(), tolerance);
  });
}

TEST(DynamicsPendulums, ChainsOfRods) {
  for (const int n : {5, 40}) {
    const auto values = reference_values("npendulum_N" + std::to_string(n));
    Dynamics dynamics(rod_chain(n), {}, {.tolerance = 1e-12});
    run_dynamics(dynamics, TimeGrid::instant(0.5), {.acceleration = true, .multipliers = true}, [&](const Snapshot& s) {
      const auto& want = values.at("t=0.5");
      const Vec2<double> tip = frame_of(s, n - 1).point(Vec2<double>{0.5, 0});
      EXPECT_NEAR(tip.x, want.at("tip")[0].get<double>(), 1e-10 * n) << n;
      EXPECT_NEAR(tip.y, want.at("tip")[1].get<double>(), 1e-10 * n) << n;
      EXPECT_NEAR(frame_of(s, 0).phi, want.at("phi_1").get<double>(), 1e-10) << n;
      EXPECT_NEAR(rates_of(s, s.qd, 0)[2], want.at("omega_1").get<double>(), 1e-9) << n;
      EXPECT_NEAR(rates_of(s, s.qdd, 0)[2], want.at("alpha_1").get<double>(), 1e-8) << n;
      const Reaction reaction = element_reactions(s, 0).on_j;
      EXPECT_NEAR(reaction.force.x, want.at("R_ground_on_rod1")[0].get<double>(), 1e-9 * 9.81 * n) << n;
      EXPECT_NEAR(reaction.force.y, want.at("R_ground_on_rod1")[1].get<double>(), 1e-9 * 9.81 * n) << n;
    });
  }
}

// IFToMM A01 over 2000 s, some thousand swings.
TEST(DynamicsPendulums, SimplePendulumForTwoThousandSeconds) {
  const auto values = reference_values("A01_udc_2000s");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int ball = model->add_body("ball", {.mass = 1, .position = {1, 0}, .particle = true});
  model->add("link", AbsoluteDistance<>{{0, 0}, {0, 0}}, ball, ground, 1.0);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::list({100, 1000, 2000}), {.velocity = true}, [&](const Snapshot& s) {
    const auto& want = values.at(key("t=%.0f", s.t));
    EXPECT_NEAR(frame_of(s, ball).x, want.at("x").get<double>(), 1e-6) << s.t;
    EXPECT_NEAR(frame_of(s, ball).y, want.at("y").get<double>(), 1e-6) << s.t;
    const double* v = rates_of(s, s.qd, ball);
    const double energy = 0.5 * (v[0] * v[0] + v[1] * v[1]) + 9.81 * frame_of(s, ball).y;
    EXPECT_NEAR(energy, 0, 1e-9 * 9.81) << s.t;
  });
}

// The pole has no inertia: its angle is determined by the cart and the mass at its end.
TEST(DynamicsPendulums, LightCartWithPole) {
  const auto values = reference_values("light_cart_pole");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int cart = model->add_body("cart", {.mass = 1e-6, .inertia = 1e-6});
  const int pole = model->add_body("pole", {.mass = 1, .inertia = 0, .position = {1, 0}});
  model->add("height", AbsoluteY<>{{0, 0}}, cart, ground, 0.0);
  model->add("upright", AbsoluteAngle<>{}, cart, ground, 0.0);
  model->add("pin", Revolute<>{{0, 0}, {-1, 0}}, cart, pole);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::list({0.2, 0.4, 1}), {.velocity = true}, [&](const Snapshot& s) {
    const auto& want = values.at(key(s.t < 1 ? "t=%.1f" : "t=%.0f", s.t));
    EXPECT_NEAR(frame_of(s, cart).x, want.at("x").get<double>(), 1e-9);
    EXPECT_NEAR(frame_of(s, pole).phi + std::numbers::pi / 2, want.at("theta").get<double>(), 1e-9);
  });
}

}  // namespace
}  // namespace catena
