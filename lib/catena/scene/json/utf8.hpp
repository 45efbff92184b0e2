// Reading UTF-8 one code point at a time: columns, carets and edit distances count characters as a reader sees them,
// not bytes. Invalid input never fails here: a byte that starts no valid sequence is U+FFFD of length 1.
#pragma once

#include <cstddef>
#include <string_view>

namespace catena {

struct CodePoint {
  char32_t value = 0;
  int bytes = 1;
  bool valid = true;
};

/// The code point at byte `at` of `text` (at < text.size()). Overlong forms, surrogates and values above U+10FFFF are
/// invalid (RFC 3629).
inline CodePoint next_code_point(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  if (first < 0x80) return {first, 1, true};
  const int length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  constexpr CodePoint bad{0xfffd, 1, false};
  if (first < 0xc2 || first > 0xf4 || at + static_cast<std::size_t>(length) > text.size()) return bad;
  char32_t value = first & (0x7fu >> length);
  for (int i = 1; i < length; ++i) {
    const unsigned char next = byte(at + static_cast<std::size_t>(i));
    if ((next & 0xc0) != 0x80) return bad;
    value = (value << 6) | (next & 0x3fu);
  }
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (value < least[length] || value > 0x10ffff || (value >= 0xd800 && value <= 0xdfff)) return bad;
  return {value, length, true};
}

/// Columns a terminal gives the character: 0 for combining marks, 2 for East Asian wide forms and emoji, else 1.
/// A coarse table by blocks: enough to put a caret under its place.
inline int display_width(char32_t c) {
  if ((c >= 0x300 && c <= 0x36f) || (c >= 0x200b && c <= 0x200f) || (c >= 0xfe00 && c <= 0xfe0f)) return 0;
  const bool wide = (c >= 0x1100 && c <= 0x115f) || (c >= 0x2e80 && c <= 0xa4cf) || (c >= 0xac00 && c <= 0xd7a3) ||
                    (c >= 0xf900 && c <= 0xfaff) || (c >= 0xfe30 && c <= 0xfe6f) || (c >= 0xff00 && c <= 0xff60) ||
                    (c >= 0xffe0 && c <= 0xffe6) || (c >= 0x1f300 && c <= 0x1f64f) || (c >= 0x1f900 && c <= 0x1f9ff) ||
                    (c >= 0x20000 && c <= 0x3fffd);
  return wide ? 2 : 1;
}

}  // namespace catena
