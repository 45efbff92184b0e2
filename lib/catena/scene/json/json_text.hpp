// Values as JSON text: strings escaped, doubles with the shortest digits that read back exactly, null where a number is
// not finite.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace catena {

/// Appends the string in quotes. Bytes that are no UTF-8 become U+FFFD, so that the result is always JSON.
void append_json(std::string& out, std::string_view text);
void append_json(std::string& out, double value);
void append_json(std::string& out, std::int64_t value);
void append_json(std::string& out, bool value);

}  // namespace catena
