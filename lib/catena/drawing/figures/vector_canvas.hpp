// What figures are drawn on: paths, circles and texts in solid colours, in points of 1/72 inch from the upper left
// corner, y downwards. SVG and PDF files are made of the same calls.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "catena/base/vec2.hpp"

namespace catena {

struct Colour {
  unsigned char red = 0, green = 0, blue = 0;

  friend bool operator==(const Colour&, const Colour&) = default;
};

/// The colour `part` of the way from a to b, 0 ... 1.
Colour mixed(const Colour& a, const Colour& b, double part);

inline constexpr Colour black{0x22, 0x22, 0x22}, white{0xff, 0xff, 0xff}, grey{0x88, 0x88, 0x88};

struct Paint {
  std::optional<Colour> stroke{}, fill{};
  double width = 1;     ///< of the stroke
  bool dashed = false;  ///< five times the width of the stroke on, three off

  friend bool operator==(const Paint&, const Paint&) = default;
};

enum class TextAnchor { start, middle, end };

/// Texts are black.
struct TextStyle {
  double size = 9;
  TextAnchor anchor = TextAnchor::start;
  bool upwards = false;  ///< turned by a quarter, read from below
};

class VectorCanvas {
 public:
  virtual ~VectorCanvas() = default;
  /// Corners that are not finite end a line, and the next one begins it anew.
  virtual void path(std::span<const Vec2<double>> points, bool closed, const Paint& paint) = 0;
  virtual void circle(const Vec2<double>& centre, double radius, const Paint& paint) = 0;
  /// `place`: the anchor on the base line.
  virtual void text(const Vec2<double>& place, std::string_view text, const TextStyle& style) = 0;
  /// From now on only what lies in this rectangle shows, until unclip().
  virtual void clip(const Vec2<double>& corner, const Vec2<double>& size) = 0;
  virtual void unclip() = 0;
  /// The whole file. Nothing may be drawn afterwards.
  virtual std::string finish() = 0;
};

/// About how wide a text is: six tenths of its size a letter.
double text_width(std::string_view text, double size);

/// Appends a number with at most two decimals, for files.
void append_short(std::string& out, double value);

}  // namespace catena
