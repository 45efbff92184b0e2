// Chains for the suites of statics: n rods of 1 m between pins 0.8 n apart, and masses between springs in a row.
#pragma once

#include <memory>
#include <span>

#include "catena/model/model.hpp"

namespace bench {

enum class ChainStart { bent, zigzag, random };
const char* name_of(ChainStart start);

/// `bent`: two straight halves that hang down.
std::shared_ptr<catena::Model> chain_between_pins(int rods, ChainStart start);

/// Largest distance of a joint from its exact place, m a rod. q: x, y, phi of every rod.
double error_at_rest(std::span<const double> q);

/// n particles of 1.5 kg on a line between n + 1 springs of 200 N/m, held at both ends; omega_j = 2 sqrt(k / m) sin(j
/// pi / (2 n + 2)).
std::shared_ptr<catena::Model> masses_between_springs(int n);
double exact_frequency(int n, int j);

}  // namespace bench
