// Processor time, and the least of several repetitions: a measure of speed that depends little on other programs.
#pragma once

#include <algorithm>
#include <ctime>
#include <limits>

namespace bench {

inline double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Seconds of one call: the least over `repeats` batches of `calls` calls.
template <class F>
double least_time(int repeats, int calls, F&& f) {
  double least = std::numeric_limits<double>::infinity();
  for (int r = 0; r < repeats; ++r) {
    const double start = processor_time();
    for (int c = 0; c < calls; ++c) f();
    least = std::min(least, (processor_time() - start) / calls);
  }
  return least;
}

}  // namespace bench
