// Motions in which some loads move nothing: what they did was once taken for errors of the motion, or its rounding for
// a motion. Closed forms.
#include "catena/columns/energy.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::all_methods;
using testing::four_bars;
using testing::frame_of;
using testing::rates_of;
using testing::rod_chain;

std::string name_of(IntegrationMethod method) { return std::string(to_string(method)); }

/// The energy that a motion does not account for, J.
double balance_of(const Snapshot& s) { return total_energy(s) - s.initial_energy - s.work + s.dissipated; }

/// A block on the same upright guide twice, with a torque that swings and turns nothing; its angle is far from zero.
std::shared_ptr<Model> block_on_guides() {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int block = model->add_body("block", {.mass = 2, .inertia = 3, .position = {0, 0}, .angle = 3});
  const Vec2<double> axis{std::cos(std::numbers::pi / 2 - 3), std::sin(std::numbers::pi / 2 - 3)};
  for (int n = 0; n < 2; ++n) model->add("", Translational<>{{0, 0}, {0, 0}, {0, 1}, axis}, ground, block);
  model->add_force("twist", Torque<>{}, block, ground, {TimeFunction<double>::harmonic(5, 40, 0.3)});
  return model;
}

// The work of the torque, and with it the balance of energy, is as good as the motion; between steps as well.
TEST(RestingLoads, ATorqueThatTurnsNothingDoesNoWork) {
  for (const IntegrationMethod method : all_methods) {
    for (const double tolerance : {1e-4, 1e-8, 1e-11}) {
      Dynamics dynamics(block_on_guides(), {}, {.method = method, .tolerance = tolerance});
      double place = 0, balance = 0;
      RowFunction rows([&](const Snapshot& s) {
        place = std::max(place, std::abs(frame_of(s, 0).y + 0.5 * 9.81 * s.t * s.t));
        balance = std::max(balance, std::abs(balance_of(s)));
        return true;
      });
      const AnalysisReport report = dynamics.run(TimeGrid::range(0, 1, 0.03), {.velocity = true, .work = true}, rows);
      ASSERT_TRUE(report.ok()) << name_of(method) << " " << tolerance << ": " << report.message;
      EXPECT_LE(place, 10 * tolerance) << name_of(method) << " " << tolerance;
      EXPECT_LE(balance, 10 * tolerance * 200 + 1e-12) << name_of(method) << " " << tolerance;
    }
  }
}

/// A pendulum beside a base that is welded to the ground twice and held once more, and a rod that is pinned to the
/// base: rows of the base hold nothing.
std::shared_ptr<Model> pendulum_on_a_base() {
  auto model = rod_chain(1);
  const int base = model->add_body("base", {.mass = 1, .inertia = 1, .position = {1, 1}});
  const int rod = model->add_body("rod", {.mass = 1, .inertia = 1.0 / 12, .position = {1.5, 1}});
  for (int n = 0; n < 2; ++n) model->add("", Weld<>{{1, 1}, {0, 0}}, ground, base);
  model->add("", AbsoluteY<>{}, base);
  model->add("", AbsoluteAngle<>{}, base);
  model->add("", Revolute<>{{0, 0}, {-0.5, 0}}, base, rod);
  model->add("", Revolute<>{{1, 1}, {-0.5, 0}}, ground, rod);
  return model;
}

TEST(RestingLoads, RowsBetweenImmobileBodiesAreLeftAlone) {
  for (const IntegrationMethod method : all_methods) {
    Dynamics dynamics(pendulum_on_a_base(), {}, {.method = method, .tolerance = 1e-9});
    RowFunction rows([&](const Snapshot& s) {
      for (const int rod : {0, 2}) {
        // From level: half of the moment of inertia about the pin, times the square of the rate, is the work of the
        // weight.
        const double angle = frame_of(s, rod).phi, rate = rates_of(s, s.qd, rod)[2];
        EXPECT_NEAR(rate * rate / 6, -9.81 / 2 * std::sin(angle), 1e-7) << name_of(method);
      }
      EXPECT_NEAR(frame_of(s, 0).phi, frame_of(s, 2).phi, 1e-7) << name_of(method);
      return true;
    });
    const AnalysisReport report = dynamics.run(TimeGrid::range(0, 1, 0.1), {.velocity = true}, rows);
    EXPECT_TRUE(report.ok()) << name_of(method) << ": " << report.message;
    EXPECT_EQ(report.dof, 2) << name_of(method);
  }
}

/// Two rods that hold each other, nearly level: immobile, with a pivot ratio of about the square of the rise.
std::shared_ptr<Model> flat_truss(double rise) {
  auto model = std::make_shared<Model>();
  model->gravity = {0.4, -9.81};
  const double length = std::hypot(1, rise), slope = std::atan(rise);
  const int a = model->add_body("a", {.mass = 3, .inertia = 0.2, .position = {0.5, rise / 2}, .angle = slope});
  const int b = model->add_body("b", {.mass = 1, .inertia = 0.1, .position = {1.5, rise / 2}, .angle = -slope});
  model->add("", Revolute<>{{0, 0}, {-length / 2, 0}}, ground, a);
  model->add("", Revolute<>{{length / 2, 0}, {-length / 2, 0}}, a, b);
  model->add("", Revolute<>{{2, 0}, {length / 2, 0}}, ground, b);
  return model;
}

TEST(RestingLoads, AnIllConditionedTrussStandsStill) {
  for (const IntegrationMethod method : all_methods) {
    for (const double rise : {0.3, 0.1, 0.03, 0.01}) {
      for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
        // What is not kept on the constraints drifts by 1e-12 of the size in that time.
        if (method == IntegrationMethod::baumgarte && tolerance < 1e-11) continue;
        Dynamics dynamics(flat_truss(rise), {}, {.method = method, .tolerance = tolerance, .max_steps = 2000});
        RowFunction rows([&](const Snapshot& s) {
          EXPECT_NEAR(frame_of(s, 0).phi, std::atan(rise), tolerance) << name_of(method);
          return true;
        });
        const AnalysisReport report = dynamics.run(TimeGrid::range(0, 1, 0.1), {}, rows);
        EXPECT_TRUE(report.ok()) << name_of(method) << " " << rise << " " << tolerance << ": " << report.message;
      }
    }
  }
}

// The flat position itself as the start: of the two branches that meet there the velocities say which is meant, and no
// method takes the usual pivots for those of a start beside them.
TEST(RestingLoads, AStartInTheFlatPositionIsNoUsualPlace) {
  constexpr double speed = 4;
  const auto model = four_bars(2);
  for (std::size_t k = 0; k < 5; ++k) {  // three cranks, then two bars
    BasicBody<double>& body = model->bodies[k];
    const bool crank = k < 3;
    body.position = {crank ? static_cast<double>(k) + 0.5 : static_cast<double>(k) - 1.5, 0};
    body.angle = 0;
    body.velocity = {0, crank ? -speed / 2 : -speed};
    body.angular_velocity = crank ? -speed : 0;
  }
  const double inertia = 3.0 / 3 + 2, weight = 9.81 * (3 * 0.5 + 2);
  for (const IntegrationMethod method : all_methods) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      Dynamics dynamics(model, {}, {.method = method, .tolerance = tolerance});
      double error = 0;
      RowFunction rows([&](const Snapshot& s) {
        const double angle = frame_of(s, 0).phi, rate = rates_of(s, s.qd, 0)[2];
        // Still a parallelogram, with the energy of one.
        error = std::max({error, std::abs(frame_of(s, 2).phi - angle), std::abs(frame_of(s, 3).phi),
                          std::abs(0.5 * inertia * (rate * rate - speed * speed) + weight * std::sin(angle)) /
                              (inertia * speed * speed)});
        return true;
      });
      const AnalysisReport report = dynamics.run(TimeGrid::range(0, 3, 0.1), {.velocity = true}, rows);
      EXPECT_TRUE(report.ok()) << name_of(method) << " " << tolerance << ": " << report.message;
      EXPECT_LE(error, 10 * tolerance) << name_of(method) << " " << tolerance;
    }
  }
}

}  // namespace
}  // namespace catena
