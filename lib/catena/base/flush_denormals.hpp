// While an object of this class lives, numbers too small to be normal count as zero on this thread.
//
// Reactions die out exponentially along a chain at rest; where they reach 1e-308 every operation on them would take a
// hundred times as long and change no result. x86-64 only; elsewhere nothing happens. The destructor restores the
// former mode.
#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace catena {

class FlushDenormals {
 public:
#ifdef __SSE2__
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | flush_results | read_as_zero); }
  ~FlushDenormals() { _mm_setcsr(before_); }
#else
  FlushDenormals() = default;
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#ifdef __SSE2__
  static constexpr unsigned flush_results = 0x8000, read_as_zero = 0x0040;
  unsigned before_;
#endif
};

}  // namespace catena
