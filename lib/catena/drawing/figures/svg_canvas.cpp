#include "catena/drawing/figures/svg_canvas.hpp"

#include <cmath>

namespace catena {
namespace {

void append_escaped(std::string& out, std::string_view text) {
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        // Control characters are not allowed in XML at all.
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
}

void append_colour(std::string& out, const std::optional<Colour>& colour) {
  if (!colour) {
    out += "none";
    return;
  }
  constexpr char digits[] = "0123456789abcdef";
  out += '#';
  for (const unsigned char part : {colour->red, colour->green, colour->blue}) {
    out += digits[part >> 4];
    out += digits[part & 15];
  }
}

void append_attribute(std::string& out, std::string_view name, double value) {
  out += ' ';
  out += name;
  out += "=\"";
  append_short(out, value);
  out += '"';
}

void append_point(std::string& out, const Vec2<double>& p) {
  append_short(out, p.x);
  out += ' ';
  append_short(out, p.y);
}

}  // namespace

SvgCanvas::SvgCanvas(double width, double height, std::string_view title) {
  out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\"";
  append_attribute(out_, "width", width);
  append_attribute(out_, "height", height);
  out_ += " viewBox=\"0 0 ";
  append_point(out_, {width, height});
  out_ +=
      "\" font-family=\"Helvetica, Arial, sans-serif\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>";
  append_escaped(out_, title);
  out_ += "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
}

void SvgCanvas::append_paint(const Paint& paint) {
  out_ += " fill=\"";
  append_colour(out_, paint.fill);
  out_ += '"';
  if (!paint.stroke) return;
  out_ += " stroke=\"";
  append_colour(out_, paint.stroke);
  out_ += '"';
  append_attribute(out_, "stroke-width", paint.width);
  if (paint.dashed) {
    out_ += " stroke-dasharray=\"";
    append_point(out_, {5 * paint.width, 3 * paint.width});
    out_ += '"';
  }
}

void SvgCanvas::end_path() {
  if (data_.empty()) return;
  out_ += "<path d=\"" + data_ + '"';
  append_paint(paint_);
  out_ += "/>\n";
  data_.clear();
}

void SvgCanvas::path(std::span<const Vec2<double>> points, bool closed, const Paint& paint) {
  // Areas that overlap would show holes where they are one path.
  if (!(paint == paint_) || paint.fill) end_path();
  paint_ = paint;
  bool begun = false;
  for (const Vec2<double>& p : points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
      begun = false;
      continue;
    }
    data_ += begun ? 'L' : 'M';
    append_point(data_, p);
    begun = true;
  }
  if (closed && begun) data_ += 'Z';
}

void SvgCanvas::circle(const Vec2<double>& centre, double radius, const Paint& paint) {
  end_path();
  if (!std::isfinite(centre.x) || !std::isfinite(centre.y)) return;
  out_ += "<circle";
  append_attribute(out_, "cx", centre.x);
  append_attribute(out_, "cy", centre.y);
  append_attribute(out_, "r", radius);
  append_paint(paint);
  out_ += "/>\n";
}

void SvgCanvas::text(const Vec2<double>& place, std::string_view text, const TextStyle& style) {
  end_path();
  out_ += "<text";
  if (style.upwards) {
    out_ += " transform=\"translate(";
    append_point(out_, place);
    out_ += ") rotate(-90)\"";
  } else {
    append_attribute(out_, "x", place.x);
    append_attribute(out_, "y", place.y);
  }
  append_attribute(out_, "font-size", style.size);
  out_ += " fill=\"";
  append_colour(out_, black);
  out_ += '"';
  if (style.anchor != TextAnchor::start)
    out_ += style.anchor == TextAnchor::middle ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
  out_ += '>';
  append_escaped(out_, text);
  out_ += "</text>\n";
}

void SvgCanvas::clip(const Vec2<double>& corner, const Vec2<double>& size) {
  end_path();
  const std::string name = "clip" + std::to_string(++clips_);
  out_ += "<clipPath id=\"" + name + "\"><rect";
  append_attribute(out_, "x", corner.x);
  append_attribute(out_, "y", corner.y);
  append_attribute(out_, "width", size.x);
  append_attribute(out_, "height", size.y);
  out_ += "/></clipPath>\n<g clip-path=\"url(#" + name + ")\">\n";
}

void SvgCanvas::unclip() {
  end_path();
  out_ += "</g>\n";
}

std::string SvgCanvas::finish() {
  end_path();
  out_ += "</svg>\n";
  return std::move(out_);
}

}  // namespace catena
