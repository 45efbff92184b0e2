#include "catena/scene/json/json_document.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "catena/scene/json/counting_iterator.hpp"
#include "catena/scene/json/json_syntax.hpp"

namespace catena {
namespace {

constexpr std::size_t deepest = 64;
constexpr std::size_t few_keys = 24;  // below this, comparing every pair is faster than sorting

bool is_separator(char c) { return c == ' ' || c == '\n' || c == ',' || c == ':' || c == '\t' || c == '\r'; }
bool is_number_character(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
}

}  // namespace

/// Receives the parser's events and appends nodes. Where a token begins follows from where the last one ended: between
/// two events stand only separators, blanks and comments.
class JsonBuilder {
 public:
  JsonBuilder(const SourceText& source, std::string_view text, Diagnostics& diagnostics)
      : document_(source), diagnostics_(diagnostics), text_(text), cursor_(text_.data()) {
    position_.end = text_.starts_with("\xef\xbb\xbf") ? 3 : 0;
    // Scenes have a value every 10 to 12 bytes; memory reserved and not touched costs nothing.
    document_.nodes_.reserve(text_.size() / 8 + 16);
  }

  std::optional<JsonDocument> parse() {
    // The parser would take a zero byte for the end of the text.
    if (const std::size_t zero = text_.find('\0'); zero != std::string_view::npos) {
      diagnostics_.error(*document_.source_, zero, "unexpected byte 0x00; a scene is UTF-8 text");
      return std::nullopt;
    }
    const CountingIterator begin{text_.data(), &cursor_}, end{text_.data() + text_.size(), &cursor_};
    const bool good = nlohmann::json::sax_parse(begin, end, this, nlohmann::json::input_format_t::json, true, true);
    if (!good) return std::nullopt;
    return std::move(document_);
  }

  /// Where a number too large for a double ended the parse.
  std::optional<std::size_t> too_large() const { return too_large_; }

  bool null() {
    append(JsonKind::null);
    return finish_value(offset_of_cursor());
  }
  bool boolean(bool value) {
    append(JsonKind::boolean).boolean = value;
    return finish_value(offset_of_cursor());
  }
  bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string&) { return number(value); }
  bool string(std::string& value) {
    append_string(value);
    return finish_value(offset_of_cursor());
  }
  bool key(std::string& value) {
    keys_.push_back({static_cast<std::uint32_t>(document_.nodes_.size()), 0});
    append_string(value);
    finish(JsonEvent::key, offset_of_cursor());
    return true;
  }
  bool start_object(std::size_t) { return open(JsonKind::object); }
  bool start_array(std::size_t) { return open(JsonKind::array); }
  bool end_object() {
    check_duplicates();
    return close();
  }
  bool end_array() { return close(); }
  bool binary(std::vector<std::uint8_t>&) { return false; }  // part of the interface, never in JSON

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) {
    return syntax_error(error.id);
  }

 private:
  struct Open {
    std::uint32_t node;
    std::uint32_t count;
    std::size_t first_key;
  };
  struct Key {
    std::uint32_t node;
    std::uint32_t hash;
  };

  std::size_t offset_of_cursor() const { return static_cast<std::size_t>(cursor_ - text_.data()); }

  JsonNode& append(JsonKind kind) {
    std::size_t begin = position_.end;
    while (begin < text_.size() && is_separator(text_[begin])) ++begin;
    if (begin < text_.size() && text_[begin] == '/') begin = skip_separators(text_, begin);
    JsonNode node{};
    node.offset = static_cast<std::uint32_t>(begin);
    node.kind = kind;
    document_.nodes_.push_back(node);
    return document_.nodes_.back();
  }

  void append_string(const std::string& value) {
    JsonNode& node = append(JsonKind::string);
    const std::size_t raw_length = offset_of_cursor() - node.offset - 2;
    node.string.length = static_cast<std::uint32_t>(value.size());
    node.decoded = raw_length != value.size();  // an escape is always longer than what it stands for
    node.string.begin = node.offset + 1;
    if (node.decoded) {
      node.string.begin = static_cast<std::uint32_t>(document_.decoded_.size());
      document_.decoded_ += value;
    }
  }

  bool number(double value) {
    JsonNode& node = append(JsonKind::number);
    node.number = value;
    // The parser has read one character more than the number, or stands at the end of the text.
    std::size_t end = node.offset;
    while (end < text_.size() && is_number_character(text_[end])) ++end;
    if (offset_of_cursor() <= end && end < text_.size()) return malformed_number(node.offset, end);
    return finish_value(end);
  }

  /// The parser has accepted only a part of the text there, as 0 of 01.
  bool malformed_number(std::size_t begin, std::size_t end) {
    diagnostics_.error(*document_.source_, begin, not_a_number(text_.substr(begin, end - begin)));
    return false;
  }

  void finish(JsonEvent event, std::size_t end) {
    position_.last = event;
    position_.end = end;
  }
  bool finish_value(std::size_t end) {
    finish(JsonEvent::value, end);
    if (!open_.empty()) ++open_.back().count;
    return true;
  }

  bool open(JsonKind kind) {
    append(kind);
    const auto index = static_cast<std::uint32_t>(document_.nodes_.size() - 1);
    if (open_.size() >= deepest) {
      diagnostics_.error(*document_.source_, document_.nodes_[index].offset, "nested more than 64 levels deep");
      return false;
    }
    open_.push_back({index, 0, keys_.size()});
    position_.last = kind == JsonKind::object ? JsonEvent::open_object : JsonEvent::open_array;
    position_.end = offset_of_cursor();
    return true;
  }

  bool close() {
    const Open closed = open_.back();
    open_.pop_back();
    document_.nodes_[closed.node].children = {static_cast<std::uint32_t>(document_.nodes_.size()), closed.count};
    return finish_value(offset_of_cursor());
  }

  std::string_view key_text(const Key& key) const { return document_.string_of(document_.nodes_[key.node]); }

  void check_duplicates() {
    const auto first = keys_.begin() + static_cast<std::ptrdiff_t>(open_.back().first_key);
    if (keys_.end() - first <= static_cast<std::ptrdiff_t>(few_keys)) {
      for (auto later = first; later != keys_.end(); ++later) {
        const std::string_view text = key_text(*later);
        const auto earlier = std::find_if(first, later, [&](const Key& key) { return key_text(key) == text; });
        if (earlier != later) report_duplicate(*earlier, *later);
      }
    } else {
      for (auto key = first; key != keys_.end(); ++key) {
        key->hash = static_cast<std::uint32_t>(std::hash<std::string_view>{}(key_text(*key)));
      }
      std::sort(first, keys_.end(),
                [](const Key& a, const Key& b) { return a.hash != b.hash ? a.hash < b.hash : a.node < b.node; });
      for (auto later = first; later != keys_.end(); ++later) {
        // Different keys of one hash are rare: a walk back through the run is enough.
        for (auto earlier = later; earlier != first && (earlier - 1)->hash == later->hash;) {
          --earlier;
          if (key_text(*earlier) != key_text(*later)) continue;
          report_duplicate(*earlier, *later);
          break;
        }
      }
    }
    keys_.erase(first, keys_.end());
  }

  void report_duplicate(const Key& earlier, const Key& later) {
    const TextPlace place = document_.source_->place(document_.nodes_[earlier.node].offset);
    diagnostics_.error(*document_.source_, document_.nodes_[later.node].offset,
                       "duplicate key " + in_quotes(key_text(later)) + "; it was given before at line " +
                           std::to_string(place.line) + ", column " + std::to_string(place.column));
  }

  /// Reports the error after the last event. Always false: stops the parser.
  bool syntax_error(int library_code) {
    position_.inside = open_.empty() ? JsonKind::null : document_.nodes_[open_.back().node].kind;
    position_.opened_at = open_.empty() ? 0 : document_.nodes_[open_.back().node].offset;
    constexpr int out_of_range = 406;
    const SyntaxError error = explain_syntax_error(*document_.source_, position_, library_code == out_of_range);
    diagnostics_.error(*document_.source_, error.offset, error.message);
    if (library_code == out_of_range) too_large_ = error.offset;
    return false;
  }

  JsonDocument document_;
  Diagnostics& diagnostics_;
  std::string_view text_;
  const char* cursor_;
  JsonPosition position_;
  std::optional<std::size_t> too_large_;
  std::vector<Open> open_;
  std::vector<Key> keys_;  // of all objects that are open
};

std::string_view describe(JsonKind kind) {
  constexpr std::string_view names[] = {"null", "true or false", "a number", "text", "a list", "an object"};
  return names[static_cast<std::size_t>(kind)];
}

std::optional<JsonDocument> JsonDocument::parse(const SourceText& source, Diagnostics& diagnostics) {
  JsonBuilder builder(source, source.text(), diagnostics);
  std::optional<JsonDocument> document = builder.parse();
  // The parser stops at a number too large for a double. To find the other errors as well, the text is parsed again
  // with 1 in its place; errors already reported are not repeated.
  std::string patched;
  for (std::optional<std::size_t> at = builder.too_large(); at && !diagnostics.full();) {
    if (patched.empty()) patched = source.text();
    std::size_t end = *at;
    while (end < patched.size() && is_number_character(patched[end])) patched[end++] = ' ';
    patched[*at] = '1';
    JsonBuilder again(source, patched, diagnostics);
    document = again.parse();
    at = again.too_large();
  }
  return document;
}

JsonValue JsonValue::find(std::string_view key) const {
  for (const JsonMember member : members()) {
    if (member.name() == key) return member.value;
  }
  return {};
}

}  // namespace catena
