#include "catena/scene/json/diagnostic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "catena/scene/json/utf8.hpp"

namespace catena {
namespace {

constexpr std::size_t before_caret = 70;  // bytes of a long line shown left of the caret
constexpr std::size_t after_caret = 50;

/// `at` moved left to the beginning of the character it stands in.
std::size_t character_start(std::string_view text, std::size_t at) {
  for (int i = 0; i < 3 && at > 0 && at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80; ++i)
    --at;
  return at;
}

/// Appends text[from, to) as a terminal can show it; returns the columns it takes there.
int append_visible(std::string& out, std::string_view text, std::size_t from, std::size_t to) {
  int width = 0;
  for (std::size_t at = from; at < to;) {
    const CodePoint c = next_code_point(text, at);
    const bool control = c.value < 0x20 || (c.value >= 0x7f && c.value < 0xa0);
    if (c.value == '\t') {
      out += "  ";
      width += 2;
    } else if (control || !c.valid) {
      out += '?';
      width += 1;
    } else {
      out.append(text, at, static_cast<std::size_t>(c.bytes));
      width += display_width(c.value);
    }
    at += static_cast<std::size_t>(c.bytes);
  }
  return width;
}

void add_excerpt(Diagnostic& diagnostic, std::string_view line, std::size_t caret) {
  constexpr std::string_view dots = "...";
  caret = std::min(caret, line.size());
  std::size_t from = line.starts_with("\xef\xbb\xbf") && caret >= 3 ? 3 : 0;
  std::size_t to = line.size();
  if (caret > from + before_caret) {
    from = character_start(line, caret - before_caret);
    diagnostic.excerpt += dots;
    diagnostic.caret = static_cast<int>(dots.size());
  }
  const bool clipped = to > caret + after_caret;
  if (clipped) to = character_start(line, caret + after_caret);
  diagnostic.caret += append_visible(diagnostic.excerpt, line, from, caret);
  append_visible(diagnostic.excerpt, line, caret, to);
  if (clipped) diagnostic.excerpt += dots;
}

}  // namespace

std::string to_string(const Diagnostic& diagnostic) {
  if (diagnostic.line == 0) return fmt::format("{}: error: {}\n", diagnostic.file, diagnostic.message);
  std::string text =
      fmt::format("{}:{}:{}: error: {}\n", diagnostic.file, diagnostic.line, diagnostic.column, diagnostic.message);
  if (!diagnostic.excerpt.empty()) text += fmt::format("{}\n{:>{}}\n", diagnostic.excerpt, '^', diagnostic.caret + 1);
  return text;
}

void Diagnostics::error(const SourceText& source, std::size_t offset, std::string message, bool leading) {
  for (std::size_t k = 0; k < items_.size(); ++k) {
    if (places_[k] == std::pair(&source, offset) && items_[k].message == message) return;
  }
  ++count_;
  if (items_.size() >= limit_) return;
  const TextPlace place = source.place(offset);
  Diagnostic diagnostic{source.name(), place.line, place.column, std::move(message), {}, 0, leading};
  std::size_t start = 0;
  const std::string_view line = source.line_at(offset, start);
  add_excerpt(diagnostic, line, std::min(offset, source.text().size()) - start);
  items_.push_back(std::move(diagnostic));
  places_.push_back({&source, offset});
}

bool Diagnostics::reported(const SourceText& source, std::size_t offset) const {
  return std::find(places_.begin(), places_.end(), std::pair(&source, offset)) != places_.end();
}

std::vector<Diagnostic> Diagnostics::in_order() const {
  std::vector<Diagnostic> order = items_;
  std::stable_sort(order.begin(), order.end(), [](const Diagnostic& a, const Diagnostic& b) {
    if (a.leading != b.leading) return a.leading;
    return std::tie(a.file, a.line, a.column) < std::tie(b.file, b.line, b.column);
  });
  return order;
}

std::string Diagnostics::text() const {
  std::string text;
  for (const Diagnostic& item : in_order()) text += to_string(item);
  const std::size_t more = count_ - items_.size();
  if (more > 0) text += fmt::format("and {} more error{}\n", more, more == 1 ? "" : "s");
  return text;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string out = "\"";
  for (std::size_t at = 0; at < text.size();) {
    if (at >= longest) {
      out += "...";
      break;
    }
    const CodePoint c = next_code_point(text, at);
    if (c.value == '"' || c.value == '\\') {
      out += '\\';
      out += static_cast<char>(c.value);
    } else if (!c.valid) {
      out += "\xef\xbf\xbd";
    } else if (c.value < 0x20 || (c.value >= 0x7f && c.value < 0xa0)) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c.value));
    } else {
      out.append(text, at, static_cast<std::size_t>(c.bytes));
    }
    at += static_cast<std::size_t>(c.bytes);
  }
  return out + '"';
}

}  // namespace catena
