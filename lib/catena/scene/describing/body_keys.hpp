// The keys of a body and of its parts, in the order of readers and schema.
#pragma once

#include <array>
#include <string_view>

namespace catena {

inline constexpr std::array<std::string_view, 13> body_keys{
    "mass",  "inertia", "position", "angle",    "velocity", "angular_velocity", "points", "centroid",
    "parts", "rod",     "fixed",    "particle", "hold"};
inline constexpr std::array<std::string_view, 2> rod_keys{"from", "to"};
inline constexpr std::array<std::string_view, 6> part_keys{"mass",      "centroid", "inertia",
                                                           "rectangle", "disc",     "polygon"};
inline constexpr std::array<std::string_view, 4> rectangle_keys{"centre", "width", "height", "angle"};
inline constexpr std::array<std::string_view, 2> disc_keys{"centre", "radius"};
inline constexpr std::array<std::string_view, 3> hold_columns{"x", "y", "angle"};

}  // namespace catena
