// Designs in lanes: what they give is what every design gives by itself, failures included; a mechanism that cannot be
// computed in lanes says why.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "catena/analysis/batch/batch.hpp"
#include "catena/analysis/batch/kernels/lane_kernels.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "design/lane_families.hpp"

namespace catena::testing {
namespace {

/// Crank-rockers and others: some lock, some cannot be assembled.
Family four_bars() {
  return {four_bar + "]," + drive,
          {"a", "b", "c", "d", "w"},
          {R"json({"range": "rocker.angle"})json", R"json({"max": "coupler.pen.y"})json",
           R"json({"rms": "rocker.alpha"})json", R"json({"final": "coupler.pen.vx"})json"},
          {{0.2, 0.6}, {0.8, 1.6}, {0.7, 1.3}, {1.0, 1.8}, {1, 3}}};
}

/// Formulas of columns, of time and of the ground's points, beside plain ones.
Family formulas() {
  Family family = four_bars();
  family.measures = {R"json({"max": "=sqrt(coupler.pen.vx^2 + coupler.pen.vy^2)"})json",
                     R"json({"mean": "=abs(coupler.angle - rocker.angle) + t*w"})json",
                     R"json({"range": "coupler.pen.ax"})json", R"json({"min": "coupler.pen.ay"})json",
                     R"json({"integral": "=crank.to.x*coupler.omega + a"})json"};
  return family;
}

/// Columns that lanes have no formulas for.
Family joint_angles() {
  Family family = four_bars();
  const std::size_t place = family.mechanism.find(R"json("i": "coupler.to")json");
  family.mechanism.insert(place, R"json("name": "B", )json");
  family.measures = {R"json({"range": "B.angle"})json", R"json({"max": "B.omega"})json",
                     R"json({"max": "coupler.pen.y"})json"};
  return family;
}

/// A slide on a slanting line, moved through a rod without mass; an offset that some cranks cannot pass.
Family slider_cranks() {
  return {R"json( "bodies": {"crank": {"rod": {"from": [0, 0], "to": ["a", 0]}},
      "slide": {"position": ["=a + b", 0.1]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
      {"type": "translational", "i": ["ground", [0, 0.1]], "j": "slide", "axis_i": ["=cos(c)", "=sin(c)"]},
      {"type": "coupler", "i": "crank.to", "j": "slide", "value": "b"}],)json" +
              drive,
          {"a", "b", "c", "w"},
          {R"json({"range": "slide.x"})json", R"json({"min": "slide.ay"})json", R"json({"mean": "slide.vx"})json"},
          {{0.2, 0.7}, {0.6, 1.5}, {-0.3, 0.3}, {1, 2}}};
}

/// Watt's six-bar: a second loop of two links on the rocker.
Family six_bars() {
  std::string bodies = four_bar;
  bodies.replace(bodies.find("=c*sin(1.8)\"]}}}"), 16,
                 R"json(=c*sin(1.8)"]}, "points": {"ear": ["=0.5*c", 0.3]}},
  "link": {"rod": {"from": ["=d - 0.6", 0.5], "to": ["=d - 0.4 + e", 0.9]}},
  "lever": {"rod": {"from": ["=d + 1.2", 0], "to": ["=d - 0.4 + e", 0.9]}}})json");
  return {bodies + R"json(, {"type": "revolute", "i": "rocker.ear", "j": "link.from"},
    {"type": "revolute", "i": "link.to", "j": "lever.to"},
    {"type": "revolute", "i": ["ground", ["=d + 1.2", 0]], "j": "lever.from"}],)json" +
              drive,
          {"a", "b", "c", "d", "e", "w"},
          {R"json({"range": "lever.angle"})json", R"json({"max": "lever.omega"})json"},
          {{0.2, 0.4}, {1.0, 1.4}, {0.8, 1.1}, {1.1, 1.5}, {0.8, 1.2}, {1, 2}}};
}

class RandomDesigns : public ::testing::TestWithParam<Family (*)()> {};

TEST_P(RandomDesigns, AreWhatEachIsByItself) { expect_same_as_alone(GetParam()()); }

INSTANTIATE_TEST_SUITE_P(Lanes, RandomDesigns,
                         ::testing::Values(four_bars, formulas, joint_angles, slider_cranks, six_bars));

/// A four-bar about (x, y), its crank turned by theta(t) = 0.3 + 2 t.
struct Lengths {
  double a, b, c, d;
};

/// Angles of coupler and rocker of the open four-bar, from two triangles.
std::array<double, 2> closed_form(const Lengths& l, double crank) {
  const double x = l.a * std::cos(crank), y = l.a * std::sin(crank), r = std::hypot(l.d - x, y);
  const double coupler = std::atan2(-y, l.d - x) + std::acos((l.b * l.b + r * r - l.c * l.c) / (2 * l.b * r));
  return {coupler, std::atan2(y + l.b * std::sin(coupler), x + l.b * std::cos(coupler) - l.d)};
}

void write(Model& model, const Lengths& l) {
  auto& pins = std::get<std::vector<ElementEntry<Revolute<double>, double>>>(model.constraints);
  pins[1].element.s_i.x = l.a;
  pins[2].element.s_i.x = l.b;
  pins[2].element.s_j.x = l.c;
  pins[3].element.s_i.x = l.d;
  const std::array<double, 2> angles = closed_form(l, 0.3);
  model.bodies[1].position = {l.a * std::cos(0.3), l.a * std::sin(0.3)};
  model.bodies[1].angle = angles[0];
  model.bodies[2].position = {l.d, 0};
  model.bodies[2].angle = angles[1];
}

std::shared_ptr<Model> four_bar_model() {
  auto model = std::make_shared<Model>();
  BodyValues values;
  values.angle = 0.3;
  for (const char* name : {"crank", "coupler", "rocker"}) model->add_body(name, values);
  Revolute<double> pin;
  model->add("O2", pin, ground, 0);
  model->add("A", pin, 0, 1);
  model->add("B", pin, 1, 2);
  model->add("O4", pin, ground, 2);
  const std::vector<double> turning{0.3, 2};
  model->add_driver("drive", AbsoluteAngle<double>{}, 0, ground, TimeFunction<double>::polynomial(turning));
  write(*model, {1, 2.5, 2, 3});
  return model;
}

TEST(Batch, FourBarsInClosedForm) {
  const auto lengths_of = [](std::int64_t k) {
    std::mt19937 random(static_cast<unsigned>(k) + 1);
    const auto around = [&](double middle) { return middle * std::uniform_real_distribution(0.93, 1.07)(random); };
    return Lengths{around(1), around(2.5), around(2), around(3)};
  };
  const TimeGrid grid = TimeGrid::range(0, 3.2, 0.04);
  for (const char* kernels : {"baseline", "avx2", "avx512"}) {
    if (!select_lane_kernels(kernels)) continue;  // this processor does not have them
    BatchOptions options;
    options.threads = 2;
    options.same_functions = true;
    Batch batch(four_bar_model(), options);
    std::atomic<int> taken = 0;
    const BatchReport report = batch.run(
        101, grid, [&](std::int64_t k, Model& model) { write(model, lengths_of(k)); },
        [&](const BatchRows& rows) {
          for (int lane = 0; lane < rows.designs; ++lane) {
            ASSERT_EQ(rows.status(lane), Status::ok) << rows.message(lane);
            const Lengths l = lengths_of(rows.first + lane);
            for (int row = 0; row < rows.rows; ++row) {
              const double crank = 0.3 + 2 * grid[row], h = 1e-4;
              const auto here = closed_form(l, crank), before = closed_form(l, crank - h),
                         after = closed_form(l, crank + h);
              EXPECT_NEAR(rows.position(row, 1, lane).phi, here[0], 1e-12);
              EXPECT_NEAR(rows.position(row, 2, lane).phi, here[1], 1e-12);
              EXPECT_NEAR(rows.position(row, 1, lane).x, l.a * std::cos(crank), 1e-12);
              // Central differences: h^2 of the third and fourth derivatives, some hundred here, and rounding over h^2.
              EXPECT_NEAR(rows.velocity(row, 2, lane).omega, 2 * (after[1] - before[1]) / (2 * h), 1e-5);
              EXPECT_NEAR(rows.acceleration(row, 2, lane).omega, 4 * (after[1] - 2 * here[1] + before[1]) / (h * h),
                          1e-3);
            }
            ++taken;
          }
        });
    EXPECT_EQ(taken, 101);
    EXPECT_EQ(report.designs, 101);
    EXPECT_EQ(report.in_lanes, 101);
    EXPECT_EQ(report.failed, 0);
  }
  for (const char* kernels : {"baseline", "avx2", "avx512"}) select_lane_kernels(kernels);  // the widest again
}

// A design that cannot be assembled, and one that locks, beside six that turn: each ends as by itself.
TEST(Batch, FailuresStayInTheirLanes) {
  const auto write_design = [](std::int64_t k, Model& model) {
    write(model, {1, 2.5, 2, 3});
    auto& pins = std::get<std::vector<ElementEntry<Revolute<double>, double>>>(model.constraints);
    if (k == 2) pins[3].element.s_i.x = 9;    // out of reach
    if (k == 5) pins[1].element.s_i.x = 1.6;  // 1.6 + 3 > 2.5 + 2: the crank does not pass
  };
  const TimeGrid grid = TimeGrid::range(0, 3.2, 0.04);
  Batch batch(four_bar_model());
  const BatchReport report = batch.run(8, grid, write_design, [&](const BatchRows& rows) {
    for (int lane = 0; lane < 8; ++lane) {
      SCOPED_TRACE(lane);
      auto model = std::make_shared<Model>(*four_bar_model());
      write_design(lane, *model);
      std::vector<double> angles;
      RowFunction keep([&](const Snapshot& row) {
        angles.push_back(row.q[3 * static_cast<std::size_t>(row.evaluator.plan().plan_body[2]) + 2]);
        return true;
      });
      const AnalysisReport alone = Kinematics(model).run(grid, {}, keep);
      EXPECT_EQ(rows.status(lane), alone.status);
      EXPECT_EQ(rows.message(lane), alone.message);
      EXPECT_EQ(rows.left_lane(lane).empty(), lane != 2 && lane != 5);
      for (int row = 0; row < rows.rows; ++row) {
        const double angle = rows.position(row, 2, lane).phi;
        if (static_cast<std::size_t>(row) < angles.size())
          EXPECT_NEAR(angle, angles[static_cast<std::size_t>(row)], 1e-12);
        else
          EXPECT_TRUE(std::isnan(angle));
      }
    }
  });
  EXPECT_EQ(report.failed, 2);
  EXPECT_EQ(report.in_lanes, 6);
}

TEST(Batch, SaysWhatIsWrong) {
  const auto refusal = [](const auto& f) -> std::string {
    try {
      f();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing";
  };
  const auto nothing = [](std::int64_t, Model&) {};
  const auto nobody = [](const BatchRows&) {};
  Batch batch(four_bar_model());
  const TimeGrid grid = TimeGrid::range(0, 1, 0.1);
  EXPECT_NE(refusal([&] { batch.run(-1, grid, nothing, nobody); }).find("-1 designs"), std::string::npos);
  EXPECT_NE(refusal([&] {
              batch.run(1, TimeGrid::list({1, 0}), nothing, nobody);
            }).find("in order"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              batch.run(
                  9, grid, [](std::int64_t k, Model& m) { m.bodies[1].angle = k == 8 ? std::nan("") : 1.2; }, nobody);
            }).find("design 8"),
            std::string::npos);
  auto redundant = four_bar_model();
  redundant->add("again", Revolute<double>{}, ground, 0);
  EXPECT_NE(refusal([&] { Batch twice(redundant); }).find("11 equations for 9"), std::string::npos);
  auto cammed = four_bar_model();
  const int follower = cammed->add_body("follower", {});
  cammed->bodies[static_cast<std::size_t>(follower)].position = {0, 0.5};
  cammed->add("guide", Translational<double>{.axis_i = {0, 1}, .axis_j = {0, 1}}, ground, follower);
  CamFlat<double> cam;
  const std::vector<Vec2<double>> arc{{0.3, -0.1}, {0.35, 0}, {0.3, 0.1}};
  cam.curve = Curve<double>::spline(arc, SplineEnd::natural);
  cam.axis_j = {1, 0};
  cammed->add("cam", cam, 0, follower);
  EXPECT_NE(Batch::obstacle(*cammed).find("curves or tables that end"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
