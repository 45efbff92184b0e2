// What the suites of `catena bench` write their rows to: options, the rows so far, and the way times are taken.
//
// A time is the least of many repeats of processor time, so that other programs on the machine disturb it little: what
// takes less than a millisecond is called in batches, and calls go on for `budget` seconds; where the run is not brief
// thrice at least, twice from 0.3 s a call on, once from 3 s on: disturbances are brief beside such calls.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "documents/bench_row.hpp"
#include "timing.hpp"

namespace bench {

struct Options {
  bool brief = false;        ///< small sizes, few tolerances, one call each: for tests
  double budget = 0.25;      ///< s of processor time that a row may spend on repeats
  std::string only{};        ///< rows whose key holds this alone; empty: all
  std::string references{};  ///< folder of reference values; empty: that of the sources
  std::string peers{};       ///< folder of programs of other engines, or a file of their records; may be empty
  bool instructions = true;  ///< economy: count instructions by callgrind
  std::function<void(const Row&)> progress{};  ///< called for every row
  std::function<bool()> cancelled{};           ///< asked between rows; may be empty
};

class Bench {
 public:
  explicit Bench(Options options) : options_(std::move(options)) {}

  const Options& options() const { return options_; }
  bool brief() const { return options_.brief; }
  /// Whether this row is among those asked for, and the run was not cancelled.
  bool wants(const Row& row) const {
    return (!options_.cancelled || !options_.cancelled()) &&
           (options_.only.empty() || row.key().find(options_.only) != std::string::npos);
  }
  void add(Row row) {
    if (options_.progress) options_.progress(row);
    rows_.push_back(std::move(row));
  }
  void remark(std::string note) { notes_.push_back(std::move(note)); }

  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<std::string>& notes() const { return notes_; }

  /// Calls f as often as the budget allows and fills in time, spread and repeats, of one of `parts` parts of a call.
  template <class F>
  void time(Row& row, F&& f, double parts = 1) const {
    const auto batch = [&f](int calls) {
      const double start = processor_time();
      for (int c = 0; c < calls; ++c) f();
      return (processor_time() - start) / calls;
    };
    const double first = batch(1);
    const double budget = options_.brief ? 0 : options_.budget;
    constexpr double brief_call = 1e-3;  // s: the clock's own cost and grain, under a microsecond, no longer show
    const int calls = budget > 0 ? static_cast<int>(std::clamp(brief_call / std::max(first, 1e-9), 1.0, 1e6)) : 1;
    std::vector<double> times;
    if (calls == 1) times.push_back(first);
    double spent = first;
    constexpr double long_call = 0.3, very_long_call = 3;  // s: whole lists of suites are to end within ten minutes
    const std::size_t least = budget == 0 || first >= very_long_call ? 1 : first >= long_call ? 2 : 3;
    while (times.size() < least || (spent < budget && times.size() < 1000)) {
      times.push_back(batch(calls));
      spent += times.back() * calls;
    }
    std::sort(times.begin(), times.end());
    row.seconds = times.front() / parts;
    row.spread = times[times.size() / 2] / times.front() - 1;
    row.repeats = static_cast<int>(times.size());
  }

 private:
  Options options_;
  std::vector<Row> rows_;
  std::vector<std::string> notes_;
};

/// Bytes that the program holds on the heap now.
double held_bytes();

/// "1e-08"
std::string tolerance_text(double tolerance);

}  // namespace bench
