// A motion that is taken up where another run paused gives the very same rows: all bits of positions, velocities,
// accelerations, multipliers and energies, by every method, through singular positions, whole turns and jumps of
// forces.
#include <cstring>

#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/columns/energy.hpp"
#include "catena/elements/constraints/cam_cam.hpp"
#include "catena/elements/constraints/cam_flat.hpp"
#include "catena/elements/constraints/point_on_curve.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "oracles/dynamics_mechanisms.hpp"
#include "oracles/redundant_mechanisms.hpp"

namespace catena {
namespace {

using testing::four_bars;
using testing::rod_chain;

constexpr Needs everything{.velocity = true, .acceleration = true, .multipliers = true, .work = true};

struct Rows {
  std::vector<double> values;
  std::size_t size = 0;  // of a row

  void add(const Snapshot& s) {
    const std::size_t before = values.size();
    values.push_back(s.t);
    for (const std::span<const double> part : {s.q, s.qd, s.qdd, s.lambda, s.driver_work}) {
      values.insert(values.end(), part.begin(), part.end());
    }
    for (const double value : {total_energy(s), s.initial_energy, s.work, s.dissipated, s.residual})
      values.push_back(value);
    size = values.size() - before;
  }
};

struct Outcome {
  Rows rows;
  std::vector<MotionMemory> memories;
  double end = 0;
};

Outcome run(const std::shared_ptr<Model>& model, const DynamicsOptions& options, const TimeGrid& grid, double every,
            const MotionMemory* from = nullptr) {
  Outcome result;
  DynamicsWithEvents dynamics(model, {}, options, {}, {.analysis = "dynamics"});
  dynamics.pause({every, [&](const MotionMemory& memory) { result.memories.push_back(memory); }});
  if (from) dynamics.resume(*from);
  RowFunction keep([&](const Snapshot& s) {
    result.rows.add(s);
    return true;
  });
  const AnalysisReport report = dynamics.run(grid, everything, keep);
  EXPECT_TRUE(report.ok()) << report.message;
  result.end = dynamics.state().t;
  return result;
}

/// Takes the motion up at every one of its pauses.
void check(const std::shared_ptr<Model>& model, double until, double every, IntegrationMethod method, double step = 0) {
  const DynamicsOptions options{.method = method, .tolerance = 1e-8, .step = step};
  const TimeGrid grid = TimeGrid::range(0, until, until / 150);
  const Outcome whole = run(model, options, grid, every);
  ASSERT_EQ(whole.rows.values.size(), 151 * whole.rows.size);
  ASSERT_GE(whole.memories.size(), std::floor(until / every) - 1);
  for (const MotionMemory& memory : whole.memories) {
    const Outcome rest = run(model, options, grid, every, &memory);
    const std::size_t first = static_cast<std::size_t>(memory.next_row) * whole.rows.size;
    ASSERT_EQ(rest.rows.values.size(), whole.rows.values.size() - first) << to_string(method) << " " << memory.t;
    EXPECT_EQ(std::memcmp(rest.rows.values.data(), whole.rows.values.data() + first,
                          rest.rows.values.size() * sizeof(double)),
              0)
        << to_string(method) << " from " << memory.t;
    EXPECT_EQ(rest.end, until);
  }
}

class DynamicsCheckpoints : public ::testing::TestWithParam<IntegrationMethod> {};

TEST_P(DynamicsCheckpoints, FourBarsThroughTheFlatPosition) { check(four_bars(2), 6, 0.37, GetParam()); }
TEST_P(DynamicsCheckpoints, Squeezer) { check(testing::squeezer(), 0.03, 0.004, GetParam()); }
TEST_P(DynamicsCheckpoints, ChainWithFixedSteps) { check(rod_chain(5), 1, 0.11, GetParam(), 0.004); }

// Which directions among the rows are left out goes with the motion.
TEST_P(DynamicsCheckpoints, RedundantCranksThatTurn) {
  const testing::KnownMotion motion = testing::redundant_motion(0, 3);
  check(motion.model, motion.until, motion.until / 7.5, GetParam());
}

// A motor that jumps turns a damped rod many times.
TEST_P(DynamicsCheckpoints, WholeTurnsAndJumps) {
  auto model = rod_chain(2);
  model->bodies[0].angular_velocity = 40;
  model->bodies[0].angular_velocity_given = true;
  model->add_force("motor", Torque<>{}, 0, ground, {TimeFunction<double>::step(0.5, 0.6, 0, 30, 3)});
  SpringDamper<> damper;
  damper.s_i = {3, 0};
  damper.c = 0.1;
  damper.k = 1;
  damper.length = 2;
  model->add_force("damper", damper, ground, 1);
  check(model, 3, 0.31, GetParam());
}

/// A cam of two lobes that turns freely between a flat face, two knife edges and a roller, which springs hold. Where
/// they touch is a part of the state.
std::shared_ptr<Model> four_followers() {
  auto model = std::make_shared<Model>();
  std::vector<Vec2<double>> points;
  for (int k = 0; k < 48; ++k) {
    const double angle = 2 * std::numbers::pi * k / 48, r = 0.1 * (1 + 0.12 * std::cos(2 * angle));
    points.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  const Curve<double> lobes = Curve<double>::spline(points, SplineEnd::periodic);
  const double roller = 0.03;
  const int cam = model->add_body("cam", {.mass = 2, .inertia = 0.02});
  const int face = model->add_body("face", {.mass = 0.3, .inertia = 0.01, .position = {0, 0.088}});
  const int edge = model->add_body("edge", {.mass = 0.2, .inertia = 0.01, .position = {-0.112, 0}});
  const int wheel = model->add_body("wheel", {.mass = 0.4, .inertia = 0.01, .position = {0.112 + roller, 0}});
  const int other = model->add_body("other", {.mass = 0.2, .inertia = 0.01, .position = {0, -0.088}});
  model->add("pin", Revolute<>{}, ground, cam);
  model->bodies[static_cast<std::size_t>(cam)].angular_velocity = 9;
  model->bodies[static_cast<std::size_t>(cam)].angular_velocity_given = true;
  const auto guide = [&](const char* name, int body, const Vec2<double>& along) {
    model->add(name, Translational<>{.s_i = along, .axis_i = along}, ground, body);
    SpringDamper<> spring;
    spring.s_i = 5.0 * model->bodies[static_cast<std::size_t>(body)].position;
    spring.k = 20;
    model->add_force(std::string(name) + " spring", spring, ground, body);
  };
  guide("up", face, {0, 1});
  guide("left", edge, {1, 0});
  guide("right", wheel, {1, 0});
  guide("down", other, {0, 1});
  model->add("flat", CamFlat<>{.axis_j = {1, 0}, .curve = lobes}, cam, face);
  model->add("knife", PointOnCurve<>{.curve = lobes}, cam, edge);
  model->add("rolling", CamCam<>{.curve_i = lobes, .curve_j = Curve<double>::circle({}, roller)}, cam, wheel);
  model->add("below", PointOnCurve<>{.curve = lobes}, cam, other);
  return model;
}

TEST_P(DynamicsCheckpoints, SeveralCamContacts) { check(four_followers(), 0.5, 0.11, GetParam()); }

std::string method_name(const ::testing::TestParamInfo<IntegrationMethod>& info) {
  return std::string(to_string(info.param));
}
INSTANTIATE_TEST_SUITE_P(Methods, DynamicsCheckpoints, ::testing::ValuesIn(testing::all_methods), method_name);

TEST(DynamicsPauses, MemoriesOfOtherMotionsAreRefused) {
  const Outcome other = run(rod_chain(3), {}, TimeGrid::range(0, 1, 0.1), 0.4);
  ASSERT_FALSE(other.memories.empty());
  Dynamics dynamics(rod_chain(2));
  dynamics.resume(other.memories.front());
  RowFunction none([](const Snapshot&) { return true; });
  EXPECT_EQ(dynamics.run(TimeGrid::range(0, 1, 0.1), everything, none).status, Status::refused);
}

// A particle that nothing gives a length, pushed to and fro: the one that its motion had at the start is that of the
// rest, too.
TEST(DynamicsPauses, KeepTheLengthOfTheMotion) {
  const auto model = std::make_shared<Model>();
  const int body = model->add_body("ball", {.mass = 2, .particle = true});
  model->bodies[static_cast<std::size_t>(body)].velocity = {3, 0};
  model->bodies[static_cast<std::size_t>(body)].velocity_given = true;
  constexpr double force = 10, omega = 4;
  model->add_force("push", PointForce<>{}, body, ground,
                   {TimeFunction<double>::harmonic(force, omega, 0, 0), TimeFunction<double>(0.0)});
  const DynamicsOptions options{.method = IntegrationMethod::rk8, .tolerance = 1e-6};
  const TimeGrid grid = TimeGrid::range(0, 10, 0.5);
  const Outcome once = run(model, options, grid, 100), often = run(model, options, grid, 1);
  ASSERT_GT(often.memories.size(), 3u);
  // |v| T + |a| T^2 / 2 with T = 1 / omega, by differences over a hundredth of a second.
  const double way = 3 / omega + force / 2 / (2 * omega * omega);
  for (const MotionMemory& memory : often.memories) EXPECT_NEAR(memory.length, way, 1e-3 * way);
  EXPECT_EQ(once.rows.values, often.rows.values);
}

// Pauses cost accuracy no more than the tolerance allows.
TEST(DynamicsPauses, ManyPausesSpoilNothing) {
  for (const IntegrationMethod method : testing::all_methods) {
    const DynamicsOptions options{.method = method, .tolerance = 1e-9};
    const TimeGrid grid = TimeGrid::range(0, 5, 0.5);
    const Outcome few = run(four_bars(2), options, grid, 100), many = run(four_bars(2), options, grid, 0.05);
    ASSERT_EQ(few.memories.size(), 0u);
    ASSERT_GT(many.memories.size(), 50u);
    ASSERT_EQ(few.rows.values.size(), many.rows.values.size());
    double difference = 0;
    for (std::size_t row = 0; row < few.rows.values.size(); row += few.rows.size) {
      difference = std::max(difference, std::abs(few.rows.values[row + 3] - many.rows.values[row + 3]));
    }
    EXPECT_LT(difference, 1e-8) << to_string(method);
    // Adams loses its history, Runge-Kutta has none to lose.
    if (method == IntegrationMethod::adams) {
      EXPECT_GT(difference, 0);
    } else if (method == IntegrationMethod::rk8) {
      EXPECT_EQ(difference, 0);
    }
  }
}

}  // namespace
}  // namespace catena
