#include "catena/drawing/figures/pdf_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace catena {
namespace {

/// UTF-8 as a PDF string in Latin-1, parentheses and backslashes escaped.
std::string pdf_string(std::string_view text) {
  std::string out = "(";
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto first = static_cast<unsigned char>(text[at]);
    char letter = '?';
    if (first < 0x80) {
      letter = first < 0x20 ? ' ' : text[at];
    } else {
      const bool latin = (first == 0xc2 || first == 0xc3) && at + 1 < text.size();
      if (latin) letter = static_cast<char>((first == 0xc3 ? 0x40 : 0) | static_cast<unsigned char>(text[at + 1]));
      while (at + 1 < text.size() && (static_cast<unsigned char>(text[at + 1]) & 0xc0) == 0x80) ++at;
    }
    if (letter == '(' || letter == ')' || letter == '\\') out += '\\';
    out += letter;
  }
  return out + ")";
}

/// Width of a text in Helvetica, in parts of its size, near enough to put it in the middle or at an end: digits and
/// most letters are 0.556 wide, narrow ones half of it, capitals and m, w more.
double helvetica_width(std::string_view text) {
  double sum = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;
    if (std::string_view("ijl.,:;'|! tfI()[]/").find(c) != std::string_view::npos) {
      sum += 0.278;
    } else if (std::string_view("mwMW").find(c) != std::string_view::npos) {
      sum += 0.83;
    } else {
      sum += c >= 'A' && c <= 'Z' ? 0.68 : 0.556;
    }
  }
  return sum;
}

}  // namespace

PdfCanvas::PdfCanvas(double width, double height, std::string_view title)
    : width_(width), height_(height), title_(title), content_("1 J 1 j\n") {}

void PdfCanvas::append_point(const Vec2<double>& p) {
  append_short(content_, p.x);
  content_ += ' ';
  append_short(content_, height_ - p.y);  // y upwards here
  content_ += ' ';
}

void PdfCanvas::append_colour(const Colour& colour, std::string_view command) {
  char text[64];
  const int length = std::snprintf(text, sizeof text, "%.3f %.3f %.3f ", colour.red / 255.0, colour.green / 255.0,
                                   colour.blue / 255.0);
  content_.append(text, static_cast<std::size_t>(length));
  content_ += command;
  content_ += '\n';
}

void PdfCanvas::set_paint(const Paint& paint) {
  if (paint.fill) append_colour(*paint.fill, "rg");
  if (!paint.stroke) return;
  append_colour(*paint.stroke, "RG");
  append_short(content_, paint.width);
  content_ += " w [";
  if (paint.dashed) {
    append_short(content_, 5 * paint.width);
    content_ += ' ';
    append_short(content_, 3 * paint.width);
  }
  content_ += "] 0 d\n";
}

void PdfCanvas::end_path(const Paint& paint, bool closed) {
  if (closed) content_ += "h ";
  content_ += paint.fill && paint.stroke ? "B\n" : paint.fill ? "f\n" : paint.stroke ? "S\n" : "n\n";
}

void PdfCanvas::path(std::span<const Vec2<double>> points, bool closed, const Paint& paint) {
  const auto is_finite = [](const Vec2<double>& p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  if (std::none_of(points.begin(), points.end(), is_finite)) return;  // a path without a point is an error in PDF
  set_paint(paint);
  bool begun = false;
  for (const Vec2<double>& p : points) {
    if (!is_finite(p)) {
      begun = false;
      continue;
    }
    append_point(p);
    content_ += begun ? "l\n" : "m\n";
    begun = true;
  }
  end_path(paint, closed);
}

void PdfCanvas::circle(const Vec2<double>& centre, double radius, const Paint& paint) {
  if (!std::isfinite(centre.x) || !std::isfinite(centre.y)) return;
  constexpr double arm = 0.5522847498;  // of a quarter as a cubic: 4/3 (sqrt 2 - 1)
  set_paint(paint);
  append_point(centre + Vec2<double>{radius, 0});
  content_ += "m\n";
  Vec2<double> out{radius, 0};
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Vec2<double> next = perpendicular(out);
    append_point(centre + out + arm * next);
    append_point(centre + next + arm * out);
    append_point(centre + next);
    content_ += "c\n";
    out = next;
  }
  end_path(paint, true);
}

void PdfCanvas::text(const Vec2<double>& place, std::string_view text, const TextStyle& style) {
  const double length = style.size * helvetica_width(text);
  const double back = style.anchor == TextAnchor::start ? 0 : style.anchor == TextAnchor::middle ? length / 2 : length;
  const Vec2<double> start = style.upwards ? place + Vec2<double>{0, back} : place - Vec2<double>{back, 0};
  append_colour(black, "rg");
  content_ += "BT /F1 ";
  append_short(content_, style.size);
  content_ += style.upwards ? " Tf 0 1 -1 0 " : " Tf 1 0 0 1 ";
  append_point(start);
  content_ += "Tm " + pdf_string(text) + " Tj ET\n";
}

void PdfCanvas::clip(const Vec2<double>& corner, const Vec2<double>& size) {
  content_ += "q ";
  append_point(corner + Vec2<double>{0, size.y});
  append_short(content_, size.x);
  content_ += ' ';
  append_short(content_, size.y);
  content_ += " re W n\n";
}

void PdfCanvas::unclip() { content_ += "Q\n1 J 1 j\n"; }

std::string PdfCanvas::finish() {
  std::string box = "[0 0 ";
  append_short(box, width_);
  box += ' ';
  append_short(box, height_);
  box += ']';
  const std::string objects[] = {
      "<< /Type /Catalog /Pages 2 0 R >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      "<< /Type /Page /Parent 2 0 R /MediaBox " + box + " /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
      "<< /Length " + std::to_string(content_.size()) + " >>\nstream\n" + content_ + "endstream",
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
      "<< /Title " + pdf_string(title_) + " /Producer (catena) >>"};
  std::string out = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";
  std::vector<std::size_t> offsets;
  for (const std::string& object : objects) {
    offsets.push_back(out.size());
    out += std::to_string(offsets.size()) + " 0 obj\n" + object + "\nendobj\n";
  }
  const std::size_t table = out.size();
  const std::string count = std::to_string(offsets.size() + 1);
  out += "xref\n0 " + count + "\n0000000000 65535 f \n";
  for (const std::size_t offset : offsets) {
    char line[24];
    std::snprintf(line, sizeof line, "%010zu 00000 n \n", offset);
    out += line;
  }
  return out + "trailer\n<< /Size " + count + " /Root 1 0 R /Info 6 0 R >>\nstartxref\n" + std::to_string(table) +
         "\n%%EOF\n";
}

}  // namespace catena
