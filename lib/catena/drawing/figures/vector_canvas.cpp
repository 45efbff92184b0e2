#include "catena/drawing/figures/vector_canvas.hpp"

#include <charconv>
#include <cmath>

namespace catena {

Colour mixed(const Colour& a, const Colour& b, double part) {
  const auto mix = [part](unsigned char u, unsigned char v) {
    return static_cast<unsigned char>(std::lround(u + part * (v - u)));
  };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

double text_width(std::string_view text, double size) {
  std::size_t letters = 0;
  for (const char c : text) letters += (static_cast<unsigned char>(c) & 0xc0) != 0x80;  // not within a UTF-8 letter
  return 0.6 * size * static_cast<double>(letters);
}

void append_short(std::string& out, double value) {
  char text[40];
  // What is beyond a million points is on no page; so is what is no number.
  constexpr double most = 1e6;
  const double bounded = std::isfinite(value) ? std::fmin(std::fmax(value, -most), most) : 0;
  const auto [end, code] = std::to_chars(text, text + sizeof text, bounded, std::chars_format::fixed, 2);
  std::string_view digits(text, static_cast<std::size_t>(end - text));
  while (digits.ends_with('0')) digits.remove_suffix(1);
  if (digits.ends_with('.')) digits.remove_suffix(1);
  out += digits == "-0" ? std::string_view("0") : digits;
}

}  // namespace catena
