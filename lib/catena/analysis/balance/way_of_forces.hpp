// The way on which forces change by as much as they are: the length of a scene at rest in which nothing else gives one,
// of particles on springs without length, at one place.
//
//   way = min s:   max |F(q + s e) - F(q)| >= max |F(q)|        e: every particle, by unlike parts of s
//
// q the given configuration, F the sums of forces on particles, N; s doubles from the smallest numbers on. For a weight
// m g on a spring k that is m g / k, to within some octaves. Singular: where no force acts, or none changes, there is
// none.
#pragma once

#include "catena/assembly/evaluate.hpp"

namespace catena {

/// At the evaluator's time; it is left elsewhere. 0: there is none.
double way_of_forces(Evaluator& evaluator);

}  // namespace catena
