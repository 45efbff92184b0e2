// Drawings of mechanisms: every element has a look, links reach their pins, gears mesh, figures show the true pose.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <set>

#include "catena/drawing/shapes/guide_travel.hpp"
#include "catena/drawing/shapes/pen.hpp"
#include "catena/drawing/shapes/placement.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/scene/explaining/example.hpp"
#include "catena/scene/viewing/record_figure.hpp"
#include "drawing/recorded_text.hpp"
#include "drawing/svg_text.hpp"

namespace catena::testing {
namespace {

namespace fs = std::filesystem;

/// All corners of a drawing at the given configuration.
std::vector<Vec2<double>> corners_of(const Model& model, const Drawing& drawing, double size) {
  std::vector<Vec2<double>> corners;
  const std::vector<Frame<double>> frames = given_poses(model);
  for (const DrawnShape& shape : drawing.shapes) {
    const Placement placement = place(shape, frames, size);
    for (const DrawnLine& line : drawing.symbols.at(static_cast<std::size_t>(shape.symbol)).lines) {
      for (const Vec2<double>& p : line.points) corners.push_back(placement(p));
    }
  }
  return corners;
}

TEST(Drawings, OfAllScenesAreFiniteAndShowEveryBody) {
  for (const auto& entry : fs::directory_iterator(CATENA_DATA_DIR "/scenes")) {
    const std::string name = entry.path().filename().string();
    if (name == "linkage_100000.json") continue;  // its size is a matter of the tests of pages
    SCOPED_TRACE(name);
    RunRecorder recorder;
    RunOptions options;
    options.verb = "check";
    options.poses = &recorder;
    run_scene(entry.path().string(), options, recorder);
    ASSERT_TRUE(recorder.record().model);
    const Model& model = *recorder.record().model;
    const Drawing drawing = draw_model(model);
    for (const Vec2<double>& p : corners_of(model, drawing, 0.01))
      ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
    std::set<int> bodies;
    for (const DrawnShape& shape : drawing.shapes) {
      bodies.insert(shape.body_i);
      bodies.insert(shape.body_j);
      ASSERT_LT(shape.element, static_cast<int>(model.elements.size()));
    }
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) EXPECT_TRUE(bodies.count(b)) << model.body_name(b);
    const DrawnFigure figure = draw_record(recorder.record(), {});
    EXPECT_EQ(svg_fault(figure.file), "");
  }
}

/// What an element of a scene adds to the drawing: shapes and arrows.
int shapes_of(const Model& model, int element) {
  const Drawing drawing = draw_model(model);
  const auto own = [&](const auto& part) { return part.element == element; };
  return static_cast<int>(std::count_if(drawing.shapes.begin(), drawing.shapes.end(), own) +
                          std::count_if(drawing.loads.begin(), drawing.loads.end(), own));
}

// Every type that the library knows has a look of its own, but those that prescribe or bound something without a place.
TEST(Drawings, ShowEveryTypeOfElement) {
  const std::set<std::string_view> placeless{"absolute_angle", "displacement", "friction", "relative_angle",
                                             "relative_x",     "relative_y",   "stop"};
  for (const ElementDescription& type : element_descriptions()) {
    SCOPED_TRACE(type.type);
    const RecordedText run = record_text(example_scene(type));
    ASSERT_TRUE(run.record().model) << run.outcome.error_text;
    const Model& model = *run.record().model;
    EXPECT_EQ(shapes_of(model, model.find_element("A")) > 0, !placeless.contains(type.type));
    for (const Vec2<double>& p : corners_of(model, draw_model(model), 0.1))
      EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
  }
}

// Forms of elements that their examples do not show.
TEST(Drawings, ShowElementsInAllTheirForms) {
  const std::string text = R"({"catena": 1,
    "bodies": {"a": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}}, "b": {"mass": 1, "inertia": 1, "position": [3, 1]}},
    "constraints": [{"type": "revolute", "name": "G", "i": "ground", "j": "a.from"}, ELEMENT]})";
  const std::string elements[] = {
      R"({"type": "gear", "name": "A", "i": "a", "j": "b", "radius_i": 1, "radius_j": 3.7, "internal": true})",
      R"({"type": "belt", "name": "A", "i": "a", "j": "b", "radius_i": 0.3, "radius_j": 0.5, "crossed": true})",
      R"({"type": "point_on_curve", "name": "A", "i": "a", "j": "b", "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}})"};
  for (const std::string& element : elements) {
    SCOPED_TRACE(element);
    const RecordedText run = record_text(std::string(text).replace(text.find("ELEMENT"), 7, element));
    ASSERT_TRUE(run.record().model) << run.outcome.error_text;
    const Model& model = *run.record().model;
    EXPECT_GT(shapes_of(model, model.find_element("A")), 0);
    for (const Vec2<double>& p : corners_of(model, draw_model(model), 0.1))
      EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
  }
}

/// A random mechanism that floats: bodies with elements of many types between them, nothing on the ground.
Model random_model(std::mt19937& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  const auto place = [&] { return Vec2<double>{part(random), part(random)}; };
  Model model;
  const int bodies = 2 + static_cast<int>(random() % 5);
  for (int b = 0; b < bodies; ++b)
    model.add_body("b" + std::to_string(b),
                   {.position = {3.0 * b + part(random), part(random)}, .angle = 4 * part(random)});
  for (int e = 0; e < 12; ++e) {
    const int i = static_cast<int>(random() % static_cast<unsigned>(bodies));
    const int j = (i + 1) % bodies;
    const Vec2<double> s_i = place(), s_j = place(), axis{1 + part(random) / 2, part(random)};
    switch (random() % 9) {
      case 0:
        model.add("", Revolute<double>{s_i, s_j}, i, j);
        break;
      case 1:
        model.add("", Translational<double>{s_i, s_j, axis, {}}, i, j);
        break;
      case 2:
        model.add("", Slot<double>{s_i, s_j, axis}, i, j);
        break;
      case 3:
        model.add("", Coupler<double>{s_i, s_j}, i, j);
        break;
      case 4:
        model.add("", Weld<double>{s_i, s_j}, i, j);
        break;
      case 5:
        model.add_force("", SpringDamper<double>{s_i, s_j, 1.0, part(random) > 0 ? 1.0 : 0.0}, i, j);
        break;
      case 6:
        model.add("", Belt<double>{s_i, s_j, 0.2, 0.3, part(random) > 0}, i, j);
        break;
      case 7:
        model.add("", Gear<double>{s_i, s_j, 0.2, 0.5, part(random) > 0}, i, j);
        break;
      default:
        model.add_force("", TorsionSpring<double>{s_i, s_j, 1.0, 0.0}, i, j);
    }
  }
  return model;
}

// Where a whole mechanism moves its picture moves with it: all corners but those of symbols that stand upright on the
// page.
TEST(Drawings, OfRandomMechanismsMoveWithThem) {
  std::mt19937 random(2024);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int trial = 0; trial < 60; ++trial) {
    const Model model = random_model(random);
    Drawing drawing = draw_model(model);
    std::vector<Frame<double>> frames = given_poses(model), moved;
    observe_guides(drawing, frames);
    fit_guides(drawing, 0.1);
    const Frame<double> motion = make_frame(7 * part(random), 7 * part(random), 4 * part(random));
    for (const Frame<double>& f : frames) {
      const Vec2<double> at = motion.point(f.origin());
      moved.push_back(make_frame(at.x, at.y, f.phi + motion.phi));
    }
    int compared = 0;
    for (const DrawnShape& shape : drawing.shapes) {
      if (shape.anchor == Anchor::point && shape.body_j < 0) continue;
      const Placement before = place(shape, frames, 0.1), after = place(shape, moved, 0.1);
      for (const DrawnLine& line : drawing.symbols[static_cast<std::size_t>(shape.symbol)].lines) {
        for (const Vec2<double>& p : line.points) {
          const Vec2<double> away = after(p) - motion.point(before(p));
          ASSERT_LT(norm(away), 1e-9) << "trial " << trial;
          ++compared;
        }
      }
    }
    EXPECT_GT(compared, 10);
  }
}

/// The rim of a wheel on the line of centres: how far it reaches towards `direction` from its centre.
double reach(const Drawing& drawing, std::span<const Frame<double>> frames, int body, const Vec2<double>& centre,
             double direction) {
  double best = 0, nearest = INFINITY;
  for (const DrawnShape& shape : drawing.shapes) {
    const DrawnSymbol& symbol = drawing.symbols[static_cast<std::size_t>(shape.symbol)];
    if (shape.body_i != body || symbol.lines.front().role != Role::gear || symbol.lines.front().radius > 0) continue;
    const Placement placement = place(shape, frames, 1);
    const std::vector<Vec2<double>>& rim = symbol.lines.front().points;
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const Vec2<double> p = placement(rim[k]) - centre, q = placement(rim[(k + 1) % rim.size()]) - centre;
      const Vec2<double> middle = 0.5 * (p + q);
      const double away = std::abs(std::remainder(std::atan2(middle.y, middle.x) - direction, 2 * std::numbers::pi));
      if (away < nearest) {
        nearest = away;
        best = norm(middle);
      }
    }
  }
  return best;
}

// Over whole turns of both wheels: at the pitch point never two teeth or two gaps. Angles follow from the radii alone.
TEST(Drawings, OfGearsMeshWhereverTheyTurn) {
  for (const bool internal : {false, true}) {
    const double radius_a = 0.3, radius_b = 1.05, distance = internal ? radius_b - radius_a : radius_a + radius_b;
    const double start = 0.4;  // of the line of centres
    Model model;
    const int a = model.add_body("a", {.angle = 0.3});
    const int b =
        model.add_body("b", {.position = {distance * std::cos(start), distance * std::sin(start)}, .angle = -1.1});
    Gear<double> gear;
    gear.radius_i = radius_a;
    gear.radius_j = radius_b;
    gear.internal = internal;
    model.add("mesh", gear, a, b);
    const Drawing drawing = draw_model(model);
    int teeth_meet = 0;
    for (int k = 0; k < 400; ++k) {
      const double turn = 0.037 * k;
      const double angle_b = -1.1 + (internal ? 1 : -1) * turn * radius_a / radius_b;
      const Vec2<double> at_b = model.frame(b).origin();
      const std::vector<Frame<double>> frames{make_frame(0.0, 0.0, 0.3 + turn), make_frame(at_b.x, at_b.y, angle_b)};
      const double towards = internal ? start + std::numbers::pi : start;
      const double reach_a = reach(drawing, frames, a, {0, 0}, towards);
      const double reach_b = reach(drawing, frames, b, at_b, start + std::numbers::pi);
      // A tooth of one in the gap of the other: together as long as the distance of the centres.
      const double sum = internal ? reach_b - reach_a : reach_a + reach_b;
      if (std::abs(sum - distance) > 0.6 * radius_a / 18) ++teeth_meet;
    }
    // Where flanks pass the pitch point the nearest pieces of the two rims may differ: a small part of all places.
    EXPECT_LT(teeth_meet, 60) << (internal ? "internal" : "external");
  }
}

// A crank-rocker at a quarter turn, its pins by plane geometry: two circles about the known joints meet at the third.
TEST(Figures, ShowTheTruePose) {
  const RecordedText run = record_text(R"({"catena": 1,
    "bodies": {"crank": {"rod": {"from": [0, 0], "to": [0.1, 0]}}, "coupler": {"rod": {"from": [0.1, 0], "to": [0.256, 0.195]}},
               "rocker": {"rod": {"from": [0.3, 0], "to": [0.256, 0.195]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
                    {"type": "revolute", "i": "crank.to", "j": "coupler.from"},
                    {"type": "revolute", "i": "coupler.to", "j": "rocker.to"},
                    {"type": "revolute", "i": ["ground", [0.3, 0]], "j": "rocker.from"}],
    "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0, 1]}}],
    "analyses": [{"type": "kinematics", "at": [0, 1, 2]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<SvgCircle> pins = svg_circles(draw_record(run.record(), {.at = {2}}).file);
  ASSERT_EQ(pins.size(), 4u);
  const double coupler = std::hypot(0.156, 0.195), rocker = std::hypot(0.044, 0.195);
  const Vec2<double> tip{0.1 * std::cos(2.0), 0.1 * std::sin(2.0)}, base{0.3, 0};
  const Vec2<double> h = base - tip;
  const double d = norm(h), along = (d * d + coupler * coupler - rocker * rocker) / (2 * d);
  const double across = std::sqrt(coupler * coupler - along * along);
  const Vec2<double> joint = tip + (along / d) * h - (across / d) * perpendicular(h);
  const Vec2<double> upper = joint.y > 0 ? joint : tip + (along / d) * h + (across / d) * perpendicular(h);
  const Vec2<double> wanted[] = {{0, 0}, tip, upper, base};
  const double scale = norm(pins[3].centre - pins[0].centre) / 0.3;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2<double> found = (pins[k].centre - pins[0].centre) / scale;
    EXPECT_NEAR(found.x, wanted[k].x, 0.011 / scale) << k;  // two decimals in the file
    EXPECT_NEAR(found.y, wanted[k].y, 0.011 / scale) << k;
  }
}

TEST(Figures, SayWhatTheyCannotShow) {
  const RecordedText run = record_text(R"({"catena": 1, "bodies": {"arm": {"points": {"tip": [1, 0]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "arm"}],
    "drivers": [{"type": "absolute_angle", "i": "arm", "value": {"polynomial": [0, 1]}}],
    "analyses": [{"type": "kinematics", "until": 1, "every": 0.25}]})");
  const auto message_of = [&](const DrawRequest& request) {
    try {
      draw_record(run.record(), request);
    } catch (const FigureError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was said");
  };
  EXPECT_NE(message_of({.traces = {"arm.tipp"}}).find("did you mean \"arm.tip\""), std::string::npos);
  EXPECT_NE(message_of({.analysis = 4}).find("there is no analysis 4"), std::string::npos);
  const DrawnFigure between = draw_record(run.record(), {.at = {0.3}});
  ASSERT_EQ(between.notes.size(), 1u);
  EXPECT_NE(between.notes[0].find("0.25"), std::string::npos);
  EXPECT_TRUE(draw_record(run.record(), {.at = {0.25}}).notes.empty());
}

TEST(Figures, OfASceneWithoutAnalysesShowItAsGiven) {
  const RecordedText run = record_text(R"({"catena": 1, "bodies": {"stone": {"mass": 1, "inertia": 1}}})");
  const DrawnFigure figure = draw_record(run.record(), {});
  EXPECT_EQ(svg_fault(figure.file), "");
  ASSERT_EQ(figure.notes.size(), 1u);
  EXPECT_NE(figure.notes[0].find("given configuration"), std::string::npos);
}

// Shapes that a body is given: a rectangle turned by its angle, about a centroid that is not the body's origin.
TEST(BodyShapes, AreDrawnInTheFrameOfTheirAuthor) {
  const RecordedText run = record_text(R"({"catena": 1, "bodies": {
    "plate": {"mass": 1, "inertia": 1, "position": [5, 5], "centroid": [1, 2],
              "draw": [{"rectangle": {"centre": [1, 0], "width": 2, "height": 4, "angle": "90 deg"}},
                       {"disc": {"centre": [0, 0], "radius": 0.5}}, {"line": [[0, 0], [3, 0]]}]},
    "block": {"parts": [{"mass": 2, "polygon": [[0, 0], [1, 0], [0, 1]]}, {"mass": -1, "disc": {"radius": 0.1}}]}}})");
  ASSERT_TRUE(run.record().model) << run.outcome.error_text;
  const Model& model = *run.record().model;
  ASSERT_EQ(model.shapes.size(), 5u);
  const Frame<double> plate = model.frame(0);
  const Vec2<double> corner = plate.point(model.shapes[0].points[0]);
  EXPECT_NEAR(corner.x, 5 + 1 + 2, 1e-12);  // (-1, -2) turned by a quarter is (2, -1)
  EXPECT_NEAR(corner.y, 5 + 0 - 1, 1e-12);
  EXPECT_NEAR(plate.point(model.shapes[1].points[0]).x, 5, 1e-12);
  EXPECT_EQ(model.shapes[1].radius, 0.5);
  EXPECT_FALSE(model.shapes[2].closed);
  EXPECT_TRUE(model.shapes[3].closed);
  EXPECT_FALSE(model.shapes[4].closed) << "a hole is an outline";
}

}  // namespace
}  // namespace catena::testing
