// Dynamics at the ends of what users build: masses and lengths of all sizes, very long chains, many rows, starts in
// singular positions.
#include <sys/resource.h>

#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::four_bars;
using testing::frame_of;
using testing::rates_of;
using testing::rod_chain;
using testing::run_dynamics;

double last_angle(const std::shared_ptr<Model>& model, int body, double until) {
  double angle = std::nan("");
  Dynamics dynamics(model, {}, {.tolerance = 1e-10});
  run_dynamics(dynamics, TimeGrid::instant(until), {}, [&](const Snapshot& s) { angle = frame_of(s, body).phi; });
  return angle;
}

// A rod at the end of one that is 10^12 times as heavy does not disturb it.
TEST(DynamicsExtremes, AHeavyRodIgnoresALightOne) {
  const auto model = rod_chain(2);
  model->bodies[0].mass *= 1e12;
  model->bodies[0].inertia *= 1e12;
  EXPECT_NEAR(last_angle(model, 0, 1), last_angle(rod_chain(1), 0, 1), 1e-9);
}

// A light rod that carries a heavy one is all but a massless link: its own mass changes the motion by 10^-6.
TEST(DynamicsExtremes, ALightRodCarriesAHeavyOne) {
  const auto carried = [](double factor) {
    auto model = rod_chain(2);
    model->bodies[0].mass *= factor;
    model->bodies[0].inertia *= factor;
    return model;
  };
  const double nothing = last_angle(carried(0), 1, 1), little = last_angle(carried(1e-6), 1, 1) - nothing;
  EXPECT_NEAR(little, 0, 1e-6);
  EXPECT_NEAR(1000 * little, last_angle(carried(1e-3), 1, 1) - nothing, 1e-5) << "in proportion to its mass";
  EXPECT_GT(std::abs(last_angle(carried(1), 1, 1) - nothing), 1e-3);
}

// A pendulum s times as long swings sqrt(s) times as slowly.
TEST(DynamicsExtremes, LengthsFromMicrometresToMegametres) {
  const double angle = last_angle(rod_chain(3), 2, 1);
  for (const double length : {1e-6, 1e-3, 1e3, 1e6}) {
    EXPECT_NEAR(last_angle(rod_chain(3, length), 2, std::sqrt(length)), angle, 1e-8) << length;
  }
}

TEST(DynamicsExtremes, AChainOfAHundredThousandRods) {
  const int n = 100000;
  Dynamics dynamics(rod_chain(n), {}, {.method = IntegrationMethod::rk5, .step = 1e-3});
  const AnalysisReport report =
      run_dynamics(dynamics, TimeGrid::instant(0.1), {.velocity = true}, [&](const Snapshot& s) {
        // Far from its pin it falls freely.
        EXPECT_NEAR(frame_of(s, n - 1).y, -0.5 * 9.81 * s.t * s.t, 1e-9);
        EXPECT_NEAR(rates_of(s, s.qd, n - 1)[1], -9.81 * s.t, 1e-9);
        EXPECT_LT(s.residual, 1e-8);
        double drop = 0, energy = 0;
        for (int k = 0; k < n; ++k) {
          const double* v = rates_of(s, s.qd, k);
          energy += 0.5 * (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2] / 24;
          drop -= frame_of(s, k).y;
        }
        EXPECT_NEAR(energy, 9.81 * drop, 1e-9 * energy);
      });
  EXPECT_EQ(report.counters.steps, 100);
}

// The flat position itself as the start: of the two branches that meet there the velocities say which is meant.
TEST(DynamicsExtremes, StartInTheFlatPosition) {
  const auto model = four_bars(2);
  const double speed = 4;
  for (std::size_t k = 0; k < 5; ++k) {  // three cranks, then two bars
    BasicBody<double>& body = model->bodies[k];
    const bool crank = k < 3;
    body.position = {crank ? static_cast<double>(k) + 0.5 : static_cast<double>(k) - 1.5, 0};
    body.angle = 0;
    body.velocity = {0, crank ? -speed / 2 : -speed};
    body.angular_velocity = crank ? -speed : 0;
  }
  Dynamics dynamics(model, {}, {.tolerance = 1e-8});
  const double inertia = 3.0 / 3 + 2, weight = 9.81 * (3 * 0.5 + 2);
  run_dynamics(dynamics, TimeGrid::range(0, 3, 0.1), {.velocity = true}, [&](const Snapshot& s) {
    const double angle = frame_of(s, 0).phi, rate = rates_of(s, s.qd, 0)[2];
    // Still a parallelogram, with the energy of one.
    EXPECT_NEAR(frame_of(s, 2).phi, angle, 1e-7) << s.t;
    EXPECT_NEAR(frame_of(s, 3).phi, 0, 1e-7) << s.t;
    EXPECT_NEAR(0.5 * inertia * rate * rate + weight * std::sin(angle), 0.5 * inertia * speed * speed, 1e-6) << s.t;
  });
}

TEST(DynamicsExtremes, AMillionRowsTakeNoMemory) {
  Dynamics dynamics(rod_chain(2));
  RowFunction none([](const Snapshot&) { return true; });
  ASSERT_TRUE(dynamics.run(TimeGrid::instant(0.01), {}, none).ok());
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  std::int64_t rows = 0;
  RowFunction count([&](const Snapshot&) {
    ++rows;
    return true;
  });
  EXPECT_TRUE(dynamics.run(TimeGrid::range(0.01, 1.01, 1e-6), {.velocity = true}, count).ok());
  getrusage(RUSAGE_SELF, &after);
  EXPECT_GE(rows, 1000000);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 4096) << "kilobytes";
}

}  // namespace
}  // namespace catena
