// Many numbers in little room, for the data of pages: little-endian binary in base64 (RFC 4648), which JSON can hold.
//
//   float64   8 bytes, exact: columns            float32   4 bytes, 7 digits: poses, about an origin of their own
//   uint16    2 bytes: value = offset + step k, step = range / 65535; angles are wrapped into one turn, step 2 pi /
//   65536
//
// Numbers that are not finite stay so in the floating-point forms; pages show them as gaps.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace catena {

void append_base64(std::string& out, std::span<const unsigned char> bytes);

/// Collects numbers and gives them as base64.
class PackedNumbers {
 public:
  void add_double(double value) { add_bytes(&value, sizeof value); }
  void add_float(double value) {
    const auto rounded = static_cast<float>(value);
    add_bytes(&rounded, sizeof rounded);
  }
  void add_short(std::uint16_t value) { add_bytes(&value, sizeof value); }
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  void append_to(std::string& out) const {
    append_base64(out, {reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size()});
  }

 private:
  void add_bytes(const void* first, std::size_t count) { bytes_.append(static_cast<const char*>(first), count); }

  std::string bytes_;
};

}  // namespace catena
