// Counts what C++ code (operator new) and SuiteSparse (its replaceable memory functions) take from the heap.
#pragma once

namespace catena::testing {

/// Counts from construction to destruction; one at a time.
class HeapWatch {
 public:
  HeapWatch();
  ~HeapWatch();
  HeapWatch(const HeapWatch&) = delete;
  HeapWatch& operator=(const HeapWatch&) = delete;
  long count() const;
  long bytes() const;  ///< asked for, freed or not
};

}  // namespace catena::testing
