// Instants at which functions of time jump, and how fast they move with design parameters.
//
//   f-^(k-1)(t*(p), p) = f+^(k-1)(t*(p), p)    =>    dt*/dp = -(f-,p^(k-1) - f+,p^(k-1)) / (f-^(k) - f+^(k))
//
// f- and f+ are the function just before and just after t*, k = 1, 2 or 3 the lowest derivative that jumps there: below
// it the two sides agree whatever the parameters are, and this moves the instant. What depends on the motion then has,
// beside its derivative at a fixed t, the part (c- - c+) dt*/dp in integrals of a column c, and (y'- - y'+) dt*/dp in a
// state y that a motion carries on. Singular where two jumps that move apart meet: the rate is not a number there.
// Units: s over the unit of the parameter. Source: apps/manual/sensitivity.md.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/base/design_scalar.hpp"
#include "catena/base/time_function.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

// A derivative that changes by less than this part of its size around the instant does not jump: both sides are
// polynomials or sines whose values there are rounded to 1e-16 x condition (1e-13 seen with laws of 1e3 s).
constexpr double no_jump_part = 1e-8;
// Sizes are looked for at 2^-k of the instant's own distance from zero, or of 1 s, on both sides.
constexpr int jump_looks = 24;

/// What a function does at an instant.
struct FunctionJump {
  int order = 0;  ///< of the lowest derivative that jumps: 1, 2 or 3; 0: none does
  std::array<double, parameters_at_once> rate{};
};
FunctionJump jump_of(const TimeFunction<DesignScalar>& function, double t);

/// df/dt at the end of a stretch, from its inside, by differences of order 4; nothing where f, or the motion, cannot be
/// looked at, or the differences do not settle.
std::optional<double> rate_at_end(const MotionStretch& stretch, const std::function<std::optional<double>(double)>& f);
/// The same of a single column.
std::optional<double> rate_at_end(const MotionStretch& stretch, const ColumnSet& column);

/// Whether all that jumps at an instant t moves together with it, by so much. The rate of an instant follows from a
/// function's two sides there, which do not tell one jump from two of the parts of a sum that happen to meet: those
/// move apart with the parameters, and what is made of the function has other values between them. `moved`: the
/// functions of a model with a parameter moved a little; no jump may be left near t but where the rate puts it.
bool jumps_together(const std::vector<TimeFunction<double>>& moved, double t, double by);

/// What the functions of a model do together at an instant.
struct MovingInstant {
  int order = 0;             ///< the lowest of those that jump; 0: none does
  std::vector<double> rate;  ///< dt*/dp by parameter; not a number where functions jump together that move apart
  bool jumps() const { return order > 0; }
  /// Whether some parameter moves it.
  bool moves() const {
    for (const double r : rate) {
      if (r != 0) return true;
    }
    return false;
  }
  /// Puts another function's jump beside, whose parameters begin with number `first`.
  void add(const FunctionJump& jump, std::size_t first);
};

}  // namespace catena
