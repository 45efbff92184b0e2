#include "catena/scene/viewing/packed_numbers.hpp"

#include <bit>

namespace catena {

static_assert(std::endian::native == std::endian::little, "packed numbers are written as they lie in memory");

void append_base64(std::string& out, std::span<const unsigned char> bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t start = out.size();
  out.resize(start + (bytes.size() + 2) / 3 * 4);
  char* to = out.data() + start;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = bytes.size() - k;
    const unsigned triple = bytes[k] << 16 | (left > 1 ? bytes[k + 1] << 8 : 0) | (left > 2 ? bytes[k + 2] : 0);
    *to++ = letters[triple >> 18];
    *to++ = letters[triple >> 12 & 63];
    *to++ = left > 1 ? letters[triple >> 6 & 63] : '=';
    *to++ = left > 2 ? letters[triple & 63] : '=';
  }
}

}  // namespace catena
