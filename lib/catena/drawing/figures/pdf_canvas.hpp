// Figures as PDF 1.4, one page of the figure's size: vector graphics for papers.
//
// Texts are in Helvetica, which every reader has, with the letters of Latin-1; other letters show as "?". Circles are
// four Bezier curves (error 2.7e-4 of the radius). The object table is written at the end, as the format wants it.
// Source: Adobe, PDF Reference, version 1.4.
#pragma once

#include "catena/drawing/figures/vector_canvas.hpp"

namespace catena {

class PdfCanvas final : public VectorCanvas {
 public:
  PdfCanvas(double width, double height, std::string_view title);

  void path(std::span<const Vec2<double>> points, bool closed, const Paint& paint) override;
  void circle(const Vec2<double>& centre, double radius, const Paint& paint) override;
  void text(const Vec2<double>& place, std::string_view text, const TextStyle& style) override;
  void clip(const Vec2<double>& corner, const Vec2<double>& size) override;
  void unclip() override;
  std::string finish() override;

 private:
  void append_point(const Vec2<double>& p);
  void append_colour(const Colour& colour, std::string_view command);
  void set_paint(const Paint& paint);
  void end_path(const Paint& paint, bool closed);

  double width_, height_;
  std::string title_, content_;
};

}  // namespace catena
