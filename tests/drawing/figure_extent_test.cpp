// How large figures are, and that everything lies within them: arrows, guides, lone points.
#include <gtest/gtest.h>

#include <cmath>

#include "catena/drawing/figures/plot.hpp"
#include "catena/drawing/figures/svg_canvas.hpp"
#include "catena/drawing/shapes/guide_travel.hpp"
#include "catena/drawing/shapes/pen.hpp"
#include "catena/drawing/shapes/placement.hpp"
#include "catena/scene/viewing/record_figure.hpp"
#include "drawing/recorded_text.hpp"
#include "drawing/svg_text.hpp"

namespace catena::testing {
namespace {

const std::string pushed = R"({"catena": 1, "bodies": {"arm": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 1]}}},
  "constraints": [{"type": "weld", "i": "ground", "j": "arm.from"}],
  "forces": [{"type": "point_force", "i": "arm.from", "force": [FX, FY]},
             {"type": "point_force", "i": "arm.to", "force": [FX, FY]}],
  "analyses": [{"type": "assemble"}]})";

std::string with_force(double fx, double fy) {
  std::string text = pushed;
  for (const auto& [mark, value] : {std::pair("FX", fx), std::pair("FY", fy)}) {
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark))
      text.replace(at, 2, std::to_string(value));
  }
  return text;
}

TEST(FigureExtent, HoldsArrowsOfForces) {
  for (int k = 0; k < 12; ++k) {
    const double angle = 0.5 * k;
    const RecordedText run = record_text(with_force(std::cos(angle), std::sin(angle)));
    for (const double width : {100.0, 480.0, 1200.0}) {
      const std::string file = draw_record(run.record(), {.width = width}).file;
      const Vec2<double> size = svg_size(file);
      EXPECT_NEAR(std::max(size.x, size.y), width, 0.02);
      const std::vector<Vec2<double>> corners = svg_corners(file);
      ASSERT_GT(corners.size(), 10u);
      for (const Vec2<double>& p : corners) {
        EXPECT_TRUE(p.x >= 0 && p.x <= size.x && p.y >= 0 && p.y <= size.y)
            << angle << ": " << p.x << ' ' << p.y << " of " << size.x << ' ' << size.y;
      }
    }
  }
}

// A mechanism without any extent is as large as its arrow.
TEST(FigureExtent, OfASinglePlaceHoldsItsArrow) {
  const RecordedText run = record_text(R"({"catena": 1, "bodies": {"stone": {"mass": 1, "inertia": 1}},
    "forces": [{"type": "point_force", "i": "stone", "force": [-3, 4]}], "analyses": [{"type": "check"}]})");
  const std::string file = draw_record(run.record(), {}).file;
  const Vec2<double> size = svg_size(file);
  EXPECT_GT(size.x, 40);
  EXPECT_LT(size.x, 480);
  for (const Vec2<double>& p : svg_corners(file)) EXPECT_TRUE(p.x >= 0 && p.x <= size.x && p.y >= 0 && p.y <= size.y);
}

TEST(FigureExtent, GrowsWithTheWidthAskedFor) {
  const RecordedText run = record_text(with_force(0, 0));
  for (const double width : {80.0, 480.0, 2000.0}) {
    const Vec2<double> size = svg_size(draw_record(run.record(), {.width = width}).file);
    EXPECT_NEAR(size.x, width, 0.02);
    EXPECT_LE(size.y, width + 0.01);
  }
}

/// From where to where along x the straight shape of an element goes.
std::pair<double, double> reach_of(const RunRecord& record, int element) {
  const RecordedAnalysis& analysis = record.analyses.back();
  Drawing drawing = draw_model(*analysis.model);
  for (std::size_t k = 0; k < analysis.poses.size(); ++k)
    observe_guides(drawing, frames_of(analysis.layout, analysis.poses[k]));
  fit_guides(drawing, 0);
  double low = INFINITY, high = -INFINITY;
  for (const DrawnShape& shape : drawing.shapes) {
    if (shape.element != element || shape.anchor != Anchor::span) continue;
    for (const double x : {shape.point_i.x, shape.point_j.x}) low = std::min(low, x), high = std::max(high, x);
  }
  return {low, high};
}

// What follows the line is the end of a rod, a long way from its centroid.
TEST(FigureExtent, OfStraightCurvesReachesWhatFollowsThem) {
  const std::string rod = R"({"catena": 1, "bodies": {"rod": {"mass": 1, "rod": {"from": [0, 0], "to": [4, 0]}}},
    "LIST": [ELEMENT],
    "drivers": [{"type": "absolute_x", "i": "rod.from", "value": {"polynomial": [0, 1]}},
                {"type": "absolute_y", "i": "rod.from", "value": 0},
                {"type": "absolute_angle", "i": "rod", "value": 0}],
    "analyses": [{"type": "kinematics", "until": 1, "every": 0.1}]})";
  const std::string line = R"("curve": {"line": {"point": [0, 0], "axis": [1, 0]}})";
  const std::pair<std::string, std::string> elements[] = {
      {"constraints", R"({"type": "point_on_curve", "i": "ground", "j": "rod.to", )" + line + "}"},
      {"forces", R"({"type": "contact", "i": "ground", "j": "rod.to", "side": 1, )" + line + "}"}};
  for (const auto& [list, element] : elements) {
    std::string text = rod;
    text.replace(text.find("LIST"), 4, list);
    text.replace(text.find("ELEMENT"), 7, element);
    const RecordedText run = record_text(text);
    ASSERT_FALSE(run.record().analyses.empty()) << run.outcome.error_text;
    ASSERT_GT(run.record().analyses.back().poses.size(), 1u) << run.outcome.analyses.back().report.message;
    const Model& model = *run.record().model;
    const int number = model.element_type(0) == std::string(list == "forces" ? "contact" : "point_on_curve") ? 0 : 3;
    const auto [low, high] = reach_of(run.record(), number);
    EXPECT_NEAR(low, 4 - 0.1, 1e-9) << list;
    EXPECT_NEAR(high, 5 + 0.1, 1e-9) << list;
  }
}

// A value between gaps has no neighbour to draw a line to: it is a dot.
TEST(PlotFigure, ShowsEveryLoneValue) {
  const auto dots = [](const std::vector<double>& y) {
    Plot plot{.title = "", .x_name = "t", .x_unit = "s", .x = {}, .panels = {{"m", {{"y", y}}}}};
    for (std::size_t k = 0; k < y.size(); ++k) plot.x.push_back(static_cast<double>(k));
    return svg_circles(draw_plot(plot, 360, 120,
                                 [](double width, double height) {
                                   return std::make_unique<SvgCanvas>(width, height, "plot");
                                 }))
        .size();
  };
  EXPECT_EQ(dots({1}), 1u);
  EXPECT_EQ(dots({1, 2, 3}), 0u);
  EXPECT_EQ(dots({1, NAN, 2, 3, NAN, 4, NAN}), 2u);
  EXPECT_EQ(dots({NAN, NAN}), 0u);
}

}  // namespace
}  // namespace catena::testing
