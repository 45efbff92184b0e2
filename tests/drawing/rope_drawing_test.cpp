// Ropes in drawings: tangents of their circles and arcs on them, by plane geometry that shares nothing with the
// library.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>

#include "catena/drawing/shapes/pen.hpp"
#include "catena/drawing/shapes/rope_points.hpp"
#include "catena/scene/viewing/record_figure.hpp"
#include "drawing/recorded_text.hpp"
#include "drawing/svg_text.hpp"

namespace catena::testing {
namespace {

double length_of(const std::vector<Vec2<double>>& points) {
  double length = 0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) length += norm(points[k + 1] - points[k]);
  return length;
}

/// On which side of the way from p to q a place lies: positive on the left.
double left_of(const Vec2<double>& p, const Vec2<double>& q, const Vec2<double>& place) {
  return cross(q - p, place - p);
}

// Two weights over one pulley: both hang straight down, half a turn of rope lies on the pulley.
TEST(RopePoints, OfTwoWeightsOverAPulley) {
  const double r = 0.3;
  const RopePath rope{.nodes = {{ground, {-r, -1}}, {ground, {0, 0}, -r}, {ground, {r, -2}}}};
  const std::vector<Vec2<double>> points = rope_points(rope, {});
  ASSERT_GT(points.size(), 20u);
  EXPECT_NEAR(norm(points[1] - Vec2<double>{-r, 0}), 0, 1e-12);
  EXPECT_NEAR(norm(points[points.size() - 2] - Vec2<double>{r, 0}), 0, 1e-12);
  // Chords are shorter than their arcs by 1/24 of the square of the angle, pi/32.
  EXPECT_NEAR(length_of(points), 3 + std::numbers::pi * r, 5e-4);
  EXPECT_LT(length_of(points), 3 + std::numbers::pi * r);
}

// Random ways over circles that turn with bodies. What makes a tangent: a corner at the distance of the radius, a
// straight piece at right angles to it, the circle on its own side. A circle that is not touched lies on its own side
// of the straight piece that passes it, farther than its radius.
TEST(RopePoints, AreTangentsAndArcs) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> part(-1, 1);
  int arcs = 0, points_on_way = 0, passed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    RopePath rope;
    std::vector<Frame<double>> frames;
    std::vector<Vec2<double>> centres;
    const int nodes = 3 + static_cast<int>(random() % 4);
    for (int k = 0; k < nodes; ++k) {
      const bool end = k == 0 || k + 1 == nodes;
      const bool point = end || random() % 4 == 0;
      frames.push_back(make_frame(3.0 * k, 2 * part(random), 5 * part(random)));
      rope.nodes.push_back({k, {part(random) / 3, part(random) / 3}, point ? 0 : (part(random) > 0 ? 1 : -1) * 0.5});
      centres.push_back(frames.back().point(rope.nodes.back().centre));
      points_on_way += point ? 1 : 0;
    }
    const std::vector<Vec2<double>> points = rope_points(rope, frames);
    std::size_t at = 0;
    for (int k = 0, m = 1; k + 1 < nodes; k = m++) {
      const RopeNode& from = rope.nodes[static_cast<std::size_t>(k)];
      const Vec2<double> c = centres[static_cast<std::size_t>(k)];
      ASSERT_LT(at + 1, points.size());
      const Vec2<double> p = points[at], q = points[at + 1];
      const auto is_touched = [&](int node) {
        return std::abs(norm(q - centres[static_cast<std::size_t>(node)]) -
                        std::abs(rope.nodes[static_cast<std::size_t>(node)].radius)) < 1e-11;
      };
      for (; !is_touched(m) && m + 1 < nodes; ++m, ++passed) {
        const double r = rope.nodes[static_cast<std::size_t>(m)].radius;
        ASSERT_GT(left_of(p, q, centres[static_cast<std::size_t>(m)]) * (r > 0 ? 1 : -1), std::abs(r)) << trial;
      }
      const RopeNode& to = rope.nodes[static_cast<std::size_t>(m)];
      const Vec2<double> next = centres[static_cast<std::size_t>(m)];
      ASSERT_NEAR(norm(p - c), std::abs(from.radius), 1e-12) << "trial " << trial;
      ASSERT_NEAR(norm(q - next), std::abs(to.radius), 1e-12) << "trial " << trial;
      ASSERT_NEAR(dot(q - p, p - c), 0, 1e-11) << "trial " << trial;
      ASSERT_NEAR(dot(q - p, q - next), 0, 1e-11) << "trial " << trial;
      ASSERT_TRUE(from.radius == 0 || left_of(p, q, c) * from.radius > 0) << "trial " << trial;
      ASSERT_TRUE(to.radius == 0 || left_of(p, q, next) * to.radius > 0) << "trial " << trial;
      ++at;
      if (m + 1 == nodes) break;
      if (to.radius == 0) {
        ++at;
        continue;
      }
      // The arc goes round its circle in one sense, by less than a turn, to where the next straight piece begins.
      double turned = 0;
      for (int piece = 0; piece < 32; ++piece, ++at) {
        ASSERT_LT(at + 1, points.size());
        const Vec2<double> a = points[at] - next, b = points[at + 1] - next;
        ASSERT_NEAR(norm(b), std::abs(to.radius), 1e-12);
        const double step = std::atan2(cross(a, b), dot(a, b)) * (to.radius > 0 ? 1 : -1);
        turned += step;
      }
      // Backwards by no more than what counts as grazing.
      ASSERT_GE(turned, -0.01) << "trial " << trial;
      ASSERT_LT(turned, 2 * std::numbers::pi) << "trial " << trial;
      ++arcs;
    }
    // As many corners whatever is passed.
    for (; at < points.size(); ++at) ASSERT_EQ(norm(points[at] - points.back()), 0) << "trial " << trial;
  }
  EXPECT_GT(arcs, 200);
  EXPECT_GT(passed, 50);
  EXPECT_GT(points_on_way, 700);
}

// A circle that holds the next one has no tangent in common with it: a gap, not a wrong line.
TEST(RopePoints, LeaveOutWhatDoesNotExist) {
  const RopePath rope{.nodes = {{ground, {0, 0}}, {ground, {2, 0}, 0.5}, {ground, {2.1, 0}}}};
  const std::vector<Vec2<double>> points = rope_points(rope, {});
  EXPECT_TRUE(std::isfinite(points[0].x) && std::isfinite(points[1].x));
  EXPECT_FALSE(std::isfinite(points.back().x));
}

// Data of a page are rounded: a rope that grazes a circle may seem to bend away from it a little, and must not be drawn
// all around it.
TEST(RopePoints, DoNotGoRoundACircleThatIsGrazed) {
  for (const double off : {-1e-3, -1e-7, 0.0, 1e-7, 1e-3}) {
    const RopePath rope{.nodes = {{ground, {-1, 0}}, {ground, {0, -0.2 + off}, -0.2}, {ground, {1, 0}}}};
    EXPECT_NEAR(length_of(rope_points(rope, {})), 2, 1e-3) << off;  // once round it would be 3.3
  }
}

const std::string tackle = CATENA_DATA_DIR "/scenes/tackle.json";

RecordedText record_file(const std::string& path) {
  std::ifstream in(path);
  return record_text(std::string(std::istreambuf_iterator<char>(in), {}));
}

// What leaves the drum by its turning comes to the straight parts: by the drawn pictures alone the ropes keep their
// lengths. The weight's rope winds on the left of the large wheel, the load's on the right of the small one.
TEST(RopeDrawings, KeepTheLengthOfARopeInMotion) {
  const RecordedText run = record_file(tackle);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const RecordedAnalysis& motion = run.record().analyses.back();
  const Drawing drawing = draw_model(*motion.model);
  ASSERT_EQ(drawing.ropes.size(), 2u);
  const int drum = motion.model->find_body("drum");
  const double wheel[] = {-0.3, 0.1};  // radius and sense of winding: with the drum's angle the rope becomes longer
  double first[2] = {}, before[2] = {};
  ASSERT_GT(motion.poses.size(), 5u);
  for (std::size_t k = 0; k < motion.poses.size(); ++k) {
    const std::vector<Frame<double>> frames = frames_of(motion.layout, motion.poses[k]);
    for (std::size_t n = 0; n < 2; ++n) {
      RopePath rope = drawing.ropes[n];
      rope.nodes.pop_back();  // made fast at the middle of the drum, where nothing is drawn
      const std::vector<Vec2<double>> points = rope_points(rope, frames);
      // To the drum's wheel the rope comes at a place that moves round it.
      const Vec2<double> last = points.back() - frames[static_cast<std::size_t>(drum)].origin();
      const double angle = std::atan2(last.y, last.x), turned = frames[static_cast<std::size_t>(drum)].phi;
      const double at = k == 0 ? angle : before[n] + std::remainder(angle - before[n], 2 * std::numbers::pi);
      before[n] = at;
      const double whole = length_of(points) + wheel[n] * (turned - at);
      if (k == 0) first[n] = whole;
      EXPECT_NEAR(whole, first[n], 3e-4) << "rope " << n << ", pose " << k;  // chords of the load's pulley
    }
  }
}

// A way whose first and last parts lie between places that stand still, which are no elements: all of it is drawn.
TEST(RopeDrawings, ShowWhatIsNoElement) {
  const RecordedText run = record_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"load": {"particle": true, "mass": 1, "position": [3, -2]}},
    "forces": [{"type": "rope", "name": "line", "i": ["ground", [0, -1]],
                "over": [{"at": ["ground", [1, 0]], "radius": 0.2}, {"at": ["ground", [2, 0]], "radius": 0.2}],
                "j": "load"}],
    "analyses": [{"type": "check"}]})");
  ASSERT_TRUE(run.record().model) << run.outcome.error_text;
  const Drawing drawing = draw_model(*run.record().model);
  ASSERT_EQ(drawing.ropes.size(), 1u);
  const std::vector<Vec2<double>> points = rope_points(drawing.ropes[0], given_poses(*run.record().model));
  EXPECT_NEAR(norm(points.front() - Vec2<double>{0, -1}), 0, 1e-12);
  EXPECT_NEAR(norm(points.back() - Vec2<double>{3, -2}), 0, 1e-12);
  double highest = -1;
  for (const Vec2<double>& p : points) highest = std::max(highest, p.y);
  EXPECT_NEAR(highest, 0.2, 1e-12) << "straight from the top of one pulley to the top of the other";
}

// Of a rope that turns a wheel between its ends, both parts touch the wheel up to where the other one leaves it.
TEST(RopeDrawings, GoOnOverAWheelThatRolls) {
  const RecordedText run = record_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"a": {"particle": true, "mass": 1, "position": [-0.5, -1]}, "b": {"particle": true, "mass": 1.1, "position": [0.5, -2]},
               "wheel": {"mass": 1, "inertia": 0.1}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "wheel"}],
    "forces": [{"type": "rope", "name": "line", "i": "a", "over": [{"at": "wheel", "radius": 0.5, "side": -1, "pulley": "rolls"}], "j": "b"}],
    "analyses": [{"type": "check"}]})");
  ASSERT_TRUE(run.record().model) << run.outcome.error_text;
  const Model& model = *run.record().model;
  const Drawing drawing = draw_model(model);
  ASSERT_EQ(drawing.ropes.size(), 2u);
  EXPECT_NE(drawing.ropes[0].element, drawing.ropes[1].element);
  const std::vector<Vec2<double>> first = rope_points(drawing.ropes[0], given_poses(model)),
                                  second = rope_points(drawing.ropes[1], given_poses(model));
  EXPECT_NEAR(norm(first.back() - second.front()), 0, 1e-12);
  EXPECT_NEAR(length_of(first) + length_of(second), 1 + 2 + 0.5 * std::numbers::pi, 1e-3);
}

// The figure has the same ropes: the corner where the weight's rope leaves the large wheel, found by its circle.
TEST(RopeDrawings, OfFiguresTouchTheirPulleys) {
  const RecordedText run = record_file(tackle);
  const std::string file = draw_record(run.record(), {.at = {0.5}}).file;
  SvgCircle drum{};
  for (const SvgCircle& circle : svg_circles(file)) {
    if (circle.radius > drum.radius) drum = circle;
  }
  int touching = 0;
  for (Vec2<double> p : svg_corners(file)) {
    p.y = -p.y;
    // On the right the fixed end of the other rope has the same distance.
    if (p.x < drum.centre.x && std::abs(norm(p - drum.centre) - drum.radius) < 0.02) ++touching;
  }
  EXPECT_EQ(touching, 1);
}

}  // namespace
}  // namespace catena::testing
