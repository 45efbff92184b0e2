// Processor time of this process: used for reported run times, since it depends less on other programs than wall-clock
// time.
#pragma once

#include <ctime>

namespace catena {

class ProcessTimer {
 public:
  /// Seconds of processor time since construction.
  double seconds() const { return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t start_ = std::clock();
};

}  // namespace catena
