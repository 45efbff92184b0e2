#include "catena/results/text_output.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace catena {

TextOutput TextOutput::standard_output() {
  TextOutput output;
  output.file_ = stdout;
  output.path_ = "the standard output";
  return output;
}

TextOutput TextOutput::file(const std::string& path) {
  TextOutput output;
  output.owned_ = true;
  output.path_ = path;
  // The process number keeps two runs into one folder apart.
  output.temporary_ = path + "." + std::to_string(::getpid()) + ".part";
  output.file_ = std::fopen(output.temporary_.c_str(), "wb");
  if (!output.file_) output.fail();
  return output;
}

TextOutput::TextOutput(TextOutput&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)),
      owned_(other.owned_),
      reader_gone_(other.reader_gone_),
      path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      error_(std::move(other.error_)) {}

TextOutput::~TextOutput() {
  if (!owned_ || !file_) return;
  std::fclose(file_);
  std::remove(temporary_.c_str());
}

bool TextOutput::fail() {
  reader_gone_ = errno == EPIPE;
  error_ = "cannot write " + path_ + ": " + std::strerror(errno);
  return false;
}

void TextOutput::fail_with(const std::string& reason) {
  if (ok()) error_ = "cannot write " + path_ + ": " + reason;
}

bool TextOutput::write(std::string_view text) {
  if (!ok()) return false;
  errno = 0;
  return std::fwrite(text.data(), 1, text.size(), file_) == text.size() || fail();
}

bool TextOutput::flush() {
  if (!ok()) return false;
  errno = 0;
  return std::fflush(file_) == 0 || fail();
}

bool TextOutput::commit() {
  if (!owned_) return flush();
  flush();
  if (!file_) return false;
  errno = 0;
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (ok() && !closed) fail();
  if (ok() && std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  if (!ok()) std::remove(temporary_.c_str());
  return ok();
}

}  // namespace catena
