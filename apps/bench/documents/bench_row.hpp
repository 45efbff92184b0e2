// One measurement of `catena bench`: how long, how wrong, how much work.
//
// Times are processor times of this process, s: the least of `repeats`, and how far the median of them lies above it.
// The error is taken against something that shares no code with the library (`reference`); `allowed` is the largest
// one that counts as right, so that a row can fail. What was not measured is not a number, or empty.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "catena/base/counters.hpp"

namespace bench {

inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

struct Row {
  std::string suite{};            ///< "dynamics"
  std::string problem{};          ///< "chain of 40 rods"
  std::string engine = "catena";  ///< or the name of another
  std::string method{};           ///< "rk8"
  std::string setting{};          ///< "1e-08": what was varied
  int bodies = 0;

  double seconds = not_measured;  ///< of one call, or of one step where `method` says so
  double spread = not_measured;   ///< (median - least) / least
  int repeats = 0;

  double error = not_measured;
  double allowed = not_measured;  ///< not a number: nothing is promised
  std::string error_of{};         ///< "worst joint, m"
  std::string reference{};        ///< what the error was taken against

  double bytes_per_body = not_measured;  ///< that the analysis holds on the heap
  std::vector<std::pair<std::string, double>> counts{};
  std::string failure{};  ///< why there is no answer

  /// An answer that is wrong, or none.
  bool failed() const { return !failure.empty() || error > allowed; }
  /// What names the measurement in another run: all but the figures.
  std::string key() const {
    return suite + " / " + problem + " / " + engine + " / " + method + (setting.empty() ? "" : " / " + setting) +
           (bodies > 0 ? " / " + std::to_string(bodies) + " bodies" : "");
  }
};

/// The counts of the library's own work that are not zero.
std::vector<std::pair<std::string, double>> named_counts(const catena::Counters& counters);

}  // namespace bench
