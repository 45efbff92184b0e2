#include "catena/scene/models/sweep_record.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "catena/scene/json/json_document.hpp"
#include "catena/scene/json/json_text.hpp"

namespace catena {
namespace {

/// Reads a line from its beginning.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  bool skip(std::string_view expected) {
    if (!rest_.starts_with(expected)) return false;
    rest_.remove_prefix(expected.size());
    return true;
  }
  template <class Number>
  bool number(Number& value) {
    const auto [end, code] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (code != std::errc()) return false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return true;
  }
  /// Up to the next quote.
  std::string_view word() {
    const std::string_view word = rest_.substr(0, rest_.find('"'));
    rest_.remove_prefix(word.size());
    return word;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

std::optional<Status> status_of(std::string_view word) {
  for (int k = 0; k <= static_cast<int>(Status::refused); ++k) {
    if (to_string(static_cast<Status>(k)) == word) return static_cast<Status>(k);
  }
  return {};
}

struct Line {
  int analysis = 0;
  std::int64_t number = 0;
  SweepRecord::Design design;
};

/// Nothing for a line that is no design.
std::optional<Line> read_line(const std::string& text) {
  Line line;
  LineReader reader(text);
  if (!reader.skip("[") || !reader.number(line.analysis) || !reader.skip(", ") || !reader.number(line.number) ||
      !reader.skip(", \"") || line.number < 1)
    return {};
  const std::optional<Status> status = status_of(reader.word());
  if (!status || !reader.skip("\"")) return {};
  line.design.status = *status;
  if (*status == Status::ok) {
    for (double value = 0; reader.skip(", ");) {
      if (!reader.number(value)) return {};
      line.design.measures.push_back(value);
    }
    return reader.skip("]") && reader.at_end() ? std::optional(std::move(line)) : std::nullopt;
  }
  const SourceText source("", text);
  Diagnostics diagnostics;
  const std::optional<JsonDocument> document = JsonDocument::parse(source, diagnostics);
  if (!document || document->root().size() != 4) return {};
  JsonValue message;
  for (const JsonValue& value : document->root().elements()) message = value;
  if (!message.is(JsonKind::string)) return {};
  line.design.message = message.text();
  return line;
}

}  // namespace

void SweepRecord::fail(const std::string& what) const {
  throw SweepRecordError(fmt::format("the sweep's record \"{}\" {}", path_, what));
}

SweepRecord::SweepRecord(const std::string& path, std::string_view scene, std::string_view owner, bool resume)
    : path_(path) {
  file_ = ::open(path.c_str(), O_RDWR | O_APPEND | O_CLOEXEC | (resume ? 0 : O_CREAT | O_EXCL), 0666);
  if (file_ < 0 && !resume && errno == EEXIST)
    fail("exists already: --resume goes on from it, another name begins a new one");
  if (file_ < 0) fail(fmt::format("cannot be {}: {}", resume ? "resumed" : "written", std::strerror(errno)));
  try {
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) fail("is in use by another run");
    if (resume) {
      read(owner);
    } else {
      std::string line = R"({"catena": "sweep record", "format": 1, "scene": )";
      append_json(line, scene);
      line += ", \"owner\": ";
      append_json(line, owner);
      write(line + "}\n");
    }
  } catch (...) {
    ::close(file_);
    throw;
  }
}

SweepRecord::~SweepRecord() { ::close(file_); }

void SweepRecord::check_owner(const std::string& line, std::string_view owner) const {
  const SourceText source("", line);
  Diagnostics diagnostics;
  const std::optional<JsonDocument> document = JsonDocument::parse(source, diagnostics);
  const auto text = [&](std::string_view key) -> std::string {
    const JsonValue value = document->root().find(key);
    return value && value.is(JsonKind::string) ? std::string(value.text()) : std::string();
  };
  if (!document || !document->root().is(JsonKind::object) || text("catena") != "sweep record")
    fail("is no record of a sweep");
  const JsonValue format = document->root().find("format");
  if (!format || !format.is(JsonKind::number) || format.number() != 1) fail("has the format of another version");
  if (text("owner") != owner) {
    fail(
        fmt::format("belongs to another scene (\"{}\"), or to this one with another text, other files or other "
                    "parameters, or to another command, processor or version of catena",
                    text("scene")));
  }
}

void SweepRecord::read(std::string_view owner) {
  std::ifstream in(path_, std::ios::binary);
  std::string text;
  std::int64_t offset = 0;
  for (std::int64_t number = 1; std::getline(in, text); ++number) {
    // Torn: the process ended while it wrote.
    if (in.eof()) break;
    if (number == 1) {
      check_owner(text, owner);
    } else {
      const std::optional<Line> line = read_line(text);
      if (!line) fail(fmt::format("is damaged in line {}: take that line and all after it away to go on", number));
      places_.push_back({line->analysis, line->number, offset});
    }
    offset += static_cast<std::int64_t>(text.size()) + 1;
  }
  if (offset == 0) fail("is no record of a sweep");
  if (::ftruncate(file_, offset) != 0) fail(fmt::format("cannot be resumed: {}", std::strerror(errno)));
  std::stable_sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.key() < b.key(); });
}

std::optional<SweepRecord::Design> SweepRecord::find(int analysis, std::int64_t design, std::size_t measures) const {
  const auto place = std::lower_bound(places_.begin(), places_.end(), std::pair(analysis, design),
                                      [](const Place& a, const auto& key) { return a.key() < key; });
  if (place == places_.end() || place->key() != std::pair(analysis, design)) return {};
  std::string text;
  char piece[512];
  for (std::size_t end = std::string::npos; end == std::string::npos;) {
    const ssize_t bytes = ::pread(file_, piece, sizeof piece, place->offset + static_cast<std::int64_t>(text.size()));
    if (bytes <= 0) fail("cannot be read any more");
    const std::size_t before = text.size();
    text.append(piece, static_cast<std::size_t>(bytes));
    end = text.find('\n', before);
    if (end != std::string::npos) text.resize(end);
  }
  std::optional<Line> line = read_line(text);
  const bool fits = line && line->analysis == analysis && line->number == design;
  if (!fits) fail("was changed while it was used");
  if (line->design.status == Status::ok && line->design.measures.size() != measures)
    fail(fmt::format("has {} measures of design {}, not {}", line->design.measures.size(), design, measures));
  return std::move(line->design);
}

void SweepRecord::add(int analysis, std::int64_t design, const Design& done) {
  std::string text = fmt::format("[{}, {}, \"{}\"", analysis, design, to_string(done.status));
  if (done.status != Status::ok) {
    text += ", ";
    append_json(text, std::string_view(done.message));
  }
  for (const double value : done.measures) {
    text += ", ";
    append_json(text, value);
  }
  write(text + "]\n");
  const std::lock_guard lock(mutex_);
  ++added_;
}

void SweepRecord::write(std::string_view text) {
  const std::lock_guard lock(mutex_);
  while (!text.empty()) {
    const ssize_t bytes = ::write(file_, text.data(), text.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) fail(fmt::format("cannot be written: {}", std::strerror(errno)));
    text.remove_prefix(static_cast<std::size_t>(bytes));
  }
}

std::int64_t SweepRecord::size() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::int64_t>(places_.size()) + added_;
}

}  // namespace catena
