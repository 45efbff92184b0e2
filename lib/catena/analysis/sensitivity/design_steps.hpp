// A step of a motion in dual numbers, by the method of Dormand and Prince of order 8: the sums of its stages.
//
//   Y_s = y0 + h sum a_sj k_j,   y1 = y0 + h sum b_s k_s                       y = [q, qd], k their rates
//   y(t) = (1 - e) y0 + e y1 + h sum c_s k_s        inside of it, in derivatives alone (interpolant_weights)
//
// For motions whose derivatives are carried forward. Units of y. Source: analysis/motion/tableau.hpp,
// recomputed_steps.hpp.
#pragma once

#include <vector>

#include "catena/analysis/motion/derivative_error.hpp"
#include "catena/analysis/motion/tableau.hpp"
#include "catena/assembly/design/design_mechanism.hpp"

namespace catena {

/// Numbers with derivatives, over coordinates, rows or both.
using DesignVector = std::vector<DesignScalar>;

/// out = from + h sum weight k.
void combine_stages(const StageSum& sum, double h, const DesignVector& from, const std::vector<DesignVector>& stages,
                    DesignVector& out);
/// The derivatives of y at a part of a step of length h, which has 16 stages; values are left alone.
void interpolate_derivatives(double part, double h, const DesignVector& begin, const DesignVector& end,
                             const std::vector<DesignVector>& stages, DesignVector& y);
/// What they miss at the end, of one group (motion/derivative_error.hpp).
double error_of_derivatives(double h, const DesignVector& begin, const DesignVector& end,
                            const std::vector<DesignVector>& stages, const DerivativeAim& aim, std::size_t group);

}  // namespace catena
