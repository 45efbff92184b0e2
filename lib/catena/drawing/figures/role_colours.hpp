// The colours of figures on white paper: those of Okabe and Ito for bodies, which people with colour-blindness can
// tell apart, and greys for what does not move. Source: Okabe and Ito, Color Universal Design, 2008.
#pragma once

#include <array>

#include "catena/drawing/figures/vector_canvas.hpp"
#include "catena/drawing/shapes/drawing.hpp"

namespace catena {

inline constexpr std::array<Colour, 7> body_colours{{{0x00, 0x72, 0xb2},
                                                     {0xd5, 0x5e, 0x00},
                                                     {0x00, 0x9e, 0x73},
                                                     {0xcc, 0x79, 0xa7},
                                                     {0xe6, 0x9f, 0x00},
                                                     {0x56, 0xb4, 0xe9},
                                                     {0x8c, 0x7a, 0x2b}}};

inline Colour body_colour(int body) {
  return body < 0 ? grey : body_colours[static_cast<std::size_t>(body) % body_colours.size()];
}

/// Whether a line of this role takes the colour of its body.
inline bool has_body_colour(Role role) {
  return role == Role::link || role == Role::gear || role == Role::curve || role == Role::wheel;
}

/// The colour inside of the rims of wheels.
inline Colour wheel_colour(int body) { return mixed(body_colour(body), white, 0.82); }

/// The colour of edges and lines.
inline Colour role_colour(Role role, int body) {
  if (role == Role::wheel) return wheel_colour(body);  // its edge is the rim, which is drawn apart
  if (has_body_colour(role)) return mixed(body_colour(body), black, 0.25);
  switch (role) {
    case Role::support:
    case Role::guide:
      return {0x66, 0x66, 0x66};
    case Role::driver:
      return {0xb0, 0x2a, 0x2a};
    case Role::measure:
      return grey;
    case Role::spring:
      return {0x33, 0x55, 0x66};
    default:
      return black;
  }
}

/// The colour inside of areas.
inline Colour role_fill(Role role, int body) {
  if (role == Role::driver) return role_colour(role, body);
  if (role == Role::gear || role == Role::wheel) return wheel_colour(body);
  if (has_body_colour(role)) return mixed(body_colour(body), white, 0.6);
  if (role == Role::support || role == Role::rod) return {0xdd, 0xdd, 0xdd};
  return white;
}

}  // namespace catena
