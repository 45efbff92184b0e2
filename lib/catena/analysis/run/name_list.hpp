// Names as messages list them: `"a", "b", "c" and 4 more`. A reader follows up the first few; all of a large scene
// would hide the message.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace catena {

class NameList {
 public:
  /// Names before the rest is counted.
  static constexpr std::size_t most = 6;

  void add(std::string_view name) { add_text("\"" + std::string(name) + "\""); }
  /// What is listed as it stands, without quotes.
  void add_text(std::string_view text) {
    if (++count_ > most) return;
    if (count_ > 1) text_ += ", ";
    text_ += text;
  }
  std::size_t count() const { return count_; }
  std::string text() const { return count_ > most ? text_ + " and " + std::to_string(count_ - most) + " more" : text_; }

 private:
  std::string text_;
  std::size_t count_ = 0;
};

/// The names of these elements of a model.
template <class Model>
std::string element_names(const Model& model, const std::vector<int>& elements) {
  NameList names;
  for (const int element : elements) names.add(model.element_name(element));
  return names.text();
}

}  // namespace catena
