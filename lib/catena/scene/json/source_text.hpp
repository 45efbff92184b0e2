// The text of a scene with its name, and the way from a byte offset to line and column.
//
// Everything read from a scene remembers a byte offset only (4 bytes); lines are counted when a message needs them, by
// an index of line starts made at the first such question (about 1 ms per 10 MB). Lines and columns start at 1, columns
// count code points, a tab is one.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace catena {

/// A file that cannot be read: missing, a directory, no permission. what() names the file and the reason.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct TextPlace {
  int line = 1;
  int column = 1;
};

/// Not for concurrent use: place() builds its index on demand.
class SourceText {
 public:
  /// A text from another source, with the name shown in messages.
  SourceText(std::string name, std::string_view text);
  /// The whole file. Throws FileError; files of 4 GB and more are refused.
  static SourceText read(const std::string& path);

  const std::string& name() const { return name_; }
  std::string_view text() const { return {bytes_.get(), size_}; }

  TextPlace place(std::size_t offset) const;
  /// The line that holds byte `offset`, without its line end; `start` becomes the offset of its first byte.
  std::string_view line_at(std::size_t offset, std::size_t& start) const;
  /// Where the character number `index` (in bytes, escapes decoded) of the JSON string that begins at `offset` stands.
  std::size_t offset_in_string(std::size_t offset, std::size_t index) const;

 private:
  SourceText() = default;
  std::size_t line_number(std::size_t offset) const;

  std::string name_;
  std::unique_ptr<char[]> bytes_;  // not a std::string: its bytes would be zeroed before they are read over
  std::size_t size_ = 0;
  mutable std::vector<std::uint32_t> line_starts_;
};

}  // namespace catena
