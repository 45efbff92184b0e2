// From text to model: bodies, attachments, blocks, functions; the same over dual numbers.
#include "catena/scene/building/build_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/scene/reading/scene_reader.hpp"

namespace catena::testing {
namespace {

using std::numbers::pi;

Model build(const std::string& text, std::int64_t max_elements = 10'000'000) {
  Diagnostics diagnostics;
  const auto scene = read_scene(SourceText("scene", text), diagnostics);
  if (!scene) {
    ADD_FAILURE() << diagnostics.text();
    return {};
  }
  const std::vector<double> parameters = scene->parameters.evaluate<double>(scene->expressions, diagnostics);
  Model model = build_model<double>(*scene, parameters, {max_elements}, diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
  return model;
}

const BasicBody<double>& body(const Model& model, std::string_view name) {
  const int number = model.find_body(name);
  EXPECT_GE(number, 0) << name;
  return model.bodies.at(static_cast<std::size_t>(number));
}

template <class E>
const std::vector<ElementEntry<E, double>>& list(const Model& model) {
  return std::get<std::vector<ElementEntry<E, double>>>(model.constraints);
}

void expect_vector(const Vec2<double>& v, double x, double y) {
  EXPECT_NEAR(v.x, x, 1e-15);
  EXPECT_NEAR(v.y, y, 1e-15);
}

TEST(BuildModel, RodsLieBetweenTheirEnds) {
  const Model model = build(R"({"catena": 1, "bodies": {
    "up": {"mass": 3, "rod": {"from": [1, 1], "to": [1, 5]}, "points": {"mid": [0.5, 0.25]}},
    "own": {"mass": 3, "inertia": 7, "rod": {"from": [0, 0], "to": [2, 0]}},
    "light": {"rod": {"from": [0, 0], "to": [2, 0]}}}})");
  const auto& up = body(model, "up");
  expect_vector(up.position, 1, 3);
  EXPECT_EQ(up.angle, pi / 2);
  EXPECT_DOUBLE_EQ(up.inertia, 3 * 16 / 12.0);
  expect_vector(*model.find_point(0, "from"), -2, 0);
  expect_vector(*model.find_point(0, "to"), 2, 0);
  expect_vector(*model.find_point(0, "mid"), 0.5, 0.25);
  EXPECT_EQ(body(model, "own").inertia, 7);
  EXPECT_FALSE(body(model, "light").has_mass);
  EXPECT_FALSE(body(model, "light").has_inertia);
}

TEST(BuildModel, ACentroidElsewhereShiftsEverythingLocal) {
  const Model model = build(R"({"catena": 1, "bodies": {
    "arm": {"mass": 2, "inertia": 1, "position": [1, 2], "angle": "90 deg", "centroid": [0.5, 0],
            "velocity": [3, 4], "points": {"tip": [1, 0]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": ["arm", [0.25, 0.125]]},
                    {"type": "absolute_x", "i": "arm"}, {"type": "absolute_y", "i": "arm.tip"}]})");
  const auto& arm = body(model, "arm");
  expect_vector(arm.position, 1, 2.5);
  expect_vector(arm.origin, -0.5, 0);
  expect_vector(arm.velocity, 3, 4);
  expect_vector(*model.find_point(0, "tip"), 0.5, 0);
  expect_vector(list<Revolute<double>>(model)[0].element.s_j, -0.25, 0.125);
  expect_vector(list<AbsoluteX<double>>(model)[0].element.s_i, -0.5, 0);
  EXPECT_NEAR(list<AbsoluteX<double>>(model)[0].values[0].constant, 1, 1e-15);
  EXPECT_NEAR(list<AbsoluteY<double>>(model)[0].values[0].constant, 3, 1e-15);
}

TEST(BuildModel, PartsMakeMassCentroidAndInertia) {
  // A plate 0.4 x 0.2 with a round hole, a disc and a triangle: by hand.
  const Model model = build(R"({"catena": 1, "bodies": {
    "masses": {"parts": [{"mass": 1, "centroid": [0, 0]}, {"mass": 3, "centroid": [1, 0], "inertia": 0.5}]},
    "plate": {"parts": [{"mass": 4, "rectangle": {"width": 0.4, "height": 0.2}},
                        {"mass": -1, "disc": {"centre": [0.1, 0], "radius": 0.05}}]},
    "square": {"parts": [{"mass": 6, "polygon": [[1, 1], [3, 1], [3, 3], [1, 3]]}]},
    "clockwise": {"parts": [{"mass": 6, "polygon": [[1, 1], [1, 3], [3, 3], [3, 1]]}]}}})");
  EXPECT_DOUBLE_EQ(body(model, "masses").mass, 4);
  expect_vector(body(model, "masses").origin, -0.75, 0);
  EXPECT_NEAR(body(model, "masses").inertia, 0.5 + 1 * 0.5625 + 3 * 0.0625, 1e-15);
  const double plate = 4 * 0.2 / 12, hole = 1 * 0.0025 / 2, centre = -0.1 / 3;
  expect_vector(body(model, "plate").origin, -centre, 0);
  EXPECT_NEAR(body(model, "plate").inertia, plate - hole - 0.01 - 3 * centre * centre, 1e-15);
  for (const char* name : {"square", "clockwise"}) {
    expect_vector(body(model, name).origin, -2, -2);
    EXPECT_NEAR(body(model, name).inertia, 6 * 8 / 12.0, 1e-13) << name;
  }
}

TEST(BuildModel, EveryWayToAttachMeansTheSamePlace) {
  const Model model = build(R"({"catena": 1, "bodies": {"ground": {"points": {"post": [2, 1]}},
    "a": {"position": [1, 1], "angle": "90 deg", "points": {"tip": [0, -1]}},
    "b": {"position": [3, 1], "angle": "180 deg"}},
    "constraints": [{"type": "revolute", "i": "a.tip", "j": ["b", [1, 0]]},
                    {"type": "revolute", "i": "a", "j": "b", "at": [2, 1]},
                    {"type": "revolute", "i": "ground.post", "j": "a.tip"},
                    {"type": "revolute", "i": "ground", "j": "b"}]})");
  const auto& pins = list<Revolute<double>>(model);
  ASSERT_EQ(pins.size(), 4u);
  for (int k : {0, 1}) {
    expect_vector(pins[static_cast<std::size_t>(k)].element.s_i, 0, -1);
    expect_vector(pins[static_cast<std::size_t>(k)].element.s_j, 1, 0);
  }
  EXPECT_EQ(pins[2].i, ground);
  expect_vector(pins[2].element.s_i, 2, 1);
  expect_vector(pins[3].element.s_i, 0, 0);
}

TEST(BuildModel, WhatIsLeftOutComesFromTheGivenConfiguration) {
  const Model model = build(R"({"catena": 1, "bodies": {"a": {"angle": 0.25}, "b": {"position": [3, 4], "angle": 1}},
    "constraints": [{"type": "coupler", "i": "a", "j": "b"}, {"type": "relative_angle", "i": "a", "j": "b"},
                    {"type": "weld", "i": "a", "j": "b", "at": [3, 4]}, {"type": "slot", "i": "a", "j": "b", "axis_i": [2, 0]}],
    "forces": [{"type": "spring_damper", "i": "a", "j": "b", "k": 5}, {"type": "torque", "i": "b", "torque": 3}]})");
  EXPECT_NEAR(list<Coupler<double>>(model)[0].values[0].constant, 5, 1e-14);
  EXPECT_NEAR(list<RelativeAngle<double>>(model)[0].values[0].constant, 0.75, 1e-15);
  EXPECT_NEAR(list<Weld<double>>(model)[0].element.angle, 0.75, 1e-15);
  EXPECT_EQ(list<Slot<double>>(model)[0].values[0].constant, 0);
  const auto& spring = std::get<std::vector<ElementEntry<SpringDamper<double>, double>>>(model.forces)[0];
  EXPECT_NEAR(spring.element.length, 5, 1e-14);
  const auto& torque = std::get<std::vector<ElementEntry<Torque<double>, double>>>(model.forces)[0];
  EXPECT_EQ(torque.j, ground);
  EXPECT_EQ(torque.values[0].constant, 3);
}

TEST(BuildModel, ACouplersValueMayBeCalledItsLength) {
  const Model model = build(R"({"catena": 1, "parameters": {"l": 2}, "bodies": {"a": {}, "b": {"position": [3, 4]}},
    "constraints": [{"type": "coupler", "i": "a", "j": "b", "length": "=2*l"}],
    "drivers": [{"type": "coupler", "i": "ground", "j": "b", "length": {"polynomial": [5, 1]}}]})");
  EXPECT_EQ(list<Coupler<double>>(model)[0].values[0].constant, 4);
  EXPECT_GE(list<Coupler<double>>(model)[1].values[0].function, 0);
}

TEST(BuildModel, BlocksExpandInTheOrderOfTheTextAndMayNameWhatComesLater) {
  const Model model = build(R"({"catena": 1, "parameters": {"n": 3},
    "constraints": [{"type": "revolute", "name": "first", "i": "ground", "j": "link1"}],
    "replicate": [{"count": "=n-1", "first": 2, "constraints": [{"type": "revolute", "i": "link{k-1}", "j": "link{k}"}]},
                  {"count": "n", "bodies": {"link{k}": {"position": ["=k/2", 0], "points": {"p{2*k}": ["=k", 0]}}}},
                  {"count": 0, "bodies": {"none{k}": {}}}],
    "forces": [{"type": "torque", "i": "link{n}", "torque": 1}]})");
  ASSERT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.body_name(2), "link3");
  EXPECT_EQ(body(model, "link2").position.x, 1);
  expect_vector(*model.find_point(2, "p6"), 3, 0);
  const auto& pins = list<Revolute<double>>(model);
  ASSERT_EQ(pins.size(), 3u);
  EXPECT_EQ(model.element_name(0), "first");
  EXPECT_EQ(model.element_name(1), "revolute#2");
  EXPECT_EQ(pins[2].i, 1);
  EXPECT_EQ(pins[2].j, 2);
  EXPECT_EQ(model.element_type(3), "torque");
}

TEST(BuildModel, BlocksWithinBlocks) {
  const Model model = build(R"({"catena": 1, "replicate": [{"count": 2, "variable": "row", "replicate": [
    {"count": "=row+1", "first": 0, "bodies": {"b{row}_{k}": {"position": ["=k", "=row"]}}}]}]})");
  ASSERT_EQ(model.bodies.size(), 5u);
  EXPECT_EQ(model.body_name(0), "b1_0");
  EXPECT_EQ(model.body_name(4), "b2_2");
  expect_vector(body(model, "b2_2").position, 2, 2);
}

TEST(BuildModel, TimeMakesADriverWhicheverListItStandsIn) {
  const Model model = build(R"({"catena": 1, "bodies": {"a": {}},
    "constraints": [{"type": "absolute_x", "i": "a", "value": {"polynomial": [1, 2]}},
                    {"type": "absolute_y", "i": "a", "value": {"polynomial": [3]}}],
    "drivers": [{"type": "absolute_angle", "i": "a", "value": {"product": [{"sum": [1, {"step": {"t0": 0, "t1": 1, "from": 0, "to": 2}}]}, 3]}}]})");
  EXPECT_EQ(model.elements[0].kind, ElementKind::driver);
  EXPECT_EQ(model.elements[1].kind, ElementKind::constraint);
  EXPECT_EQ(list<AbsoluteY<double>>(model)[0].values[0].constant, 3);
  EXPECT_EQ(model.elements[2].kind, ElementKind::driver);
  ASSERT_EQ(model.functions.size(), 2u);
  EXPECT_EQ(model.functions[1].evaluate(2).f, 9);
}

TEST(BuildModel, LargerScenesThanAllowedAreRefused) {
  EXPECT_EQ(build(R"({"catena": 1, "replicate": [{"count": 100, "bodies": {"b{k}": {}}}]})", 100).bodies.size(), 100u);
}

// Derivatives with respect to two parameters against central differences, through rods, `at`, parts, functions and
// constants that are taken from the configuration.
TEST(BuildModel, DualNumbersCarryDesignDerivatives) {
  using D = Dual<double, 4>;
  const std::string text = R"({"catena": 1, "parameters": {"l": 0.3, "w": 0.7},
    "bodies": {"a": {"mass": "=2+w", "rod": {"from": [0, 0], "to": ["l", "=l*w"]}},
               "b": {"position": ["=2*l", 1], "angle": "w", "parts": [{"mass": 1, "disc": {"centre": ["l", 0], "radius": "w"}},
                                                                    {"mass": 2, "centroid": [0, "w"]}]}},
    "constraints": [{"type": "revolute", "i": "a", "j": "b", "at": ["=l+1", "w"]}, {"type": "coupler", "i": "a.to", "j": "b"}],
    "drivers": [{"type": "absolute_angle", "i": "a", "value": {"harmonic": {"amplitude": "w", "omega": "=3*l"}}}]})";
  Diagnostics diagnostics;
  const auto scene = read_scene(SourceText("scene", text), diagnostics);
  ASSERT_TRUE(scene);
  const auto measures = []<class S>(const BasicModel<S>& model) {
    const auto& pin = std::get<std::vector<ElementEntry<Revolute<S>, S>>>(model.constraints)[0].element;
    const auto& coupler = std::get<std::vector<ElementEntry<Coupler<S>, S>>>(model.constraints)[0];
    return std::vector<S>{model.bodies[0].angle,
                          model.bodies[0].inertia,
                          model.bodies[1].inertia,
                          model.bodies[1].origin.x,
                          model.bodies[1].position.y,
                          pin.s_i.x,
                          pin.s_j.y,
                          coupler.values[0].constant,
                          model.functions[0].evaluate(0.4).f};
  };
  const auto at = [&](double l, double w) {
    const std::vector<double> values{l, w};
    return measures(build_model<double>(*scene, std::span<const double>(values), {}, diagnostics));
  };
  const std::vector<D> seeds{D::variable(0.3, 0), D::variable(0.7, 1)};
  const std::vector<D> exact = measures(build_model<D>(*scene, std::span<const D>(seeds), {}, diagnostics));
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
  const double h = 1e-5;
  const auto plain = at(0.3, 0.7), l1 = at(0.3 + h, 0.7), l0 = at(0.3 - h, 0.7), w1 = at(0.3, 0.7 + h),
             w0 = at(0.3, 0.7 - h);
  for (std::size_t k = 0; k < exact.size(); ++k) {
    EXPECT_DOUBLE_EQ(exact[k].v, plain[k]) << k;
    EXPECT_NEAR(exact[k].d[0], (l1[k] - l0[k]) / (2 * h), 1e-8) << k;
    EXPECT_NEAR(exact[k].d[1], (w1[k] - w0[k]) / (2 * h), 1e-8) << k;
  }
}

}  // namespace
}  // namespace catena::testing
