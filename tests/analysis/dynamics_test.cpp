// What a user meets of dynamics besides correct motion: rows, starts, breakpoints, energies, refusals.
#include "catena/analysis/dynamics/dynamics.hpp"

#include <gtest/gtest.h>

#include "catena/columns/energy.hpp"
#include "catena/columns/reaction.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::frame_of;
using testing::rates_of;
using testing::rod_chain;
using testing::run_dynamics;

AnalysisReport run_silently(Dynamics& dynamics, const TimeGrid& grid) {
  RowFunction none([](const Snapshot&) { return true; });
  return dynamics.run(grid, {}, none);
}

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts) {
    if (text.find(part) != std::string::npos) return true;
  }
  return false;
}

// Rows between steps are as good as rows where the integrator was made to stop.
TEST(Dynamics, RowsBetweenStepsKeepTheOrder) {
  for (const IntegrationMethod method : testing::all_methods) {
    const DynamicsOptions options{.method = method, .tolerance = 1e-9};
    Dynamics dense(rod_chain(3), {}, options);
    std::vector<double> angle, rate;
    run_dynamics(dense, TimeGrid::range(0, 1, 0.01), {.velocity = true}, [&](const Snapshot& s) {
      angle.push_back(frame_of(s, 2).phi);
      rate.push_back(rates_of(s, s.qd, 2)[2]);
    });
    for (const std::size_t k : {3u, 37u, 71u, 99u}) {
      Dynamics stopping(rod_chain(3), {}, {.method = method, .tolerance = 1e-12});
      run_dynamics(stopping, TimeGrid::instant(0.01 * static_cast<double>(k)), {.velocity = true},
                   [&](const Snapshot& s) {
                     EXPECT_NEAR(angle[k], frame_of(s, 2).phi, 1e-8) << k;
                     EXPECT_NEAR(rate[k], rates_of(s, s.qd, 2)[2], 1e-7) << k;
                   });
    }
  }
}

TEST(Dynamics, RowsMeetTheConstraints) {
  Dynamics dynamics(rod_chain(5), {}, {.tolerance = 1e-4});
  run_dynamics(dynamics, TimeGrid::range(0, 1, 0.013), {.velocity = true}, [&](const Snapshot& s) {
    for (int k = 1; k < 5; ++k) {
      const Vec2<double> gap =
          frame_of(s, k).point(Vec2<double>{-0.5, 0}) - frame_of(s, k - 1).point(Vec2<double>{0.5, 0});
      EXPECT_LT(norm(gap), 1e-13) << s.t;
    }
  });
}

// A driving torque that jumps at 0.3 s: the motion is a parabola on either side.
TEST(Dynamics, JumpsOfFunctionsOfTimeLoseNoOrder) {
  auto model = std::make_shared<Model>();
  const int wheel = model->add_body("wheel", {.mass = 1, .inertia = 0.5});
  model->add("axle", Revolute<>{}, ground, wheel);
  const auto torque = TimeFunction<double>::custom(
      [](double t) {
        return Taylor<double>{t < 0.3 ? 1.0 : -2.0, 0.0, 0.0};
      },
      {0.3});
  model->add_force("motor", Torque<>{}, wheel, ground, {torque});
  for (const IntegrationMethod method : testing::all_methods) {
    Dynamics dynamics(model, {}, {.method = method, .tolerance = 1e-10});
    const AnalysisReport report =
        run_dynamics(dynamics, TimeGrid::list({0.2, 1}), {.velocity = true}, [&](const auto& s) {
          const double late = std::max(0.0, s.t - 0.3), early = s.t - late;
          EXPECT_NEAR(rates_of(s, s.qd, wheel)[2], 2 * early - 4 * late, 1e-10) << s.t << " " << to_string(method);
          EXPECT_NEAR(frame_of(s, wheel).phi, early * early + 2 * early * late - 2 * late * late, 1e-10) << s.t;
        });
    EXPECT_EQ(report.counters.rejected, 0) << to_string(method);
  }
}

TEST(Dynamics, EnergyBalanceWithDamperLoadAndDriver) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int arm = model->add_body("arm", {.mass = 2, .inertia = 0.2, .position = {0.5, 0}});
  const int rod = model->add_body("rod", {.mass = 1, .inertia = 0.1, .position = {1.5, 0}});
  model->add("O", Revolute<>{{0, 0}, {-0.5, 0}}, ground, arm);
  model->add("A", Revolute<>{{0.5, 0}, {-0.5, 0}}, arm, rod);
  model->add_driver("drive", AbsoluteAngle<>{}, arm, ground, TimeFunction<double>::harmonic(0.4, 5));
  SpringDamper<> damper;
  damper.s_i = {2, 1};
  damper.s_j = {0.5, 0};
  damper.k = 20;
  damper.c = 3;
  damper.complete({}, make_frame(1.5, 0.0, 0.0));
  model->add_force("spring", damper, ground, rod, {TimeFunction<double>::harmonic(2, 3)});
  PointForce<> follower;
  follower.s_i = {0.5, 0};
  follower.in_body_axes = true;
  model->add_force("jet", follower, rod, ground, {TimeFunction<double>(0.0), TimeFunction<double>(1.5)});
  for (const IntegrationMethod method : testing::all_methods) {
    Dynamics dynamics(model, {}, {.method = method, .tolerance = 1e-10});
    double exchanged = 0;
    run_dynamics(dynamics, TimeGrid::range(0, 2, 0.07), {.velocity = true, .work = true}, [&](const Snapshot& s) {
      const double balance = total_energy(s) - s.initial_energy - s.work + s.dissipated;
      EXPECT_NEAR(balance, 0, 1e-8) << s.t << " " << to_string(method);
      exchanged = std::max({exchanged, std::abs(s.work), s.dissipated});
    });
    EXPECT_GT(exchanged, 1) << "nothing was balanced";
  }
}

TEST(Dynamics, GivenVelocitiesAreKeptOmittedOnesGetTheLeastEnergy) {
  auto model = rod_chain(2);
  model->bodies[0].angular_velocity = 3;
  model->bodies[0].angular_velocity_given = true;
  Dynamics dynamics(model);
  const AnalysisReport report = run_dynamics(dynamics, TimeGrid::instant(0), {.velocity = true}, [](const Snapshot& s) {
    EXPECT_NEAR(rates_of(s, s.qd, 0)[2], 3, 1e-12);
    EXPECT_NEAR(rates_of(s, s.qd, 0)[1], 1.5, 1e-12);
    // The second rod's pin moves with 3 m/s; least energy is that of a rod struck there: omega = -3/2 of v / l.
    EXPECT_NEAR(rates_of(s, s.qd, 1)[2], -4.5, 1e-12);
    EXPECT_NEAR(rates_of(s, s.qd, 1)[1], 0.75, 1e-12);
  });
  EXPECT_TRUE(report.warnings.empty());
}

TEST(Dynamics, SaysWhatItChangedAtTheStart) {
  auto model = rod_chain(2);
  model->bodies[1].position.x += 0.02;
  model->bodies[0].velocity = {1, 0};  // along the rod: the pin forbids it
  model->bodies[0].velocity_given = true;
  Dynamics dynamics(model);
  const AnalysisReport report = run_dynamics(dynamics, TimeGrid::instant(0.1), {}, [](const Snapshot&) {});
  EXPECT_TRUE(mentions(report.warnings, "assembled first"));
  EXPECT_TRUE(mentions(report.warnings, "rod1"));
}

TEST(Dynamics, RefusesMissingMassByName) {
  auto model = std::make_shared<Model>();
  model->add_body("plate", {.mass = 1});
  Dynamics without_inertia(model);
  const AnalysisReport report = run_silently(without_inertia, TimeGrid::instant(1));
  EXPECT_EQ(report.status, Status::refused);
  EXPECT_NE(report.message.find("\"plate\" has a mass but no inertia"), std::string::npos) << report.message;
  model->bodies[0].particle = true;
  Dynamics particle(model);
  EXPECT_TRUE(run_silently(particle, TimeGrid::instant(1)).ok());
}

TEST(Dynamics, RefusesMassesThatNothingDetermines) {
  auto model = rod_chain(2);
  model->bodies[1].mass = model->bodies[1].inertia = 0;
  Dynamics dynamics(model);
  const AnalysisReport report = run_silently(dynamics, TimeGrid::instant(1));
  EXPECT_EQ(report.status, Status::refused);
  EXPECT_NE(report.message.find("rod2"), std::string::npos) << report.message;
}

TEST(Dynamics, RefusesTolerancesBelowDoublePrecision) {
  Dynamics dynamics(rod_chain(1), {}, {.tolerance = 1e-15});
  EXPECT_EQ(run_silently(dynamics, TimeGrid::instant(1)).status, Status::refused);
}

TEST(Dynamics, CancelKeepsTheRows) {
  Dynamics dynamics(rod_chain(2));
  int rows = 0;
  RowFunction some([&](const Snapshot&) { return ++rows < 4; });
  EXPECT_EQ(dynamics.run(TimeGrid::range(0, 1, 0.1), {}, some).status, Status::cancelled);
  EXPECT_EQ(rows, 4);
}

// A pin doubled: the motion is that of one pin, each carries half of its force.
TEST(Dynamics, DoubledPinsShareTheirForce) {
  auto model = rod_chain(2);
  const int twin = model->add("twin", Revolute<>{{0, 0}, {-0.5, 0}}, ground, 0);
  Dynamics doubled(model, {}, {.tolerance = 1e-10}), plain(rod_chain(2), {}, {.tolerance = 1e-10});
  double angle = 0;
  Vec2<double> whole;
  run_dynamics(plain, TimeGrid::instant(0.7), {.multipliers = true}, [&](const Snapshot& s) {
    angle = frame_of(s, 1).phi;
    whole = element_reactions(s, 0).on_j.force;
  });
  const AnalysisReport report =
      run_dynamics(doubled, TimeGrid::instant(0.7), {.multipliers = true}, [&](const auto& s) {
        EXPECT_NEAR(frame_of(s, 1).phi, angle, 1e-9);
        for (const int pin : {0, twin}) {
          EXPECT_NEAR(element_reactions(s, pin).on_j.force.x, whole.x / 2, 1e-7);
          EXPECT_NEAR(element_reactions(s, pin).on_j.force.y, whole.y / 2, 1e-7);
        }
      });
  EXPECT_TRUE(mentions(report.warnings, "\"pin1\", \"twin\"")) << report.warnings.size();
  EXPECT_FALSE(mentions(report.warnings, "pin2"));
  EXPECT_EQ(report.dof, 2);
}

TEST(Dynamics, GoesOnFromAnEarlierState) {
  Dynamics whole(rod_chain(2), {}, {.tolerance = 1e-11}), first(rod_chain(2), {}, {.tolerance = 1e-11}),
      second(rod_chain(2), {}, {.tolerance = 1e-11});
  run_silently(whole, TimeGrid::instant(1));
  run_silently(first, TimeGrid::instant(0.4));
  second.start_from(first.state());
  run_silently(second, TimeGrid::instant(1));
  const SystemState a = whole.state(), b = second.state();
  for (std::size_t k = 0; k < a.q.size(); ++k) {
    EXPECT_NEAR(a.q[k], b.q[k], 1e-9);
    EXPECT_NEAR(a.qd[k], b.qd[k], 1e-8);
  }
}

TEST(Dynamics, FixedStepConvergesWithItsOrder) {
  const auto error = [](double step) {
    Dynamics fixed(rod_chain(2), {}, {.method = IntegrationMethod::rk5, .step = step}),
        exact(rod_chain(2), {}, {.tolerance = 1e-13});
    run_silently(fixed, TimeGrid::instant(0.5));
    run_silently(exact, TimeGrid::instant(0.5));
    return std::abs(fixed.state().q[5] - exact.state().q[5]);
  };
  const double coarse = error(0.05), fine = error(0.025);
  EXPECT_GT(coarse / fine, 16);
  EXPECT_LT(coarse, 1e-3);
}

}  // namespace
}  // namespace catena
