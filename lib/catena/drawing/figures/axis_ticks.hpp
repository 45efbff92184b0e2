// Where an axis has its marks, and what stands at them.
//
//   linear   multiples of 1, 2 or 5 times a power of ten, about `wanted` of them
//   log      powers of ten, every second, third ... one where there are many
//
// Linear labels are exact to the step: with the same decimals all along the axis, or, where its largest value is 1e5
// and more or below 1e-3, in the form 2.5e-6.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace catena {

struct AxisTicks {
  double first = 0, last = 1;  ///< the range of the axis
  bool logarithmic = false;
  std::vector<double> at{};
  std::vector<std::string> labels{};

  /// Place of a value along the axis, 0 at its beginning, 1 at its end; not finite where it has none (a value that is
  /// not above zero on a logarithmic axis).
  double place(double value) const;
};

/// How far an axis goes: to round numbers, or to the values themselves.
enum class AxisEnds { round, tight };

/// The axis that shows every finite value. On a logarithmic one values that are not above zero have no place.
AxisTicks choose_ticks(std::span<const double> values, int wanted, bool logarithmic, AxisEnds ends = AxisEnds::round);

}  // namespace catena
