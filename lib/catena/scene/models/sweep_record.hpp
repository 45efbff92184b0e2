// The finished designs of sweeps in a file, from which an interrupted run goes on.
//
// JSON, a value a line. The first line says whose designs they are:
//
//   {"catena": "sweep record", "format": 1, "scene": "crank", "owner": "9f0c..."}
//
// and every other line is one design: the number of its analysis in the run and its own number, both from 1, its
// status, and its measures in order, or the reason why it has none:
//
//   [1, 17, "ok", 0.30000000000000004, 2.5]
//   [1, 18, "not_assembled", "constraint \"B\" cannot be met ..."]
//
// in the order in which they were finished. Numbers have the digits that read back to the same bits. A line is written
// at once, whole, when its design is done; one that an ended process left without its end is cut off. `owner` is a hash
// of what designs depend on: a record of anything else is refused.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/base/status.hpp"

namespace catena {

/// The message is a sentence that names the file.
class SweepRecordError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class SweepRecord {
 public:
  struct Design {
    Status status = Status::ok;
    std::string message;           ///< why it has no measures; empty if it has
    std::vector<double> measures;  ///< empty if it failed
  };

  /// Begins a record, of which there must be none yet, or with `resume` goes on with the one that is there. Throws
  /// SweepRecordError: it exists or does not, is not of this owner, is damaged, in use, or cannot be written.
  SweepRecord(const std::string& path, std::string_view scene, std::string_view owner, bool resume);
  ~SweepRecord();
  SweepRecord(const SweepRecord&) = delete;
  SweepRecord& operator=(const SweepRecord&) = delete;

  /// A design that was finished before, with `measures` measures; both numbers from 1. Several threads may ask. Throws
  /// SweepRecordError where it has another number of measures, or the file does not have it any more.
  std::optional<Design> find(int analysis, std::int64_t design, std::size_t measures) const;
  /// Takes a design that is done now. Throws SweepRecordError if it cannot be written.
  void add(int analysis, std::int64_t design, const Design& done);
  /// How many designs there are.
  std::int64_t size() const;
  const std::string& path() const { return path_; }

 private:
  /// Where the line of a design stands: 24 bytes a design.
  struct Place {
    int analysis;
    std::int64_t design, offset;
    auto key() const { return std::pair(analysis, design); }
  };
  void read(std::string_view owner);
  void check_owner(const std::string& line, std::string_view owner) const;
  void write(std::string_view text);
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;
  int file_ = -1;
  std::vector<Place> places_;  // of designs that the file had, sorted
  std::int64_t added_ = 0;
  mutable std::mutex mutex_;  // of what is written
};

}  // namespace catena
