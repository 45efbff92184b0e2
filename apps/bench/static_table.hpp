// Tables of static equilibrium: hanging chains from several starts, by Newton and by Ipopt.
#pragma once

namespace bench {

/// Iterations and ns a body an iteration against the number of links and the kind of start; microseconds and bytes a
/// link of everything from the scene's text to the certificate; Newton beside Ipopt on the same chain. Errors are those
/// of the horizontal force, against the exact one.
void print_static_tables();

}  // namespace bench
