// Records of catena in the form in which other engines' programs print theirs: one line a measurement, fields set apart
// by tabs, the first names the table. Printed in one run with theirs they can be laid side by side; each scene has an
// answer that no engine had a part in.
//
//   S1a  one evaluation of accelerations, chain of N rods, angle 0.3 sin(i), rate 0.1 cos(i):
//        method, N, ns a body, us a call, acceleration of the tip, m/s^2
//   S1b  the straight chain of 40 rods falls for 1 s: method, tolerance, steps, ms, energy J, error of the tip and of
//        the worst joint, m
//   S2   A02, N four-bars for 10 s, 401 samples: method, tolerance, N, ms, energy J, error of B0, m, time for which it
//        stayed below 0.1 m
//   S3   Andrews' squeezing mechanism to 0.03 s: method, tolerance, steps, ms, worst angle, rad
//   S4   chain of N rods over 0.8 N m at rest: solver, tolerance, N, ms, relative excess of energy, worst joint, m
//
// Time: processor, the least of some runs, from the model to the last row (plan, assembly and integration).
#pragma once

#include <string_view>

namespace bench {

/// Prints the records of a scene: acceleration, chain, fourbar, squeezer or equilibrium; false for another name.
bool print_peer_records(std::string_view scene);

}  // namespace bench
