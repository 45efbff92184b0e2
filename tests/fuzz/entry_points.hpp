// What readers of text must hold for any bytes whatever: the entry points of the fuzzers (target.cpp) and of the test
// that replays what they kept (tests/scene/fuzz_corpus_test.cpp).
//
// A reader ends with a value or with its own kind of error, which has words and a place inside the text; a value is
// finite, and reads the same again. Anything else is a Finding. Nothing here knows what a text should mean.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace catena::testing {

struct Finding : std::logic_error {
  using std::logic_error::logic_error;
};
inline void require(bool holds, const std::string& what) {
  if (!holds) throw Finding(what);
}

/// A scene's text, to the point where it would be analysed.
void read_any_scene(std::string_view text);
/// The part of an expression after "=", and the same text as a name with expressions in braces.
void read_any_expression(std::string_view text);
/// A number with its unit; the first line may be a unit that results are asked for.
void read_any_quantity(std::string_view text);
/// A checkpoint as it is, and with the checksum that it should have.
void read_any_checkpoint(std::string_view text);
/// A file of numbers that a scene names, read in all the ways that a scene can ask for.
void read_any_table(std::string_view text);

}  // namespace catena::testing
