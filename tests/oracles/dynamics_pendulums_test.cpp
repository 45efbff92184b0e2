// Pendulums against their independent solutions in data/reference.
#include <map>

#include "catena/columns/reaction.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
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
  run_dynamics(dynamics, TimeGrid::list({0.25, 0.5, 1.0, 2.0}), {.acceleration = true, .multipliers = true},
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

/// What a reference that is good to so many digits at time t may be missed by, relative to the size of things.
double allowed(double digits, double t) { return std::max(std::pow(10, 2 - digits), t < 10 ? 1e-11 : 1e-10); }

std::map<double, nlohmann::json> by_time(const std::string& reference) {
  std::map<double, nlohmann::json> rows;
  const nlohmann::json values = reference_values(reference);
  for (const auto& [name, row] : values.items()) rows[std::stod(name.substr(2))] = row;
  return rows;
}

TimeGrid times_of(const std::map<double, nlohmann::json>& rows) {
  std::vector<double> times;
  for (const auto& row : rows) times.push_back(row.first);
  return TimeGrid::list(times);
}

void expect_force(const Reaction& reaction, const nlohmann::json& want, double relative, double t) {
  const double x = want[0].get<double>(), y = want[1].get<double>(), size = std::hypot(x, y);
  EXPECT_NEAR(reaction.force.x, x, relative * size) << t;
  EXPECT_NEAR(reaction.force.y, y, relative * size) << t;
}

// Point masses on massless links: particles held at distances.
TEST(DynamicsPendulums, DoubleOfPoints) {
  const auto rows = by_time("double_pendulum_points");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int first = model->add_body("first", {.mass = 1, .position = {1, 0}, .particle = true});
  const int second = model->add_body("second", {.mass = 1, .position = {2, 0}, .particle = true});
  model->add("upper", AbsoluteDistance<>{{0, 0}, {0, 0}}, first, ground, 1.0);
  const int lower = model->add("lower", RelativeDistance<>{{0, 0}, {0, 0}}, first, second, 1.0);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, times_of(rows), {.multipliers = true}, [&](const Snapshot& s) {
    const auto& want = rows.at(s.t);
    const double near = allowed(want.at("absolute_digits"), s.t);
    EXPECT_NEAR(frame_of(s, second).x, want.at("tip")[0].get<double>(), near) << s.t;
    EXPECT_NEAR(frame_of(s, second).y, want.at("tip")[1].get<double>(), near) << s.t;
    expect_force(element_reactions(s, lower).on_j, want.at("R_1_on_2"), 10 * near, s.t);
  });
}

TEST(DynamicsPendulums, DoubleOfRods) {
  const auto rows = by_time("double_pendulum_rods");
  Dynamics dynamics(rod_chain(2), {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, times_of(rows), {.acceleration = true, .multipliers = true}, [&](const Snapshot& s) {
    const auto& want = rows.at(s.t);
    const double near = allowed(want.at("absolute_digits"), s.t);
    for (const int k : {0, 1}) {
      const std::string number = std::to_string(k + 1);
      const auto value = [&](const char* name) { return want.at(name + number).get<double>(); };
      EXPECT_NEAR(frame_of(s, k).phi + std::numbers::pi / 2, value("theta"), near) << s.t;
      EXPECT_NEAR(rates_of(s, s.qd, k)[2], value("omega"), near * 10) << s.t;
      EXPECT_NEAR(rates_of(s, s.qdd, k)[2], value("alpha"), near * 100) << s.t;
    }
    expect_force(element_reactions(s, 0).on_j, want.at("R_ground_on_1"), near, s.t);
    expect_force(element_reactions(s, 1).on_j, want.at("R_1_on_2"), near, s.t);
  });
}

void check_chain(const std::string& reference, int n, double length, double mass) {
  const auto rows = by_time(reference);
  Dynamics dynamics(rod_chain(n, length, mass), {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, times_of(rows), {.acceleration = true, .multipliers = true}, [&](const Snapshot& s) {
    const auto& want = rows.at(s.t);
    const double near = allowed(want.at("relative_digits"), s.t);
    const auto value = [&](const char* name) { return want.at(name).get<double>(); };
    const Vec2<double> tip = frame_of(s, n - 1).point(Vec2<double>{length / 2, 0});
    EXPECT_NEAR(tip.x, want.at("tip")[0].get<double>(), near * n * length) << s.t;
    EXPECT_NEAR(tip.y, want.at("tip")[1].get<double>(), near * n * length) << s.t;
    EXPECT_NEAR(frame_of(s, 0).phi, value("phi_1"), near) << s.t;
    EXPECT_NEAR(frame_of(s, n - 1).phi, value("phi_N"), near) << s.t;
    // Rates and accelerations of the chain are compared with the larger of those of its ends.
    const double rate = std::max(std::abs(value("omega_1")), std::abs(value("omega_N")));
    const double second = std::max(std::abs(value("alpha_1")), std::abs(value("alpha_N")));
    EXPECT_NEAR(rates_of(s, s.qd, 0)[2], value("omega_1"), near * rate) << s.t;
    EXPECT_NEAR(rates_of(s, s.qd, n - 1)[2], value("omega_N"), near * rate) << s.t;
    EXPECT_NEAR(rates_of(s, s.qdd, 0)[2], value("alpha_1"), near * second) << s.t;
    EXPECT_NEAR(rates_of(s, s.qdd, n - 1)[2], value("alpha_N"), near * second) << s.t;
    const auto& pin = want.at("R_ground_on_rod1");
    expect_force(element_reactions(s, 0).on_j, pin, near, s.t);
    const double size = std::hypot(pin[0].get<double>(), pin[1].get<double>());
    const Reaction middle = element_reactions(s, n / 2).on_j;
    EXPECT_NEAR(middle.force.x, want.at("R_on_rod_mid_plus_1")[0].get<double>(), near * size) << s.t;
    EXPECT_NEAR(middle.force.y, want.at("R_on_rod_mid_plus_1")[1].get<double>(), near * size) << s.t;
  });
}

TEST(DynamicsPendulums, ChainOfFive) { check_chain("npendulum_N5", 5, 1, 1); }
TEST(DynamicsPendulums, ChainOfTen) { check_chain("npendulum_N10", 10, 1, 1); }
TEST(DynamicsPendulums, ChainOfForty) { check_chain("npendulum_N40", 40, 1, 1); }
TEST(DynamicsPendulums, ChainOfFortyShortLinks) { check_chain("npendulum_N40_total1m", 40, 0.025, 0.025); }

// Released from the horizontal: at every angle on the way down, rate, acceleration and pin force are closed forms.
TEST(DynamicsPendulums, FallingRod) {
  const auto values = reference_values("falling_rod_pin_reaction");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int rod = model->add_body("rod", {.mass = 3, .inertia = 1, .position = {1, 0}});
  const int pin = model->add("pin", Revolute<>{{0, 0}, {-1, 0}}, ground, rod);
  for (const auto& item : values.items()) {
    const std::string& name = item.key();
    const nlohmann::json& want = item.value();
    const double angle = std::stod(name.substr(3)) * std::numbers::pi / 180;
    // Where the motion is at this angle: one Newton step on the time of a run that ended beside it.
    double t = angle > 0 ? 0.5 : 0, alpha = 0;
    for (int k = 0; k < 8 && angle > 0; ++k) {
      Dynamics dynamics(model, {}, {.tolerance = 1e-13});
      run_dynamics(dynamics, TimeGrid::instant(t), {.velocity = true},
                   [&](const Snapshot& s) { t -= (frame_of(s, rod).phi + angle) / rates_of(s, s.qd, rod)[2]; });
    }
    Dynamics dynamics(model, {}, {.tolerance = 1e-13});
    run_dynamics(dynamics, TimeGrid::instant(t), {.acceleration = true, .multipliers = true}, [&](const Snapshot& s) {
      EXPECT_NEAR(frame_of(s, rod).phi, -angle, 1e-12) << name;
      EXPECT_NEAR(-rates_of(s, s.qd, rod)[2], want.at("omega").get<double>(), 4e-9) << name;
      alpha = -rates_of(s, s.qdd, rod)[2];
      const Vec2<double> force = element_reactions(s, pin).on_j.force, axis = frame_of(s, rod).axis(Vec2<double>{1, 0});
      EXPECT_NEAR(-dot(force, axis), want.at("R_axial_toward_pin").get<double>(), 1e-9 * 73.575) << name;
      EXPECT_NEAR(cross(axis, force), want.at("R_transverse_up").get<double>(), 1e-9 * 73.575) << name;
    });
    EXPECT_NEAR(alpha, want.at("alpha").get<double>(), 1e-9 * 7.3575) << name;
  }
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
  // It passes the bottom eleven times, at 4429 rad/s.
  run_dynamics(dynamics, TimeGrid::list({0.2, 0.4, 1, 2.5, 5, 10}), {.velocity = true}, [&](const Snapshot& s) {
    const auto& want = values.at(key("t=%g", s.t));
    const auto close = [&](double got, const char* name) {
      const double value = want.at(name).get<double>();
      EXPECT_NEAR(got, value, 1e-9 * std::max(1.0, std::abs(value))) << name << " at " << s.t;
    };
    close(frame_of(s, cart).x, "x");
    close(frame_of(s, pole).phi + std::numbers::pi / 2, "theta");
    close(rates_of(s, s.qd, pole)[2], "theta_dot");
    close(rates_of(s, s.qd, cart)[0], "x_dot");
  });
}

}  // namespace
}  // namespace catena
