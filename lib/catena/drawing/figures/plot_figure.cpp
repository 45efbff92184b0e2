#include <algorithm>
#include <cmath>

#include "catena/drawing/figures/axis_ticks.hpp"
#include "catena/drawing/figures/plot.hpp"
#include "catena/drawing/figures/role_colours.hpp"

namespace catena {
namespace {

constexpr double left = 58, right = 12, top = 10, bottom = 34, between = 12, title_room = 16,
                 legend_line = 12;  // points
constexpr double letters = 8;
constexpr Colour rule{0xdd, 0xdd, 0xdd};

struct Box {
  Vec2<double> corner, size;

  Vec2<double> at(double u, double v) const { return {corner.x + u * size.x, corner.y + (1 - v) * size.y}; }
};

std::vector<double> all_values(const PlotPanel& panel) {
  std::vector<double> values;
  for (const PlotLine& line : panel.lines) values.insert(values.end(), line.y.begin(), line.y.end());
  return values;
}

void draw_axes(VectorCanvas& canvas, const Box& box, const AxisTicks& x, const AxisTicks& y, bool lowest) {
  for (std::size_t k = 0; k < x.at.size(); ++k) {
    const double u = x.place(x.at[k]);
    const Vec2<double> line[] = {box.at(u, 0), box.at(u, 1)};
    canvas.path(line, false, {.stroke = rule, .width = 0.5});
    if (lowest)
      canvas.text(box.at(u, 0) + Vec2<double>{0, 11}, x.labels[k], {.size = letters, .anchor = TextAnchor::middle});
  }
  for (std::size_t k = 0; k < y.at.size(); ++k) {
    const double v = y.place(y.at[k]);
    const Vec2<double> line[] = {box.at(0, v), box.at(1, v)};
    canvas.path(line, false, {.stroke = rule, .width = 0.5});
    canvas.text(box.at(0, v) + Vec2<double>{-4, 0.35 * letters}, y.labels[k],
                {.size = letters, .anchor = TextAnchor::end});
  }
  const Vec2<double> frame[] = {box.at(0, 0), box.at(1, 0), box.at(1, 1), box.at(0, 1)};
  canvas.path(frame, true, {.stroke = Colour{0x55, 0x55, 0x55}, .width = 0.8});
}

/// One line of the legend a column, as many beside each other as there is room for.
double draw_legend(VectorCanvas& canvas, const PlotPanel& panel, double x0, double y, double width, bool paint) {
  double x = x0, height = legend_line;
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    const double room = 22 + text_width(panel.lines[k].name, letters);
    if (x > x0 && x + room > x0 + width) {
      x = x0;
      y += legend_line;
      height += legend_line;
    }
    if (paint) {
      const Vec2<double> mark[] = {{x, y - 3}, {x + 12, y - 3}};
      canvas.path(mark, false, {.stroke = body_colour(static_cast<int>(k)), .width = 1.6, .dashed = k >= 7});
      canvas.text({x + 16, y}, panel.lines[k].name, {.size = letters});
    }
    x += room;
  }
  return height;
}

void draw_panel(VectorCanvas& canvas, const Plot& plot, const PlotPanel& panel, const Box& box, const AxisTicks& x,
                bool lowest) {
  const int wanted = std::max(2, static_cast<int>(box.size.y / 24));
  const AxisTicks y = choose_ticks(all_values(panel), wanted, plot.log_y);
  draw_axes(canvas, box, x, y, lowest);
  canvas.clip(box.corner, box.size);
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    const PlotLine& line = panel.lines[k];
    const std::vector<double>& places = places_of(plot, line);
    std::vector<Vec2<double>> points;
    for (std::size_t row = 0; row < places.size(); ++row)
      points.push_back(box.at(x.place(places[row]), y.place(line.y[row])));
    const Paint paint{.stroke = body_colour(static_cast<int>(k)), .width = 1.2, .dashed = k >= 7};
    canvas.path(points, false, paint);
    // A line of one point, between gaps, would not be seen.
    const auto shown = [&](std::size_t row) {
      return row < points.size() && std::isfinite(points[row].x + points[row].y);
    };
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (shown(row) && (line.marks || ((row == 0 || !shown(row - 1)) && !shown(row + 1))))
        canvas.circle(points[row], 2, {.fill = paint.stroke});
    }
  }
  canvas.unclip();
  const std::string name = panel.lines.size() == 1 ? with_unit(panel.lines.front().name, panel.unit)
                           : !panel.name.empty()   ? with_unit(panel.name, panel.unit)
                           : panel.unit.empty()    ? std::string()
                                                   : "[" + panel.unit + "]";
  canvas.text(box.at(0, 0.5) - Vec2<double>{left - 11, 0}, name,
              {.size = letters, .anchor = TextAnchor::middle, .upwards = true});
}

}  // namespace

std::vector<double> all_places(const Plot& plot) {
  std::vector<double> places = plot.x;
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotLine& line : panel.lines) places.insert(places.end(), line.x.begin(), line.x.end());
  }
  return places;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string draw_plot(const Plot& plot, double width, double panel_height, const CanvasMaker& make_canvas) {
  const double inside = width - left - right;
  const auto probe = make_canvas(width, panel_height);  // measures legends; nothing is painted on it
  std::vector<double> legends;
  double height = top + (plot.title.empty() ? 0 : title_room) + bottom;
  for (const PlotPanel& panel : plot.panels) {
    legends.push_back(panel.lines.size() > 1 ? draw_legend(*probe, panel, left, 0, inside, false) : 0);
    height += legends.back() + panel_height + between;
  }
  const auto canvas = make_canvas(width, height - between);
  const AxisTicks x =
      choose_ticks(all_places(plot), std::max(2, static_cast<int>(inside / 45)), plot.log_x, AxisEnds::tight);
  double y = top;
  if (!plot.title.empty()) {
    canvas->text({left, y + 8}, plot.title, {.size = 10});
    y += title_room;
  }
  for (std::size_t k = 0; k < plot.panels.size(); ++k) {
    const PlotPanel& panel = plot.panels[k];
    if (legends[k] > 0) draw_legend(*canvas, panel, left, y + 8, inside, true);
    const Box box{{left, y + legends[k]}, {inside, panel_height}};
    draw_panel(*canvas, plot, panel, box, x, k + 1 == plot.panels.size());
    y += legends[k] + panel_height + between;
  }
  canvas->text({left + inside / 2, y - between + 26}, with_unit(plot.x_name, plot.x_unit),
               {.size = letters, .anchor = TextAnchor::middle});
  return canvas->finish();
}

}  // namespace catena
