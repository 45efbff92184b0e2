// Linkages against their independent solutions in data/reference, and what `tolerance` promises of them.
#include "catena/columns/reaction.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/rack_pinion.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::four_bars;
using testing::frame_of;
using testing::rates_of;
using testing::reference_values;
using testing::run_dynamics;
using testing::squeezer;

/// Largest error of the first crank's end over 20 s, through the flat position some twenty times.
double four_bar_error(int n, const DynamicsOptions& options) {
  const auto values = reference_values("A02_n_four_bar_N" + std::to_string(n));
  double error = 0;
  Dynamics dynamics(four_bars(n), {}, options);
  run_dynamics(dynamics, TimeGrid::range(0, 20, 0.5), {}, [&](const Snapshot& s) {
    char key[16];
    std::snprintf(key, sizeof key, "t=%.1f", s.t);
    if (!values.contains(key)) return;
    const Vec2<double> end = frame_of(s, 0).point(Vec2<double>{0.5, 0});
    error = std::max({error, std::abs(end.x - values.at(key).at("B0x").get<double>()),
                      std::abs(end.y - values.at(key).at("B0y").get<double>())});
  });
  return error;
}

TEST(DynamicsLinkages, FourBarsThroughTheFlatPosition) {
  for (const int n : {2, 40}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      EXPECT_LE(four_bar_error(n, {.tolerance = tolerance}), 10 * tolerance) << n;
    }
  }
}

TEST(DynamicsLinkages, FourBarsByOrderFive) {
  EXPECT_LE(four_bar_error(2, {.method = IntegrationMethod::rk5, .tolerance = 1e-7}), 1e-6);
}

// The Test Set's angles beta, Theta, gamma, Phi, delta, Omega, epsilon: relative ones of K1, K2 - K1, K3, K4 - K5, ...
TEST(DynamicsLinkages, SqueezerAtThirtyMilliseconds) {
  const auto want = reference_values("andrews_t003").at("t=0.03");
  Dynamics dynamics(squeezer(), {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::instant(0.03), {.acceleration = true, .multipliers = true}, [&](const Snapshot& s) {
    const auto relative = [](const double* k) {
      return std::array{k[0], k[1] - k[0], k[2], k[3] - k[4], k[4], k[5] - k[6], k[6]};
    };
    double q[7], v[7], a[7];
    for (int k = 0; k < 7; ++k) {
      q[k] = frame_of(s, k).phi;
      v[k] = rates_of(s, s.qd, k)[2];
      a[k] = rates_of(s, s.qdd, k)[2];
    }
    const auto angles = relative(q), rates = relative(v), seconds = relative(a);
    for (std::size_t k = 0; k < 7; ++k) {
      const auto near = [&](double got, const char* name, double relative_error) {
        const double value = want.at(name)[k].get<double>();
        EXPECT_NEAR(got, value, relative_error * std::abs(value)) << name << " " << k;
      };
      near(angles[k], "q", 1e-10);
      near(rates[k], "v", 1e-9);
      near(seconds[k], "a", 1e-9);
    }
    // The Test Set closes its loops with K2 at K3, K4 and K6; here K3, K4, K6 hang on each other in this order.
    const Vec2<double> on_k3 = element_reactions(s, 2).on_j.force, on_k4 = element_reactions(s, 3).on_j.force,
                       on_k6 = element_reactions(s, 4).on_j.force;
    const Vec2<double> multipliers[] = {on_k3 - on_k4, on_k4 - on_k6, on_k6};
    for (std::size_t k = 0; k < 6; ++k) {
      const double value = want.at("lambda_")[k].get<double>();
      EXPECT_NEAR(k % 2 == 0 ? multipliers[k / 2].x : multipliers[k / 2].y, value, 1e-7 * std::abs(value)) << k;
    }
  });
}

// The Test Set's car axis: two masses on a bar, one of them guided along the upright of an axle that a road lifts.
TEST(DynamicsLinkages, CarAxis) {
  const auto want = reference_values("caraxis_t3").at("t=3");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -1};
  const int axle = model->add_body("axle", {.mass = 1, .inertia = 1});
  const int left = model->add_body("left", {.mass = 5e-4, .position = {0, 0.5}, .particle = true});
  const int right = model->add_body("right", {.mass = 5e-4, .position = {1, 0.5}, .particle = true});
  for (const int wheel : {left, right}) {
    model->bodies[static_cast<std::size_t>(wheel)].velocity = {-0.5, 0};
    model->bodies[static_cast<std::size_t>(wheel)].velocity_given = true;
  }
  model->add("pivot", Revolute<>{}, ground, axle);
  model->add_driver("road", AbsoluteY<>{{1, 0}}, axle, ground, TimeFunction<double>::harmonic(0.1, 10));
  const int guide = model->add("guide", Slot<>{{0, 0}, {0, 0}, {0, 1}}, axle, left, 0.0);
  const int bar = model->add("bar", RelativeDistance<>{}, left, right, 1.0);
  SpringDamper<> spring;
  spring.k = 1;
  spring.length = 0.5;
  model->add_force("left spring", spring, ground, left);
  spring.s_i = {1, 0};
  model->add_force("right spring", spring, axle, right);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::instant(3), {.acceleration = true, .multipliers = true}, [&](const Snapshot& s) {
    const auto near = [&](double got, const char* name) {
      const double value = want.at(name).get<double>();
      EXPECT_NEAR(got, value, 1e-9 * std::abs(value)) << name;
    };
    near(frame_of(s, left).x, "xl");
    near(frame_of(s, left).y, "yl");
    near(frame_of(s, right).x, "xr");
    near(frame_of(s, right).y, "yr");
    near(rates_of(s, s.qd, left)[0], "vxl");
    near(rates_of(s, s.qd, left)[1], "vyl");
    near(rates_of(s, s.qd, right)[0], "vxr");
    near(rates_of(s, s.qd, right)[1], "vyr");
    // Its multipliers: lam1 b pushes the left mass, 2 lam2 (pl - pr) as well.
    near(dot(element_reactions(s, guide).on_j.force, frame_of(s, axle).axis(Vec2<double>{1, 0})), "lam1");
    near(-element_reactions(s, bar).multiplier[0], "lam2");
  });
}

TEST(DynamicsLinkages, SqueezerKeepsItsTolerance) {
  const auto want = reference_values("andrews_t003").at("t=0.03").at("q");
  for (const IntegrationMethod method : {IntegrationMethod::rk8, IntegrationMethod::rk5}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-9}) {
      Dynamics dynamics(squeezer(), {}, {.method = method, .tolerance = tolerance});
      run_dynamics(dynamics, TimeGrid::instant(0.03), {}, [&](const Snapshot& s) {
        EXPECT_NEAR(frame_of(s, 0).phi, want[0].get<double>(), 10 * tolerance);
        EXPECT_NEAR(frame_of(s, 2).phi, want[2].get<double>(), 10 * tolerance);
        EXPECT_NEAR(frame_of(s, 6).phi, want[6].get<double>(), 10 * tolerance);
      });
    }
  }
}

TEST(DynamicsLinkages, RackFallsAndTurnsItsPinion) {
  const auto want = reference_values("rack_pinion_drop");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int rack = model->add_body("rack", {.mass = 3, .inertia = 1, .position = {-0.05, 0}});
  const int pinion = model->add_body("pinion", {.mass = 1, .inertia = 0.004});
  model->add("guide", Translational<>{{-0.05, 0}, {0, 0}, {0, 1}, {0, 1}}, ground, rack);
  model->add("axle", Revolute<>{}, ground, pinion);
  RackPinion<> teeth;
  teeth.axis_i = {0, 1};
  teeth.radius = 0.05;
  teeth.side = -1;
  const int mesh = model->add("teeth", teeth, rack, pinion);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::instant(0.7), {.acceleration = true, .multipliers = true}, [&](const Snapshot& s) {
    EXPECT_NEAR(frame_of(s, rack).y, -want.at("drop").get<double>(), 1e-9);
    EXPECT_NEAR(rates_of(s, s.qd, rack)[1], -want.at("v").get<double>(), 1e-9);
    EXPECT_NEAR(rates_of(s, s.qdd, rack)[1], -want.at("a").get<double>(), 1e-9);
    EXPECT_NEAR(std::abs(frame_of(s, pinion).phi), want.at("pinion_angle").get<double>(), 1e-8);
    EXPECT_NEAR(std::abs(element_reactions(s, mesh).on_i.force.y), want.at("F_tooth").get<double>(), 1e-8);
  });
}

// A driver among the constraints: the motion is the driver's, torque and reactions follow.
TEST(DynamicsLinkages, RodSpunByADriver) {
  const auto values = reference_values("spinning_rod");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int rod = model->add_body("rod", {.mass = 3, .inertia = 1, .position = {1, 0}});
  const int pin = model->add("pin", Revolute<>{{0, 0}, {-1, 0}}, ground, rod);
  const double ramp[] = {0.0, 12.0};
  const int drive = model->add_driver("drive", AbsoluteAngle<>{}, rod, ground, TimeFunction<double>::polynomial(ramp));
  const double degree = std::numbers::pi / 180;
  std::vector<double> times;
  for (const double angle : {0.0, 30.0, 90.0, 200.0}) times.push_back(angle * degree / 12);
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::list(times), {.acceleration = true, .multipliers = true, .work = true},
               [&](const Snapshot& s) {
                 const auto& want = values.at("th_" + std::to_string(std::lround(12 * s.t / degree)) + "deg");
                 const Reaction reaction = element_reactions(s, pin).on_j;
                 EXPECT_NEAR(reaction.force.x, want.at("R")[0].get<double>(), 1e-9 * 432);
                 EXPECT_NEAR(reaction.force.y, want.at("R")[1].get<double>(), 1e-9 * 432);
                 EXPECT_NEAR(-element_reactions(s, drive).multiplier[0], want.at("torque").get<double>(), 1e-9 * 432);
                 // Its work lifts the rod and nothing else.
                 EXPECT_NEAR(s.driver_work[static_cast<std::size_t>(drive)], 3 * 9.81 * std::sin(12 * s.t), 1e-9 * 432);
               });
}

TEST(DynamicsLinkages, FreeFlight) {
  const auto values = reference_values("free_flight_spin");
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int body = model->add_body("body", {.mass = 2, .inertia = 0.3, .position = {0, 1}});
  model->bodies[0].velocity = {3, 5};
  model->bodies[0].angular_velocity = 7;
  model->bodies[0].velocity_given = model->bodies[0].angular_velocity_given = true;
  Dynamics dynamics(model, {}, {.tolerance = 1e-12});
  run_dynamics(dynamics, TimeGrid::list({1, 2}), {.velocity = true}, [&](const Snapshot& s) {
    const auto& want = values.at("t=" + std::to_string(std::lround(s.t)));
    EXPECT_NEAR(frame_of(s, body).x, want.at("x").get<double>(), 1e-12);
    EXPECT_NEAR(frame_of(s, body).y, want.at("y").get<double>(), 1e-12);
    EXPECT_NEAR(frame_of(s, body).phi, want.at("phi").get<double>(), 1e-12) << "whole turns count";
    EXPECT_NEAR(rates_of(s, s.qd, body)[1], want.at("vy").get<double>(), 1e-12);
  });
}

}  // namespace
}  // namespace catena
