// Functions of time are asked for no instant outside the run, whatever is done at its ends: starts and ends in singular
// positions, differences taken there, work between rows.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/parallelogram.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/kinematics/minimum_norm_motion.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// A function of time that keeps when it was asked.
struct Watched {
  std::shared_ptr<TimeRange> asked = std::make_shared<TimeRange>(
      TimeRange{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
  TimeFunction<double> function;

  template <class F>
  Watched(F f, const TimeRange& domain) {
    const auto note = [f, range = asked](double t) {
      range->first = std::min(range->first, t);
      range->last = std::max(range->last, t);
      return f(t);
    };
    function = TimeFunction<double>::custom(note, {}, domain);
  }
};

/// A parallelogram turned through its flat positions, its crank's angle given from the start.
std::shared_ptr<const Model> driven_parallelogram(const TimeFunction<double>& drive) {
  auto model = std::make_shared<Model>();
  const double start = drive.evaluate(drive.domain().first).f, x = 0.1 * std::cos(start), y = 0.1 * std::sin(start);
  const auto rod = [&](const char* name, double from_x, double from_y, double to_x, double to_y) {
    return model->add_body(name, {.mass = 1,
                                  .inertia = 0.01,
                                  .position = {(from_x + to_x) / 2, (from_y + to_y) / 2},
                                  .angle = std::atan2(to_y - from_y, to_x - from_x)});
  };
  const int crank = rod("crank", 0, 0, x, y), coupler = rod("coupler", x, y, 0.3 + x, y);
  const int rocker = rod("rocker", 0.3, 0, 0.3 + x, y);
  model->add("O", Revolute<>{{0, 0}, {-0.05, 0}}, ground, crank);
  model->add("A", Revolute<>{{0.05, 0}, {-0.15, 0}}, crank, coupler);
  model->add("B", Revolute<>{{0.15, 0}, {0.05, 0}}, coupler, rocker);
  model->add("C", Revolute<>{{0.3, 0}, {-0.05, 0}}, ground, rocker);
  model->add_driver("drive", AbsoluteAngle<>{}, crank, ground, drive);
  return model;
}

RowFunction nothing([](const Snapshot&) { return true; });

// From one flat position to another one, both at ends of the run, and from between.
TEST(WithinTheRun, KinematicsAsksForNothingElse) {
  for (const double from : {0.0, 0.25, 0.3}) {
    for (const bool inverse : {false, true}) {
      const TimeRange run{from, 1};
      Watched drive([](double t) { return Taylor<double>(pi * t, pi, 0); }, run);
      const auto model = driven_parallelogram(drive.function);
      Kinematics kinematics(model, {}, {.inverse_dynamics = inverse, .branch = 1});
      SystemState state;
      state.t = from;
      kinematics.start_from(state);
      const AnalysisReport report =
          kinematics.run(TimeGrid::range(from, 1, 0.1), {.velocity = true, .acceleration = true}, nothing);
      EXPECT_GE(drive.asked->first, from) << report.message;
      EXPECT_LE(drive.asked->last, 1) << report.message;
    }
  }
}

TEST(WithinTheRun, LeastVelocitiesAndDynamicsAskForNothingElse) {
  const TimeRange run{0, 1};
  Watched drive([](double t) { return Taylor<double>(0.3 + pi * t, pi, 0); }, run);
  const auto model = driven_parallelogram(drive.function);
  MinimumNormMotion least(model);
  least.run(TimeGrid::range(0, 1, 0.1), {.velocity = true, .acceleration = true}, nothing);
  EXPECT_GE(drive.asked->first, 0);
  EXPECT_LE(drive.asked->last, 1);
  for (const IntegrationMethod method :
       {IntegrationMethod::rk8, IntegrationMethod::rk5, IntegrationMethod::adams, IntegrationMethod::baumgarte}) {
    Watched again([](double t) { return Taylor<double>(pi * t, pi, 0); }, run);
    Dynamics dynamics(driven_parallelogram(again.function), {}, {.method = method});
    dynamics.run(TimeGrid::range(0, 1, 0.1), {.velocity = true, .acceleration = true, .multipliers = true}, nothing);
    EXPECT_GE(again.asked->first, 0);
    EXPECT_LE(again.asked->last, 1);
  }
}

// A run that a function of time does not cover is refused before it begins, by every analysis, in a status.
TEST(WithinTheRun, AFunctionThatEndsIsRefusedBeforehand) {
  Watched drive([](double t) { return Taylor<double>(0.3 + t, 1, 0); }, {0, 0.5});
  const auto model = driven_parallelogram(drive.function);
  const TimeGrid grid = TimeGrid::range(0, 1, 0.1);
  Kinematics kinematics(model);
  const AnalysisReport refused = kinematics.run(grid, {}, nothing);
  EXPECT_EQ(refused.status, Status::refused);
  EXPECT_NE(refused.message.find("\"drive\" reaches from 0 to 0.5 s"), std::string::npos) << refused.message;
  EXPECT_EQ(MinimumNormMotion(model).run(grid, {}, nothing).status, Status::refused);
  EXPECT_EQ(Dynamics(model).run(grid, {}, nothing).status, Status::refused);
  Kinematics steps(model);
  EXPECT_TRUE(steps.assemble().ok());
  EXPECT_EQ(steps.move_to(0.6).status, Status::refused);
  EXPECT_TRUE(steps.move_to(0.5).ok());
  EXPECT_NEAR(steps.frame(model->find_body("crank")).phi, 0.8, 1e-12);
}

}  // namespace
}  // namespace catena::testing
