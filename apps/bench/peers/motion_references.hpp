// What motion_peer.hpp compares engines with: places in double, free of what headers of C++17 do not read.
#pragma once

#include <array>
#include <vector>

namespace motion_peer {

using Place = std::array<double, 2>;

/// Far ends, m, of a chain of so many rods of 1 m that has fallen from the horizontal for `duration`, s.
std::vector<Place> ends_of_falling_chain(int rods, double duration);

inline constexpr double duration_of_a02 = 10;  // s
inline constexpr int samples_of_a02 = 400;     // of it, behind the start
/// The end of A02's first crank, m, in all of them; n four-bars.
std::vector<Place> crank_ends_of_a02(int n);

}  // namespace motion_peer
