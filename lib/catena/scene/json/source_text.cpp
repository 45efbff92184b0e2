#include "catena/scene/json/source_text.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <limits>

namespace catena {
namespace {

constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max() - 1;  // offsets have 32 bits
constexpr std::size_t largest_stream = std::size_t(1) << 30;  // pipes and devices, whose end is not known beforehand

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw FileError("cannot read " + path + ": " + reason);
}

/// Reads until `buffer` is full or the file ends; returns the bytes read.
std::size_t fill(int file, char* buffer, std::size_t size, const std::string& path) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::read(file, buffer + done, size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path, std::strerror(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace

SourceText::SourceText(std::string name, std::string_view text)
    : name_(std::move(name)), bytes_(std::make_unique_for_overwrite<char[]>(text.size())), size_(text.size()) {
  if (text.size() > largest) throw FileError(name_ + " is larger than 4 GB");
  std::copy(text.begin(), text.end(), bytes_.get());
}

SourceText SourceText::read(const std::string& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  struct stat status {};
  if (file.number < 0 || ::fstat(file.number, &status) != 0) fail(path, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) fail(path, "it is a directory");
  const bool regular = S_ISREG(status.st_mode);
  const std::size_t limit = regular ? largest : largest_stream;
  if (regular && static_cast<std::uint64_t>(status.st_size) > limit) fail(path, "it is larger than 4 GB");

  SourceText source;
  source.name_ = path;
  // One byte more than the file has: a short read then means the end, without a second buffer.
  std::size_t capacity = regular ? static_cast<std::size_t>(status.st_size) + 1 : std::size_t(1) << 16;
  source.bytes_ = std::make_unique_for_overwrite<char[]>(capacity);
  for (;;) {
    source.size_ += fill(file.number, source.bytes_.get() + source.size_, capacity - source.size_, path);
    if (source.size_ < capacity) return source;
    if (source.size_ > limit) fail(path, "it is too large");
    capacity *= 2;
    auto larger = std::make_unique_for_overwrite<char[]>(capacity);
    std::copy_n(source.bytes_.get(), source.size_, larger.get());
    source.bytes_ = std::move(larger);
  }
}

std::size_t SourceText::line_number(std::size_t offset) const {
  if (line_starts_.empty()) {
    line_starts_.push_back(0);
    const char* const begin = bytes_.get();
    const char* const end = begin + size_;
    for (const char* p = begin; p != end;) {
      const void* found = std::memchr(p, '\n', static_cast<std::size_t>(end - p));
      if (!found) break;
      p = static_cast<const char*>(found) + 1;
      line_starts_.push_back(static_cast<std::uint32_t>(p - begin));
    }
  }
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  return static_cast<std::size_t>(after - line_starts_.begin()) - 1;
}

TextPlace SourceText::place(std::size_t offset) const {
  offset = std::min(offset, size_);
  const std::size_t line = line_number(offset);
  std::size_t start = line_starts_[line];
  if (line == 0 && offset >= 3 && text().starts_with("\xef\xbb\xbf")) start = 3;  // a byte order mark has no column
  // Every byte but a continuation byte begins a character; counting them vectorises, and a scene may be a single line.
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  const auto count = std::count_if(bytes_.get() + start, bytes_.get() + offset, begins);
  return {static_cast<int>(line) + 1, static_cast<int>(count) + 1};
}

std::string_view SourceText::line_at(std::size_t offset, std::size_t& start) const {
  const std::size_t line = line_number(std::min(offset, size_));
  start = line_starts_[line];
  std::size_t end = line + 1 < line_starts_.size() ? line_starts_[line + 1] - 1 : size_;
  if (end > start && bytes_[end - 1] == '\r') --end;
  return text().substr(start, end - start);
}

std::size_t SourceText::offset_in_string(std::size_t offset, std::size_t index) const {
  std::size_t at = offset + 1;  // after the opening quote
  while (index > 0 && at + 1 < size_ && bytes_[at] != '"') {
    std::size_t raw = 1, decoded = 1;
    if (bytes_[at] == '\\' && bytes_[at + 1] == 'u') {
      unsigned value = 0;
      if (at + 6 <= size_) std::from_chars(bytes_.get() + at + 2, bytes_.get() + at + 6, value, 16);
      const bool pair = value >= 0xd800 && value <= 0xdbff && at + 12 <= size_;
      raw = pair ? 12 : 6;
      decoded = pair ? 4 : value < 0x80 ? 1 : value < 0x800 ? 2 : 3;
    } else if (bytes_[at] == '\\') {
      raw = 2;
    }
    at += raw;
    index -= std::min(index, decoded);
  }
  return std::min(at, size_);
}

}  // namespace catena
