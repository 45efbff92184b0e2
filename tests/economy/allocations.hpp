// How often C++ code asked for memory since the program began.
#pragma once

#include <atomic>

namespace catena::testing {

extern std::atomic<long> allocations;

}  // namespace catena::testing
