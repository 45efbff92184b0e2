// Text output to the standard output or to a file, buffered, with failure remembered instead of thrown.
//
// A file is written beside its final place and renamed by commit(), so that a run that is stopped or fills the disk
// never leaves an incomplete file under that name, nor destroys the earlier one.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace catena {

class TextOutput {
 public:
  static TextOutput standard_output();
  /// A file that will be called `path`. Failure shows in ok() and error().
  static TextOutput file(const std::string& path);

  TextOutput(TextOutput&& other) noexcept;
  TextOutput& operator=(TextOutput&&) = delete;
  ~TextOutput();  ///< removes a file that was not committed

  /// False once anything could not be written; further text is then dropped.
  bool write(std::string_view text);
  bool flush();
  /// What is to be written cannot be: the same as if writing had failed for that reason.
  void fail_with(const std::string& reason);
  /// Ends a file: flushed, closed and put in its place. False if any of it failed.
  bool commit();

  bool ok() const { return error_.empty(); }
  /// Why writing failed, with the file's name; empty if it did not.
  const std::string& error() const { return error_; }
  /// The reader of the standard output has closed the pipe: not reported as an error.
  bool reader_gone() const { return reader_gone_; }

 private:
  TextOutput() = default;
  bool fail();

  std::FILE* file_ = nullptr;
  bool owned_ = false;
  bool reader_gone_ = false;
  std::string path_, temporary_, error_;
};

}  // namespace catena
