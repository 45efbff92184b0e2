// A number of bodies, rows or columns as an index into a container.
//
//   at(k) = k as std::size_t,  k >= 0
//
// Numbers that may be -1 ("none") and differences of numbers are int throughout; containers ask for std::size_t.
#pragma once

#include <cstddef>

namespace catena {

constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }

}  // namespace catena
