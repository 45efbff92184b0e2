#include "economy/allocations.hpp"

#include <cstdlib>
#include <new>

namespace catena::testing {

std::atomic<long> allocations{0};

}  // namespace catena::testing

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++catena::testing::allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
// Algorithms that can do without a buffer ask for it this way; it goes back through the same delete.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++catena::testing::allocations;
  return std::malloc(size ? size : 1);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
