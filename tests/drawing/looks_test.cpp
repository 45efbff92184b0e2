// What an engineer looks for in a picture: nothing hides what matters, nothing floats, nothing sticks out.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "catena/drawing/shapes/guide_travel.hpp"
#include "catena/drawing/shapes/pen.hpp"
#include "catena/drawing/shapes/placement.hpp"
#include "catena/scene/viewing/record_figure.hpp"
#include "drawing/recorded_text.hpp"
#include "drawing/svg_text.hpp"

namespace catena::testing {
namespace {

RecordedText record_scene(const std::string& name) {
  std::ifstream in(CATENA_DATA_DIR "/scenes/" + name + ".json");
  return record_text(std::string(std::istreambuf_iterator<char>(in), {}));
}

const DrawnLine& first_line(const Drawing& drawing, const DrawnShape& shape) {
  return drawing.symbols.at(static_cast<std::size_t>(shape.symbol)).lines.front();
}

/// As pages and figures have it: guides as long as the last analysis needs them.
Drawing fitted_drawing(const RecordedAnalysis& analysis) {
  Drawing drawing = draw_model(*analysis.model);
  for (std::size_t k = 0; k < analysis.poses.size(); ++k)
    observe_guides(drawing, frames_of(analysis.layout, analysis.poses[k]));
  fit_guides(drawing, 0.2 * drawing.typical_length);
  return drawing;
}

// A gear on the shaft of a cam is larger than the cam: its area lies below everything else, its rim is no area.
TEST(Looks, WheelsHideNothing) {
  for (const std::string name : {"cam_harmonic_lift", "planetary_gear", "belt_drive", "tackle"}) {
    SCOPED_TRACE(name);
    const RecordedText run = record_scene(name);
    ASSERT_TRUE(run.record().model) << run.outcome.error_text;
    const Drawing drawing = draw_model(*run.record().model);
    bool others = false;
    int wheels = 0;
    for (const DrawnShape& shape : drawing.shapes) {
      const DrawnLine& line = first_line(drawing, shape);
      if (line.role == Role::wheel) {
        ++wheels;
        EXPECT_TRUE(line.filled);
        EXPECT_FALSE(others) << "something lies below a wheel";
      } else {
        others = true;
        EXPECT_FALSE(line.role == Role::gear && line.filled) << "the rim of a wheel is filled";
      }
    }
    EXPECT_GE(wheels, 2);
  }
}

// The pulleys of a belt drive name points of their rims: no bar goes there, which would stick out of the wheel.
TEST(Looks, NoBarSticksOutOfAWheel) {
  const RecordedText run = record_scene("belt_drive");
  const Drawing drawing = draw_model(*run.record().model);
  for (const DrawnShape& shape : drawing.shapes) EXPECT_NE(first_line(drawing, shape).role, Role::link);
  // What goes on beyond the rim has a bar, from the middle of the wheel.
  const RecordedText arm = record_text(R"({"catena": 1,
    "bodies": {"a": {"points": {"rim": [0.3, 0], "tip": [0, 2]}}, "b": {"position": [1, 0]}},
    "constraints": [{"type": "belt", "i": "a", "j": "b", "radius_i": 0.3, "radius_j": 0.2}], "analyses": [{"type": "check"}]})");
  ASSERT_TRUE(arm.record().model) << arm.outcome.error_text;
  const Drawing with_arm = draw_model(*arm.record().model);
  int bars = 0;
  for (const DrawnShape& shape : with_arm.shapes) {
    if (first_line(with_arm, shape).role != Role::link) continue;
    ++bars;
    EXPECT_EQ(norm(shape.point_i) + norm(shape.point_j), 2) << "from the middle to the tip";
  }
  EXPECT_EQ(bars, 1);
}

// A Geneva wheel is held at its middle, and its slot is far from there: the wheel's bar joins both and bears the slot.
TEST(Looks, SlotsBelongToTheirBody) {
  const RecordedText run = record_scene("geneva");
  const RecordedAnalysis& motion = run.record().analyses.back();
  const Drawing drawing = fitted_drawing(motion);
  ASSERT_EQ(drawing.guides.size(), 1u);
  const DrawnGuide& guide = drawing.guides[0];
  ASSERT_GE(guide.member, 0);
  const DrawnShape &slot = drawing.shapes.at(static_cast<std::size_t>(guide.shape)),
                   &member = drawing.shapes.at(static_cast<std::size_t>(guide.member));
  EXPECT_EQ(member.body_i, motion.model->find_body("wheel"));
  EXPECT_EQ(first_line(drawing, member).role, Role::link);
  EXPECT_EQ(first_line(drawing, slot).role, Role::joint) << "the slot lies upon the link";
  const double reach = norm(slot.point_j - guide.point_i), bar = norm(member.point_j - member.point_i);
  EXPECT_NEAR(bar, std::max(reach, norm(slot.point_i - guide.point_i)), 1e-12);
  EXPECT_GT(norm(slot.point_i - slot.point_j), 0.01);
}

// The figure of one instant has the guides of the whole motion, as the page: figures of two instants fit each other.
TEST(Looks, GuidesAreThoseOfTheWholeMotion) {
  const RecordedText run = record_scene("scotch_yoke");
  const RecordedAnalysis& motion = run.record().analyses.back();
  const double first = motion.poses[0][PoseLayout::time], later = motion.poses[5][PoseLayout::time];
  const Drawing drawing = fitted_drawing(motion);
  double slot = 0;  // length of the longest guide, m
  for (const DrawnGuide& guide : drawing.guides) {
    const DrawnShape& shape = drawing.shapes.at(static_cast<std::size_t>(guide.shape));
    slot = std::max(slot, norm(shape.point_j - shape.point_i));
  }
  ASSERT_GT(slot, 0.15);
  for (const double t : {first, later}) {
    const Vec2<double> both = svg_size(draw_record(run.record(), {.at = {t, later}}).file),
                       one = svg_size(draw_record(run.record(), {.at = {t}}).file);
    EXPECT_NEAR(one.x, both.x, 0.5) << t;
    EXPECT_NEAR(one.y, both.y, 8) << t;
  }
}

// A floor under a ball is seen as one, although nothing in the scene is a link.
TEST(Looks, AFloorIsSeenUnderItsBall) {
  const RecordedText run = record_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"ball": {"mass": 1, "inertia": 1, "position": [0, 1]}},
    "forces": [{"type": "contact", "i": "ground", "j": "ball", "radius": 0.05, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
    "analyses": [{"type": "dynamics", "until": 0.2, "every": 0.1}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const Drawing drawing = fitted_drawing(run.record().analyses.back());
  EXPECT_EQ(drawing.typical_length, 0.1);
  ASSERT_EQ(drawing.guides.size(), 1u);
  const DrawnShape& floor = drawing.shapes.at(static_cast<std::size_t>(drawing.guides[0].shape));
  EXPECT_NEAR(norm(floor.point_j - floor.point_i), 2 * 0.2 * 0.1, 1e-12) << "a fifth of the ball on either side";
}

// The best design of an optimisation, not the given one: a crank of 0.4 on a ground of 1.2.
TEST(Looks, OptimisationsShowTheirBestDesign) {
  const RecordedText run = record_scene("path_generation");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const DrawnFigure figure = draw_record(run.record(), {});
  ASSERT_EQ(figure.notes.size(), 1u);
  EXPECT_NE(figure.notes[0].find("\"best\" of optimise"), std::string::npos) << figure.notes[0];
  const std::vector<SvgCircle> pins = svg_circles(figure.file);
  ASSERT_GE(pins.size(), 4u);
  double nearest = INFINITY, farthest = 0;
  for (const SvgCircle& pin : pins) {
    if (norm(pin.centre - pins[0].centre) > 1) nearest = std::min(nearest, norm(pin.centre - pins[0].centre));
  }
  for (const SvgCircle& pin : pins) {
    if (std::abs(pin.centre.y - pins[0].centre.y) < 0.02)
      farthest = std::max(farthest, norm(pin.centre - pins[0].centre));
  }
  EXPECT_NEAR(nearest / farthest, 0.4 / 1.2, 1e-3);
}

TEST(Looks, AnInstantIsANumber) {
  const RecordedText run = record_scene("crank_rocker");
  for (const double t : {std::nan(""), double(INFINITY)})
    EXPECT_THROW(draw_record(run.record(), {.at = {t}}), FigureError);
}

}  // namespace
}  // namespace catena::testing
