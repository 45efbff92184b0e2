// Loads, reactions and applied forces in lanes: those of each design by itself, and those of the balances of power and
// force; gears, belts and racks.
#include "catena/analysis/batch/batch.hpp"
#include "catena/analysis/batch/kernels/lane_kernels.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "design/lane_families.hpp"

namespace catena::testing {
namespace {

/// The four-bar with masses and names.
std::string heavy_four_bar() {
  std::string text = four_bar;
  for (const char* name : {"O2", "A", "B", "O4"})
    text.insert(text.find(R"json({"type": "revolute", "i")json") + 1, fmt::format(R"json("name": "{}", )json", name));
  for (std::size_t at = text.find("{\"rod\""); at != std::string::npos; at = text.find("{\"rod\"", at + 9))
    text.insert(at + 1, R"json("mass": "m", )json");
  return R"json("gravity": [0.5, -9.81],)json" + text;
}
const std::string named_drive =
    R"json( "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, "w"]}}],)json";

/// Every force that lanes know.
Family loaded_four_bars() {
  Family family{
      heavy_four_bar() + "]," + named_drive + R"json("forces": [
      {"type": "spring_damper", "i": ["ground", [0.3, 1.5]], "j": "coupler.pen", "k": "k", "c": 1.5, "length": 0.4,
       "force": {"harmonic": {"amplitude": 2, "omega": "=3*w"}}},
      {"type": "torsion_spring", "i": "ground", "j": "rocker", "k": 3, "c": 0.4, "angle": 0.2},
      {"type": "torque", "i": "rocker", "j": "coupler", "torque": {"harmonic": {"amplitude": 4, "omega": "w"}}},
      {"type": "point_force", "i": "coupler.pen", "force": [{"polynomial": [1, 2]}, -3], "frame": "body"},
      {"type": "point_force", "i": "rocker.to", "force": [2, {"polynomial": [0, 1]}]},
      {"type": "bushing", "i": "crank.to", "j": "rocker.to", "kx": 5, "ky": 7, "kt": 1, "cx": 0.3, "ct": 0.2},
      {"type": "cable", "i": ["ground", [0, 0]], "j": "rocker.to", "length": 1.6, "k": 30}],)json",
      {"a", "b", "c", "d", "w", "m", "k"},
      {R"json({"max": "drive.load"})json", R"json({"mean": "drive.power"})json",
       R"json({"max": "=sqrt(B.fx^2 + B.fy^2)"})json", R"json({"min": "A.i.fy"})json",
       R"json({"rms": "O4.joint.fx"})json", R"json({"max": "B.joint.fy"})json", R"json({"final": "A.lambda2"})json"},
      {{0.2, 0.6}, {0.8, 1.6}, {0.7, 1.3}, {1.0, 1.8}, {1, 3}, {0.5, 2}, {2, 20}}};
  const std::size_t pin = family.mechanism.find(R"json("name": "B")json");
  family.mechanism.insert(pin, R"json("c": 0.7, )json");
  family.analysis = "inverse_dynamics";
  family.size = 100;
  return family;
}

/// Columns that lanes take from snapshots.
Family looked_at() {
  Family family = loaded_four_bars();
  family.measures = {R"json({"max": "B.torque"})json", R"json({"max": "energy.kinetic"})json",
                     R"json({"min": "energy.potential"})json", R"json({"max": "=abs(drive.load)*abs(A.fx)"})json"};
  family.size = 1000;
  return family;
}

/// A boom on a cylinder, whose length is given by a squared distance, and a lever at a rod: some cannot be reached.
Family booms() {
  Family family{
      R"json("gravity": [0, -9.81], "bodies": {
      "boom": {"mass": "m", "inertia": 0.6, "centroid": [0.5, 0.05], "position": [0, 0], "points": {"eye": [0.8, -0.1], "tip": ["a", 0.1]}},
      "lever": {"mass": 1.2, "inertia": 0.1, "position": ["=a + 0.6", -0.2], "points": {"end": [0, "b"]}}},
    "constraints": [{"type": "revolute", "name": "hinge", "i": "ground", "j": "boom"},
      {"type": "revolute", "i": ["ground", ["=a + 0.6", -0.2]], "j": "lever"},
      {"type": "coupler", "name": "rod", "i": "boom.tip", "j": "lever.end", "value": "r"}],
    "drivers": [{"type": "relative_distance", "name": "cylinder", "i": ["ground", [0.2, -0.5]], "j": "boom.eye",
      "value": {"polynomial": [0.721, "=0.01*w"]}}],)json",
      {"a", "b", "r", "w", "m"},
      {R"json({"max": "cylinder.load"})json", R"json({"mean": "cylinder.power"})json", R"json({"max": "hinge.fx"})json",
       R"json({"min": "hinge.joint.fy"})json", R"json({"rms": "rod.fx"})json", R"json({"max": "rod.lambda1"})json"},
      {{1.2, 1.6}, {0.3, 0.5}, {0.4, 0.9}, {1, 4}, {1, 3}}};
  family.analysis = "inverse_dynamics";
  family.size = 100;
  return family;
}

/// A crank turns a four-bar by gears, one of them a ring, a belt and a rack; many turns of the wheels.
Family geared_four_bars() {
  Family family{
      R"json("gravity": [0, -9.81],)json" + four_bar +
          R"json(, {"type": "revolute", "i": ["ground", ["=-g - 0.2", 0]], "j": "wheel"},
    {"type": "gear", "name": "mesh", "i": "wheel", "j": "crank", "radius_i": "g", "radius_j": 0.2},
    {"type": "revolute", "i": ["ground", [0.1, 0.05]], "j": "planet"},
    {"type": "gear", "name": "ring", "i": "crank", "j": "planet", "radius_i": "=g + 0.4", "radius_j": 0.15,
     "internal": true},
    {"type": "revolute", "i": "coupler.pen", "j": "pulley"},
    {"type": "belt", "name": "belt", "i": "wheel", "j": "pulley", "radius_i": 0.3, "radius_j": 0.1, "crossed": true},
    {"type": "absolute_angle", "i": "rack", "value": 0},
    {"type": "rack_pinion", "name": "teeth", "i": "rack", "j": "planet", "axis_i": [1, 0], "radius": 0.05}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "wheel", "value": {"polynomial": [0, "=1.5*w"]}}],)json",
      {"a", "b", "c", "d", "w", "g"},
      {R"json({"range": "pulley.angle"})json", R"json({"max": "rack.vx"})json", R"json({"rms": "pulley.alpha"})json",
       R"json({"final": "planet.angle"})json", R"json({"max": "coupler.pen.ay"})json"},
      {{0.2, 0.6}, {0.8, 1.6}, {0.7, 1.3}, {1.0, 1.8}, {1, 3}, {0.05, 0.15}}};
  const std::size_t end = family.mechanism.find("}}},") + 2;
  family.mechanism.insert(end, R"json(, "wheel": {"mass": 1, "inertia": 0.1, "position": ["=-g - 0.2", 0]},
    "planet": {"mass": 0.3, "inertia": 0.02, "position": [0.1, 0.05]},
    "pulley": {"mass": 0.2, "inertia": 0.01, "position": ["=a + 0.05", 0.2]},
    "rack": {"mass": 0.5, "inertia": 0.1, "position": [0, 0]})json");
  family.size = 10;
  return family;
}

/// The same with the loads of the teeth.
Family loaded_gears() {
  Family family = geared_four_bars();
  give_masses(family);
  family.measures = {R"json({"max": "drive.load"})json", R"json({"max": "mesh.lambda1"})json",
                     R"json({"rms": "belt.lambda1"})json", R"json({"max": "teeth.lambda2"})json",
                     R"json({"max": "ring.fx"})json"};
  family.analysis = "inverse_dynamics";
  family.size = 1000;
  return family;
}

class RandomLoads : public ::testing::TestWithParam<Family (*)()> {};

TEST_P(RandomLoads, AreWhatEachIsByItself) { expect_same_as_alone(GetParam()()); }

INSTANTIATE_TEST_SUITE_P(Lanes, RandomLoads,
                         ::testing::Values(loaded_four_bars, looked_at, booms, geared_four_bars, loaded_gears));

constexpr double mass = 1.7, inertia = 0.3, stiffness = 40, free_length = 0.6;
const Vec2<double> weight{0.4, -9.81}, hook{0.5, 2};

/// A four-bar whose bodies have their centroids at pins, with a spring from the ground to the end of the rocker.
std::shared_ptr<Model> heavy_model() {
  auto model = std::make_shared<Model>();
  BodyValues values;
  values.mass = mass;
  values.inertia = inertia;
  for (const char* name : {"crank", "coupler", "rocker"}) model->add_body(name, values);
  model->gravity = weight;
  Revolute<double> pin;
  const int ends[4][2] = {{ground, 0}, {0, 1}, {1, 2}, {ground, 2}};
  for (const auto& [i, j] : ends) model->add("", pin, i, j);
  const std::vector<double> turning{0, 2};
  model->add_driver("drive", AbsoluteAngle<double>{}, 0, ground, TimeFunction<double>::polynomial(turning));
  SpringDamper<double> spring;
  spring.s_i = hook;
  spring.k = stiffness;
  spring.length = free_length;
  model->add_force("spring", spring, ground, 2);
  return model;
}

void write_lengths(Model& model, const std::array<double, 4>& lengths) {
  const auto& [a, b, c, d] = lengths;
  auto& pins = std::get<std::vector<ElementEntry<Revolute<double>, double>>>(model.constraints);
  pins[1].element.s_i.x = a;
  pins[2].element.s_i.x = b;
  pins[2].element.s_j.x = c;
  pins[3].element.s_i.x = d;
  std::get<std::vector<ElementEntry<SpringDamper<double>, double>>>(model.forces)[0].element.s_j = {c, 0};
  const double x = d - a, between = std::acos((b * b + x * x - c * c) / (2 * b * x));
  model.bodies[1].position = {a, 0};
  model.bodies[1].angle = between;
  model.bodies[2].position = {d, 0};
  model.bodies[2].angle = std::atan2(b * std::sin(between), a + b * std::cos(between) - d);
}

std::array<double, 4> random_lengths(std::int64_t k) {
  std::mt19937 random(static_cast<unsigned>(k) + 5);
  const auto around = [&](double middle) { return middle * std::uniform_real_distribution(0.95, 1.05)(random); };
  return {around(1), around(2.5), around(2), around(3)};
}

TEST(BatchLoads, BalancePowerAndForces) {
  const TimeGrid grid = TimeGrid::range(0, 3.1, 0.1);
  for (const char* kernels : {"baseline", "avx2", "avx512"}) {
    if (!select_lane_kernels(kernels)) continue;  // this processor does not have them
    BatchOptions options;
    options.loads = true;
    Batch batch(heavy_model(), options);
    std::atomic<int> taken = 0;
    const auto take = [&](const BatchRows& rows) {
      for (int lane = 0; lane < rows.designs; ++lane) {
        ASSERT_EQ(rows.status(lane), Status::ok) << rows.message(lane);
        const std::array<double, 4> lengths = random_lengths(rows.first + lane);
        for (int row = 0; row < rows.rows; ++row) {
          double power = 0;
          for (int body = 0; body < 3; ++body) {
            const Rates v = rows.velocity(row, body, lane), a = rows.acceleration(row, body, lane);
            power += mass * ((a.vx - weight.x) * v.vx + (a.vy - weight.y) * v.vy) + inertia * a.omega * v.omega;
          }
          const Frame<double> rocker = rows.position(row, 2, lane);
          const Vec2<double> arm = lengths[2] * Vec2<double>{rocker.c, rocker.s};
          const Vec2<double> h = Vec2<double>{lengths[3], 0} + arm - hook;
          const double length = norm(h), omega = rows.velocity(row, 2, lane).omega;
          const Vec2<double> pull = (stiffness * (length - free_length) / length) * h;
          power += omega * dot(pull, perpendicular(arm));
          EXPECT_NEAR(2 * rows.load(row, 4, lane), power, 1e-11 * mass * 100);
          // On coupler and rocker; pins exert -lambda on their second body.
          const auto pin = [&](int element, int k) { return rows.multipliers(row, element, k)[lane]; };
          const Rates a = rows.acceleration(row, 1, lane);
          EXPECT_NEAR(pin(2, 0) - pin(1, 0), mass * (a.vx - weight.x), 1e-10);
          EXPECT_NEAR(pin(2, 1) - pin(1, 1), mass * (a.vy - weight.y), 1e-10);
          EXPECT_NEAR(-pin(2, 0) - pin(3, 0), pull.x - mass * weight.x, 1e-10);
          EXPECT_NEAR(-pin(2, 1) - pin(3, 1), pull.y - mass * weight.y, 1e-10);
        }
        ++taken;
      }
    };
    const BatchReport report = batch.run(
        53, grid, [&](std::int64_t k, Model& model) { write_lengths(model, random_lengths(k)); }, take);
    EXPECT_EQ(taken, 53);
    EXPECT_EQ(report.in_lanes, 53);
  }
  for (const char* kernels : {"baseline", "avx2", "avx512"}) select_lane_kernels(kernels);  // the widest again
}

// A design that lacks a mass is refused as Kinematics refuses it, one that locks has the loads that it had.
TEST(BatchLoads, FailuresStayInTheirLanes) {
  const TimeGrid grid = TimeGrid::range(0, 3.1, 0.1);
  BatchOptions options;
  options.loads = true;
  Batch batch(heavy_model(), options);
  const auto write = [](std::int64_t k, Model& model) {
    write_lengths(model, k == 6 ? std::array{1.6, 2.5, 2.0, 3.0} : std::array{1.0, 2.5, 2.0, 3.0});
    model.bodies[1].has_mass = k != 3;
  };
  const BatchReport report = batch.run(8, grid, write, [&](const BatchRows& rows) {
    for (int lane = 0; lane < 8; ++lane) {
      SCOPED_TRACE(lane);
      auto model = std::make_shared<Model>(*heavy_model());
      write(lane, *model);
      std::vector<double> loads;
      RowFunction keep([&](const Snapshot& row) {
        loads.push_back(-row.lambda[static_cast<std::size_t>(row.evaluator.plan().element_row[4])]);
        return true;
      });
      KinematicsOptions inverse;
      inverse.inverse_dynamics = true;
      const AnalysisReport alone = Kinematics(model, {}, inverse).run(grid, {.multipliers = true}, keep);
      EXPECT_EQ(rows.status(lane), alone.status);
      EXPECT_EQ(rows.message(lane), alone.message);
      EXPECT_EQ(rows.left_lane(lane).empty(), lane != 3 && lane != 6);
      for (int row = 0; row < rows.rows; ++row) {
        const double load = rows.load(row, 4, lane);
        if (static_cast<std::size_t>(row) < loads.size() && std::isfinite(loads[static_cast<std::size_t>(row)]))
          EXPECT_NEAR(load, loads[static_cast<std::size_t>(row)], 1e-10);
        else
          EXPECT_TRUE(std::isnan(load));
      }
    }
  });
  EXPECT_EQ(report.failed, 2);
}

TEST(BatchLoads, SayWhatIsNotInLanes) {
  auto curved = heavy_model();
  auto& spring = std::get<std::vector<ElementEntry<SpringDamper<double>, double>>>(curved->forces)[0].element;
  spring.curve = ForceCurve<double>(std::vector<Vec2<double>>{{-5, -1}, {0, 0}, {5, 2}});
  for (const bool loads : {false, true})
    EXPECT_NE(Batch::obstacle(*curved, loads).find("tables that end"), std::string::npos);
  const std::string work =
      R"json({"type": "sweep", "of": {"type": "inverse_dynamics", "until": 1, "every": 0.1, "measures": {"done": {"final": "drive.work"}}},
       "over": {"m": [1, 2]}})json";
  const Family family = loaded_four_bars();
  const TextRun run = run_text(scene_of(family, {0.3, 1.2, 1, 1.4, 2, 1, 5}, work));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(field<std::int64_t>(run, "in_lanes"), 0);
  EXPECT_EQ(run.column("status"), (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace catena::testing
