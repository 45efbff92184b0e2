#include "catena/scene/json/json_text.hpp"

#include <charconv>
#include <cmath>

#include "catena/results/number_format.hpp"
#include "catena/scene/json/utf8.hpp"

namespace catena {

void append_json(std::string& out, std::string_view text) {
  constexpr char digits[] = "0123456789abcdef";
  out += '"';
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = next_code_point(text, at);
    if (!c.valid) {
      out += "\xef\xbf\xbd";
    } else if (c.value == '"' || c.value == '\\') {
      out += '\\';
      out += static_cast<char>(c.value);
    } else if (c.value == '\n') {
      out += "\\n";
    } else if (c.value < 0x20 || c.value == 0x7f) {
      out += "\\u00";
      out += digits[c.value >> 4];
      out += digits[c.value & 15];
    } else {
      out.append(text, at, static_cast<std::size_t>(c.bytes));
    }
    at += static_cast<std::size_t>(c.bytes);
  }
  out += '"';
}

void append_json(std::string& out, double value) {
  if (std::isfinite(value)) {
    append_exact(out, value);
  } else {
    out += "null";
  }
}

void append_json(std::string& out, std::int64_t value) {
  char text[24];
  const auto [end, code] = std::to_chars(text, text + sizeof text, value);
  out.append(text, end);
}

void append_json(std::string& out, bool value) { out += value ? "true" : "false"; }

}  // namespace catena
