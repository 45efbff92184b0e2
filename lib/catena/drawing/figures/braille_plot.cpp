#include <algorithm>
#include <cmath>
#include <cstdint>

#include "catena/drawing/figures/axis_ticks.hpp"
#include "catena/drawing/figures/plot.hpp"

namespace catena {
namespace {

/// Dots of braille letters: 2 x 4 of them a letter, each letter in the colour of the line that was there last.
class DotField {
 public:
  DotField(std::size_t columns, std::size_t rows)
      : columns_(columns), rows_(rows), dots_(columns * rows, 0), line_(columns * rows, 0) {}

  /// Straight from one dot to another; u, v from 0 to 1 over the field, v upwards.
  void draw(double u0, double v0, double u1, double v1, int line) {
    const double wide = 2.0 * static_cast<double>(columns_) - 1, tall = 4.0 * static_cast<double>(rows_) - 1;
    const double x0 = u0 * wide, y0 = v0 * tall, x1 = u1 * wide, y1 = v1 * tall;
    const auto steps = static_cast<int>(std::ceil(std::max({std::abs(x1 - x0), std::abs(y1 - y0), 1.0})));
    for (int k = 0; k <= steps; ++k) {
      const double part = static_cast<double>(k) / steps;
      set(std::lround(x0 + part * (x1 - x0)), std::lround(y0 + part * (y1 - y0)), line);
    }
  }

  /// One row of letters, the upper one first; `colours`: with the escape sequences of terminals.
  std::string row(std::size_t row, bool colours) const {
    std::string out;
    int colour = -1;
    for (std::size_t column = 0; column < columns_; ++column) {
      const std::size_t k = row * columns_ + column;
      if (colours && dots_[k] != 0 && line_[k] != colour) {
        colour = line_[k];
        out += "\x1b[3" + std::to_string(1 + (colour + 3) % 6) + "m";
      }
      const unsigned letter = 0x2800u + dots_[k];
      out += static_cast<char>(0xe0 | letter >> 12);
      out += static_cast<char>(0x80 | (letter >> 6 & 0x3f));
      out += static_cast<char>(0x80 | (letter & 0x3f));
    }
    if (colour >= 0) out += "\x1b[0m";
    return out;
  }

 private:
  void set(long x, long y, int line) {
    if (x < 0 || y < 0 || x >= 2 * static_cast<long>(columns_) || y >= 4 * static_cast<long>(rows_)) return;
    // Numbers of the dots in a letter, from its upper left one down; the last row came later to the alphabet.
    constexpr std::uint8_t bits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    const auto down = static_cast<std::size_t>(4 * static_cast<long>(rows_) - 1 - y);
    const std::size_t k = down / 4 * columns_ + static_cast<std::size_t>(x) / 2;
    dots_[k] |= bits[down % 4][x % 2];
    line_[k] = line;
  }

  std::size_t columns_, rows_;
  std::vector<std::uint8_t> dots_;
  std::vector<int> line_;
};

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

/// The labels of the vertical axis by the row of letters they stand beside.
std::vector<std::string> row_labels(const AxisTicks& axis, std::size_t rows) {
  std::vector<std::string> labels(rows);
  for (std::size_t k = 0; k < axis.at.size(); ++k) {
    const double down = (1 - axis.place(axis.at[k])) * static_cast<double>(rows - 1);
    labels[static_cast<std::size_t>(std::lround(down))] = axis.labels[k];
  }
  return labels;
}

/// The labels of the horizontal axis in one line, those that would touch left out.
std::string below(const AxisTicks& axis, std::size_t columns) {
  std::string line(columns, ' ');
  std::size_t free = 0;
  for (std::size_t k = 0; k < axis.at.size(); ++k) {
    const std::string& label = axis.labels[k];
    const double middle = axis.place(axis.at[k]) * static_cast<double>(columns - 1);
    const double begin = std::clamp(middle - static_cast<double>(label.size()) / 2, 0.0,
                                    static_cast<double>(columns - std::min(columns, label.size())));
    const auto at = static_cast<std::size_t>(std::lround(begin));
    if (at < free || at + label.size() > columns) continue;
    line.replace(at, label.size(), label);
    free = at + label.size() + 1;
  }
  return line;
}

std::string heading(const PlotPanel& panel, bool colours) {
  std::string out;
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    if (k > 0) out += ", ";
    if (colours) out += "\x1b[3" + std::to_string(1 + (static_cast<int>(k) + 3) % 6) + "m";
    out += panel.lines[k].name;
    if (colours) out += "\x1b[0m";
  }
  return panel.unit.empty() ? out : out + " [" + panel.unit + "]";
}

std::string draw_panel(const Plot& plot, const PlotPanel& panel, const AxisTicks& x, std::size_t columns,
                       std::size_t rows, bool colours) {
  std::vector<double> values;
  for (const PlotLine& line : panel.lines) values.insert(values.end(), line.y.begin(), line.y.end());
  const AxisTicks y = choose_ticks(values, std::max(2, static_cast<int>(rows) / 3), plot.log_y);
  std::vector<std::string> labels = row_labels(y, rows);
  std::size_t margin = 0;
  for (const std::string& label : labels) margin = std::max(margin, label.size());
  const std::size_t wide = columns > margin + 12 ? columns - margin - 2 : 10;
  DotField field(wide, rows);
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    const std::vector<double>&values_y = panel.lines[k].y, &places = places_of(plot, panel.lines[k]);
    double u0 = NAN, v0 = NAN;
    for (std::size_t row = 0; row < places.size(); ++row) {
      const double u = x.place(places[row]), v = y.place(values_y[row]);
      const bool shown = std::isfinite(u) && std::isfinite(v);
      if (shown) field.draw(std::isfinite(v0) ? u0 : u, std::isfinite(v0) ? v0 : v, u, v, static_cast<int>(k));
      u0 = shown ? u : NAN;
      v0 = shown ? v : NAN;
    }
  }
  std::string out = heading(panel, colours) + "\n";
  for (std::size_t row = 0; row < rows; ++row)
    out += padded(labels[row], margin) + " \u2502" + field.row(row, colours) + "\n";
  out += std::string(margin, ' ') + " \u2514";
  for (std::size_t k = 0; k < wide; ++k) out += "\u2500";
  return out + "\n" + std::string(margin + 2, ' ') + below(x, wide) + "\n";
}

}  // namespace

std::string braille_plot(const Plot& plot, std::size_t columns, std::size_t rows, bool colours) {
  const AxisTicks x =
      choose_ticks(all_places(plot), std::max(2, static_cast<int>(columns) / 12), plot.log_x, AxisEnds::tight);
  std::string out;
  for (const PlotPanel& panel : plot.panels) {
    if (colours) {
      out += draw_panel(plot, panel, x, columns, rows, true);
      continue;
    }
    for (const PlotLine& line : panel.lines) out += draw_panel(plot, {panel.unit, {line}}, x, columns, rows, false);
  }
  return out + "over " + with_unit(plot.x_name, plot.x_unit) + "\n";
}

}  // namespace catena
