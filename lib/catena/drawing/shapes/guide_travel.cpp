#include "catena/drawing/shapes/guide_travel.hpp"

#include <algorithm>
#include <cmath>

#include "catena/drawing/shapes/placement.hpp"

namespace catena {
namespace {

/// The toothed pitch line of a rack from u = low to high, in the frame of its body; a tooth at `tooth`.
DrawnLine toothed_line(const DrawnGuide& guide, double low, double high, double tooth) {
  DrawnLine line{.role = Role::gear, .closed = true, .filled = true};
  const double pitch = std::acos(-1.0) * guide.module, height = guide.module / 2;
  const Vec2<double> along = guide.axis_i / norm(guide.axis_i), up = guide.side * perpendicular(along);
  const auto add = [&](double u, double v) { line.points.push_back(guide.point_i + u * along + v * up); };
  const auto first = static_cast<int>(std::floor((low - tooth) / pitch));
  const auto last = static_cast<int>(std::ceil((high - tooth) / pitch));
  for (int k = first; k <= last; ++k) {
    const double middle = tooth + k * pitch;
    add(middle - 0.35 * pitch, -height);
    add(middle - 0.15 * pitch, height);
    add(middle + 0.15 * pitch, height);
    add(middle + 0.35 * pitch, -height);
  }
  add(tooth + (last + 0.5) * pitch, -3 * height);
  add(tooth + (first - 0.5) * pitch, -3 * height);
  return line;
}

}  // namespace

void observe_guides(Drawing& drawing, std::span<const Frame<double>> frames) {
  for (DrawnGuide& guide : drawing.guides) {
    const Frame<double> i = frame_of_body(frames, guide.body_i), j = frame_of_body(frames, guide.body_j);
    const Vec2<double> axis = i.axis(guide.axis_i);
    const double u = dot(axis, j.point(guide.point_j) - i.point(guide.point_i)) / norm(axis);
    if (!std::isfinite(u)) continue;
    if (!guide.observed) guide.low = guide.high = guide.first = u;
    guide.observed = true;
    guide.low = std::min(guide.low, u);
    guide.high = std::max(guide.high, u);
  }
}

void fit_guides(Drawing& drawing, double least_margin) {
  for (const DrawnGuide& guide : drawing.guides) {
    const double margin = std::max(least_margin, 0.1 * (guide.high - guide.low));
    const double low = guide.low - margin, high = guide.high + margin;
    DrawnShape& shape = drawing.shapes[static_cast<std::size_t>(guide.shape)];
    if (guide.module > 0) {
      shape.symbol = static_cast<int>(drawing.symbols.size());
      drawing.symbols.push_back({{toothed_line(guide, low, high, guide.first)}});
      continue;
    }
    const Vec2<double> along = guide.axis_i / norm(guide.axis_i);
    shape.point_i = guide.point_i + low * along;
    shape.point_j = guide.point_i + high * along;
    if (guide.member < 0) continue;
    DrawnShape& member = drawing.shapes[static_cast<std::size_t>(guide.member)];
    member.point_i = guide.point_i + std::min(low, 0.0) * along;
    member.point_j = guide.point_i + std::max(high, 0.0) * along;
  }
}

}  // namespace catena
