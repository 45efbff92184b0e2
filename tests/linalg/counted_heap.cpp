// The operators are replaced in a file of their own: inlined next to their use, compilers would warn of mismatches.
#include "linalg/counted_heap.hpp"

#include <suitesparse/SuiteSparse_config.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> allocations{0}, bytes_asked_for{0};

void* counted_malloc(std::size_t size) {
  ++allocations;
  bytes_asked_for += static_cast<long>(size);
  return std::malloc(size);
}
void* counted_calloc(std::size_t count, std::size_t size) {
  ++allocations;
  bytes_asked_for += static_cast<long>(count * size);
  return std::calloc(count, size);
}
void* counted_realloc(void* place, std::size_t size) {
  ++allocations;
  bytes_asked_for += static_cast<long>(size);
  return std::realloc(place, size);
}

}  // namespace

void* operator new(std::size_t size) {
  if (void* place = counted_malloc(size == 0 ? 1 : size)) return place;
  throw std::bad_alloc();
}
void operator delete(void* place) noexcept { std::free(place); }
void operator delete(void* place, std::size_t) noexcept { std::free(place); }

namespace catena::testing {

HeapWatch::HeapWatch() {
  SuiteSparse_config.malloc_func = counted_malloc;
  SuiteSparse_config.calloc_func = counted_calloc;
  SuiteSparse_config.realloc_func = counted_realloc;
  allocations = 0;
  bytes_asked_for = 0;
}

HeapWatch::~HeapWatch() {
  SuiteSparse_config.malloc_func = std::malloc;
  SuiteSparse_config.calloc_func = std::calloc;
  SuiteSparse_config.realloc_func = std::realloc;
}

long HeapWatch::count() const { return allocations; }

long HeapWatch::bytes() const { return bytes_asked_for; }

}  // namespace catena::testing
