// What the public functions do with arguments that mean nothing: exceptions that name them, never a crash.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "catena/analysis/kinematics/minimum_norm_motion.hpp"
#include "catena/analysis/stability/buckling.hpp"
#include "catena/analysis/stability/modes.hpp"
#include "catena/analysis/stability/path.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/catena.hpp"

namespace catena::testing {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

/// The text of what f throws, of the kind Wanted; a failure if it throws nothing, or something else.
template <class Wanted, class F>
std::string thrown(F&& f) {
  try {
    f();
  } catch (const Wanted& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another kind of exception: " << error.what();
    return {};
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}
#define EXPECT_THROWN(Wanted, expression, part)                                      \
  {                                                                                  \
    const std::string text = thrown<Wanted>([&] { static_cast<void>(expression); }); \
    EXPECT_NE(text.find(part), std::string::npos) << text;                           \
  }

/// A crank that a driver turns.
std::shared_ptr<Model> crank() {
  auto model = std::make_shared<Model>();
  const int body = model->add_body("crank", {.mass = 1, .inertia = 1, .position = {0.5, 0}, .centroid = {0.5, 0}});
  model->add("A", Revolute<>{}, ground, body);
  const double speed[] = {0, 2};
  model->add_driver("drive", AbsoluteAngle<>{}, body, ground, TimeFunction<double>::polynomial(speed));
  return model;
}

RowFunction nothing([](const Snapshot&) { return true; });

TEST(BadArguments, OfModels) {
  Model model = *crank();
  EXPECT_THROWN(ModelError, model.add_body("b", {.mass = nan}), "\"b\": mass is not finite");
  EXPECT_THROWN(ModelError, model.add_body("b", {.position = {0, infinity}}), "position.y");
  EXPECT_THROWN(ModelError, model.add_body("b", {.angle = nan}), "angle");
  EXPECT_THROWN(ModelError, model.add_body("", {}), "name");
  EXPECT_THROWN(ModelError, model.add_body("crank", {}), "crank");
  EXPECT_THROWN(ModelError, model.add_body("ground", {}), "ground");
  EXPECT_THROWN(std::out_of_range, model.add_point(3, "p", {0, 0}), "no body number 3: the model has 1");
  EXPECT_THROWN(ModelError, model.add_point(0, "p", {nan, 0}), "\"p\" of \"crank\"");
  EXPECT_THROWN(ModelError, model.add_point(0, "", {0, 0}), "name");
  EXPECT_THROWN(std::out_of_range, model.find_point(-2, "p"), "-2");
  EXPECT_THROWN(std::out_of_range, model.frame(1), "1");
  EXPECT_THROWN(std::out_of_range, model.body_name(-7), "-7");
  EXPECT_THROWN(std::out_of_range, model.element_name(2), "no element number 2: the model has 2");
  EXPECT_THROWN(std::out_of_range, model.element_type(-1), "-1");
  EXPECT_THROWN(std::out_of_range, model.add("B", Revolute<>{}, 0, 5), "5");
  EXPECT_THROWN(std::out_of_range, model.add("B", Revolute<>{}, -3, 0), "-3");
  EXPECT_THROWN(ModelError, model.add("B", Revolute<>{}, 0, 0), "itself");
  EXPECT_THROWN(ModelError, model.add("B", Revolute<>{{nan, 0}, {0, 0}}, ground, 0), "revolute: i is not finite");
  EXPECT_THROWN(ModelError, model.add("B", AbsoluteX<>{}, 0, ground, nan), "absolute_x");
  EXPECT_THROWN(ModelError, model.add("B", AbsoluteX<>{}, ground), "ground");
  EXPECT_THROWN(std::out_of_range, model.add_driver("B", AbsoluteX<>{}, 9, ground, 1.0), "9");
  EXPECT_THROWN(std::out_of_range, model.add_force("F", SpringDamper<>{}, ground, 4), "4");
  EXPECT_THROWN(ModelError, model.add_force("F", SpringDamper<>{{}, {}, nan}, ground, 0), "spring_damper: k");
  EXPECT_THROWN(ModelError, model.add_force("F", Torque<>{}, 0, ground, {nan}), "torque");
  EXPECT_EQ(model.elements.size(), 2u);
  EXPECT_EQ(model.bodies.size(), 1u);
}

TEST(BadArguments, OfCurvesAndTables) {
  const std::vector<double> two{0, 1}, wrong{0, nan}, three{0, 1, 2};
  EXPECT_THROWN(std::invalid_argument, Spline<double>(two, three, SplineEnd::natural), "2 knots, but 3 values");
  EXPECT_THROWN(std::invalid_argument, Spline<double>(two, wrong, SplineEnd::natural), "value[1]");
  EXPECT_THROWN(std::invalid_argument, Curve<double>::circle({0, 0}, nan), "radius");
  EXPECT_THROWN(std::invalid_argument, Curve<double>::line({0, 0}, {0, 0}), "axis");
  EXPECT_THROWN(std::invalid_argument, TimeFunction<double>::custom({}), "callback");
  EXPECT_THROWN(std::invalid_argument, ForceCurve<double>(std::vector<Vec2<double>>{{0, 1}}), "2 points");
}

TEST(BadArguments, OfGrids) {
  EXPECT_THROWN(std::invalid_argument, TimeGrid::instant(nan), "not finite");
  EXPECT_THROWN(std::invalid_argument, TimeGrid::list({0, infinity}), "not finite");
  EXPECT_THROWN(std::invalid_argument, TimeGrid::range(0, 1, 0), "above zero");
  EXPECT_THROWN(std::invalid_argument, TimeGrid::range(0, 1, -1), "above zero");
  EXPECT_THROWN(std::invalid_argument, TimeGrid::range(0, nan, 1), "not finite");
  EXPECT_THROWN(std::invalid_argument, TimeGrid::range(0, 1e300, 1e-300), "too close");
  const TimeGrid grid = TimeGrid::range(0, 1, 0.5);
  EXPECT_THROWN(std::out_of_range, grid[3], "no row number 3 among 3");
  EXPECT_THROWN(std::out_of_range, grid[-1], "-1");
  EXPECT_THROWN(std::out_of_range, grid.from_row(4), "4");
  EXPECT_THROWN(std::out_of_range, TimeGrid::list({}).last(), "no instants");
}

TEST(BadArguments, OfAnalyses) {
  const auto at_value = [](double) { return crank(); };
  EXPECT_THROWN(std::invalid_argument, Kinematics(nullptr), "null");
  EXPECT_THROWN(std::invalid_argument, Dynamics(nullptr), "null");
  EXPECT_THROWN(std::invalid_argument, Equilibrium(nullptr), "null");
  EXPECT_THROWN(std::invalid_argument, Modes(nullptr), "null");
  EXPECT_THROWN(std::invalid_argument, MinimumNormMotion(nullptr), "null");
  EXPECT_THROWN(std::invalid_argument, Path(nullptr, at_value, {.to = 1}), "null");
  EXPECT_THROWN(std::invalid_argument, Path(crank(), {}, {.to = 1}), "other values of the parameter");
  EXPECT_THROWN(std::invalid_argument, Path(crank(), at_value, {.to = nan}), "to");
  EXPECT_THROWN(std::invalid_argument, Path(crank(), at_value, {.to = 1, .arc = 0}), "arc");
  EXPECT_THROWN(std::invalid_argument, Buckling(crank(), {}, {}), "other values of the parameter");
  EXPECT_THROWN(std::invalid_argument, Kinematics(crank(), {}, {.tolerance = nan}), "tolerance");
  EXPECT_THROWN(std::invalid_argument, Kinematics(crank(), {}, {.branch = -1}), "branch");
  EXPECT_THROWN(std::invalid_argument, Equilibrium(crank(), {}, {.tolerance = 0}), "tolerance");
  EXPECT_THROWN(std::invalid_argument, Equilibrium(crank(), {}, {.find = 0}), "find");
  EvaluationWork work;
  EXPECT_THROWN(std::invalid_argument, Evaluator(nullptr, *crank(), work), "null");
  EXPECT_THROWN(std::out_of_range, Kinematics(crank(), {.keep_elements = {7}}), "no element number 7");
  EXPECT_THROWN(std::out_of_range, Kinematics(crank(), {.released_elements = {-1}}), "-1");
  const auto model = crank();
  auto other = crank();
  other->add_body("more", {});
  EXPECT_THROWN(std::invalid_argument, Evaluator(Plan::make(*model), *other, work), "2 bodies");
  Equilibrium equilibrium(crank());
  EXPECT_THROWN(std::invalid_argument, equilibrium.set_model(other), "2 bodies");
  EXPECT_THROWN(std::invalid_argument, equilibrium.set_model(nullptr), "null");

  Kinematics kinematics(model);
  EXPECT_THROWN(std::invalid_argument, kinematics.move_to(nan), "not finite");
  EXPECT_THROWN(std::invalid_argument, kinematics.move_to(infinity), "not finite");
  EXPECT_THROWN(std::out_of_range, kinematics.frame(1), "no body number 1");
  EXPECT_THROWN(std::invalid_argument, kinematics.start_from(SystemState{0, {1, 2}, {}}), "another model");
  EXPECT_THROWN(std::invalid_argument, kinematics.start_from(SystemState{0, {0, nan, 0}, {}}), "\"crank\"");
  EXPECT_THROWN(std::invalid_argument, kinematics.start_from(SystemState{nan, {}, {}}), "time");
  Dynamics dynamics(model);
  EXPECT_THROWN(std::invalid_argument, dynamics.start_from(SystemState{0, {}, {1, 2}}), "another model");
  EXPECT_THROWN(std::out_of_range, dynamics.frame(-2), "-2");
  EXPECT_EQ(Dynamics(model, {}, {.tolerance = nan}).run(TimeGrid::instant(1), {}, nothing).status, Status::refused);
  EXPECT_EQ(Dynamics(model, {}, {.step = nan}).run(TimeGrid::instant(1), {}, nothing).status, Status::refused);
  EXPECT_EQ(Dynamics(model, {}, {.max_steps = -1}).run(TimeGrid::instant(1), {}, nothing).status, Status::refused);
}

TEST(BadArguments, OfColumnsAndRows) {
  const auto model = crank();
  Kinematics kinematics(model);
  const std::vector<std::string> names{"crank.vx"}, unknown{"crank.z"};
  ColumnSources sources;
  sources.velocity = true;
  EXPECT_THROWN(ColumnError, ColumnSet::resolve(*model, kinematics.plan(), unknown, sources), "crank.z");
  auto other = crank();
  const int more = other->add_body("more", {});
  other->add("B", AbsoluteX<>{}, more);
  other->add("C", AbsoluteY<>{}, more);
  other->add("D", AbsoluteAngle<>{}, more);
  EXPECT_THROWN(std::invalid_argument, ColumnSet::resolve(*other, kinematics.plan(), names, sources), "another model");
  const ColumnSet columns = ColumnSet::resolve(*model, kinematics.plan(), names, sources);
  ResultStorage storage;
  ColumnRows rows(columns, storage);
  EXPECT_THROWN(std::invalid_argument, kinematics.run(TimeGrid::instant(0), {}, rows), "velocities");
  Kinematics of_other(other);
  EXPECT_THROWN(std::invalid_argument, of_other.run(TimeGrid::instant(0), {.velocity = true}, rows), "another model");
  EXPECT_TRUE(Kinematics(model).run(TimeGrid::instant(0), columns.needs(), rows).ok());
  EXPECT_THROWN(std::out_of_range, storage.at(1, 0), "no row number 1");
  EXPECT_THROWN(std::out_of_range, storage.at(0, 1), "no column number 1");
  EXPECT_THROWN(std::out_of_range, storage[5], "5");
}

// The frame is that of the author: its origin, not the centroid.
TEST(Frames, AreThoseInWhichBodiesWereGiven) {
  const auto model = crank();
  Kinematics kinematics(model);
  kinematics.assemble();
  ASSERT_TRUE(kinematics.move_to(0.4).ok());
  const Frame<double> f = kinematics.frame(0);
  EXPECT_NEAR(f.phi, 0.8, 1e-12);
  EXPECT_NEAR(f.point(Vec2<double>{0.25, 0}).x, 0.25 * std::cos(0.8), 1e-12);
  EXPECT_NEAR(f.point(Vec2<double>{0.25, 0}).y, 0.25 * std::sin(0.8), 1e-12);
  EXPECT_EQ(kinematics.frame(ground).x, 0);
}

}  // namespace
}  // namespace catena::testing
