// Passes a text to a parser and counts how far it has read.
//
// nlohmann's parser reports values to its handler, but not their places. It reads its input through iterators, one
// character at a time: after the event of a string, a literal or a bracket the cursor stands exactly after that token;
// after a number it stands one character further, unless the text ended.
#pragma once

#include <cstddef>
#include <iterator>

namespace catena {

struct CountingIterator {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char* at;
  const char** cursor;

  reference operator*() const { return *at; }
  CountingIterator& operator++() {
    *cursor = ++at;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at == other.at; }
  bool operator!=(const CountingIterator& other) const { return at != other.at; }
};

}  // namespace catena
