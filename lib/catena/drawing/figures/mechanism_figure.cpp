#include "catena/drawing/figures/mechanism_figure.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/drawing/figures/role_colours.hpp"
#include "catena/drawing/shapes/guide_travel.hpp"
#include "catena/drawing/shapes/placement.hpp"

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

class Figure {
 public:
  Figure(const Drawing& drawing, const MechanismFigure& figure) : drawing_(drawing), figure_(figure) {}

  std::string draw(const CanvasMaker& make_canvas);

 private:
  void find_extent();
  void choose_scale();
  Vec2<double> on_page(const Vec2<double>& p) const {
    return {(p.x - extent_.low.x) * scale_ + room_, height_ - room_ - (p.y - extent_.low.y) * scale_};
  }
  void draw_pose(VectorCanvas& canvas, const FigurePose& pose, double pale) const;
  void draw_line(VectorCanvas& canvas, const DrawnLine& line, const Placement& place, int body, double pale) const;
  void draw_loads(VectorCanvas& canvas, const FigurePose& pose) const;

  const Drawing& drawing_;
  const MechanismFigure& figure_;
  Extent extent_;
  double scale_ = 1, room_ = 0, width_ = 0, height_ = 0;
  double size_ = 0;  // of symbols, m
};

// With symbols of no size: they get the room around everything.
void Figure::find_extent() {
  for (const FigurePose& pose : figure_.poses) {
    for (const DrawnShape& shape : drawing_.shapes) {
      const Placement placement = place(shape, pose.frames, 0);
      for (const DrawnLine& line : drawing_.symbols[static_cast<std::size_t>(shape.symbol)].lines) {
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

void Figure::choose_scale() {
  const Vec2<double> span = extent_.high - extent_.low;
  width_ = figure_.width;
  double points = figure_.symbol_points;
  for (int pass = 0; pass < 3; ++pass) {  // the room depends on the symbols, and these on the scale
    room_ = symbol_room * points + 2;
    const double inside = width_ - 2 * room_, tall = figure_.most_height - 2 * room_;
    const double largest = std::max(span.x, span.y);
    scale_ = largest > 0 ? std::min(span.x > 0 ? inside / span.x : INFINITY, span.y > 0 ? tall / span.y : INFINITY) : 1;
    if (drawing_.typical_length > 0)
      points = std::clamp(0.25 * drawing_.typical_length * scale_, smallest_symbol, figure_.symbol_points);
  }
  width_ = std::min(width_, span.x * scale_ + 2 * room_);
  height_ = span.y * scale_ + 2 * room_;
  size_ = points / scale_;
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
    for (const DrawnLine& line : drawing_.symbols[static_cast<std::size_t>(shape.symbol)].lines) {
      const bool support = line.role == Role::support || line.role == Role::driver;
      if (pale == 0 || !support) draw_line(canvas, line, placement, body, pale);
    }
  }
}

void Figure::draw_loads(VectorCanvas& canvas, const FigurePose& pose) const {
  double largest = 0;
  for (const Vec2<double>& load : pose.loads) largest = std::max(largest, norm(load));
  if (!(largest > 0)) return;
  const Paint line{.stroke = role_colour(Role::driver, ground), .width = 1.4};
  for (std::size_t k = 0; k < pose.loads.size(); ++k) {
    const DrawnLoad& load = drawing_.loads[k];
    const Frame<double> frame = frame_of_body(pose.frames, load.body);
    const Vec2<double> force = load.in_body_axes ? frame.axis(pose.loads[k]) : pose.loads[k];
    if (!(norm(force) > 0)) continue;
    const Vec2<double> along = force / norm(force), across = perpendicular(along), tip = frame.point(load.point);
    const double length = load_length * size_ * norm(force) / largest, head = std::min(1.5 * size_, length);
    const Vec2<double> shaft[] = {on_page(tip - length * along), on_page(tip - head * along)};
    const Vec2<double> arrow[] = {on_page(tip), on_page(tip - head * along + 0.4 * head * across),
                                  on_page(tip - head * along - 0.4 * head * across)};
    canvas.path(shaft, false, line);
    canvas.path(arrow, true, {.fill = line.stroke});
  }
}

std::string Figure::draw(const CanvasMaker& make_canvas) {
  find_extent();
  choose_scale();
  const std::unique_ptr<VectorCanvas> canvas = make_canvas(width_, height_);
  const auto poses = static_cast<double>(figure_.poses.size());
  for (std::size_t k = 0; k + 1 < figure_.poses.size(); ++k)
    draw_pose(*canvas, figure_.poses[k], palest - 0.35 * static_cast<double>(k) / poses);
  draw_pose(*canvas, figure_.poses.back(), 0);
  for (const auto& trace : figure_.traces) {
    std::vector<Vec2<double>> points;
    for (const Vec2<double>& p : trace) points.push_back(on_page(p));
    canvas->path(points, false, {.stroke = role_colour(Role::driver, ground), .width = 1.2});
  }
  draw_loads(*canvas, figure_.poses.back());
  return canvas->finish();
}

}  // namespace

std::string draw_mechanism(Drawing drawing, const MechanismFigure& figure, const CanvasMaker& canvas) {
  if (figure.poses.empty()) throw std::invalid_argument("a figure of a mechanism needs at least one pose");
  for (const FigurePose& pose : figure.poses) observe_guides(drawing, pose.frames);
  const double margin = drawing.typical_length > 0 ? 0.2 * drawing.typical_length : 0;
  fit_guides(drawing, margin);
  return Figure(drawing, figure).draw(canvas);
}

}  // namespace catena
