// Numbers with units: "30 deg", "120 mm", "6 N m/rad", "-9.81 m/s^2".
//
// A number, then units multiplied by blanks or * and divided by /; ^ raises the unit before it to an integer; / divides
// by the one unit that follows it (N/m s is (N/m) s). Units: m mm cm km in ft, kg g t lb, s ms min, Hz (1/s), rad deg
// rev, rpm, N kN lbf, Pa psi, J, W. The result is in SI and radians. Conversion factors are ratios of exactly stored
// numbers, so "120 mm" is the same double as 0.12 wherever the decimal is a short one.
#pragma once

#include <string_view>

#include "catena/scene/json/text_error.hpp"
#include "catena/scene/numbers/unit.hpp"

namespace catena {

struct Quantity {
  double value = 0;  ///< in SI units and radians; always finite
  Dimension dimension;
  bool has_unit = false;  ///< false for "0.12", which fields refuse
};

/// Reads the whole of `text`. Positions of errors are bytes in it.
Parsed<Quantity> parse_quantity(std::string_view text);

}  // namespace catena
