// Figures as SVG 1.1: no script, no outside reference, readable by browsers, Inkscape and LaTeX tool chains.
//
// Lines in a row that are painted alike become one path. Names are escaped. Source: W3C, SVG 1.1 (second edition).
#pragma once

#include "catena/drawing/figures/vector_canvas.hpp"

namespace catena {

class SvgCanvas final : public VectorCanvas {
 public:
  /// `title` is what readers of the file are told it shows.
  SvgCanvas(double width, double height, std::string_view title);

  void path(std::span<const Vec2<double>> points, bool closed, const Paint& paint) override;
  void circle(const Vec2<double>& centre, double radius, const Paint& paint) override;
  void text(const Vec2<double>& place, std::string_view text, const TextStyle& style) override;
  void clip(const Vec2<double>& corner, const Vec2<double>& size) override;
  void unclip() override;
  std::string finish() override;

 private:
  void end_path();
  void append_paint(const Paint& paint);

  std::string out_, data_;  // the file so far; the path that may still grow
  Paint paint_;
  int clips_ = 0;
};

}  // namespace catena
