#include "catena/results/npz_writer.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "catena/results/status_word.hpp"

namespace catena {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

constexpr std::uint32_t local_header = 0x04034b50, central_header = 0x02014b50, end_of_directory = 0x06054b50;
constexpr std::uint16_t version = 20, utf8_names = 1 << 11;
// Midnight of 1 January 1980: the same results make the same file.
constexpr std::uint16_t no_time = 0, no_date = 0x21;
constexpr std::size_t status_width = 16;
constexpr std::size_t most_entries = std::numeric_limits<std::uint16_t>::max();
constexpr std::uint64_t largest_archive = std::numeric_limits<std::uint32_t>::max();

/// CRC-32 of zip, byte by byte.
std::uint32_t checksum(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320U ^ (c >> 1) : c >> 1;
      made[n] = c;
    }
    return made;
  }();
  std::uint32_t c = 0xffffffffU;
  for (const char byte : bytes) c = table[(c ^ static_cast<unsigned char>(byte)) & 0xff] ^ (c >> 8);
  return c ^ 0xffffffffU;
}

template <class... Numbers>
void append(std::string& out, Numbers... numbers) {
  const auto one = [&](auto number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    out.append(bytes, sizeof number);
  };
  (one(numbers), ...);
}

/// The magic word and description of an array, padded to whole blocks of 64 bytes.
std::string array_header(std::string_view type, std::size_t length) {
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({},), }}", type, length);
  constexpr std::size_t before = 10, block = 64;
  text.append(block - 1 - (before + text.size()) % block, ' ');
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  append(header, static_cast<std::uint16_t>(text.size()));
  return header + text;
}

std::string array_of(const ColumnInfo& column, const std::vector<double>& values) {
  if (!column.is_status) {
    std::string bytes = array_header("<f8", values.size());
    const std::size_t first = bytes.size(), size = values.size() * sizeof(double);
    bytes.resize(first + size);
    if (size > 0) std::memcpy(bytes.data() + first, values.data(), size);
    return bytes;
  }
  std::string bytes = array_header(fmt::format("|S{}", status_width), values.size());
  for (const double value : values) {
    std::string word(status_word(value));
    word.resize(status_width, '\0');
    bytes += word;
  }
  return bytes;
}

}  // namespace

void NpzWriter::begin(std::span<const ColumnInfo> columns) {
  columns_.assign(columns.begin(), columns.end());
  values_.assign(columns.size(), {});
}

bool NpzWriter::row(std::span<const double> values) {
  for (std::size_t c = 0; c < values.size(); ++c) values_[c].push_back(values[c]);
  return true;
}

void NpzWriter::write(const std::string& bytes) {
  output_.write(bytes);
  written_ += bytes.size();
}

void NpzWriter::add(const std::string& name, const std::string& array) {
  if (written_ + array.size() + 2 * name.size() + 200 > largest_archive || entries_.size() >= most_entries) {
    too_large_ = true;
    return;
  }
  const Entry entry{name + ".npy", checksum(array), static_cast<std::uint32_t>(array.size()),
                    static_cast<std::uint32_t>(written_)};
  std::string header;
  append(header, local_header, version, utf8_names, std::uint16_t{0}, no_time, no_date, entry.check, entry.size,
         entry.size, static_cast<std::uint16_t>(entry.name.size()), std::uint16_t{0});
  write(header + entry.name);
  write(array);
  entries_.push_back(entry);
}

void NpzWriter::finish() {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    add(columns_[c].name, array_of(columns_[c], values_[c]));
    values_[c] = {};
  }
  if (too_large_) output_.fail_with("an archive has at most 4 GB and 65535 columns; write CSV files instead");
  const auto start = static_cast<std::uint32_t>(written_);
  std::string directory;
  for (const Entry& entry : entries_) {
    append(directory, central_header, version, version, utf8_names, std::uint16_t{0}, no_time, no_date, entry.check,
           entry.size, entry.size, static_cast<std::uint16_t>(entry.name.size()), std::uint16_t{0}, std::uint16_t{0},
           std::uint16_t{0}, std::uint16_t{0}, std::uint32_t{0}, entry.offset);
    directory += entry.name;
  }
  const auto count = static_cast<std::uint16_t>(entries_.size());
  const auto size = static_cast<std::uint32_t>(directory.size());
  append(directory, end_of_directory, std::uint16_t{0}, std::uint16_t{0}, count, count, size, start, std::uint16_t{0});
  write(directory);
}

}  // namespace catena
