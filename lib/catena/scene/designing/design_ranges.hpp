// Numbers of designs in words: "3, 5 to 9 and 12", as users count them, from 1.
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace catena {

/// `designs` count from 0. Of many ranges the first ones are named, and how many designs are in the others.
std::string design_ranges(const std::set<std::int64_t>& designs);

}  // namespace catena
