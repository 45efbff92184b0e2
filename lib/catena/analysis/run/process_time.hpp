// Processor time of this process: what run times are reported in, since the machines people share are noisy.
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
