#include "catena/scene/json/json_syntax.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/json/utf8.hpp"

namespace catena {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// The word or number that begins at `at`.
std::string_view token(std::string_view text, std::size_t at) {
  std::size_t end = at;
  const auto belongs = [](char c) { return is_letter(c) || is_digit(c) || c == '+' || c == '-' || c == '.'; };
  while (end < text.size() && belongs(text[end])) ++end;
  return text.substr(at, end - at);
}

bool read_hexadecimal(std::string_view digits, unsigned& value) {
  const char* const end = digits.data() + digits.size();
  return digits.size() == 4 && std::from_chars(digits.data(), end, value, 16).ptr == end;
}

SyntaxError at_end_of_text(const SourceText& source, const JsonPosition& position) {
  const std::size_t end = source.text().size();
  if (position.inside == JsonKind::null) {
    return {end, "the text is empty; a scene is an object: {\"catena\": 1, ...}"};
  }
  const TextPlace opened = source.place(position.opened_at);
  return {end, fmt::format("the text ends here, but the {} opened at line {}, column {} is not closed",
                           position.inside == JsonKind::object ? "{" : "[", opened.line, opened.column)};
}

/// A string that begins at `start` and is not sound: the first fault in it.
SyntaxError explain_string(std::string_view text, std::size_t start) {
  for (std::size_t at = start + 1; at < text.size();) {
    const char c = text[at];
    if (c == '"') return {start, "unexpected text"};
    if (c == '\n' || c == '\r') return {start, "this text is not closed with \" before the end of the line"};
    if (static_cast<unsigned char>(c) < 0x20) {
      return {at, fmt::format("a control character in a text must be written as \\u{:04x}", static_cast<unsigned>(c))};
    }
    if (c == '\\') {
      const char escape = at + 1 < text.size() ? text[at + 1] : ' ';
      if (escape == 'u') {
        const std::string_view digits = text.substr(std::min(at + 2, text.size()), 4);
        unsigned unit = 0, second = 0;
        if (!read_hexadecimal(digits, unit)) return {at, "\\u must be followed by four hexadecimal digits"};
        const bool surrogate = unit >= 0xd800 && unit <= 0xdfff;
        const bool paired = unit <= 0xdbff && text.substr(at + 6).starts_with("\\u") &&
                            read_hexadecimal(text.substr(at + 8, 4), second) && second >= 0xdc00 && second <= 0xdfff;
        if (surrogate && !paired) return {at, fmt::format("\\u{} is half of a surrogate pair", digits)};
        at += surrogate ? 12 : 6;
        continue;
      }
      if (std::string_view("\"\\/bfnrt").find(escape) == std::string_view::npos) {
        return {at, "a backslash in a text must be doubled, or begin one of \\n \\t \\\" \\\\ \\/ \\b \\f \\r \\u"};
      }
      at += 2;
      continue;
    }
    const CodePoint point = next_code_point(text, at);
    if (!point.valid) {
      return {at, fmt::format("invalid UTF-8: byte 0x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(c)))};
    }
    at += static_cast<std::size_t>(point.bytes);
  }
  return {start, "this text is not closed with \" before the end of the file"};
}

SyntaxError unexpected_character(std::string_view text, std::size_t at) {
  const CodePoint point = next_code_point(text, at);
  if (!point.valid || point.value < 0x20 || point.value == 0x7f) {
    const auto byte = static_cast<unsigned>(static_cast<unsigned char>(text[at]));
    return {at, fmt::format("unexpected byte 0x{:02x}; a scene is UTF-8 text", byte)};
  }
  if (text[at] == '/') {
    return {at, text.substr(at).starts_with("/*") ? "this comment is not closed with */" : "unexpected /"};
  }
  if (text[at] == '#') return {at, "unexpected #; comments begin with //"};
  if (text[at] == '\'') return {at, "text needs double quotes"};
  return {at, fmt::format("unexpected {}", text.substr(at, static_cast<std::size_t>(point.bytes)))};
}

/// Something that should be a value begins at `at`.
SyntaxError explain_value(std::string_view text, std::size_t at, bool out_of_range) {
  const char c = text[at];
  if (c == '"') return explain_string(text, at);
  const std::string_view word = token(text, at);
  if (out_of_range) return {at, fmt::format("the number {} is too large", word.substr(0, 40))};
  if (is_letter(c) || ((c == '-' || c == '+') && word.size() > 1 && is_letter(word[1]))) {
    std::string lower(word.substr(is_letter(c) ? 0 : 1));
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char l) { return l >= 'A' && l <= 'Z' ? static_cast<char>(l + ('a' - 'A')) : l; });
    if (lower == "nan" || lower == "inf" || lower == "infinity") {
      return {at, fmt::format("{} is not a number a scene can have; numbers are finite", word)};
    }
    constexpr std::string_view words[] = {"true", "false", "null"};
    const std::string hint = NearMiss(word).consider_all(words).hint();
    return {at,
            fmt::format("{} is not a value{}", in_quotes(word), hint.empty() ? "; text needs double quotes" : hint)};
  }
  if (is_digit(c) || c == '-' || c == '+' || c == '.') {
    return {at, not_a_number(word)};
  }
  return unexpected_character(text, at);
}

}  // namespace

std::string not_a_number(std::string_view word) {
  return fmt::format("{} is not a number; write it like -0.5, 12 or 1e-3", in_quotes(word));
}

std::size_t skip_blanks(std::string_view text, std::size_t at) {
  for (; at < text.size(); ++at) {
    if (is_blank(text[at])) continue;
    if (text[at] != '/') break;
    std::size_t end = std::string_view::npos;
    if (text.substr(at).starts_with("//")) {
      end = text.find_first_of("\n\r", at);
      if (end == std::string_view::npos) return text.size();
    } else if (text.substr(at).starts_with("/*")) {
      end = text.find("*/", at + 2);
      if (end != std::string_view::npos) ++end;
    }
    if (end == std::string_view::npos) break;
    at = end;
  }
  return at;
}

std::size_t skip_separators(std::string_view text, std::size_t at) {
  for (;; ++at) {
    at = skip_blanks(text, at);
    if (at >= text.size() || (text[at] != ',' && text[at] != ':')) return at;
  }
}

SyntaxError explain_syntax_error(const SourceText& source, const JsonPosition& position, bool out_of_range) {
  const std::string_view text = source.text();
  std::size_t at = skip_blanks(text, position.end);
  if (at >= text.size()) return at_end_of_text(source, position);
  const bool in_object = position.inside == JsonKind::object;
  const char close = in_object ? '}' : ']';
  std::size_t comma = text.size();

  if (position.last == JsonEvent::key) {
    if (text[at] != ':') return {at, "expected : after this key"};
    at = skip_blanks(text, at + 1);
  } else if (position.last == JsonEvent::value) {
    if (position.inside == JsonKind::null) return {at, "unexpected text after the end of the scene"};
    if (text[at] == '/' || text[at] == '#') return unexpected_character(text, at);
    if (text[at] != ',') return {at, fmt::format("expected , or {} here", close)};
    comma = at;
    at = skip_blanks(text, at + 1);
  }
  if (at >= text.size()) return at_end_of_text(source, position);
  if (text[at] == close && comma < text.size()) {
    return {comma, fmt::format("remove this comma: {} follows", close)};
  }
  if (in_object && position.last != JsonEvent::key) {
    if (text[at] == '"') return explain_string(text, at);
    if (is_letter(text[at])) return {at, fmt::format("the key {} needs double quotes", token(text, at))};
    const bool other = is_digit(text[at]) || text[at] == '[' || text[at] == '{';
    return other ? SyntaxError{at, "expected a key in double quotes"} : unexpected_character(text, at);
  }
  return explain_value(text, at, out_of_range);
}

}  // namespace catena
