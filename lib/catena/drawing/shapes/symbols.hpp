// The symbols of joints, supports, springs and drivers, in sizes of symbols: what they look like stands here alone.
//
// Drawn as textbooks on mechanisms do: pins as small circles, the ground hatched, sliders as blocks, springs as
// zigzags. Coordinates (u, v) as in drawing.hpp: u along the symbol, v to the left of it; of a span u counts in parts
// of its length.
#pragma once

#include "catena/drawing/shapes/drawing.hpp"

namespace catena {

DrawnSymbol bar_symbol(double width, Role role);  ///< span: the straight bar from P to Q
DrawnSymbol disc_symbol(double radius, Role role);
DrawnSymbol pin_symbol();
DrawnSymbol ground_pin_symbol();  ///< below the pin: a triangle on hatched ground
DrawnSymbol weld_symbol();
DrawnSymbol ground_weld_symbol();
DrawnSymbol block_symbol();   ///< of a slider, along u
DrawnSymbol roller_symbol();  ///< a support on wheels below the point
DrawnSymbol turn_symbol();    ///< the curved arrow of what turns a body
DrawnSymbol cylinder_symbol();
DrawnSymbol spring_symbol(bool elastic, bool damped);
DrawnSymbol spiral_symbol();
DrawnSymbol bushing_symbol();
DrawnSymbol face_symbol();  ///< a flat face along u, its body below
DrawnSymbol limit_symbol();
DrawnSymbol guide_symbol(bool on_ground);  ///< span
DrawnSymbol slot_symbol(bool on_ground);   ///< span

/// Short slanted strokes below the line from (u0, v) to (u1, v), `depth` deep; `slant` is how far they lean.
void add_hatching(DrawnSymbol& symbol, double u0, double u1, double v, int strokes, double slant, double depth);

}  // namespace catena
