// Describes the error in a text that is not JSON, at the character where it occurs, so that a user can correct it.
//
// A parser's own message names the token that its grammar did not expect. From the last valid token and the open
// brackets the usual mistakes can be named instead: a comma too many, a bracket or quote not closed, 'single' quotes,
// NaN, +1, 01.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "catena/scene/json/json_document.hpp"

namespace catena {

enum class JsonEvent { none, key, value, open_array, open_object };

/// How far a text was sound.
struct JsonPosition {
  JsonEvent last = JsonEvent::none;  ///< the last event
  std::size_t end = 0;               ///< offset after its token
  JsonKind inside = JsonKind::null;  ///< the innermost open container; null at the top
  std::size_t opened_at = 0;         ///< where that one begins
};

struct SyntaxError {
  std::size_t offset = 0;
  std::string message;
};

/// `out_of_range`: the text is a number too large for a double.
SyntaxError explain_syntax_error(const SourceText& source, const JsonPosition& position, bool out_of_range);

/// The message for a word that begins like a number but is not one.
std::string not_a_number(std::string_view word);

/// The offset of the first byte at or after `at` that is neither blank nor in a comment.
std::size_t skip_blanks(std::string_view text, std::size_t at);
/// The same, over commas and colons too.
std::size_t skip_separators(std::string_view text, std::size_t at);

}  // namespace catena
