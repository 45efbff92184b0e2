// Files of figures: SVG that is well formed whatever the names, PDF whose tables point where they say, marks of axes,
// dots of braille.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <regex>

#include "catena/drawing/figures/axis_ticks.hpp"
#include "catena/drawing/figures/pdf_canvas.hpp"
#include "catena/drawing/figures/plot.hpp"
#include "catena/drawing/figures/svg_canvas.hpp"
#include "drawing/svg_text.hpp"

namespace catena::testing {
namespace {

void draw_something(VectorCanvas& canvas) {
  const Vec2<double> corners[] = {{10, 10}, {50, NAN}, {60, 10}, {90, 40}};
  canvas.path(corners, false, {.stroke = black, .width = 2, .dashed = true});
  canvas.path(corners, true, {.stroke = grey, .fill = white});
  canvas.clip({0, 0}, {80, 80});
  canvas.circle({40, 40}, 12, {.fill = grey});
  canvas.circle({INFINITY, 40}, 12, {.fill = grey});
  canvas.unclip();
  canvas.text({5, 90}, "<b>(\"\xc3\xa4\") \\ & \xe2\x82\xac", {.anchor = TextAnchor::middle, .upwards = true});
}

TEST(SvgCanvas, WritesWellFormedFiles) {
  SvgCanvas canvas(100, 100, "a <title> & more");
  draw_something(canvas);
  const std::string file = canvas.finish();
  EXPECT_EQ(svg_fault(file), "") << file;
  EXPECT_NE(file.find("&lt;b&gt;(&quot;"), std::string::npos);
  EXPECT_EQ(file.find("nan"), std::string::npos);
  EXPECT_EQ(file.find("inf"), std::string::npos);
}

TEST(SvgCanvas, TheFaultFinderFindsFaults) {
  EXPECT_NE(svg_fault("<svg><path></svg>"), "");
  EXPECT_NE(svg_fault("<svg><text>a < b</text></svg>"), "");
  EXPECT_NE(svg_fault("<svg/><g>"), "");
  EXPECT_NE(svg_fault("<svg><text>a & b</text></svg>"), "");
  EXPECT_EQ(svg_fault("<svg><path d=\"M0 0\"/><text>a &lt; b</text></svg>"), "");
}

TEST(PdfCanvas, PointsWhereItsObjectsAre) {
  PdfCanvas canvas(100, 100, "figure (1)");
  draw_something(canvas);
  const std::string file = canvas.finish();
  EXPECT_EQ(file.substr(0, 8), "%PDF-1.4");
  EXPECT_EQ(file.find("nan"), std::string::npos);
  const std::size_t table = file.find("xref\n0 ");
  ASSERT_NE(table, std::string::npos);
  const std::size_t start = file.find("startxref\n");
  EXPECT_EQ(std::stoul(file.substr(start + 10)), table);
  const std::size_t count = std::stoul(file.substr(table + 7));
  const std::size_t first = file.find('\n', table + 7) + 1;
  for (std::size_t object = 1; object < count; ++object) {
    const std::string line = file.substr(first + 20 * object, 20);
    ASSERT_EQ(line.substr(10), " 00000 n \n");
    const std::string opening = std::to_string(object) + " 0 obj\n";
    EXPECT_EQ(file.substr(std::stoul(line.substr(0, 10)), opening.size()), opening);
  }
  std::smatch length;
  ASSERT_TRUE(std::regex_search(file, length, std::regex("/Length (\\d+) >>\nstream\n")));
  const std::size_t stream = file.find("stream\n") + 7;
  EXPECT_EQ(file.substr(stream + std::stoul(length[1]), 9), "endstream");
  // Latin letters are kept, others become question marks, brackets are escaped.
  EXPECT_NE(file.find("(<b>\\(\"\xe4\"\\) \\\\ & ?) Tj"), std::string::npos) << file;
}

// A painting operator without a path before it is an error in PDF.
TEST(PdfCanvas, LeavesOutPathsWithoutPoints) {
  const auto content_of = [](bool with_empty_paths) {
    PdfCanvas canvas(100, 100, "");
    const Vec2<double> line[] = {{1, 2}, {3, 4}}, nowhere[] = {{NAN, 1}, {2, INFINITY}};
    canvas.path(line, false, {.stroke = black});
    if (with_empty_paths) {
      canvas.path({}, false, {.stroke = grey});
      canvas.path(nowhere, true, {.stroke = grey, .fill = white});
    }
    return canvas.finish();
  };
  EXPECT_EQ(content_of(true), content_of(false));
}

TEST(AxisTicks, AreRoundAndCoverTheValues) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-12, 12), part(-1, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double size = std::pow(10, exponent(random));
    const double values[] = {size * part(random), size * part(random), NAN};
    const int wanted = 3 + trial % 8;
    const AxisTicks axis = choose_ticks(values, wanted, false);
    ASSERT_GE(axis.at.size(), 2u);
    EXPECT_LE(axis.at.size(), static_cast<std::size_t>(wanted) + 3);
    const double step = axis.at[1] - axis.at[0], mantissa = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 || std::abs(mantissa - 5) < 1e-6)
        << mantissa;
    for (const double value : {values[0], values[1]}) {
      EXPECT_GE(axis.place(value), -1e-9);
      EXPECT_LE(axis.place(value), 1 + 1e-9);
    }
    for (std::size_t k = 0; k < axis.at.size(); ++k)
      EXPECT_NEAR(std::stod(axis.labels[k]), axis.at[k], 1e-3 * step) << axis.labels[k];
  }
}

TEST(AxisTicks, OfTightAxesLieWithinTheValues) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int trial = 0; trial < 500; ++trial) {
    const double values[] = {part(random), part(random)};
    const AxisTicks axis = choose_ticks(values, 5, false, AxisEnds::tight);
    EXPECT_EQ(axis.first, std::min(values[0], values[1]));
    EXPECT_EQ(axis.last, std::max(values[0], values[1]));
    ASSERT_GE(axis.at.size(), 1u);
    EXPECT_EQ(axis.at.size(), axis.labels.size());
    const double room = 1e-8 * (axis.last - axis.first);
    for (const double mark : axis.at) EXPECT_TRUE(mark >= axis.first - room && mark <= axis.last + room);
  }
}

TEST(AxisTicks, OfLogarithmicAxesArePowersOfTen) {
  const double values[] = {0.02, 300, -1, 0, NAN};
  const AxisTicks axis = choose_ticks(values, 6, true);
  EXPECT_EQ(axis.labels, (std::vector<std::string>{"1e-2", "1e-1", "1e0", "1e1", "1e2", "1e3"}));
  EXPECT_NEAR(axis.place(1), 0.4, 1e-12);
  EXPECT_TRUE(std::isnan(axis.place(0)));
  EXPECT_TRUE(std::isnan(axis.place(-1)));
}

TEST(AxisTicks, OfNothingAndOfConstantsHaveRoom) {
  const double none[] = {NAN}, constant[] = {7, 7}, zero[] = {0};
  EXPECT_LT(choose_ticks(none, 4, false).first, choose_ticks(none, 4, false).last);
  EXPECT_LT(choose_ticks(none, 4, true).first, choose_ticks(none, 4, true).last);
  for (const auto& values : {std::span<const double>(constant), std::span<const double>(zero)}) {
    const AxisTicks axis = choose_ticks(values, 4, false);
    EXPECT_LT(axis.first, values[0]);
    EXPECT_GT(axis.last, values[0]);
  }
}

/// The dots of a braille plot's panel, upper row first.
std::vector<std::vector<bool>> dots_of(const std::string& text, std::size_t letters, std::size_t rows) {
  constexpr int bits[4][2] = {{0, 3}, {1, 4}, {2, 5}, {6, 7}};
  std::vector<std::vector<bool>> dots(4 * rows, std::vector<bool>(2 * letters));
  std::size_t row = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t bar = line.find("\u2502");
    if (bar == std::string::npos) continue;
    for (std::size_t k = 0; k < letters; ++k) {
      const std::size_t at = bar + 3 + 3 * k;
      const int letter = (static_cast<unsigned char>(line[at + 1]) & 0x3f) << 6 | (line[at + 2] & 0x3f);
      for (std::size_t y = 0; y < 4; ++y) {
        for (std::size_t x = 0; x < 2; ++x) dots[4 * row + y][2 * k + x] = letter >> bits[y][x] & 1;
      }
    }
    ++row;
  }
  EXPECT_EQ(row, rows);
  return dots;
}

TEST(BraillePlot, OfAStraightLineIsADiagonal) {
  Plot plot{.title = "", .x_name = "t", .x_unit = "s", .x = {0, 10}, .panels = {{"m", {{"y", {0, 10}}}}}};
  constexpr std::size_t rows = 5, columns = 30;
  const std::string text = braille_plot(plot, columns, rows, false);
  const std::size_t letters = columns - 2 - 2;  // labels of two digits, a space and the axis
  const auto dots = dots_of(text, letters, rows);
  const std::size_t wide = 2 * letters, tall = 4 * rows;
  for (std::size_t x = 0; x < wide; ++x) {
    const double y = static_cast<double>(x) * static_cast<double>(tall - 1) / static_cast<double>(wide - 1);
    for (std::size_t down = 0; down < tall; ++down) {
      const double away = std::abs(static_cast<double>(tall - 1 - down) - y);
      EXPECT_TRUE(!dots[down][x] || away <= 1) << x << ' ' << down;
    }
  }
  EXPECT_TRUE(dots[tall - 1][0]);
  EXPECT_TRUE(dots[0][wide - 1]);
  EXPECT_NE(text.find("y [m]"), std::string::npos);
  EXPECT_NE(text.find("over t [s]"), std::string::npos);
}

TEST(BraillePlot, LeavesGapsWhereThereIsNoValue) {
  Plot plot{.title = "", .x_name = "x", .x_unit = "", .x = {0, 1, 2, 3}, .panels = {{"", {{"y", {1, NAN, NAN, 1}}}}}};
  const std::string text = braille_plot(plot, 40, 4, false);
  const std::size_t margin = text.find("\u2502", text.find('\n')) - text.find('\n');  // labels, a space, the axis
  const auto dots = dots_of(text, 40 - margin, 4);
  std::size_t set = 0;
  for (const auto& row : dots) set += static_cast<std::size_t>(std::count(row.begin(), row.end(), true));
  EXPECT_EQ(set, 2u) << "the first value and the last\n" << text;
}

TEST(PlotFigure, IsWellFormedWithManyLinesAndGaps) {
  Plot plot{.title = "<scene>", .x_name = "t", .x_unit = "s", .x = {0, 1, 2}, .panels = {}};
  for (int panel = 0; panel < 3; ++panel) {
    PlotPanel& added = plot.panels.emplace_back(PlotPanel{"m", {}});
    for (int k = 0; k < 9; ++k) added.lines.push_back({"line <" + std::to_string(k) + ">", {0.5 * k, NAN, 2.0 * k}});
  }
  for (const bool log_y : {false, true}) {
    plot.log_y = log_y;
    const std::string file = draw_plot(
        plot, 360, 120, [](double width, double height) { return std::make_unique<SvgCanvas>(width, height, "plot"); });
    EXPECT_EQ(svg_fault(file), "");
    EXPECT_EQ(file.find("nan"), std::string::npos);
    // Each line has two values with a gap between them; those of k = 0, both 0, have no place on a logarithmic axis.
    EXPECT_EQ(svg_circles(file).size(), log_y ? 3u * 2 * 8 : 3u * 2 * 9);
  }
}

// Error over run time: every line has its own places, and a dot at each.
TEST(Plots, LinesMayHavePlacesOfTheirOwn) {
  Plot plot{.title = "", .x_name = "time", .x_unit = "ms", .x = {}, .panels = {}, .log_x = true, .log_y = true};
  plot.panels = {{"", {{"a", {1e-3, 1e-6}, {1, 10}, true}, {"b", {1e-4, 1e-5, 1e-6}, {10, 100, 1000}, true}}}};
  const std::string file = draw_plot(plot, 400, 120, [](double w, double h) -> std::unique_ptr<VectorCanvas> {
    return std::make_unique<SvgCanvas>(w, h, "plot");
  });
  EXPECT_EQ(svg_fault(file), "") << file;
  const std::vector<SvgCircle> dots = svg_circles(file);
  ASSERT_EQ(dots.size(), 5u);
  // Three decades across and three up: a's first dot is the upper left corner, b's last the lower right one.
  const Vec2<double> across = dots[4].centre - dots[0].centre;
  const auto expect_at = [&](std::size_t dot, double u, double v) {
    EXPECT_NEAR(dots[dot].centre.x, dots[0].centre.x + u * across.x, 0.02) << dot;
    EXPECT_NEAR(dots[dot].centre.y, dots[0].centre.y + v * across.y, 0.02) << dot;
  };
  EXPECT_GT(across.x, 300);
  EXPECT_LT(across.y, -100);
  expect_at(1, 1 / 3.0, 1);
  expect_at(2, 1 / 3.0, 1 / 3.0);
  expect_at(3, 2 / 3.0, 2 / 3.0);
  const std::string letters = braille_plot(plot, 40, 6, false);
  EXPECT_NE(letters.find("1e3"), std::string::npos) << letters;
}

}  // namespace
}  // namespace catena::testing
