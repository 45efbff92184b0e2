// Tables of dynamics: cost of an evaluation of accelerations, and run time against error.
#pragma once

namespace bench {

/// Accelerations of a chain of 10^2 ... 10^6 rods, ns a body.
void print_acceleration_costs();

/// Error against evaluations of accelerations and processor time at tolerances 1e-3 ... 1e-12, all methods and what
/// `auto` chooses: a falling chain, four-bars through their flat position, Andrews' squeezing mechanism, a double
/// pendulum, the car axis. Errors are differences from a run at 1e-13, of the four-bars from the exact motion.
void print_dynamic_errors();

}  // namespace bench
