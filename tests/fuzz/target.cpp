// A fuzzer: CATENA_ENTRY, one of entry_points.hpp, for whatever bytes libFuzzer finds. An exception ends it, as a
// crash does.
#include <cstddef>
#include <cstdint>

#include "fuzz/entry_points.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  catena::testing::CATENA_ENTRY({reinterpret_cast<const char*>(data), size});
  return 0;
}
