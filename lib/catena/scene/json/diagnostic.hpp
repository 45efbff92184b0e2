// Errors in a scene's text, collected so that a user sees all of them at once, and printed as a compiler prints them:
//
//   scene.json:12:15: error: unknown key "lenght" in body "crank"; did you mean "length"?
//       "crank": {"lenght": 0.4},
//                 ^
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/scene/json/source_text.hpp"

namespace catena {

struct Diagnostic {
  std::string file;
  int line = 0;    ///< from 1; 0 where no place in a text applies
  int column = 0;  ///< from 1, in characters
  std::string message;
  std::string excerpt;   ///< the line of the text, clipped around the place, control characters made visible
  int caret = 0;         ///< columns of a terminal before the caret in `excerpt`
  bool leading = false;  ///< others may follow from it: told first
};

/// The compiler-like text of one error: two or three lines, the last one ended.
std::string to_string(const Diagnostic& diagnostic);

class Diagnostics {
 public:
  /// Keeps the first `limit` errors and only counts the rest: one mistake in a block may appear a million times.
  explicit Diagnostics(std::size_t limit = 50) : limit_(limit) {}

  /// A message for this place that was reported already is not repeated.
  void error(const SourceText& source, std::size_t offset, std::string message, bool leading = false);

  /// Whether an error at this place was kept: repeated blocks report a place once.
  bool reported(const SourceText& source, std::size_t offset) const;

  bool ok() const { return count_ == 0; }
  /// Whether a further error would only be counted; costly messages and searches can be left out then.
  bool full() const { return count_ >= limit_; }
  std::size_t count() const { return count_; }
  std::span<const Diagnostic> items() const { return items_; }
  /// The same in the order of the text, leading ones before the others.
  std::vector<Diagnostic> in_order() const;
  /// All that were kept, in the order of the text, and how many more there are.
  std::string text() const;

 private:
  std::size_t limit_;
  std::size_t count_ = 0;
  std::vector<Diagnostic> items_;
  std::vector<std::pair<const SourceText*, std::size_t>> places_;  // of the items
};

/// The text between double quotes, control characters and invalid bytes escaped, clipped to about 60 characters.
std::string in_quotes(std::string_view text);

}  // namespace catena
