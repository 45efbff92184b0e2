// Films: a figure for every pose, all in one scale.
#include <gtest/gtest.h>

#include <cmath>

#include "catena/drawing/figures/svg_canvas.hpp"
#include "catena/scene/viewing/record_figure.hpp"
#include "drawing/recorded_text.hpp"
#include "drawing/svg_text.hpp"

namespace catena::testing {
namespace {

// A slider that is pushed along a guide, by more and more.
const std::string pushed = R"({"catena": 1, "bodies": {"slider": {"mass": 1, "inertia": 1}},
  "constraints": [{"type": "translational", "i": "ground", "j": "slider", "axis_i": [1, 0], "axis_j": [1, 0]}],
  "drivers": [{"type": "displacement", "i": "ground", "j": "slider", "axis_i": [1, 0], "value": {"polynomial": [0, 2]}}],
  "forces": [{"type": "point_force", "i": "slider", "force": [{"polynomial": [1, 3]}, 0]}],
  "analyses": [{"type": "kinematics", "until": 1, "every": 0.25}]})";

/// Keeps the file of a picture when it is finished.
class KeptCanvas final : public VectorCanvas {
 public:
  KeptCanvas(std::unique_ptr<VectorCanvas> canvas, std::string& file) : canvas_(std::move(canvas)), file_(file) {}
  void path(std::span<const Vec2<double>> points, bool closed, const Paint& paint) override {
    canvas_->path(points, closed, paint);
  }
  void circle(const Vec2<double>& centre, double radius, const Paint& paint) override {
    canvas_->circle(centre, radius, paint);
  }
  void text(const Vec2<double>& place, std::string_view text, const TextStyle& style) override {
    canvas_->text(place, text, style);
  }
  void clip(const Vec2<double>& corner, const Vec2<double>& size) override { canvas_->clip(corner, size); }
  void unclip() override { canvas_->unclip(); }
  std::string finish() override { return file_ = canvas_->finish(); }

 private:
  std::unique_ptr<VectorCanvas> canvas_;
  std::string& file_;
};

DrawnFilm film(const RunRecord& record, const DrawRequest& request, std::vector<std::unique_ptr<std::string>>& files) {
  return film_record(record, request, [&](double width, double height) {
    std::string& file = *files.emplace_back(std::make_unique<std::string>());
    return std::make_unique<KeptCanvas>(canvas_maker(FigureFormat::svg, record.header.scene)(width, height), file);
  });
}

TEST(Films, OfOnePoseAreItsFigure) {
  const RecordedText run = record_text(pushed);
  for (const double t : {0.0, 0.5, 1.0}) {
    const DrawRequest request{.at = {t}};
    std::vector<std::unique_ptr<std::string>> files;
    const DrawnFilm drawn = film(run.record(), request, files);
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(drawn.t, std::vector<double>{t});
    EXPECT_EQ(*files.front(), draw_record(run.record(), request).file);
  }
}

TEST(Films, HaveOnePageForAllPoses) {
  const RecordedText run = record_text(pushed);
  std::vector<std::unique_ptr<std::string>> files;
  const DrawnFilm drawn = film(run.record(), {.poses = 5}, files);
  ASSERT_EQ(files.size(), 5u);
  EXPECT_EQ(drawn.t, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  for (const auto& file : files) {
    const Vec2<double> size = svg_size(*file);
    EXPECT_NEAR(size.x, drawn.scale.width, 0.02);
    EXPECT_NEAR(size.y, drawn.scale.height, 0.02);
    for (const Vec2<double>& p : svg_corners(*file))
      EXPECT_TRUE(p.x >= 0 && p.x <= size.x && p.y >= 0 && p.y <= size.y) << p.x << ' ' << p.y;
  }
  // The way of the slider, 2 m, lies within the page.
  EXPECT_LT(drawn.scale.corner.x, 0);
  EXPECT_GT(drawn.scale.corner.x + drawn.scale.width / drawn.scale.scale, 2);
}

}  // namespace
}  // namespace catena::testing
