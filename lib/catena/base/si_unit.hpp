// The SI unit of every kind of quantity, as result files print it: "m", "rad/s", "N m/rad". A pure number has "1".
#pragma once

#include <string_view>

#include "catena/base/unit_kind.hpp"

namespace catena {

/// The unit in which numbers of this kind are stored and printed, in the syntax that scene files read back.
std::string_view si_unit(UnitKind kind);

}  // namespace catena
