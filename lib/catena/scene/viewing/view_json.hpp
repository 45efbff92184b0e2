// Objects and lists of the data of pages, appended one after the other; the commas come by themselves.
#pragma once

#include <string>
#include <string_view>

#include "catena/scene/json/json_text.hpp"
#include "catena/scene/viewing/packed_numbers.hpp"

namespace catena {

class ViewJson {
 public:
  explicit ViewJson(std::string& out) : out_(out) {}

  ViewJson& open(char bracket) {
    separate();
    out_ += bracket;
    first_ = true;
    return *this;
  }
  ViewJson& close(char bracket) {
    out_ += bracket;
    first_ = false;
    return *this;
  }
  ViewJson& key(std::string_view name) {
    separate();
    append_json(out_, name);
    out_ += ':';
    first_ = true;  // no comma before its value
    return *this;
  }
  template <class Value>
  ViewJson& value(const Value& value) {
    separate();
    append_json(out_, value);
    return *this;
  }
  ViewJson& text(std::string_view text) { return value(text); }
  ViewJson& count(std::size_t number) { return value(static_cast<std::int64_t>(number)); }
  /// A number with the seven digits of single precision, for geometry.
  ViewJson& rounded(double number);
  /// The object {"type", "data"} of packed numbers.
  ViewJson& packed(std::string_view type, const PackedNumbers& numbers);
  /// The text to which something is appended as a value.
  std::string& text_of_value() {
    separate();
    return out_;
  }

 private:
  void separate() {
    if (!first_) out_ += ',';
    first_ = false;
  }

  std::string& out_;
  bool first_ = true;
};

}  // namespace catena
