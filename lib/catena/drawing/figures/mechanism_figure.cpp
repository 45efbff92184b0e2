#include "catena/drawing/figures/mechanism_figure.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "catena/drawing/figures/role_colours.hpp"
#include "catena/drawing/shapes/guide_travel.hpp"
#include "catena/drawing/shapes/placement.hpp"
#include "catena/drawing/shapes/rope_points.hpp"

namespace catena {
namespace {

constexpr double thin = 0.8;              // points
constexpr double load_length = 9;         // sizes of symbols
constexpr double symbol_room = 4;         // sizes of symbols around everything: supports are that tall
constexpr double palest = 0.8;            // of the first of several poses, towards white
constexpr double smallest_symbol = 0.25;  // points

struct Extent {
  Vec2<double> low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};

  void include(const Vec2<double>& p, double around = 0) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    low = {std::min(low.x, p.x - around), std::min(low.y, p.y - around)};
    high = {std::max(high.x, p.x + around), std::max(high.y, p.y + around)};
  }
};

/// Of an applied force: where it acts, its direction, and its length, m.
struct Arrow {
  Vec2<double> tip, along;
  double length;
};

class Figure {
 public:
  /// `with_loads`: the poses whose loads are shown.
  Figure(const Drawing& drawing, const MechanismFigure& figure, std::span<const FigurePose> with_loads);

  std::string draw(const CanvasMaker& make_canvas) const;
  FilmScale draw_film(const CanvasMaker& make_canvas) const;

 private:
  void find_extent();
  void choose_scale();
  Vec2<double> on_page(const Vec2<double>& p) const {
    return {(p.x - extent_.low.x) * scale_ + room_, height_ - room_ - (p.y - extent_.low.y) * scale_};
  }
  void draw_pose(VectorCanvas& canvas, const FigurePose& pose, double pale) const;
  void draw_line(VectorCanvas& canvas, const DrawnLine& line, const Placement& place, int body, double pale) const;
  /// Those of a symbol, ropes by where they run in this pose.
  std::vector<DrawnLine> lines_of(const DrawnShape& shape, const FigurePose& pose) const;
  void draw_traces(VectorCanvas& canvas) const;
  void draw_loads(VectorCanvas& canvas, const FigurePose& pose) const;
  std::vector<Arrow> arrows(const FigurePose& pose) const;
  Extent extent_with_arrows() const;

  const Drawing& drawing_;
  const MechanismFigure& figure_;
  std::span<const FigurePose> with_loads_;
  double largest_load_ = 0;  // the one with the longest arrow
  Extent extent_;
  double scale_ = 1, room_ = 0, width_ = 0, height_ = 0;
  double size_ = 0, longest_arrow_ = 0;  // of symbols and of arrows, m
};

Figure::Figure(const Drawing& drawing, const MechanismFigure& figure, std::span<const FigurePose> with_loads)
    : drawing_(drawing), figure_(figure), with_loads_(with_loads) {
  for (const FigurePose& pose : with_loads_) {
    for (const Vec2<double>& load : pose.loads) largest_load_ = std::max(largest_load_, norm(load));
  }
  find_extent();
  choose_scale();
}

// With symbols of no size: they get the room around everything.
void Figure::find_extent() {
  for (const FigurePose& pose : figure_.poses) {
    for (const DrawnShape& shape : drawing_.shapes) {
      const Placement placement = place(shape, pose.frames, 0);
      for (const DrawnLine& line : lines_of(shape, pose)) {
        const double around = line.radius * norm(placement.e_v);
        for (const Vec2<double>& p : line.points) extent_.include(placement(p), around);
      }
    }
  }
  for (const auto& trace : figure_.traces) {
    for (const Vec2<double>& p : trace) extent_.include(p);
  }
  if (!(extent_.low.x <= extent_.high.x)) extent_.include({0, 0});
}

std::vector<DrawnLine> Figure::lines_of(const DrawnShape& shape, const FigurePose& pose) const {
  std::vector<DrawnLine> lines = drawing_.symbols[static_cast<std::size_t>(shape.symbol)].lines;
  if (shape.anchor == Anchor::rope)
    lines.front().points = rope_points(drawing_.ropes[static_cast<std::size_t>(shape.rope)], pose.frames);
  return lines;
}

std::vector<Arrow> Figure::arrows(const FigurePose& pose) const {
  std::vector<Arrow> found;
  for (std::size_t k = 0; k < pose.loads.size(); ++k) {
    const DrawnLoad& load = drawing_.loads[k];
    const Frame<double> frame = frame_of_body(pose.frames, load.body);
    const Vec2<double> force = load.in_body_axes ? frame.axis(pose.loads[k]) : pose.loads[k];
    const double size = norm(force);
    if (size > 0) found.push_back({frame.point(load.point), force / size, longest_arrow_ * size / largest_load_});
  }
  return found;
}

Extent Figure::extent_with_arrows() const {
  Extent extent = extent_;
  for (const FigurePose& pose : with_loads_) {
    for (const Arrow& arrow : arrows(pose)) extent.include(arrow.tip - arrow.length * arrow.along);
  }
  return extent;
}

// Symbols and arrows have their size on the page, so that the room for them depends on the scale: each pass leaves as
// much as was needed at the scale before, until that does not change any more. An arrow takes a quarter of the figure
// at most, so that each pass changes the scale by less than half as much as the one before.
void Figure::choose_scale() {
  const Vec2<double> span = extent_.high - extent_.low;
  double points = figure_.symbol_points;
  Extent shown = extent_;
  Vec2<double> beyond{};  // what arrows need on the page, points
  constexpr int most_passes = 20;
  double before = 0;
  for (int pass = 0; pass < most_passes && std::abs(scale_ - before) > 1e-6 * before; ++pass) {
    before = pass > 0 ? scale_ : 0;
    room_ = symbol_room * points + 2;
    const double inside = figure_.width - 2 * room_;
    const auto fitting = [&](double length, double taken) { return length > 0 ? (inside - taken) / length : INFINITY; };
    scale_ = std::min(fitting(span.x, beyond.x), fitting(span.y, beyond.y));
    if (!std::isfinite(scale_)) scale_ = 1;  // a single place
    if (drawing_.typical_length > 0)
      points = std::clamp(0.25 * drawing_.typical_length * scale_, smallest_symbol, figure_.symbol_points);
    size_ = points / scale_;
    longest_arrow_ = std::min(load_length * points, inside / 4) / scale_;
    shown = extent_with_arrows();
    beyond = scale_ * (shown.high - shown.low - span);
  }
  extent_ = shown;
  width_ = (shown.high.x - shown.low.x) * scale_ + 2 * room_;
  height_ = (shown.high.y - shown.low.y) * scale_ + 2 * room_;
}

void Figure::draw_line(VectorCanvas& canvas, const DrawnLine& line, const Placement& placement, int body,
                       double pale) const {
  const Colour edge = mixed(role_colour(line.role, body), white, pale);
  const Colour fill = mixed(role_fill(line.role, body), white, pale);
  if (line.radius > 0) {
    Paint paint{.stroke = edge, .width = thin};
    if (line.filled) paint.fill = fill;
    return canvas.circle(on_page(placement(line.points.front())), line.radius * norm(placement.e_v) * scale_, paint);
  }
  std::vector<Vec2<double>> points;
  for (const Vec2<double>& p : line.points) points.push_back(on_page(placement(p)));
  const double width = line.width * size_ * scale_;
  if (width > 2 * thin) {  // a bar with an edge: the edge's colour below, the bar upon it
    canvas.path(points, line.closed, {.stroke = edge, .width = width + 2 * thin});
    Paint inside{.stroke = line.role == Role::belt || line.role == Role::cable ? edge : fill, .width = width};
    if (line.filled) inside.fill = fill;
    return canvas.path(points, line.closed, inside);
  }
  Paint paint{.stroke = edge, .width = std::max(thin, width), .dashed = line.role == Role::measure};
  if (line.filled) paint.fill = fill;
  canvas.path(points, line.closed, paint);
}

void Figure::draw_pose(VectorCanvas& canvas, const FigurePose& pose, double pale) const {
  for (const DrawnShape& shape : drawing_.shapes) {
    const Placement placement = place(shape, pose.frames, size_);
    const int body = shape.anchor == Anchor::point && shape.body_j >= 0 ? shape.body_j : shape.body_i;
    for (const DrawnLine& line : lines_of(shape, pose)) {
      const bool support = line.role == Role::support || line.role == Role::driver;
      if (pale == 0 || !support) draw_line(canvas, line, placement, body, pale);
    }
  }
}

void Figure::draw_traces(VectorCanvas& canvas) const {
  for (const auto& trace : figure_.traces) {
    std::vector<Vec2<double>> points;
    for (const Vec2<double>& p : trace) points.push_back(on_page(p));
    canvas.path(points, false, {.stroke = role_colour(Role::driver, ground), .width = 1.2});
  }
}

void Figure::draw_loads(VectorCanvas& canvas, const FigurePose& pose) const {
  const Paint line{.stroke = role_colour(Role::driver, ground), .width = 1.4};
  for (const Arrow& arrow : arrows(pose)) {
    const Vec2<double>&along = arrow.along, across = perpendicular(along), tip = arrow.tip;
    const double head = std::min(1.5 * size_, arrow.length);
    const Vec2<double> shaft[] = {on_page(tip - arrow.length * along), on_page(tip - head * along)};
    const Vec2<double> corners[] = {on_page(tip), on_page(tip - head * along + 0.4 * head * across),
                                    on_page(tip - head * along - 0.4 * head * across)};
    canvas.path(shaft, false, line);
    canvas.path(corners, true, {.fill = line.stroke});
  }
}

std::string Figure::draw(const CanvasMaker& make_canvas) const {
  const std::unique_ptr<VectorCanvas> canvas = make_canvas(width_, height_);
  const auto poses = static_cast<double>(figure_.poses.size());
  for (std::size_t k = 0; k + 1 < figure_.poses.size(); ++k)
    draw_pose(*canvas, figure_.poses[k], palest - 0.35 * static_cast<double>(k) / poses);
  draw_pose(*canvas, figure_.poses.back(), 0);
  draw_traces(*canvas);
  draw_loads(*canvas, figure_.poses.back());
  return canvas->finish();
}

FilmScale Figure::draw_film(const CanvasMaker& make_canvas) const {
  for (const FigurePose& pose : figure_.poses) {
    const std::unique_ptr<VectorCanvas> canvas = make_canvas(width_, height_);
    draw_pose(*canvas, pose, 0);
    draw_traces(*canvas);
    draw_loads(*canvas, pose);
    canvas->finish();
  }
  return {extent_.low - Vec2<double>{room_, room_} / scale_, scale_, width_, height_};
}

void fit_guides_to(const MechanismFigure& figure, Drawing& drawing) {
  if (figure.poses.empty()) throw std::invalid_argument("a figure of a mechanism needs at least one pose");
  for (const FigurePose& pose : figure.poses) observe_guides(drawing, pose.frames);
  const double margin = drawing.typical_length > 0 ? 0.2 * drawing.typical_length : 0;
  fit_guides(drawing, margin);
}

}  // namespace

std::string draw_mechanism(Drawing drawing, const MechanismFigure& figure, const CanvasMaker& canvas) {
  fit_guides_to(figure, drawing);
  return Figure(drawing, figure, std::span(figure.poses).last(1)).draw(canvas);
}

FilmScale draw_film(Drawing drawing, const MechanismFigure& figure, const CanvasMaker& canvas) {
  fit_guides_to(figure, drawing);
  return Figure(drawing, figure, figure.poses).draw_film(canvas);
}

}  // namespace catena
