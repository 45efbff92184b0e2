// The result of reading a small language inside a JSON string: a value, or an error with its byte in the string.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace catena {

struct TextError {
  std::size_t position = 0;  ///< byte in the text that was read
  std::string message;
};

template <class T>
struct Parsed {
  std::optional<T> value;
  TextError error;  ///< meaningful where there is no value

  Parsed(T good) : value(std::move(good)) {}
  Parsed(TextError bad) : error(std::move(bad)) {}

  explicit operator bool() const { return value.has_value(); }
  const T& operator*() const { return *value; }
  T& operator*() { return *value; }
  const T* operator->() const { return &*value; }
};

}  // namespace catena
